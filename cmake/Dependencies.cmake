# Everything that comes from outside; what the libraries need stands in
# mrpt_semantic_octree-config.cmake.in too, for those who build upon them. What differs between MRPT's
# releases stands in these two files and in libs/semantic_map/include/semantic_map/MrptVersion.h, nowhere else.
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(octomap REQUIRED)
find_package(OpenCV REQUIRED COMPONENTS core imgproc imgcodecs calib3d dnn)
find_package(Threads REQUIRED)
find_package(PNG REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(ZLIB REQUIRED)
find_package(mrpt-obs REQUIRED)
find_package(mrpt-maps REQUIRED)
find_package(mrpt-opengl REQUIRED)
find_package(mrpt-graphs REQUIRED)
find_package(mrpt-nav REQUIRED)

include(ThirdPartyTargets)

if(MSO_BUILD_APPS OR MSO_BUILD_TESTS)
  # Other planners and oracles. Its CMake files also name libraries that its Debian package does not need:
  # the first is its own.
  find_package(ompl REQUIRED)
  list(GET OMPL_LIBRARIES 0 ompl_library)
  add_library(mso_ompl INTERFACE IMPORTED)
  target_include_directories(mso_ompl SYSTEM INTERFACE ${OMPL_INCLUDE_DIR})
  target_link_libraries(mso_ompl INTERFACE ${ompl_library})
endif()

if(MSO_BUILD_APPS)
  find_package(mrpt-gui REQUIRED)
  find_package(CLI11 REQUIRED)
  find_package(nlohmann_json REQUIRED)
endif()
if(MSO_BUILD_TESTS)
  find_package(GTest REQUIRED)
  find_package(rapidcheck REQUIRED)
  find_package(nlohmann_json REQUIRED)
endif()
if(MSO_BUILD_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()
