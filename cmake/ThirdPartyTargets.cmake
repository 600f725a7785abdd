# Targets for packages whose CMake files export variables only, or too much. Used by this project's
# build and by its installed package, which is why it may be read twice.
if(NOT TARGET mso_octomap)
  add_library(mso_octomap INTERFACE IMPORTED)
  target_include_directories(mso_octomap SYSTEM INTERFACE ${OCTOMAP_INCLUDE_DIRS})
  target_link_libraries(mso_octomap INTERFACE ${OCTOMAP_LIBRARIES})
endif()

if(NOT TARGET mso_opencv)
  add_library(mso_opencv INTERFACE IMPORTED)
  target_include_directories(mso_opencv SYSTEM INTERFACE ${OpenCV_INCLUDE_DIRS})
  target_link_libraries(mso_opencv INTERFACE
    opencv_core opencv_imgproc opencv_imgcodecs opencv_calib3d opencv_dnn)
endif()
