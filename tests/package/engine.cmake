include(${CMAKE_CURRENT_LIST_DIR}/same_picture.cmake)

set(folder ${WORK}/engine-in-tree)
file(MAKE_DIRECTORY ${folder})
expect_engine_draws(${ENGINE} ${folder})
message(STATUS "the engine draws its world, and glass in it")
