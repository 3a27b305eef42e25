# A project that takes the sources in by FetchContent gets the libraries and nothing else: no tests, no
# examples, no install rules, its own flags and build type untouched.
cmake_minimum_required(VERSION 3.22)
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
set(build ${WORK}/by_fetch_content)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/fetch -B ${build} -G ${GENERATOR}
    -DFETCHCONTENT_SOURCE_DIR_BRAINSHIFT=${SOURCE} -DCMAKE_C_COMPILER=${C_COMPILER}
    -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${CCACHE}
    "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}" "-DCMAKE_C_FLAGS=${CXX_FLAGS}"
    -DBUILD_TYPE=${BUILD_TYPE} -DBRAINSHIFT_WITH_CHOLMOD=${CHOLMOD})
set(programs consumer)
if("c" IN_LIST COMPONENTS)
  list(APPEND programs c_consumer)
endif()
run(${CMAKE_COMMAND} --build ${build} --parallel 2 --target ${programs})
foreach(program IN LISTS programs)
  run(${build}/${program})
  expect("${OUTPUT}" "libbrainshift ${VERSION}")
endforeach()
