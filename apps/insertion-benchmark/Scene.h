#pragma once
#include <semantic_types/LabeledCloud.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

namespace insertion_benchmark {

struct PosedScan {
  semantic_types::LabeledCloud cloud;
  Eigen::Isometry3d T_map_sensor;
};

struct Scene {
  std::vector<PosedScan> scans;
  int numClasses = 1;

  std::size_t numPoints() const;
};

/** The scans of a rawlog. \param classes a class table (YAML) \param maxScans 0: all
 * \throw std::runtime_error naming the file and what is wrong. */
Scene sceneOf(const std::filesystem::path& file, const std::filesystem::path& classes,
              std::size_t maxScans);

}  // namespace insertion_benchmark
