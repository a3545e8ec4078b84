include(${CMAKE_CURRENT_LIST_DIR}/same_picture.cmake)

# Nothing from the build may help.
unset(ENV{LD_LIBRARY_PATH})

set(folder ${WORK}/installed)
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})
run(${folder} ${CMAKE_COMMAND} --install ${BUILD} --prefix ${folder}/staged --config "${CONFIG}")
# Moved, so that nothing that was written down about the place of installation can help either.
file(RENAME ${folder}/staged ${folder}/prefix)
file(GLOB_RECURSE files ${folder}/prefix/*)
foreach(file ${files})
    file(STRINGS ${file} traces REGEX "${folder}/staged")
    if(traces)
        message(FATAL_ERROR "${file} names the folder that it was installed into")
    endif()
endforeach()

set(pellucid ${folder}/prefix/bin/pellucid)
run(${folder} ${pellucid} --version)
string(STRIP "${said}" said)
if(NOT said STREQUAL VERSION)
    message(FATAL_ERROR "pellucid --version says '${said}', not ${VERSION}")
endif()

foreach(example minimal engine)
    run(${folder} ${CMAKE_COMMAND} -S ${EXAMPLES}/${example} -B ${folder}/${example} -G ${GENERATOR}
        -D CMAKE_BUILD_TYPE=${CONFIG} -D CMAKE_CXX_COMPILER=${CXX} "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}"
        -D CMAKE_PREFIX_PATH=${folder}/prefix -D CMAKE_FIND_PACKAGE_NO_PACKAGE_REGISTRY=ON)
    run(${folder} ${CMAKE_COMMAND} --build ${folder}/${example} --config "${CONFIG}")
endforeach()
expect_same_picture(${folder}/minimal/minimal ${pellucid} ${folder})
expect_engine_draws(${folder}/engine/engine ${folder})
message(STATUS "an installed, moved copy is found, built against, and renders the same picture")
