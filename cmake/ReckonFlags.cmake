# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# One interface target, reckon_flags, carries what every translation unit shares.

add_library(reckon_flags INTERFACE)
target_compile_features(reckon_flags INTERFACE cxx_std_20)
target_include_directories(reckon_flags INTERFACE
  "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>"
  "$<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>"
  "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")

# The determinism contract: a*b+c must round the same on every machine and in every
# kernel variant, so the compiler may not fuse it. (-fno-math-errno only lets sqrt
# become one instruction; it changes no result.)
target_compile_options(reckon_flags INTERFACE -ffp-contract=off -fno-math-errno)

# Warnings concern the project itself, not users who link its libraries.
set(reckon_warnings
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor
  -Woverloaded-virtual -Wold-style-cast
  -Wno-missing-field-initializers)  # left-out designated initialisers take the stated defaults
if(CMAKE_UNITY_BUILD)
  list(APPEND reckon_warnings -Wno-shadow)  # names of one source seem to shadow those of another
endif()
if(RECKON_WARNINGS_AS_ERRORS)
  list(APPEND reckon_warnings -Werror)
endif()
target_compile_options(reckon_flags INTERFACE "$<BUILD_INTERFACE:${reckon_warnings}>")

if(RECKON_SANITIZE)
  target_compile_options(reckon_flags INTERFACE
    -fsanitize=${RECKON_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(reckon_flags INTERFACE -fsanitize=${RECKON_SANITIZE})
endif()

if(RECKON_FUZZERS)
  target_compile_options(reckon_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()
