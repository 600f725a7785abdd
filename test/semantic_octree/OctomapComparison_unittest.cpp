// OctoMap traces rays in other arithmetic (single precision) and gives up a ray once it is as long
// as the beam; so voxels may differ whose corners or borders a ray touches, and no others.
#include <gtest/gtest.h>
#include <octomap/OcTree.h>
#include <semantic_octree/Keys.h>

#include "RandomScans.h"

using namespace semantic_octree;

namespace {

constexpr double kMaxRange = 12;

octomap::KeySet voxelsOf(const SemanticOcTree& tree, bool occupied) {
  octomap::KeySet keys;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf)
    if (tree.isNodeOccupied(*leaf) == occupied) keys.insert(leaf.getKey());
  return keys;
}

/** Distance (in voxels) by which a beam misses a voxel or, negative, its depth in it; the least
 * over all beams. */
double distanceToBeams(const octomap::OcTreeKey& key, const std::vector<Eigen::Array3d>& ends,
                       const Eigen::Array3d& begin) {
  Eigen::Array3d low;
  for (int axis = 0; axis < 3; ++axis) low[axis] = key[axis] - double{kKeyOfOrigin};
  double least = HUGE_VAL;
  for (const Eigen::Array3d& end : ends) {
    // Smallest margin m for which the beam meets the voxel grown by m: bisection.
    double inner = -0.5, outer = 1;
    for (int i = 0; i < 30 && inner < least; ++i) {
      const double margin = (inner + outer) / 2;
      double from = 0, to = 1;
      for (int axis = 0; axis < 3; ++axis) {
        const double d = end[axis] - begin[axis];
        const double a = (low[axis] - margin - begin[axis]) / d;
        const double b = (low[axis] + 1 + margin - begin[axis]) / d;
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
      }
      (from <= to ? outer : inner) = margin;
    }
    least = std::min(least, outer);
  }
  return least;
}

struct Differences {
  std::size_t voxels = 0, different = 0;
  double farthest = 0;  ///< of the differing voxels' borders from a beam, voxels
};

void compare(const octomap::KeySet& ours, const octomap::KeySet& theirs,
             const std::vector<Eigen::Array3d>& ends, const Eigen::Array3d& begin, Differences& d) {
  d.voxels += ours.size();
  for (const auto* sets : {&ours, &theirs})
    for (const octomap::OcTreeKey& key : *sets) {
      if ((sets == &ours ? theirs : ours).count(key)) continue;
      ++d.different;
      d.farthest = std::max(d.farthest, std::fabs(distanceToBeams(key, ends, begin)));
    }
}

Differences differences(double resolution, const Eigen::Vector3d& place) {
  std::mt19937 random(17);
  Differences sum;
  const PosedCloud scan = streetScan(random, place, 24, 360);
  SemanticOcTree tree(resolution, numberedClasses(2));
  tree.setPruning(false);
  InsertionOptions options;
  options.maxRange = kMaxRange;
  tree.insert(scan.cloud, scan.T_map_sensor, options);

  octomap::Pointcloud cloud;
  std::vector<Eigen::Array3d> ends;
  const Eigen::Array3d begin = scan.T_map_sensor.translation().array() / resolution;
  for (const Eigen::Vector3f& p : scan.cloud.points) {
    const Eigen::Vector3d beam = scan.T_map_sensor.linear() * p.cast<double>();
    const Eigen::Vector3f end = (scan.T_map_sensor.translation() + beam).cast<float>();
    cloud.push_back(end.x(), end.y(), end.z());
    ends.push_back(begin + beam.array() * std::min(1.0, kMaxRange / beam.norm()) / resolution);
  }
  octomap::OcTree octree(resolution);
  octomap::KeySet free, occupied;
  const Eigen::Vector3f sensor = scan.T_map_sensor.translation().cast<float>();
  octree.computeUpdate(cloud, {sensor.x(), sensor.y(), sensor.z()}, free, occupied, kMaxRange);
  for (const octomap::OcTreeKey& key : occupied) free.erase(key);
  compare(voxelsOf(tree, true), occupied, ends, begin, sum);
  compare(voxelsOf(tree, false), free, ends, begin, sum);
  return sum;
}

}  // namespace

TEST(OctomapComparison, freeAndHitVoxelsAreOctomaps) {
  for (const double resolution : {0.2, 0.1}) {
    const Differences d = differences(resolution, {0, 0, 0});
    EXPECT_LE(d.different, 2u) << "of " << d.voxels << " voxels at " << resolution << " m";
    EXPECT_GT(d.voxels, 50000u);
  }
}

TEST(OctomapComparison, farFromTheOriginVoxelsDifferThatABeamTouchesOnly) {
  // Single precision: 300 m from the origin coordinates are multiples of 0.03 mm.
  for (const double resolution : {0.2, 0.1}) {
    const Differences d = differences(resolution, {-300.3, 210.7, 5.1});
    EXPECT_LT(d.different, d.voxels / 1000) << d.voxels << " voxels at " << resolution << " m";
    EXPECT_GT(d.different, 0u);
    EXPECT_LT(d.farthest * resolution, 1e-4) << "meters";
  }
}
