# Targets for packages whose CMake files export variables only, too much, or other names from release to release.
# Used by this project's build and by its installed package, where it may be read several times, and before all of
# these packages were asked for.
if(octomap_FOUND AND NOT TARGET mso_octomap)
  add_library(mso_octomap INTERFACE IMPORTED)
  target_include_directories(mso_octomap SYSTEM INTERFACE ${OCTOMAP_INCLUDE_DIRS})
  target_link_libraries(mso_octomap INTERFACE ${OCTOMAP_LIBRARIES})
endif()

# MRPT 3 calls them mrpt::mrpt_X.
foreach(library poses obs maps opengl graphs nav gui)
  if(TARGET mrpt::mrpt_${library} AND NOT TARGET mrpt::${library})
    add_library(mrpt::${library} INTERFACE IMPORTED)
    target_link_libraries(mrpt::${library} INTERFACE mrpt::mrpt_${library})
  endif()
endforeach()

# Its releases before 0.8 have the short name only.
if(TARGET yaml-cpp AND NOT TARGET yaml-cpp::yaml-cpp)
  add_library(yaml-cpp::yaml-cpp ALIAS yaml-cpp)
endif()
