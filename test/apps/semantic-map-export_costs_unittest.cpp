// Costs of driving by class, as map_server's pictures.
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <yaml-cpp/yaml.h>

#include <opencv2/imgcodecs.hpp>

#include "Classes.h"
#include "ExportFixture.h"

using semantic_octree::SemanticOcTree;
using semantic_types::LabeledCloud;

namespace {

/** Ground from -5 to 5 m: road where |y| < 1.5, beyond it grass, and water behind y = 4; a wall of
 * 1 m at x = 3. */
SemanticOcTree yard() {
  SemanticOcTree map(0.2, tableOf({"road", "grass", "water", "wall"}));
  LabeledCloud cloud;
  const auto add = [&cloud](double x, double y, double z, int id) {
    cloud.points.push_back(Eigen::Vector3d(x, y, z - 4).cast<float>());
    cloud.classes.push_back(static_cast<semantic_types::ClassId>(id));
  };
  for (double x = -4.95; x < 5; x += 0.05)
    for (double y = -4.95; y < 5; y += 0.05) {
      add(x, y, 0.1, std::abs(y) < 1.5 ? 1 : y < 4 ? 2 : 3);
      if (x > 3 && x < 3.2)
        for (double z = 0.3; z < 1.1; z += 0.2) add(x, y, z, 4);
    }
  Eigen::Isometry3d T(Eigen::Translation3d(0, 0, 4));
  for (int i = 0; i < 3; ++i) map.insert(cloud, T);
  return map;
}

class CostExport : public FolderTest {
 protected:
  void SetUp() override {
    saveTree(yard(), path("map.semantic"));
    folder.write("order.yaml", "best_to_worst: [road, grass]\n");
    folder.write("vehicle.yaml",
                 "footprint: [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]\nclearance: 0\n");
  }
  ProgramRun costs(const std::string& name, const Words& more) {
    return runProgram(
        "semantic-map-export",
        joined({path("map.semantic"), "-o", path(name), "--costs", path("order.yaml")}, more));
  }
  std::string vehicle() const { return path("vehicle.yaml"); }
  /** The pixel where a place is, by what the description says. */
  cv::Vec4b pixel(const std::string& name, double x, double y) const {
    const YAML::Node node = YAML::LoadFile(path(name));
    cv::Mat picture =
        cv::imread((folder / node["image"].as<std::string>()).string(), cv::IMREAD_UNCHANGED);
    const double resolution = node["resolution"].as<double>();
    const int column = int(std::floor((x - node["origin"][0].as<double>()) / resolution));
    const int row =
        picture.rows - 1 - int(std::floor((y - node["origin"][1].as<double>()) / resolution));
    EXPECT_TRUE(column >= 0 && column < picture.cols && row >= 0 && row < picture.rows);
    if (picture.channels() == 4) return picture.at<cv::Vec4b>(row, column);
    return {picture.at<std::uint8_t>(row, column), 0, 0, 255};
  }
};

struct Place {
  double x, y;
  int cost;
};
/** The disc of 0.5 m keeps off the wall, and the wheels off the water. */
const std::vector<Place> kPlaces = {
    {-2, 0.1, 0},    {0, 1.1, 0},     {-2, 2.5, 90},  {-3, -3, 90},  {2.3, 0.1, 0}, {2.7, 0.1, 99},
    {2.9, -2.1, 99}, {3.1, 0.1, 100}, {-2, 4.5, 100}, {-2, 3.7, 90}, {-5.9, 0, -1}};

}  // namespace

TEST_F(CostExport, rawPicturesHoldTheCostsThemselves) {
  const ProgramRun run = succeeded(costs("raw.yaml", {"--vehicle", vehicle(), "--mode", "raw"}));
  EXPECT_TRUE(contains(run.output, "raw.pgm"));
  for (const Place& p : kPlaces)
    EXPECT_EQ(pixel("raw.yaml", p.x, p.y)[0], p.cost < 0 ? 255 : p.cost) << p.x << ' ' << p.y;
  EXPECT_EQ(YAML::LoadFile(path("raw.yaml"))["mode"].as<std::string>(), "raw");
}

TEST_F(CostExport, scaledPicturesHoldThemAsShadesAndWhatIsUnknownIsTransparent) {
  ASSERT_EQ(costs("s.yaml", {"--vehicle", vehicle(), "--mode", "scale"}).status, 0);
  const YAML::Node node = YAML::LoadFile(path("s.yaml"));
  const double occupied = node["occupied_thresh"].as<double>(),
               free = node["free_thresh"].as<double>();
  for (const Place& p : kPlaces) {
    const cv::Vec4b gray = pixel("s.yaml", p.x, p.y);
    const double share = (255 - gray[0]) / 255.0;  // as map_server reads it
    const int cost = gray[3] < 255      ? -1
                     : share > occupied ? 100
                     : share < free     ? 0
                                    : int(std::lround(100 * (share - free) / (occupied - free)));
    EXPECT_NEAR(cost, p.cost, p.cost > 0 && p.cost < 100 ? 1 : 0) << p.x << ' ' << p.y;
  }
}

TEST_F(CostExport, mrptReadsThePictureOfThreeValues) {
  ASSERT_EQ(costs("t.yaml", {"--vehicle", vehicle()}).status, 0);
  const auto grid = mrpt::maps::COccupancyGridMap2D::FromROSMapServerYAML(path("t.yaml"));
  for (const Place& p : kPlaces) {
    const float free = grid.getPos(float(p.x), float(p.y));
    if (p.cost < 0)
      EXPECT_NEAR(free, 0.5, 0.31) << p.x << ' ' << p.y;
    else
      EXPECT_EQ(free > 0.9, p.cost < 100) << p.x << ' ' << p.y << ": " << free;
  }
}

TEST_F(CostExport, aSmallRobotFitsWhereALargeOneDoesNot) {
  ASSERT_EQ(costs("small.yaml", {"--mode", "raw"}).status, 0);
  EXPECT_EQ(pixel("small.yaml", 2.5, 0.1)[0], 0);
  EXPECT_EQ(pixel("small.yaml", 2.9, 0.1)[0], 99);
}

/** A house of two storeys, 3 m apart, of road below and grass above; below there is a wall. */
TEST_F(CostExport, aStoreyIsWhatIsAroundItsFloor) {
  SemanticOcTree map(0.2, yard().classes());
  for (const int storey : {1, 0}) {
    LabeledCloud cloud;
    for (double x = -3.9; x < 4; x += 0.1)
      for (double y = -3.9; y < 4; y += 0.1) {
        if (storey == 1 && x < -2) continue;
        const bool isWall = storey == 0 && x > 2 && x < 2.4;
        for (double z = 0.1; z < (isWall ? 2.8 : 0.2); z += 0.2) {
          cloud.points.push_back(Eigen::Vector3d(x, y, z - 1.5).cast<float>());
          cloud.classes.push_back(storey == 0 ? 1 : 2);
        }
      }
    Eigen::Isometry3d T(Eigen::Translation3d(0, 0, 3 * storey + 1.5));
    for (int i = 0; i < 3; ++i) map.insert(cloud, T);
  }
  saveTree(map, path("map.semantic"));
  succeeded(costs("low.yaml", {"--floor", "0.2", "--mode", "raw"}));
  succeeded(costs("high.yaml", {"--floor", "3.2", "--mode", "raw"}));
  EXPECT_EQ(pixel("low.yaml", 0.1, 0.1)[0], 0);      // road
  EXPECT_EQ(pixel("high.yaml", 0.1, 0.1)[0], 90);    // grass
  EXPECT_EQ(pixel("low.yaml", 2.1, 0.1)[0], 100);    // wall
  EXPECT_EQ(pixel("high.yaml", 2.1, 0.1)[0], 90);    // above it
  EXPECT_EQ(pixel("high.yaml", -3.1, 0.1)[0], 255);  // no floor there
  expectRefusal(costs("a.yaml", {"--floor", "9"}), {"no drivable ground"});
}

TEST_F(CostExport, badInputIsRefusedByName) {
  const ProgramRun grey = costs("a.yaml", {"--mode", "grey"});
  EXPECT_EQ(grey.status, 64);
  EXPECT_TRUE(contains(grey.errors, "unknown value 'grey'"));
  expectRefusal(costs("a.yaml", {"--vehicle", path("gone.yaml")}), {"gone.yaml"});
  folder.write("order.yaml", "best_to_worst: [rod]\n");
  expectRefusal(costs("a.yaml", {}), {"order.yaml", "'rod'"});
  folder.write("order.yaml", "best_to_worst: [road]\n");
  SemanticOcTree air(0.2, yard().classes());
  saveTree(air, path("map.semantic"));
  expectRefusal(costs("a.yaml", {}), {"a.yaml", "no drivable ground"});
  EXPECT_FALSE(std::filesystem::exists(folder / "a.yaml"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.pgm"));
}
