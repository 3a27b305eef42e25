# A CMake project of its own finds the package by its components, builds and runs.
cmake_minimum_required(VERSION 3.22)
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
set(build ${WORK}/by_find_package)
string(REPLACE ";" "," components "${COMPONENTS}")
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${build} -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${PREFIX} -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF -DCOMPONENTS=${components}
    -DVERSION=${VERSION} -DC_COMPONENT_SOURCE=${SOURCE}/examples/hello.c
    -DCMAKE_C_COMPILER=${C_COMPILER} -DCMAKE_CXX_COMPILER=${CXX_COMPILER}
    "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}" "-DCMAKE_C_FLAGS=${CXX_FLAGS}")
run(${CMAKE_COMMAND} --build ${build})
run(${build}/consumer)
expect("${OUTPUT}" "libbrainshift ${VERSION}: converged")
if("io" IN_LIST COMPONENTS)
  run(${CMAKE_COMMAND} -E chdir ${build} ${build}/io_consumer)
  expect("${OUTPUT}" "read back 1 tet")
endif()
if("c" IN_LIST COMPONENTS)
  run(${build}/c_consumer)
endif()

# Another minor version may break what is there before 1.0: older and newer ones are refused.
foreach(wrong 0.0 0.2 1.0 99)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${WORK}/wrong_version
      -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${PREFIX} -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
      -DCOMPONENTS=core -DVERSION=${wrong}
      RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE errors)
  if(result EQUAL 0)
    message(FATAL_ERROR "version ${wrong} was accepted")
  endif()
  expect("${errors}" "requested version \"${wrong}\"")
endforeach()
