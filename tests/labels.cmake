# Labels and time limits of tests, by name: slow.txt and long.txt say which are left out by `./test` and `./test --ci`; all
# others are `quick`. Read when
# CMake configures (tests of scripts) and by ctest (tests that executables list). The limits are ten times what a quiet machine
# needs, so that a busy one does not fail.
function(pellucid_label_tests folder)
    foreach(label slow long)
        file(STRINGS ${folder}/${label}.txt ${label} REGEX "^[^#]")
        list(JOIN ${label} "|" ${label})
    endforeach()
    foreach(test IN LISTS ARGN)
        if(test MATCHES "${long}")
            set_tests_properties("${test}" PROPERTIES LABELS long TIMEOUT 3600)
        elseif(test MATCHES "${slow}")
            set_tests_properties("${test}" PROPERTIES LABELS slow TIMEOUT 1200)
        else()
            set_tests_properties("${test}" PROPERTIES LABELS quick TIMEOUT 300)
        endif()
    endforeach()
endfunction()
