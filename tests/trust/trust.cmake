# What docs/trust.md promises beside the tests of each part: failures, determinism, threads, long runs.
add_library(pellucid_failing_layer MODULE trust/failing_layer.cpp)
target_include_directories(pellucid_failing_layer PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
set(failing_layer_folder ${CMAKE_CURRENT_BINARY_DIR}/failing_layer)
set_target_properties(pellucid_failing_layer PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${failing_layer_folder} CXX_VISIBILITY_PRESET hidden)
set(library ${failing_layer_folder}/libpellucid_failing_layer.so)
configure_file(trust/failing_layer.json.in ${failing_layer_folder}/VkLayer_pellucid_failing.json @ONLY)

pellucid_test(trust_tests
    SOURCES
        trust/test_failures.cpp trust/test_long_runs.cpp trust/test_repeatable_tracers.cpp trust/test_same_pictures.cpp trust/test_statistics.cpp
    LIBRARIES Vulkan::Vulkan)
add_dependencies(trust_tests pellucid_failing_layer)
target_compile_definitions(trust_tests PRIVATE PELLUCID_FAILING_LAYER_FOLDER="${failing_layer_folder}")
