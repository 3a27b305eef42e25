# Installation: headers, libraries, a CMake package with components, pkg-config files. All of it may
# be moved as a whole. Components: core (C++), io (C++, files), c (the C library, core inside).
include(CMakePackageConfigHelpers)

file(STRINGS include/brainshift/version.hpp _version REGEX "define BRAINSHIFT_VERSION \"")
if(NOT _version MATCHES "\"${PROJECT_VERSION}\"")
  message(FATAL_ERROR "include/brainshift/version.hpp does not say ${PROJECT_VERSION}: ${_version}")
endif()

set(_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/brainshift)
# Of the whole, as linked. CHOLMOD's Supernodal is GPL-2.0-or-later; METIS is Apache-2.0, which goes
# with the GPL from version 3 on.
set(_licence "BSD-3-Clause AND MPL-2.0 AND Apache-2.0")
if(BRAINSHIFT_WITH_CHOLMOD)
  set(_licence "GPL-3.0-or-later")
endif()

# Installs the library, for others brainshift::<name>, and the file brainshift-<component>-targets.cmake.
function(brainshift_install target component name)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS ${target} EXPORT brainshift-${component}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
          RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(EXPORT brainshift-${component} NAMESPACE brainshift:: DESTINATION ${_package_dir}
          FILE brainshift-${component}-targets.cmake)
  # Libraries of this project find each other wherever they are moved together.
  set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN")
endfunction()

# Writes <name>.pc. requires: other .pc files; libs: flags, the dependencies among them in `private`,
# which a static library needs said at every link.
function(brainshift_pkg_config name description library requires private)
  set(PC_NAME ${name})
  set(PC_DESCRIPTION "${description}")
  set(PC_REQUIRES "${requires}")
  set(PC_LIBS "-l${library}")
  set(PC_LIBS_PRIVATE "${private}")
  get_target_property(type ${library} TYPE)
  if(type STREQUAL "STATIC_LIBRARY")
    string(APPEND PC_LIBS " ${private}")
    set(PC_LIBS_PRIVATE "")
  endif()
  set(PC_LICENCE "${_licence}")
  file(RELATIVE_PATH PC_PREFIX "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
  string(REGEX REPLACE "/$" "" PC_PREFIX "${PC_PREFIX}")
  configure_file(cmake/brainshift.pc.in ${name}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()

set(_solvers "-lmetis -pthread")
if(BRAINSHIFT_WITH_CHOLMOD)
  set(_solvers "-lcholmod -llapack -lblas -lmetis -pthread")
endif()

file(GLOB _headers CONFIGURE_DEPENDS include/brainshift/*.hpp)
list(REMOVE_ITEM _headers ${CMAKE_CURRENT_SOURCE_DIR}/include/brainshift/io.hpp)
install(FILES ${_headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/brainshift)
brainshift_install(brainshift core brainshift)
brainshift_pkg_config(brainshift "Predicts brain shift in deep brain stimulation surgery"
                      brainshift eigen3 "${_solvers}")
if(TARGET brainshift_io)
  install(FILES include/brainshift/io.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/brainshift)
  brainshift_install(brainshift_io io io)
  brainshift_pkg_config(brainshift-io "VTK files of libbrainshift" brainshift_io brainshift
                        "-lpugixml -lz")
endif()
if(TARGET brainshift_c)
  install(FILES include/brainshift/c/brainshift.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/brainshift/c)
  # The Python module looks for the library two folders above.
  install(FILES python/brainshift.py DESTINATION ${CMAKE_INSTALL_LIBDIR}/brainshift/python)
  brainshift_install(brainshift_c c brainshift_c)
  brainshift_pkg_config(brainshift_c "The C face of libbrainshift" brainshift_c "" "")
endif()

configure_package_config_file(cmake/brainshiftConfig.cmake.in brainshiftConfig.cmake
                              INSTALL_DESTINATION ${_package_dir})
write_basic_package_version_file(brainshiftConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/brainshiftConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/brainshiftConfigVersion.cmake
              cmake/FindMETIS.cmake cmake/FindCHOLMOD.cmake
        DESTINATION ${_package_dir})
install(FILES LICENSE THIRD_PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
