# Compiles GLSL to SPIR-V and makes `#include "STEM.EXT.inc"` (the words, comma separated) available
# to the target. Names are kept in the SPIR-V: bindings are checked against them (gpu/program.h).
#
# Every shader depends on every shared file. glslc could list the true dependencies, but does not
# escape spaces in them, and a shader compiles in a fraction of a second.
file(GLOB_RECURSE pellucid_shader_includes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*.glsl)
list(APPEND pellucid_shader_includes ${PROJECT_SOURCE_DIR}/src/gpu/structs.h)

function(pellucid_embed_shaders target)
    set(outputs "")
    foreach(shader ${ARGN})
        get_filename_component(name ${shader} NAME)
        set(source ${CMAKE_CURRENT_SOURCE_DIR}/${shader})
        set(output ${PROJECT_BINARY_DIR}/shaders/${name}.inc)
        add_custom_command(
            OUTPUT ${output}
            COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/shaders
            COMMAND Vulkan::glslc --target-env=vulkan1.3 -Werror -I ${PROJECT_SOURCE_DIR}/src
                    -mfmt=num -o ${output} ${source}
            DEPENDS ${source} ${pellucid_shader_includes}
            COMMENT "Compiling shader ${name}"
            VERBATIM)
        list(APPEND outputs ${output})
    endforeach()
    target_sources(${target} PRIVATE ${outputs})
    target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/shaders)
endfunction()
