# SPDX-License-Identifier: Apache-2.0
# Install and export: find_package(versine) gives versine::<domain>.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
get_property(domains GLOBAL PROPERTY VERSINE_DOMAINS)
install(TARGETS ${domains} EXPORT versine-targets)
install(TARGETS versine RUNTIME)
install(DIRECTORY include/versine TYPE INCLUDE)
install(EXPORT versine-targets NAMESPACE versine:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/versine)
configure_package_config_file(cmake/versine-config.cmake.in versine-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/versine)
write_basic_package_version_file(versine-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/versine-config.cmake ${PROJECT_BINARY_DIR}/versine-config-version.cmake
  cmake/VersineDependencies.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/versine)
