# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# What `cmake --install` and `cpack -G DEB` bring besides what apps/reckon installs: examples and
# documents; and, as component `development`, the libraries with their headers for find_package(reckon).
include(CMakePackageConfigHelpers)
set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/reckon")
set(modules core text math parallel shape avatar grains domain neighbor contact boundary motion simulation
  analysis scene output results run)
install(TARGETS reckon_flags EXPORT reckonTargets COMPONENT development)
set_target_properties(reckon_flags PROPERTIES EXPORT_NAME flags)
foreach(module IN LISTS modules)
  set_target_properties(reckon_${module} PROPERTIES EXPORT_NAME ${module})
  install(TARGETS reckon_${module} EXPORT reckonTargets COMPONENT development)
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/src/reckon/${module}"
    DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/reckon" COMPONENT development
    FILES_MATCHING PATTERN "*.hpp")
endforeach()
install(EXPORT reckonTargets NAMESPACE reckon:: DESTINATION "${package_folder}" COMPONENT development)
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/reckonConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/reckonConfig.cmake" INSTALL_DESTINATION "${package_folder}"
  NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/reckonConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/reckonConfig.cmake"
  "${PROJECT_BINARY_DIR}/reckonConfigVersion.cmake" "${PROJECT_SOURCE_DIR}/cmake/FindZoltan.cmake"
  DESTINATION "${package_folder}" COMPONENT development)

install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs/" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/examples" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/CHANGELOG.md"
  "${PROJECT_SOURCE_DIR}/CITATION.cff" DESTINATION "${CMAKE_INSTALL_DOCDIR}")

set(CPACK_PACKAGE_NAME reckon)
set(CPACK_PACKAGE_VENDOR "Sand Reckoner contributors")
set(CPACK_PACKAGE_CONTACT "Sand Reckoner contributors <maintainers@sand-reckoner.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/package")
set(CPACK_PACKAGING_INSTALL_PREFIX "/usr")
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEB_COMPONENT_INSTALL ON)  # two packages, reckon and reckon-dev
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME reckon)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME reckon-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libfmt-dev, libeigen3-dev, libhdf5-dev, libtomlplusplus-dev, libhwy-dev, libopenmpi-dev, libtrilinos-zoltan-dev")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # what the program links, by dpkg-shlibdeps
include(CPack)
