include(${CMAKE_CURRENT_LIST_DIR}/same_picture.cmake)

set(folder ${WORK}/in-tree)
file(MAKE_DIRECTORY ${folder})
expect_same_picture(${MINIMAL} ${PELLUCID} ${folder})
message(STATUS "the example and the command line render the same picture")
