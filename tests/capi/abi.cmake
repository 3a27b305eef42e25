# The ABI of the C face beside the recorded one, capi/abi/brainshift_c.abi.
find_program(ABIDIFF abidiff)
if(NOT ABIDIFF)
  message(STATUS "brainshift: the ABI of the C face is not compared: no abidiff (Debian: abigail-tools)")
  foreach(name abi abi_of_changes)
    add_test(NAME capi.${name} COMMAND ${CMAKE_COMMAND} -E echo "skipped: abidiff is not installed")
    set_tests_properties(capi.${name} PROPERTIES SKIP_REGULAR_EXPRESSION "skipped:" LABELS unit)
  endforeach()
  return()
endif()
get_target_property(soversion brainshift_c SOVERSION)
add_library(brainshift_c_abi SHARED ${PROJECT_SOURCE_DIR}/capi/abi/functions.c)
target_include_directories(brainshift_c_abi PRIVATE ${PROJECT_SOURCE_DIR}/include)
# DWARF 4 and no optimisation: what the recorded one was made from.
target_compile_options(brainshift_c_abi PRIVATE -g -gdwarf-4 -O0 -w -fno-sanitize=all)
target_link_options(brainshift_c_abi PRIVATE -fno-sanitize=all)
set_target_properties(brainshift_c_abi PROPERTIES OUTPUT_NAME brainshift_c SOVERSION ${soversion}
  LIBRARY_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/abi)
set(check ${PROJECT_SOURCE_DIR}/capi/abi/check)
add_test(NAME capi.abi COMMAND ${check} $<TARGET_FILE:brainshift_c_abi>)
# And what the check is worth: headers with one change each.
add_test(NAME capi.abi_of_changes COMMAND ${CMAKE_COMMAND} -DCHECK=${check} -DSOVERSION=${soversion}
         -DSOURCE=${PROJECT_SOURCE_DIR} -DWORK=${CMAKE_CURRENT_BINARY_DIR}/abi_of_changes
         -DC_COMPILER=${CMAKE_C_COMPILER} -P ${CMAKE_CURRENT_SOURCE_DIR}/abi_of_changes.cmake)
set_tests_properties(capi.abi capi.abi_of_changes PROPERTIES LABELS unit TIMEOUT 300)
