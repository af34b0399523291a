# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# httplib::httplib: cpp-httplib as distributions build it, with the settings that it was built with
# (they change its layout), or its header alone.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(PC_httplib QUIET IMPORTED_TARGET cpp-httplib)
endif()
find_path(httplib_INCLUDE_DIR httplib.h HINTS ${PC_httplib_INCLUDE_DIRS})
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(httplib REQUIRED_VARS httplib_INCLUDE_DIR)
if(httplib_FOUND AND NOT TARGET httplib::httplib)
  add_library(httplib::httplib INTERFACE IMPORTED)
  if(TARGET PkgConfig::PC_httplib)
    target_link_libraries(httplib::httplib INTERFACE PkgConfig::PC_httplib)
  else()
    target_include_directories(httplib::httplib SYSTEM INTERFACE "${httplib_INCLUDE_DIR}")
  endif()
endif()
mark_as_advanced(httplib_INCLUDE_DIR)
