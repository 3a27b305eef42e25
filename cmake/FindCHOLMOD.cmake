# CHOLMOD::CHOLMOD, from libcholmod and cholmod.h (Debian ships no package config for it).
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse)
find_library(CHOLMOD_LIBRARY cholmod)
if(CHOLMOD_INCLUDE_DIR)
  file(STRINGS "${CHOLMOD_INCLUDE_DIR}/cholmod_core.h" _lines REGEX "define CHOLMOD_(MAIN|SUB|SUBSUB)_VERSION")
  string(REGEX MATCHALL "_VERSION +([0-9]+)" _parts "${_lines}")
  string(REGEX REPLACE "_VERSION +" "" _parts "${_parts}")
  list(JOIN _parts "." CHOLMOD_VERSION)
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(CHOLMOD REQUIRED_VARS CHOLMOD_LIBRARY CHOLMOD_INCLUDE_DIR
                                  VERSION_VAR CHOLMOD_VERSION)
if(CHOLMOD_FOUND AND NOT TARGET CHOLMOD::CHOLMOD)
  add_library(CHOLMOD::CHOLMOD UNKNOWN IMPORTED)
  set_target_properties(CHOLMOD::CHOLMOD PROPERTIES
    IMPORTED_LOCATION "${CHOLMOD_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${CHOLMOD_INCLUDE_DIR}")
endif()
mark_as_advanced(CHOLMOD_INCLUDE_DIR CHOLMOD_LIBRARY)
