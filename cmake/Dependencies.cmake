# Everything that comes from outside. What differs between MRPT's releases stands here and in
# libs/semantic_map/include/semantic_map/MrptVersion.h, nowhere else.
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(octomap REQUIRED)
find_package(OpenCV REQUIRED COMPONENTS core imgproc imgcodecs calib3d dnn)
find_package(Threads REQUIRED)
find_package(mrpt-obs REQUIRED)
find_package(mrpt-maps REQUIRED)
find_package(mrpt-opengl REQUIRED)

# OctoMap's CMake file exports variables only: one imported target for all who use it.
add_library(mso_octomap INTERFACE IMPORTED)
target_include_directories(mso_octomap SYSTEM INTERFACE ${OCTOMAP_INCLUDE_DIRS})
target_link_libraries(mso_octomap INTERFACE ${OCTOMAP_LIBRARIES})

add_library(mso_opencv INTERFACE IMPORTED)
target_include_directories(mso_opencv SYSTEM INTERFACE ${OpenCV_INCLUDE_DIRS})
target_link_libraries(mso_opencv INTERFACE ${OpenCV_LIBS})

if(MSO_BUILD_APPS)
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
