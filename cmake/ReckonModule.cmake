# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# reckon_module(<name> [SOURCES ...] [DEPENDS ...] [PRIVATE ...])
#   One static library per folder of src/reckon, reachable as reckon::<name>.
#   DEPENDS: modules and libraries that its headers need; PRIVATE: only its sources.
#   A module without sources is a header-only interface target.
function(reckon_module name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS;PRIVATE" ${ARGN})
  if(arg_SOURCES)
    add_library(reckon_${name} STATIC ${arg_SOURCES})
    target_link_libraries(reckon_${name} PUBLIC reckon_flags ${arg_DEPENDS} PRIVATE ${arg_PRIVATE})
    set_target_properties(reckon_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  else()
    add_library(reckon_${name} INTERFACE)
    target_link_libraries(reckon_${name} INTERFACE reckon_flags ${arg_DEPENDS})
  endif()
  add_library(reckon::${name} ALIAS reckon_${name})
endfunction()

# reckon_test(<name> SOURCES ... DEPENDS ... [LABELS ...] [OWN_UNITS ...])
#   One GoogleTest executable; every TEST in it becomes a ctest entry. Labels, which ./check goes by:
#   slow     over about ten seconds: not under the sanitizers
#   long     many minutes: only in ./check --long
#   threads  exercises threads: also runs under the thread sanitizer
#   OWN_UNITS: sources with names that others define, too. A unity build, which the sanitizers use,
#   compiles each of them alone.
function(reckon_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS;LABELS;OWN_UNITS" ${ARGN})
  include(GoogleTest)
  set_source_files_properties(${arg_OWN_UNITS} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  add_executable(test_${name} ${arg_SOURCES})
  target_include_directories(test_${name} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  target_link_libraries(test_${name} PRIVATE reckon_flags ${arg_DEPENDS} GTest::gtest_main)
  target_compile_definitions(test_${name} PRIVATE RECKON_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  list(JOIN arg_LABELS "," labels)  # one label; ctest -L finds its parts, being a search
  if(labels)
    set(labels LABELS "${labels}")
  endif()
  gtest_discover_tests(test_${name} TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST
    PROPERTIES ${labels}
    ENVIRONMENT "OMP_WAIT_POLICY=passive"  # tests share the cores
    # Builds that test at the same time must not write into each other's temporary files. (As a
    # modification, since a list of two variables would fall apart on its way to ctest.)
    ENVIRONMENT_MODIFICATION "TEST_TMPDIR=set:${CMAKE_CURRENT_BINARY_DIR}/")
  if(threads IN_LIST arg_LABELS)
    if(NOT TARGET threaded_tests)
      add_custom_target(threaded_tests)
    endif()
    add_dependencies(threaded_tests test_${name})
  endif()
endfunction()
