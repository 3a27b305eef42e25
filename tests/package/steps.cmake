# Shared by the scripts of this folder.
set(PREFIX ${WORK}/moved)

# Runs a command; ends the test with its output where it fails. The output is left in OUTPUT.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${result}): ${command}\n${output}\n${errors}")
  endif()
  set(OUTPUT "${output}" PARENT_SCOPE)
endfunction()

function(expect text words)
  string(FIND "${text}" "${words}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "expected '${words}' in:\n${text}")
  endif()
endfunction()
