# Everything that comes from outside. What differs between MRPT's releases stands here, in
# ThirdPartyTargets.cmake, in libs/mrpt_compat and, for its navigator, in
# libs/semantic_driving/src/ReactiveSystem.h, nowhere else.

# mso_external(TARGET DEBIAN_PACKAGES PACKAGE [arguments of find_package]): finds what libraries link. Those that hand
# TARGET on to their users need it found again by the package's CMake config, and DEBIAN_PACKAGES beside the headers.
macro(mso_external target debian)
  find_package(${ARGN} REQUIRED)
  set_property(GLOBAL PROPERTY MSO_FIND_${target} "${ARGN}")
  set_property(GLOBAL PROPERTY MSO_DEBIAN_${target} ${debian})
endmacro()

# mso_external_mrpt(NAME): MRPT's library mrpt::NAME. Since MRPT 3 its package is mrpt_NAME, before mrpt-NAME;
# ThirdPartyTargets.cmake gives its target one name. Both releases may be installed: all libraries come from one.
find_package(mrpt_obs QUIET)
set(mso_mrpt mrpt-)
if(mrpt_obs_FOUND)
  set(mso_mrpt mrpt_)
endif()
macro(mso_external_mrpt name)
  mso_external(mrpt::${name} libmrpt-${name}-dev ${mso_mrpt}${name})
endmacro()
mso_external(Eigen3::Eigen libeigen3-dev Eigen3 NO_MODULE)
mso_external(mso_octomap liboctomap-dev octomap)
mso_external(mso_opencv "libopencv-imgproc-dev;libopencv-imgcodecs-dev;libopencv-dnn-dev" mso_opencv)
mso_external(Threads::Threads libc6-dev Threads)
mso_external(PNG::PNG libpng-dev PNG)
mso_external(Freetype::Freetype libfreetype-dev Freetype)
mso_external(GIF::GIF libgif-dev GIF)
mso_external(yaml-cpp::yaml-cpp libyaml-cpp-dev yaml-cpp)
mso_external(ZLIB::ZLIB zlib1g-dev ZLIB)
# Zstandard comes with CMake files or without, as it was built.
find_library(MSO_ZSTD_LIBRARY zstd REQUIRED)
find_path(MSO_ZSTD_INCLUDE_DIR zstd.h REQUIRED)
add_library(mso_zstd INTERFACE IMPORTED)
target_include_directories(mso_zstd SYSTEM INTERFACE ${MSO_ZSTD_INCLUDE_DIR})
target_link_libraries(mso_zstd INTERFACE ${MSO_ZSTD_LIBRARY})
mso_external_mrpt(obs)
mso_external_mrpt(maps)
mso_external_mrpt(opengl)
mso_external_mrpt(graphs)
mso_external_mrpt(nav)
if(MSO_BUILD_APPS)
  find_package(JPEG REQUIRED)
  find_package(${mso_mrpt}gui QUIET)  # windows
endif()

# The Python package is for Debian's interpreter, whichever comes first in the path.
find_program(MSO_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(MSO_PYTHON python3)
set(Python3_EXECUTABLE ${MSO_PYTHON})
find_package(Python3 QUIET COMPONENTS Interpreter Development.Module)
find_package(pybind11 QUIET)

include(ThirdPartyTargets)

if(MSO_BUILD_TESTS)
  # Oracles of tests. Its CMake files also name libraries that its Debian package does not need:
  # the first is its own.
  find_package(ompl QUIET)
  if(ompl_FOUND)
    list(GET OMPL_LIBRARIES 0 ompl_library)
    add_library(mso_ompl INTERFACE IMPORTED)
    target_include_directories(mso_ompl SYSTEM INTERFACE ${OMPL_INCLUDE_DIR})
    target_link_libraries(mso_ompl INTERFACE ${ompl_library})
  else()
    message(STATUS "tests that compare with OMPL are left out: there is no OMPL (libompl-dev)")
  endif()
endif()

if(MSO_BUILD_APPS)
  find_package(CLI11 REQUIRED)
  find_package(CycloneDDS QUIET)  # semantic-map-ros2
  find_program(MSO_IDLC idlc)
  find_package(nlohmann_json REQUIRED)
  find_library(MSO_SODIUM_LIBRARY sodium REQUIRED)
  find_path(MSO_SODIUM_INCLUDE_DIR sodium.h REQUIRED)
  add_library(mso_sodium INTERFACE IMPORTED)
  target_include_directories(mso_sodium SYSTEM INTERFACE ${MSO_SODIUM_INCLUDE_DIR})
  target_link_libraries(mso_sodium INTERFACE ${MSO_SODIUM_LIBRARY})
endif()
if(MSO_BUILD_TESTS)
  find_package(GTest REQUIRED)
  find_package(rapidcheck REQUIRED)
  find_package(nlohmann_json REQUIRED)
endif()
