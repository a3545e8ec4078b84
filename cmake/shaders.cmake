# Compiles GLSL to SPIR-V and declares it: `#include "MODULE/shaders.h"` has a ShaderCode pellucid::shaders::STEM_EXT
# for each shader of a module. Names are kept in the SPIR-V: bindings are checked against them (gpu/program.h).
#
# Every shader depends on every shared file. glslc could list the true dependencies, but does not
# escape spaces in them, and a shader compiles in a fraction of a second.
file(GLOB_RECURSE pellucid_shader_includes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*.glsl)
list(APPEND pellucid_shader_includes ${PROJECT_SOURCE_DIR}/src/gpu/structs.h)

function(pellucid_embed_shaders target)
    string(REGEX REPLACE "^pellucid_" "" module ${target})
    set(folder ${PROJECT_BINARY_DIR}/shaders)
    set(declared "")
    set(defined "")
    set(outputs "")
    foreach(shader ${ARGN})
        get_filename_component(name ${shader} NAME)
        set(source ${CMAKE_CURRENT_SOURCE_DIR}/${shader})
        set(output ${folder}/${module}/${name}.inc)
        add_custom_command(
            OUTPUT ${output}
            COMMAND Vulkan::glslc --target-env=vulkan1.3 -Werror -I ${PROJECT_SOURCE_DIR}/src
                    -mfmt=num -o ${output} ${source}
            DEPENDS ${source} ${pellucid_shader_includes}
            COMMENT "Compiling shader ${name}"
            VERBATIM)
        list(APPEND outputs ${output})
        string(MAKE_C_IDENTIFIER ${name} variable)
        string(APPEND declared "extern const ShaderCode ${variable};\n")
        string(APPEND defined "constexpr std::uint32_t ${variable}_words[] = {\n#include \"${module}/${name}.inc\"\n};\n"
               "constinit const ShaderCode ${variable}{\"${name}\", ${variable}_words};\n")
    endforeach()
    set(begin "#include \"gpu/program.h\"\n\nnamespace pellucid::shaders {\n")
    file(CONFIGURE OUTPUT ${folder}/${module}/shaders.h CONTENT "#pragma once\n${begin}${declared}}\n" @ONLY)
    file(CONFIGURE OUTPUT ${folder}/${module}/shaders.cpp CONTENT
         "#include \"${module}/shaders.h\"\n${begin}${defined}}\n" @ONLY)
    target_sources(${target} PRIVATE ${folder}/${module}/shaders.cpp ${outputs})
    target_include_directories(${target} PUBLIC ${folder})
endfunction()
