# The viewer: what needs no window as units, and the program in a window of an X server of the tests' own (Xvfb).
pellucid_test(viewer_tests
    SOURCES
        viewer/test_equal_command.cpp viewer/test_frame_pace.cpp viewer/test_orbit_camera.cpp viewer/test_saved_state.cpp
        viewer/test_script.cpp
    LIBRARIES pellucid_viewer_parts)

find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
    pkg_check_modules(XCB QUIET IMPORTED_TARGET xcb xcb-xtest)
endif()
if(TARGET pellucid_viewer AND XCB_FOUND)
    add_executable(x_client viewer/x_client.cpp)
    target_link_libraries(x_client PRIVATE pellucid PkgConfig::XCB fmt::fmt)
    set(file ${CMAKE_CURRENT_SOURCE_DIR}/viewer/test_viewer.py)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(STRINGS ${file} classes REGEX "^class .*\\(ViewerTest")
    foreach(class ${classes})
        string(REGEX REPLACE "^class ([A-Za-z]+).*" "\\1" class ${class})
        add_test(NAME viewer.${class} COMMAND Python3::Interpreter ${file} ${class})
        set_tests_properties(viewer.${class} PROPERTIES
            ENVIRONMENT "PELLUCID_VIEWER=$<TARGET_FILE:pellucid_viewer>;PELLUCID_BINARY=$<TARGET_FILE:pellucid_cli>;PELLUCID_X_CLIENT=$<TARGET_FILE:x_client>;PYTHONDONTWRITEBYTECODE=1;${pellucid_test_cache}"
            SKIP_RETURN_CODE 77)
        pellucid_label_tests(${PROJECT_SOURCE_DIR}/tests viewer.${class})
    endforeach()
endif()
