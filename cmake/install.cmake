# What `cmake --install` puts where: the library, its headers, the command line, and what
# find_package(pellucid) reads. Nothing installed knows where it was built or installed.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pellucid)

install(TARGETS pellucid EXPORT pellucid-targets)
install(TARGETS pellucid_images LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})  # pellucid looks for it beside itself
install(EXPORT pellucid-targets NAMESPACE pellucid:: DESTINATION ${package_dir})
install(DIRECTORY include/pellucid DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")

configure_package_config_file(cmake/pellucid-config.cmake.in pellucid-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pellucid-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pellucid-config.cmake ${PROJECT_BINARY_DIR}/pellucid-config-version.cmake
        DESTINATION ${package_dir})

# Programs find the library relative to themselves, wherever both are moved.
file(RELATIVE_PATH lib_from_bin /prefix/${CMAKE_INSTALL_BINDIR} /prefix/${CMAKE_INSTALL_LIBDIR})
set(programs pellucid_cli)
if(TARGET pellucid_viewer)
    list(APPEND programs pellucid_viewer)
endif()
set_target_properties(${programs} PROPERTIES INSTALL_RPATH "$ORIGIN/${lib_from_bin}")
install(TARGETS ${programs})

install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
