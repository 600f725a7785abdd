#pragma once
#include <semantic_octree/InsertionOptions.h>
#include <semantic_types/LabeledCloud.h>

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace insertion_benchmark {

struct PosedScan {
  semantic_types::LabeledCloud cloud;
  Eigen::Isometry3d T_map_sensor;
};

struct Scene {
  std::vector<PosedScan> scans;
  int numClasses = 1;
};

struct Settings {
  double resolution = 0.2, maxRange = 25;  ///< meters
  semantic_octree::InsertionOptions::Rays rays = semantic_octree::InsertionOptions::Rays::All;
  int terms = 4;  ///< information terms that are kept up to date
  int threads = 1;
};

/** Something that scans are inserted into. */
struct Runner {
  /** Inserts the i-th scan of the scene: this is timed. Making a runner, which may bring the scans
   * into a form of its own, is not. */
  std::function<void(std::size_t scan)> insert;
  /** Voxels that were touched, if this is known. */
  std::function<std::size_t()> touchedVoxels = [] { return 0; };
};

/** The scene outlives the runner. */
using MakeRunner = Runner (*)(const Scene& scene, const Settings& settings);

/** A byte array that beams are traced through: each voxel on the way is touched, nothing more. */
constexpr const char* kTraversal = "bare traversal of all rays";

/** All of them, by name. */
const std::vector<std::pair<std::string, MakeRunner>>& runners();

}  // namespace insertion_benchmark
