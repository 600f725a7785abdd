# find_package(mrpt_semantic_octree) for others, from an installed tree and from the build tree.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/mrpt_semantic_octree)

configure_package_config_file(cmake/mrpt_semantic_octree-config.cmake.in
  ${PROJECT_BINARY_DIR}/mrpt_semantic_octree-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/mrpt_semantic_octree-config-version.cmake
  COMPATIBILITY SameMinorVersion)
configure_file(cmake/ThirdPartyTargets.cmake ${PROJECT_BINARY_DIR}/ThirdPartyTargets.cmake COPYONLY)

export(EXPORT mrpt_semantic_octree NAMESPACE mrpt_semantic_octree::
  FILE ${PROJECT_BINARY_DIR}/mrpt_semantic_octree-targets.cmake)
install(EXPORT mrpt_semantic_octree NAMESPACE mrpt_semantic_octree::
  FILE mrpt_semantic_octree-targets.cmake DESTINATION ${package_dir} COMPONENT development)
install(FILES
  ${PROJECT_BINARY_DIR}/mrpt_semantic_octree-config.cmake
  ${PROJECT_BINARY_DIR}/mrpt_semantic_octree-config-version.cmake
  cmake/ThirdPartyTargets.cmake
  DESTINATION ${package_dir} COMPONENT development)
install(DIRECTORY config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/mrpt_semantic_octree/config
  COMPONENT tools)
install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT library)
