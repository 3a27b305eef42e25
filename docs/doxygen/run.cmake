# Writes the reference; fails where Doxygen has a warning. From the root of the repository:
# cmake -DDOXYGEN=doxygen -DOUT=FOLDER -P docs/doxygen/run.cmake
file(MAKE_DIRECTORY ${OUT})
file(READ docs/doxygen/Doxyfile settings)
file(WRITE ${OUT}/Doxyfile "${settings}\nOUTPUT_DIRECTORY = ${OUT}\n")
execute_process(COMMAND ${DOXYGEN} ${OUT}/Doxyfile RESULT_VARIABLE failed ERROR_VARIABLE said)
if(failed OR said)
  message(FATAL_ERROR "${said}")
endif()
