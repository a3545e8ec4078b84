# What `cmake --install` puts where, by component. Nothing installed knows where it was built or installed.
#   runtime      the library, the command line, man pages and completion
#   development  headers, and the files that find_package(pellucid) and pkg-config read
#   viewer       pellucid-view
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pellucid)

install(TARGETS pellucid EXPORT pellucid-targets
        LIBRARY COMPONENT runtime NAMELINK_COMPONENT development)
# pellucid looks for these beside itself.
install(TARGETS pellucid_images LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime)
install(TARGETS pellucid_reader RUNTIME DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime)
install(EXPORT pellucid-targets NAMESPACE pellucid:: DESTINATION ${package_dir} COMPONENT development)
install(DIRECTORY include/pellucid DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
        FILES_MATCHING PATTERN "*.h")

configure_package_config_file(cmake/pellucid-config.cmake.in pellucid-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pellucid-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pellucid-config.cmake ${PROJECT_BINARY_DIR}/pellucid-config-version.cmake
        DESTINATION ${package_dir} COMPONENT development)
set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH prefix_from_pkgconfig /prefix/${pkgconfig_dir} /prefix)
configure_file(cmake/pellucid.pc.in pellucid.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/pellucid.pc DESTINATION ${pkgconfig_dir} COMPONENT development)

# Programs find the library relative to themselves, wherever both are moved.
file(RELATIVE_PATH lib_from_bin /prefix/${CMAKE_INSTALL_BINDIR} /prefix/${CMAKE_INSTALL_LIBDIR})
set_target_properties(pellucid_cli PROPERTIES INSTALL_RPATH "$ORIGIN/${lib_from_bin}")
install(TARGETS pellucid_cli RUNTIME COMPONENT runtime)
if(TARGET pellucid_viewer)
    set_target_properties(pellucid_viewer PROPERTIES INSTALL_RPATH "$ORIGIN/${lib_from_bin}")
    install(TARGETS pellucid_viewer RUNTIME COMPONENT viewer)
endif()

# Man pages and completion, made by running the programs.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
set(manuals ${PROJECT_BINARY_DIR}/manuals)
set(make_manuals ${PROJECT_SOURCE_DIR}/tools/make_manuals)
add_custom_command(OUTPUT ${manuals}/made
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${manuals}
    COMMAND Python3::Interpreter ${make_manuals} $<TARGET_FILE:pellucid_cli> ${manuals}
        "$<$<TARGET_EXISTS:pellucid_viewer>:--viewer;$<TARGET_FILE:$<IF:$<TARGET_EXISTS:pellucid_viewer>,pellucid_viewer,pellucid_cli>>>"
    COMMAND ${CMAKE_COMMAND} -E touch ${manuals}/made
    DEPENDS pellucid_cli $<TARGET_NAME_IF_EXISTS:pellucid_viewer> ${make_manuals} ${PROJECT_SOURCE_DIR}/CHANGELOG.md
    COMMENT "Making man pages and completion" COMMAND_EXPAND_LISTS VERBATIM)
add_custom_target(pellucid_manuals ALL DEPENDS ${manuals}/made)

function(install_manuals component files)  # a regular expression
    foreach(section 1 7)
        install(DIRECTORY ${manuals}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section} COMPONENT ${component}
                FILES_MATCHING REGEX "/${files}\\.${section}$")
    endforeach()
    foreach(shell_folder bash:bash-completion/completions zsh:zsh/vendor-completions fish:fish/vendor_completions.d)
        string(REPLACE ":" ";" shell_folder ${shell_folder})
        list(GET shell_folder 0 shell)
        list(GET shell_folder 1 folder)
        install(DIRECTORY ${manuals}/${shell}/ DESTINATION ${CMAKE_INSTALL_DATADIR}/${folder} COMPONENT ${component}
                FILES_MATCHING REGEX "/_?${files}(\\.fish)?$")
    endforeach()
endfunction()
install_manuals(runtime "pellucid(-[a-uw-z][a-z]*|-volume)?")
if(TARGET pellucid_viewer)
    install_manuals(viewer "pellucid-view")
endif()

install(FILES LICENSE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
