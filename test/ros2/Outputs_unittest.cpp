#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <cstring>
#include <set>
#include <sstream>

#include "RoadInGrass.h"

namespace {

/** All points of all markers that stand: by class. */
std::map<std::string, std::size_t> cubesOf(
    const std::vector<std::shared_ptr<const ros2::MarkerArray>>& arrays) {
  std::map<std::pair<std::string, int>, std::size_t> markers;
  for (const auto& array : arrays)
    for (std::uint32_t i = 0; i < array->markers._length; ++i) {
      const ros2::Marker& marker = array->markers._buffer[i];
      EXPECT_EQ(marker.action == 0, marker.points._length > 0);
      markers[{marker.ns, marker.id}] = marker.points._length;
    }
  std::map<std::string, std::size_t> cubes;
  for (const auto& [which, count] : markers) cubes[which.first] += count;
  return cubes;
}

/** Voxels of a map that are occupied, by class. */
std::map<std::string, std::size_t> voxelsOf(const semantic_octree::SemanticOcTree& map) {
  std::map<std::string, std::size_t> voxels;
  for (auto it = map.begin_leafs(); it != map.end_leafs(); ++it)
    if (map.isNodeOccupied(*it))
      voxels[map.classes().name(map.query(*it).likeliestClass)] +=
          std::size_t(std::pow(8, 16 - it.getDepth()));
  return voxels;
}

}  // namespace

TEST_F(RoadInGrass, isSeenAsMarkersPointsAndOctomap) {
  start({});
  Heard<ros2::MarkerArray> markers(*live, "/semantic_map/markers");
  Heard<ros2::PointCloud2> voxels(*live, "/semantic_map/occupied", {true, true, 1});
  Heard<ros2::Octomap> octomap(*live, "/semantic_map/octomap", {true, true, 1});
  see(1);
  ASSERT_TRUE(live->waitFor([&] { return markers.last() && voxels.last() && octomap.last(); }));
  see(2);
  // A thing in the air changes one block; who comes late sees all the same.
  semantic_types::LabeledCloud beam;
  beam.points = {Eigen::Vector3f(3, 0, -27)};
  beam.classes = {2};
  const std::size_t before = markers.all().size();
  see(3, beam);
  ASSERT_TRUE(live->waitFor([&] { return markers.all().size() > before; }));
  EXPECT_LE(markers.last()->markers._length, 4u);
  Heard<ros2::MarkerArray> late(*live, "/semantic_map/markers");
  std::size_t round = 4;
  ASSERT_TRUE(live->waitFor([&] { return see(round++, beam), late.last() != nullptr; }));
  const auto octree = octomap.last();
  ASSERT_EQ(live->end(), kStopped);
  const auto map = live->map();
  EXPECT_EQ(cubesOf(markers.all()), voxelsOf(map));
  EXPECT_EQ(cubesOf(late.all()), voxelsOf(map));

  const auto cloud = voxels.last();
  std::size_t occupied = 0;
  for (const auto& [name, count] : voxelsOf(map)) occupied += count;
  EXPECT_EQ(cloud->width, occupied);
  for (std::uint32_t i = 0; i < cloud->width; ++i) {
    float p[3], probability;
    std::uint32_t label;
    std::memcpy(p, cloud->data._buffer + 24 * i, 12);
    std::memcpy(&label, cloud->data._buffer + 24 * i + 16, 4);
    std::memcpy(&probability, cloud->data._buffer + 24 * i + 20, 4);
    const auto state = map.query(double(p[0]), double(p[1]), double(p[2]));
    ASSERT_EQ(label, state.likeliestClass);
    ASSERT_GT(probability, 0.5f);
  }

  EXPECT_EQ(ros2::textOf(octree->id), "OcTree");
  EXPECT_EQ(octree->resolution, 0.2);
  octomap::OcTree tree(0.2);
  std::stringstream bytes(
      std::string(reinterpret_cast<const char*>(octree->data._buffer), octree->data._length));
  tree.readBinaryData(bytes);
  EXPECT_TRUE(tree.isNodeOccupied(tree.search(3, 0.1, -0.1)));
  EXPECT_FALSE(tree.isNodeOccupied(tree.search(3, 0.1, 0.5)));
}

TEST_F(RoadInGrass, isAGridOfCosts) {
  start({"-p", "order:=" + order(), "-p", "costs:=10,60"});
  Heard<ros2::OccupancyGrid> grids(*live, "/map", {true, true, 1});
  see(1);
  ASSERT_TRUE(live->waitFor([&] { return grids.last() != nullptr; }));
  const auto grid = grids.last();
  EXPECT_EQ(ros2::textOf(grid->header.frame_id), "map");
  const auto costAt = [&](double x, double y) {
    const auto& info = grid->info;
    const auto column = int(std::floor((x - info.origin.position.x) / double(info.resolution)));
    const auto row = int(std::floor((y - info.origin.position.y) / double(info.resolution)));
    if (column < 0 || row < 0 || column >= int(info.width) || row >= int(info.height)) return -1;
    return int(
        static_cast<std::int8_t>(grid->data._buffer[std::size_t(row) * info.width + column]));
  };
  EXPECT_EQ(costAt(3.1, 0.1), 10);   // road
  EXPECT_EQ(costAt(3.1, 3.1), 60);   // grass
  EXPECT_EQ(costAt(0.1, 4.1), 100);  // wall
  EXPECT_EQ(costAt(8.1, 0.1), 100);  // mud, which the order does not name
  EXPECT_EQ(costAt(15, 0), -1);
  EXPECT_EQ(live->end(), kStopped) << live->said();
}

TEST_F(RoadInGrass, isSavedByAMessage) {
  start({});
  ros2::Publication<ros2::Empty> save(live->node(), "/semantic_map/save", {});
  see(1);
  live->send(save, {});
  ASSERT_TRUE(live->waitFor([&] { return contains(live->said(), ": saved"); }));
  const auto saved = live->map();
  EXPECT_FALSE(saved.empty());
  see(2);
  EXPECT_EQ(live->end(), kStopped);
  EXPECT_FALSE(live->map() == saved);
}
