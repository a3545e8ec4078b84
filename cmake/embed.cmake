# Makes `#include "NAME.inc"` (the file's bytes, comma separated) available to the target.
function(pellucid_embed_files target)
    set(outputs "")
    foreach(file ${ARGN})
        get_filename_component(name ${file} NAME)
        set(source ${CMAKE_CURRENT_SOURCE_DIR}/${file})
        set(output ${PROJECT_BINARY_DIR}/embedded/${name}.inc)
        add_custom_command(
            OUTPUT ${output}
            COMMAND ${CMAKE_COMMAND} -D INPUT=${source} -D OUTPUT=${output}
                    -P ${PROJECT_SOURCE_DIR}/cmake/write_bytes.cmake
            DEPENDS ${source} ${PROJECT_SOURCE_DIR}/cmake/write_bytes.cmake
            COMMENT "Embedding ${name}"
            VERBATIM)
        list(APPEND outputs ${output})
    endforeach()
    target_sources(${target} PRIVATE ${outputs})
    target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/embedded)
endfunction()
