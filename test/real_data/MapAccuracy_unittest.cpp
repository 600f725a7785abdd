// How well maps with the default parameters answer real data that they were not made from.
#include <gtest/gtest.h>
#include <semantic_types/ClassTableFile.h>

#include <map>
#include <random>
#include <set>

#include "DataSets.h"
#include "MapQuality.h"
#include "SharedData.h"

using semantic_octree::CellState;
using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::kNoClass;

namespace {

constexpr double kKittiResolution = 0.2, kKittiRange = 25, kReplicaResolution = 0.05;

ClassTable shippedTable(const std::string& name) {
  return semantic_types::loadClassTable(std::filesystem::path(MSO_SOURCE_DIR) / "config/classes" /
                                        name);
}

/** Makes a map of the even frames and asks it for the points of the odd ones. */
MapQuality splitQuality(const std::vector<LabeledFrame>& frames, const ClassTable& table,
                        double resolution, double range) {
  SemanticOcTree map(resolution, table);
  for (std::size_t i = 0; i < frames.size(); i += 2)
    map.insert(frames[i].cloud, frames[i].T_map_sensor);
  MapQuality quality;
  for (std::size_t i = 1; i < frames.size(); i += 2) judge(map, frames[i], range, quality);
  return quality;
}

MapQuality kittiQuality(const std::string& sequence) {
  const ClassTable table = shippedTable("semantic_kitti.yaml");
  const auto frames = readSemanticKitti(sharedDataDir() / "semantic_kitti" / sequence, table);
  return splitQuality(frames, table, kKittiResolution, kKittiRange);
}

/** Replaces this share of the classes by another one at random. */
void disturb(std::vector<ClassId>& classes, double share, int numClasses, std::mt19937& random) {
  std::uniform_real_distribution<> uniform(0, 1);
  std::uniform_int_distribution<> other(1, numClasses - 1);
  for (ClassId& id : classes) {
    if (id == kNoClass || uniform(random) >= share) continue;
    const int replacement = other(random);
    id = static_cast<ClassId>(replacement < id ? replacement : replacement + 1);
  }
}

using Voxel = std::array<octomap::key_type, 3>;

Voxel voxelOf(const SemanticOcTree& map, const LabeledFrame& frame, std::size_t point) {
  const Eigen::Vector3d p = frame.T_map_sensor * frame.cloud.points[point].cast<double>();
  const auto key = map.coordToKey(p.x(), p.y(), p.z());
  return {key[0], key[1], key[2]};
}

/** In how many of the frames each voxel was hit. */
std::map<Voxel, int> countHits(const SemanticOcTree& map, const std::vector<LabeledFrame>& frames) {
  std::map<Voxel, int> hits;
  for (const LabeledFrame& frame : frames) {
    std::set<Voxel> hit;
    for (std::size_t i = 0; i < frame.cloud.size(); ++i) hit.insert(voxelOf(map, frame, i));
    for (const Voxel& voxel : hit) ++hits[voxel];
  }
  return hits;
}

}  // namespace

TEST(MapAccuracy, evenScansOfAStreetAnswerTheOddOnes) {
  SKIP_WITHOUT_DATA("semantic_kitti");
  for (const char* sequence : {"00", "07"}) {
    const MapQuality quality = kittiQuality(sequence);
    EXPECT_GE(quality.accuracy(), 0.98) << sequence;
    EXPECT_GE(quality.coverage(), 0.90) << sequence;
    RecordProperty(std::string("accuracy_") + sequence, std::to_string(quality.accuracy()));
    RecordProperty(std::string("coverage_") + sequence, std::to_string(quality.coverage()));
  }
}

TEST(MapAccuracy, evenImagesOfAFlatAnswerTheOddOnes) {
  SKIP_WITHOUT_DATA("replica_apartment_0");
  const auto frames = readReplica(sharedDataDir() / "replica_apartment_0");
  const MapQuality quality =
      splitQuality(frames, shippedTable("replica_apartment.yaml"), kReplicaResolution, HUGE_VAL);
  EXPECT_GE(quality.accuracy(), 0.98);
  EXPECT_GE(quality.coverage(), 0.92);
}

TEST(MapAccuracy, theMapSeesThroughThirtyPercentOfWrongLabels) {
  SKIP_WITHOUT_DATA("semantic_kitti");
  const ClassTable table = shippedTable("semantic_kitti.yaml");
  const auto frames = readSemanticKitti(sharedDataDir() / "semantic_kitti/00", table);
  SemanticOcTree map(kKittiResolution, table);
  std::mt19937 random(1);
  for (const LabeledFrame& frame : frames) {
    semantic_types::LabeledCloud noisy = frame.cloud;
    disturb(noisy.classes, 0.3, table.size(), random);
    map.insert(noisy, frame.T_map_sensor);
  }
  const auto hits = countHits(map, frames);
  std::size_t points = 0, right = 0;
  for (const LabeledFrame& frame : frames)
    for (std::size_t i = 0; i < frame.cloud.size(); ++i) {
      if (frame.cloud.classes[i] == kNoClass || frame.isMoving(i)) continue;
      const Voxel voxel = voxelOf(map, frame, i);
      if (hits.at(voxel) < 3) continue;
      ++points;
      const CellState state = map.query(octomap::OcTreeKey(voxel[0], voxel[1], voxel[2]));
      right += state.likeliestClass == frame.cloud.classes[i];
    }
  EXPECT_GE(static_cast<double>(right) / static_cast<double>(points), 0.95);
}
