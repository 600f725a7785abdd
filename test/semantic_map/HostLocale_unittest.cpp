// Files of the map, in a host whose numbers have decimal commas.
#include <gtest/gtest.h>
#include <labeled_cloud/CloudLabeler.h>
#include <labeled_cloud/Trajectory.h>
#include <map_operations/MapOperations.h>
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_map/MapFiles.h>

#include <sstream>

#include "Classes.h"
#include "CommaHost.h"
#include "SmallMaps.h"
#include "TemporaryFolder.h"

using namespace semantic_map;

namespace {

semantic_octree::SemanticOcTree someTree() {
  semantic_octree::SemanticOcTree tree(0.125, tableOf({{"road", {1, 2, 3}}}));
  semantic_types::LabeledCloud cloud;
  for (int i = 0; i < 2000; ++i) cloud.points.emplace_back(4.5f, 0.01f * float(i) - 10, 1.75f);
  cloud.classes.assign(cloud.points.size(), 1);
  tree.insert(cloud, Eigen::Isometry3d::Identity());
  return tree;
}

template <class Write>
std::string written(const Write& write) {
  std::ostringstream out;
  write(out);
  return out.str();
}

/** All that is written of a map, one after the other. */
std::vector<std::string> exportsOf(const semantic_octree::SemanticOcTree& tree) {
  return {written([&](std::ostream& out) { writeCsv(out, tree); }),
          written([&](std::ostream& out) { writePly(out, tree); }),
          written([&](std::ostream& out) { writeOcTree(out, tree); }),
          written([&](std::ostream& out) { writeBinaryOcTree(out, tree); })};
}

}  // namespace

TEST(HostLocale, leavesNoTraceInFilesAndTheyAreReadAsTheyAre) {
  const TemporaryFolder folder;
  const auto tree = someTree();
  const std::vector<std::string> classic = exportsOf(tree);
  EXPECT_TRUE(contains(classic[0], ",0.125,"));
  const auto octomap = folder.write("map.ot", classic[2]);
  const auto tum = folder.write("robot.tum", "1234567.5 1.5 2.25 -0.5 0 0 0 1\n");
  const CommaHost host;
  EXPECT_EQ(exportsOf(tree), classic);
  EXPECT_EQ(importOctomapFile(octomap).getResolution(), 0.125);
  const auto trajectory = labeled_cloud::loadTumTrajectory(tum);
  ASSERT_EQ(trajectory.size(), 1u);
  EXPECT_EQ(trajectory.poses().begin()->second.y(), 2.25);
  labeled_cloud::CameraDescription camera;
  camera.dist = "0.25 -0.5";
  camera.cols = 640, camera.rows = 480, camera.fx = 500, camera.fy = 500;
  camera.cx = 320, camera.cy = 240;
  EXPECT_EQ(camera.calibration().intrinsics->dist[1], -0.5);
}
