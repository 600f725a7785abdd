#pragma once
#include <filesystem>
#include <string>

/** The library without which a program is not built, if it was not; empty if it was, or has to be.
 */
inline std::string missingLibraryOf(const std::string& program) {
  if (std::filesystem::exists(MSO_BIN_DIR "/" + program)) return {};
  if (program == "semantic-map-view") return "MRPT with nanogui, or OpenGL, is not installed";
  if (program == "semantic-map-ros2") return "Cyclone DDS is not installed";
  return {};
}
