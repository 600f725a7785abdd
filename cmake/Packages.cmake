# cpack -G DEB: the Debian packages of this project, from a Release build.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME mrpt-semantic-octree)
set(CPACK_PACKAGE_CONTACT "The authors of mrpt_semantic_octree <mrpt-semantic-octree@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)

math(EXPR mso_next_python "0${Python3_VERSION_MINOR} + 1")

# A program's shlibs come from the packages of Debian, those of this project from the build tree.
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL library development tools documentation)
if(TARGET python_module)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libmrpt-semantic-octree${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS "fonts-dejavu-core")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/debian/triggers)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libmrpt-semantic-octree-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
list(JOIN mso_debian_packages ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)  # what the CMake config asks for
set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME mrpt-semantic-octree-tools)
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS "gnuplot-nox, libegl1, libgl1-mesa-dri")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-semantic-octree)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= ${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}), \
python3 (<< ${Python3_VERSION_MAJOR}.${mso_next_python}), python3-numpy")
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_NAME mrpt-semantic-octree-doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS "mrpt-semantic-octree-doc, snakemake")

# What Debian wants beside: license and changes, for each package, in its own folder.
string(TIMESTAMP mso_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(CONFIGURE OUTPUT debian/changelog CONTENT "mrpt-semantic-octree (@PROJECT_VERSION@) unstable; urgency=medium

  * What changed stands in CHANGELOG.md of mrpt-semantic-octree-doc.

 -- @CPACK_PACKAGE_CONTACT@  @mso_date@
" @ONLY)
execute_process(COMMAND gzip -9nf ${PROJECT_BINARY_DIR}/debian/changelog)
foreach(component ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${component} upper)
  set(folder ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  install(FILES LICENSE RENAME copyright DESTINATION ${folder} COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(FILES ${PROJECT_BINARY_DIR}/debian/changelog.gz DESTINATION ${folder} COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()
install(FILES cmake/debian/lintian-overrides RENAME ${CPACK_DEBIAN_LIBRARY_PACKAGE_NAME}
  DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides COMPONENT library EXCLUDE_FROM_ALL)

include(CPack)
cpack_add_component(library DESCRIPTION "Shared libraries, and the plugin for MRPT's applications")
cpack_add_component(development DESCRIPTION "Headers and CMake files" DEPENDS library)
cpack_add_component(tools DESCRIPTION "Command-line applications and their settings" DEPENDS library)
if(TARGET python_module)
  cpack_add_component(python DESCRIPTION "The Python package semantic_octree, for numpy" DEPENDS library)
endif()
cpack_add_component(documentation DESCRIPTION "Handbook, how things work, and sample rawlogs")
