#include <gtest/gtest.h>
#include <octomap/OcTree.h>
#include <yaml-cpp/yaml.h>

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
  for (const auto& array : arrays) {
    std::set<std::pair<std::string, int>> inArray;
    for (std::uint32_t i = 0; i < array->markers._length; ++i) {
      const ros2::Marker& marker = array->markers._buffer[i];
      EXPECT_EQ(marker.action == 0, marker.points._length > 0);
      EXPECT_EQ(marker.action == 2, marker.points._length == 0);
      EXPECT_EQ(marker.type, 6) << "cubes";
      EXPECT_EQ(marker.color.a, 1);
      EXPECT_TRUE(inArray.insert({marker.ns, marker.id}).second) << "RViz refuses it";
      markers[{marker.ns, marker.id}] = marker.points._length;
    }
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

/** A grid as nav2's static layer keeps it: the last whole one, and what changed since. */
class KeptGrid {
 public:
  explicit KeptGrid(LiveMap& live)
      : m_grids(live, "/map", {true, true, 1}), m_updates(live, "/map_updates") {}
  std::size_t grids() const { return m_grids.all().size(); }
  std::size_t updates() const { return m_updates.all().size(); }
  std::string frame() const { return ros2::textOf(m_grids.last()->header.frame_id); }
  std::shared_ptr<const ros2::OccupancyGridUpdate> update() const { return m_updates.last(); }
  /** -2: there is no such cell. */
  int at(double x, double y) const {
    const auto grid = m_grids.last();
    if (!grid) return -2;
    const auto& info = grid->info;
    const auto column = int(std::floor((x - info.origin.position.x) / double(info.resolution)));
    const auto row = int(std::floor((y - info.origin.position.y) / double(info.resolution)));
    if (column < 0 || row < 0 || column >= int(info.width) || row >= int(info.height)) return -2;
    int cost = std::int8_t(grid->data._buffer[std::size_t(row) * info.width + column]);
    for (const auto& update : m_updates.all()) {
      const int i = column - update->x, j = row - update->y;
      const bool isLater = ros2::stampOf(update->header.stamp) > ros2::stampOf(grid->header.stamp);
      if (isLater && i >= 0 && j >= 0 && i < int(update->width) && j < int(update->height))
        cost = std::int8_t(update->data._buffer[std::size_t(j) * update->width + i]);
    }
    return cost;
  }

 private:
  Heard<ros2::OccupancyGrid> m_grids;
  Heard<ros2::OccupancyGridUpdate> m_updates;
};

TEST_F(RoadInGrass, tellsWhatChangedInItsGrid) {
  start({"-p", "order:=" + order(), "-p", "costs:=10,60"});
  KeptGrid kept(*live);
  see(1);
  ASSERT_TRUE(live->waitFor([&] { return kept.at(3.1, 0.1) == 10; }));  // road
  EXPECT_EQ(kept.frame(), "map");
  EXPECT_EQ(kept.at(3.1, 3.1), 60);   // grass
  EXPECT_EQ(kept.at(0.1, 4.1), 100);  // wall
  EXPECT_EQ(kept.at(8.1, 0.1), 100);  // mud, which the order does not name
  EXPECT_LT(kept.at(15, 0), 0);       // unknown, or beyond the grid
  EXPECT_EQ(kept.updates(), 0u);
  const std::size_t grids = kept.grids();
  auto box = scan();  // a thing on the road, 2 m wide
  for (std::size_t i = 0; i < box.size(); ++i)
    if ((box.points[i].head<2>() - Eigen::Vector2f(3, 0)).cwiseAbs().maxCoeff() < 1) {
      box.points[i].z() += 0.6f;
      box.classes[i] = 3;
    }
  std::size_t number = 2;
  ASSERT_TRUE(live->waitFor([&] { return see(number++, box), kept.at(3.1, 0.1) == 100; }));
  EXPECT_EQ(kept.at(3.1, 3.1), 60);
  EXPECT_EQ(kept.grids(), grids) << "no whole grid";
  EXPECT_LE(kept.update()->width, 16u);
  EXPECT_LE(kept.update()->height, 16u);
  {
    KeptGrid late(*live);  // which nothing is missing
    ASSERT_TRUE(live->waitFor([&] { return late.at(3.1, 0.1) == 100; }));
  }
  // Somebody who does not hear updates gets all of it, and so does who needs a larger grid.
  const std::size_t updates = kept.updates();
  {
    Heard<ros2::OccupancyGrid> all(*live, "/map", {true, true, 1});
    ASSERT_TRUE(live->waitFor([&] { return all.last() != nullptr; }));
    const std::size_t before = all.all().size();
    ASSERT_TRUE(live->waitFor([&] { return see(number++), all.all().size() > before; }));
    EXPECT_EQ(kept.updates(), updates);
  }
  semantic_types::LabeledCloud far = scan();
  for (Eigen::Vector3f& p : far.points) p.x() += 10;
  const std::size_t whole = kept.grids();
  ASSERT_TRUE(live->waitFor([&] { return see(number++, far), kept.at(16.1, 0.1) == 10; }));
  EXPECT_EQ(kept.grids(), whole + 1);
  EXPECT_EQ(live->end(), kStopped) << live->said();
}

/** What config/ros/semantic-map.rviz asks for, as RViz asks: with the displays' own QoS. */
class RvizFile {
 public:
  ros2::Qos qosOf(const std::string& topic) const {
    for (const YAML::Node& display : m_manager["Displays"])
      if (const YAML::Node t = display["Topic"]; t && t["Value"].as<std::string>() == topic)
        return {t["Reliability Policy"].as<std::string>() == "Reliable",
                t["Durability Policy"].as<std::string>() == "Transient Local",
                t["Depth"].as<int>()};
    throw std::runtime_error("no display of " + topic);
  }
  std::set<std::string> buttons() const {
    std::set<std::string> topics;
    for (const YAML::Node& tool : m_manager["Tools"])
      if (tool["Topic"]) topics.insert(tool["Topic"]["Value"].as<std::string>());
    return topics;
  }

 private:
  YAML::Node m_manager =
      YAML::LoadFile(MSO_SOURCE_DIR "/config/ros/semantic-map.rviz")["Visualization Manager"];
};

TEST_F(RoadInGrass, isSeenByTheDisplaysOfTheRvizFile) {
  start({"-p", "order:=" + order(), "-p", "slam:=true", "-p", "odom_frame:=map", "-p",
         "map_frame:=world"});
  const std::string world = "world";
  const RvizFile rviz;
  EXPECT_EQ(rviz.buttons(), (std::set<std::string>{"/goal_pose", "/initialpose"}));
  const std::string m = "/semantic_map/markers", o = "/semantic_map/occupied";
  Heard<ros2::MarkerArray> markers(*live, m, rviz.qosOf(m));
  Heard<ros2::PointCloud2> voxels(*live, o, rviz.qosOf(o));
  Heard<ros2::OccupancyGrid> grid(*live, "/map", rviz.qosOf("/map"));
  Heard<ros2::Path> path(*live, "/plan", rviz.qosOf("/plan"));
  ros2::Publication<ros2::PoseStamped> goals(live->node(), "/goal_pose", {});
  see(1);
  ros2::PoseStamped goal{};
  goal.header = ros2::headerOf(0, world);
  goal.pose.position.x = 5;
  goal.pose.orientation.w = 1;
  live->send(goals, goal);
  ASSERT_TRUE(
      live->waitFor([&] { return markers.last() && voxels.last() && grid.last() && path.last(); }));
  for (const std::string& frame :
       {ros2::textOf(voxels.last()->header.frame_id), ros2::textOf(grid.last()->header.frame_id),
        ros2::textOf(path.last()->header.frame_id)})
    EXPECT_EQ(frame, world);
  EXPECT_EQ(live->end(), kStopped) << live->said();
}
