# find_package(mrpt_semantic_octree [COMPONENTS libraries...]) for others, from an installed tree and from the build tree.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/mrpt_semantic_octree)

# Library by library: its targets, and for the config what it needs of the others (mso_needs_X) and has to find
# (mso_finds_X): what it hands on, and shared libraries that CMake's exported targets name all the same.
get_property(mso_libraries GLOBAL PROPERTY MSO_LIBRARIES)
set(mso_components "set(mso_libraries ${mso_libraries})\n")
set(mso_debian_packages)
foreach(library ${mso_libraries})
  get_property(links GLOBAL PROPERTY MSO_LINKS_${library})
  get_property(private_links GLOBAL PROPERTY MSO_PRIVATE_LINKS_${library})
  foreach(link ${private_links})
    get_target_property(type ${link} TYPE)
    if(type STREQUAL SHARED_LIBRARY)
      list(APPEND links ${link})
    endif()
  endforeach()
  set(needs)
  set(finds)
  foreach(link ${links})
    string(REPLACE mrpt_semantic_octree:: "" name ${link})
    get_property(find GLOBAL PROPERTY MSO_FIND_${link})
    get_property(debian GLOBAL PROPERTY MSO_DEBIAN_${link})
    if(name IN_LIST mso_libraries)
      list(APPEND needs ${name})
    elseif(find)
      string(REPLACE ";" " " find "${find}")
      string(APPEND finds " \"${find}\"")
      list(APPEND mso_debian_packages ${debian})
    else()
      message(FATAL_ERROR "${library} links ${link}, which cmake/Dependencies.cmake does not name as mso_external")
    endif()
  endforeach()
  string(APPEND mso_components "set(mso_needs_${library} ${needs})\nset(mso_finds_${library}${finds})\n")

  export(EXPORT mrpt_semantic_octree_${library} NAMESPACE mrpt_semantic_octree::
    FILE ${PROJECT_BINARY_DIR}/mrpt_semantic_octree-${library}-targets.cmake)
  install(EXPORT mrpt_semantic_octree_${library} NAMESPACE mrpt_semantic_octree::
    FILE mrpt_semantic_octree-${library}-targets.cmake DESTINATION ${package_dir} COMPONENT development)
endforeach()
list(REMOVE_DUPLICATES mso_debian_packages)

configure_package_config_file(cmake/mrpt_semantic_octree-config.cmake.in
  ${PROJECT_BINARY_DIR}/mrpt_semantic_octree-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/mrpt_semantic_octree-config-version.cmake
  COMPATIBILITY SameMinorVersion)
foreach(file ThirdPartyTargets.cmake Findmso_opencv.cmake)
  configure_file(cmake/${file} ${PROJECT_BINARY_DIR}/${file} COPYONLY)
endforeach()
install(FILES
  ${PROJECT_BINARY_DIR}/mrpt_semantic_octree-config.cmake
  ${PROJECT_BINARY_DIR}/mrpt_semantic_octree-config-version.cmake
  cmake/ThirdPartyTargets.cmake
  cmake/Findmso_opencv.cmake
  DESTINATION ${package_dir} COMPONENT development)
install(DIRECTORY config/ USE_SOURCE_PERMISSIONS DESTINATION ${CMAKE_INSTALL_DATADIR}/mrpt_semantic_octree/config
  COMPONENT tools)

# Documents and samples, laid out as in the sources, so that links between them and commands of the handbook hold.
install(FILES README.md CHANGELOG.md CITATION.cff LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documentation)
install(DIRECTORY doc rawlog-samples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documentation)
foreach(folder apps test/benchmark)
  install(DIRECTORY ${folder}/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder} COMPONENT documentation FILES_MATCHING PATTERN README.md)
endforeach()
