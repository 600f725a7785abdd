#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt_compat/Drawing.h>
#include <octomap/ColorOcTree.h>
#include <yaml-cpp/yaml.h>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cstring>
#include <memory>

#include "CsvTable.h"
#include "ExportFixture.h"

namespace fs = std::filesystem;
using mrpt::maps::COccupancyGridMap2D;
using semantic_octree::CellState;
using semantic_octree::SemanticOcTree;

namespace {

class SemanticMapExport : public MapTool {
 protected:
  COccupancyGridMap2D readGrid(const std::string& name) const {
    COccupancyGridMap2D grid;
    mrpt::io::CFileGZInputStream file(path(name));
    auto archive = mrpt::serialization::archiveFrom(file);
    archive >> grid;
    return grid;
  }
};

std::size_t countOccupied(const SemanticOcTree& map) {
  std::size_t count = 0;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf)
    count += map.isNodeOccupied(*leaf);
  return count;
}

#pragma pack(push, 1)
struct Vertex {
  float x, y, z;
  std::uint8_t r, g, b, id;
  float probability, occupancy, size;
};
#pragma pack(pop)

std::vector<Vertex> verticesOf(const std::string& ply) {
  const std::string end = "end_header\n";
  const std::size_t start = ply.find(end) + end.size();
  std::vector<Vertex> vertices((ply.size() - start) / sizeof(Vertex));
  std::memcpy(vertices.data(), ply.data() + start, vertices.size() * sizeof(Vertex));
  return vertices;
}

/** Whether anything occupied, or anything at all, is in a column between two heights. */
bool anyIn(const SemanticOcTree& map, double x, double y, double low, double high,
           CellState::Status status) {
  for (double z = low; z < high; z += map.getResolution())
    if (map.query(x, y, z).status == status) return true;
  return false;
}

TEST_F(SemanticMapExport, pointsAreTheOccupiedLeavesWithWhatTheMapSaysThere) {
  ASSERT_EQ(exportTo({"map.ply"}).status, 0);
  const std::string ply = folder.read("map.ply");
  EXPECT_TRUE(contains(ply, "comment class 3 grass, \"wet\"\n"));
  const auto vertices = verticesOf(ply);
  ASSERT_EQ(vertices.size(), countOccupied(map));
  EXPECT_TRUE(contains(ply, "element vertex " + std::to_string(vertices.size()) + "\n"));
  for (const Vertex& v : vertices) {
    const CellState state = map.query(v.x, v.y, v.z);
    ASSERT_EQ(state.status, CellState::Status::Occupied);
    ASSERT_EQ(v.id, state.likeliestClass);
    ASSERT_FLOAT_EQ(v.probability, float(state.probability));
    ASSERT_FLOAT_EQ(v.occupancy, float(state.occupancy));
    if (v.id == 1) {
      ASSERT_EQ(int(v.r), 200);
    }
  }
}

TEST_F(SemanticMapExport, tablesHaveALinePerPointAndQuoteNames) {
  ASSERT_EQ(exportTo({"map.csv", "all.csv"}).status, 0);
  const std::string csv = folder.read("map.csv");
  EXPECT_EQ(csv.rfind("x,y,z,size,occupancy,class,name,probability\n", 0), 0u);
  EXPECT_TRUE(contains(csv, ",3,\"grass, \"\"wet\"\"\","));
  EXPECT_EQ(std::size_t(std::count(csv.begin(), csv.end(), '\n')), countOccupied(map) + 1);
  ASSERT_EQ(exportTo({"all.csv"}, {"--free", "-f"}).status, 0);
  const std::string all = folder.read("all.csv");
  EXPECT_EQ(std::size_t(std::count(all.begin(), all.end(), '\n')), map.getNumLeafNodes() + 1);
}

TEST_F(SemanticMapExport, gridsAreOccupiedAtPostsAndFreeOnTheGroundBetween) {
  ASSERT_EQ(exportTo({"map.gridmap"}).status, 0);
  const auto grid = readGrid("map.gridmap");
  EXPECT_FLOAT_EQ(grid.getResolution(), 0.2f);
  int occupied = 0, free = 0;
  for (unsigned cx = 0; cx < grid.getSizeX(); ++cx)
    for (unsigned cy = 0; cy < grid.getSizeY(); ++cy) {
      const double x = grid.idx2x(int(cx)), y = grid.idx2y(int(cy));
      if (std::fabs(x) > 7 || std::fabs(y) > 7) continue;
      const float p = grid.getCell(int(cx), int(cy));
      // The ground is within 0.1 m of 0, in voxels with centers at -0.1 and 0.1.
      if (anyIn(map, x, y, 0.7, 1.7, CellState::Status::Occupied)) {
        EXPECT_LT(p, 0.5) << x << " " << y;
        ++occupied;
      } else if (!anyIn(map, x, y, 0.1, 2.2, CellState::Status::Occupied) &&
                 anyIn(map, x, y, -0.1, 0, CellState::Status::Occupied)) {
        EXPECT_GT(p, 0.5) << x << " " << y;
        ++free;
      }
    }
  EXPECT_GT(occupied, 30);
  EXPECT_GT(free, 1000);
}

/** What a laser scanner sees in a room whose floor is at 1 m. */
TEST_F(SemanticMapExport, aFlatFloorNeedsNoGroundInTheMap) {
  SemanticOcTree room(0.2, coloredClasses());
  semantic_types::LabeledCloud scan;
  for (double angle = 0; angle < 2 * M_PI; angle += 0.01)
    scan.points.push_back(3 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0).cast<float>());
  for (int i = 0; i < 3; ++i)
    room.insert(scan, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1.5)));
  saveTree(room, path("room.semantic"));
  const auto at = [&](const char* name, float x) { return readGrid(name).getPos(x, 0.1f); };
  succeeded(exportTo({"room.gridmap"}, {"--floor", "1"}, "room.semantic"));
  EXPECT_GT(at("room.gridmap", 1.1f), 0.9);
  EXPECT_LT(at("room.gridmap", 3), 0.1);
  EXPECT_NEAR(at("room.gridmap", 3.5), 0.5, 0.01);
  succeeded(exportTo({"above.gridmap"}, {"--floor", "2"}, "room.semantic"));
  EXPECT_NEAR(at("above.gridmap", 3), 0.5, 0.01);
}

TEST_F(SemanticMapExport, mrptLoadsTheMapServersGrid) {
  ASSERT_EQ(exportTo({"map.gridmap", "ros.yaml"}).status, 0);
  const auto grid = readGrid("map.gridmap");
  COccupancyGridMap2D ros;
  ASSERT_TRUE(ros.loadFromROSMapServerYAML(path("ros.yaml")));
  ASSERT_EQ(ros.getSizeX(), grid.getSizeX());
  ASSERT_EQ(ros.getSizeY(), grid.getSizeY());
  EXPECT_NEAR(ros.getXMin(), grid.getXMin(), 1e-3);
  EXPECT_NEAR(ros.getYMin(), grid.getYMin(), 1e-3);
  for (int cx = 0; cx < int(grid.getSizeX()); ++cx)
    for (int cy = 0; cy < int(grid.getSizeY()); ++cy)
      if (std::fabs(grid.getCell(cx, cy) - 0.5f) > 0.1f) {
        ASSERT_EQ(ros.getCell(cx, cy) > 0.5f, grid.getCell(cx, cy) > 0.5f) << cx << " " << cy;
      }
}

TEST_F(SemanticMapExport, theMapServersFileNamesItsPictureWhateverItsName) {
  for (const char* name : {"plain", "a: b #c", "x'\nnegate: 1\n\""}) {
    ASSERT_EQ(exportTo({std::string(name) + ".yaml"}).status, 0);
    const YAML::Node node = YAML::LoadFile(path(std::string(name) + ".yaml"));
    EXPECT_EQ(node["image"].as<std::string>(), std::string(name) + ".png");
    EXPECT_EQ(node["negate"].as<int>(), 0);
  }
}

TEST_F(SemanticMapExport, classMapsLieWhereTheirWorldFilesSay) {
  ASSERT_EQ(exportTo({"top.png"}).status, 0);
  const cv::Mat_<cv::Vec3b> picture = cv::imread(path("top.png"));
  std::istringstream world(folder.read("top.pgw"));
  double a, d, b, e, c, f;
  world >> a >> d >> b >> e >> c >> f;
  EXPECT_EQ(d, 0);
  EXPECT_EQ(b, 0);
  EXPECT_EQ(e, -a);
  int looked = 0;
  for (double x = -7; x < 7; x += 0.1937)
    for (double y = -7; y < 7; y += 0.1937) {
      double z = 3;
      while (z > -1 && map.query(x, y, z).status != CellState::Status::Occupied) z -= 0.1;
      const auto id = map.query(x, y, z).likeliestClass;
      if (z <= -1 || id == 0) continue;
      const auto color = map.classes().color(id);
      const auto pixel = picture(int(std::lround((y - f) / e)), int(std::lround((x - c) / a)));
      ASSERT_EQ(pixel, cv::Vec3b(color.b, color.g, color.r)) << x << " " << y;
      ++looked;
    }
  EXPECT_GT(looked, 1000);
}

TEST_F(SemanticMapExport, scenesHoldABoxPerOccupiedLeaf) {
  ASSERT_EQ(exportTo({"map.3Dscene"}).status, 0);
  mrpt_compat::Scene scene;
  ASSERT_TRUE(scene.loadFromFile(path("map.3Dscene")));
  const auto voxels = scene.getByClass<mrpt_compat::drawing::COctoMapVoxels>();
  ASSERT_TRUE(voxels);
  EXPECT_EQ(voxels->getVoxelCount(mrpt_compat::drawing::VOXEL_SET_OCCUPIED), countOccupied(map));
}

TEST_F(SemanticMapExport, badInputIsRefusedByName) {
  expectRefusal(exportTo({"map.obj"}), {"map.obj", ".ply"});
  expectRefusal(exportTo({"a.yaml", "a.png"}), {"a.png", "twice"});
  expectRefusal(exportTo({"a.gridmap"}, {"--vehicle", "gone.yaml"}), {"a.gridmap", "gone.yaml"});
  expectRefusal(exportTo({"no/folder.ply"}), {"folder.ply"});
  expectRefusal(exportTo({"a.ply"}, {}, "none.semantic"), {"none.semantic"});
  folder.write("bad.semantic", "no map");
  expectRefusal(exportTo({"a.ply"}, {}, "bad.semantic"), {"bad.semantic"});
  saveTree(SemanticOcTree(0.5, coloredClasses()), path("empty.semantic"));
  for (const char* name : {"a.gridmap", "a.yaml", "a.png"})
    expectRefusal(exportTo({name}, {}, "empty.semantic"), {name});
  expectRefusal(exportTo({"a.yaml"}, {"--floor", "0"}, "empty.semantic"), {"the map is empty"});
}

TEST_F(SemanticMapExport, whatWasThereStaysIfAnythingFails) {
  folder.write("a.ply", "of before");
  expectRefusal(exportTo({"a.ply", "no/folder.csv"}, {"-f"}), {"folder.csv"});
  EXPECT_EQ(folder.read("a.ply"), "of before");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 2);
}

class ExportedOctrees : public MapTool {
 protected:
  template <class Tree>
  std::unique_ptr<Tree> read(const std::string& name) const {
    auto* tree = octomap::AbstractOcTree::read(path(name));
    return std::unique_ptr<Tree>(dynamic_cast<Tree*>(tree));
  }
};

}  // namespace

TEST_F(ExportedOctrees, octomapReadsEachLeafWithItsColor) {
  ASSERT_EQ(exportTo({"map.ot"}).status, 0);
  const auto tree = read<octomap::ColorOcTree>("map.ot");
  ASSERT_TRUE(tree);
  EXPECT_EQ(tree->getResolution(), map.getResolution());
  EXPECT_EQ(tree->size(), map.size());
  auto theirs = tree->begin_leafs();
  for (auto ours = map.begin_leafs(); ours != map.end_leafs(); ++ours, ++theirs) {
    ASSERT_EQ(theirs.getKey(), ours.getKey());
    ASSERT_EQ(theirs.getDepth(), ours.getDepth());
    ASSERT_EQ(theirs->getLogOdds(), ours->getLogOdds());
    const auto state = map.query(*ours);
    ASSERT_EQ(theirs->isColorSet(), map.isNodeOccupied(*ours));
    if (!map.isNodeOccupied(*ours) || state.likeliestClass == 0) continue;
    const auto color = map.classes().color(state.likeliestClass);
    ASSERT_EQ(theirs->getColor(), octomap::ColorOcTreeNode::Color(color.r, color.g, color.b));
  }
  EXPECT_EQ(theirs, tree->end_leafs());
}
