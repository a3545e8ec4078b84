# A room is one folder under src/ and one static library that links only the rooms it names.
#   pellucid_room(NAME SOURCES a.cpp ... USES other rooms ... LIBRARIES packages ...)
add_library(pellucid_options INTERFACE)
target_include_directories(pellucid_options INTERFACE
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>)
target_compile_options(pellucid_options INTERFACE
    -Wall -Wextra -Wshadow -Wnon-virtual-dtor $<$<BOOL:${PELLUCID_WERROR}>:-Werror>)

function(pellucid_room name)
    cmake_parse_arguments(ROOM "" "PCH_OF" "SOURCES;USES;LIBRARIES;PCH;SHADERS" ${ARGN})
    set(target pellucid_${name})
    list(TRANSFORM ROOM_USES PREPEND pellucid_)
    if(NOT ROOM_SOURCES)  # headers only
        add_library(${target} INTERFACE)
        target_link_libraries(${target} INTERFACE pellucid_options ${ROOM_USES} ${ROOM_LIBRARIES})
        return()
    endif()
    add_library(${target} OBJECT ${ROOM_SOURCES})
    target_link_libraries(${target} PUBLIC pellucid_options ${ROOM_USES} ${ROOM_LIBRARIES})
    if(ROOM_PCH_OF)
        target_precompile_headers(${target} REUSE_FROM pellucid_${ROOM_PCH_OF})
    elseif(ROOM_PCH)
        target_precompile_headers(${target} PRIVATE ${ROOM_PCH})
    endif()
    if(ROOM_SHADERS)
        pellucid_embed_shaders(${target} ${ROOM_SHADERS})
    endif()
endfunction()
