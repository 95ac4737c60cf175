# find_package(hoist) for users, and the .deb.
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/.cmake/hoist-config.cmake.in
  ${PROJECT_BINARY_DIR}/hoist-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/hoist)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/hoist-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(EXPORT hoist-targets NAMESPACE hoist:: FILE hoist-targets.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/hoist)
install(FILES ${PROJECT_BINARY_DIR}/hoist-config.cmake
              ${PROJECT_BINARY_DIR}/hoist-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/hoist)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME hoist)
set(CPACK_PACKAGE_CONTACT "the hoist authors <hoist@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
include(CPack)
