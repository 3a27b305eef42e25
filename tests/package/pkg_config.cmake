# The compiler alone, with what pkg-config says, builds the same programs.
cmake_minimum_required(VERSION 3.22)
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
find_program(PKG_CONFIG NAMES pkg-config pkgconf)
if(NOT PKG_CONFIG)
  message(FATAL_ERROR "pkg-config is not installed")
endif()
set(ENV{PKG_CONFIG_PATH} ${PREFIX}/${LIBDIR}/pkgconfig)
set(ENV{LD_LIBRARY_PATH} ${PREFIX}/${LIBDIR})   # for shared libraries
set(build ${WORK}/by_pkg_config)
file(MAKE_DIRECTORY ${build})

function(build_by_pkg_config package compiler standard source program)
  run(${PKG_CONFIG} --modversion ${package})
  expect("${OUTPUT}" "${VERSION}")
  run(${PKG_CONFIG} --cflags --libs ${package})
  separate_arguments(flags UNIX_COMMAND "${OUTPUT}")
  separate_arguments(own_flags UNIX_COMMAND "${CXX_FLAGS}")
  run(${compiler} ${standard} ${own_flags} ${source} -o ${build}/${program} ${flags})
  run(${CMAKE_COMMAND} -E chdir ${build} ${build}/${program})
  set(OUTPUT "${OUTPUT}" PARENT_SCOPE)
endfunction()

set(sources ${CMAKE_CURRENT_LIST_DIR}/consumer)
build_by_pkg_config(brainshift ${CXX_COMPILER} -std=c++17 ${sources}/consumer.cpp consumer)
expect("${OUTPUT}" "libbrainshift ${VERSION}: converged")
if("io" IN_LIST COMPONENTS)
  build_by_pkg_config(brainshift-io ${CXX_COMPILER} -std=c++17 ${sources}/io_consumer.cpp io_consumer)
  expect("${OUTPUT}" "read back 1 tet")
endif()
if("c" IN_LIST COMPONENTS)
  build_by_pkg_config(brainshift_c ${C_COMPILER} -std=c99 ${SOURCE}/examples/hello.c c_consumer)
endif()

# A wrong version is refused, by name.
execute_process(COMMAND ${PKG_CONFIG} --print-errors "brainshift >= 99" RESULT_VARIABLE result
                ERROR_VARIABLE errors)
if(result EQUAL 0)
  message(FATAL_ERROR "version 99 was found")
endif()
expect("${errors}" "99")

# A program whose vector flags make Eigen align otherwise does not link, and the linker says why.
if(PROCESSOR MATCHES "x86_64|AMD64" AND NOT CXX_FLAGS MATCHES "-m(avx|arch)")
  run(${PKG_CONFIG} --cflags --libs brainshift)
  separate_arguments(flags UNIX_COMMAND "${OUTPUT}")
  execute_process(COMMAND ${CXX_COMPILER} -std=c++17 -mavx2 ${sources}/consumer.cpp -o ${build}/avx2 ${flags}
                  RESULT_VARIABLE result ERROR_VARIABLE errors)
  if(result EQUAL 0)
    message(FATAL_ERROR "a consumer built with -mavx2 was linked to a library built without")
  endif()
  expect("${errors}" "brainshift_is_built_with_other_vector_flags__this_program_aligns_by_32_and_32")
endif()
