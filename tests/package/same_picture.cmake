# Runs a command and stops with what it said if it fails.
function(run folder)
    execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${folder} RESULT_VARIABLE result OUTPUT_VARIABLE said ERROR_VARIABLE said)
    if(NOT result EQUAL 0)
        list(JOIN ARGN " " command)
        message(FATAL_ERROR "${command}\nended with ${result}:\n${said}")
    endif()
    set(said "${said}" PARENT_SCOPE)
endfunction()

# The picture that `minimal` writes into `folder` is, byte for byte, the one that the command line renders.
function(expect_same_picture minimal pellucid folder)
    file(REMOVE ${folder}/goblet.png ${folder}/command-line.png)
    run(${folder} ${minimal})
    run(${folder} ${pellucid} render shape:goblet -o command-line.png)
    execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${folder}/goblet.png ${folder}/command-line.png
                    RESULT_VARIABLE differ)
    if(differ)
        message(FATAL_ERROR "${folder}/goblet.png and command-line.png differ")
    endif()
endfunction()

# The engine draws frames, of which the first may lack room and the last does not.
function(expect_engine_draws engine folder)
    file(REMOVE ${folder}/engine.ppm)
    run(${folder} ${engine} 4 engine.ppm)
    if(NOT said MATCHES "4 frames of 640x360")
        message(FATAL_ERROR "${engine} said:\n${said}")
    endif()
    file(SIZE ${folder}/engine.ppm size)
    if(NOT size EQUAL 691215)  # 640 x 360 x 3 and a header
        message(FATAL_ERROR "${folder}/engine.ppm has ${size} bytes")
    endif()
endfunction()
