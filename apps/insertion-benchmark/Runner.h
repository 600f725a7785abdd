#pragma once
#include <semantic_octree/InsertionOptions.h>
#include <semantic_types/LabeledCloud.h>

#include <Eigen/Geometry>
#include <memory>
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
class Runner {
 public:
  virtual ~Runner() = default;
  /** The i-th scan of the scene: this is timed. The constructor, which may bring the scans into a
   * form of its own, is not. */
  virtual void insert(std::size_t scan) = 0;
  /** Voxels that were touched, if this is known. */
  virtual std::size_t touchedVoxels() const { return 0; }
};

using MakeRunner = std::unique_ptr<Runner> (*)(const Scene& scene, const Settings& settings);

constexpr const char* kReference = "semantic_octree with G";
/** A byte array that beams are traced through: each voxel on the way is touched, nothing more. */
constexpr const char* kTraversal = "bare traversal of all rays";

/** All of them, by name. */
const std::vector<std::pair<std::string, MakeRunner>>& runners();

}  // namespace insertion_benchmark
