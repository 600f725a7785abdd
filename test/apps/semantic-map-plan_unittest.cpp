#include <gtest/gtest.h>
#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>
#include <semantic_octree/TreeFile.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>

#include "../semantic_planning/PaintedWorld.h"
#include "RunProgram.h"
#include "TemporaryFolder.h"

namespace {

/** A folder with a map of a road along x in grass, a wall in the grass, and an order of classes. */
class SemanticMapPlan : public FolderTest {
 protected:
  void SetUp() override {
    PaintedWorld world;
    world.floor(-10, 10, -6, 6, PaintedWorld::Grass);
    world.floor(-10, 10, -2, 2, PaintedWorld::Road);
    world.box(-2, 2, 4, 4.4, 0, 2, PaintedWorld::Wall);
    semantic_octree::saveTree(world.map(), path("map.semantic"));
    folder.write("order.yaml", "best_to_worst: [road, grass, mud]\n");
  }

  ProgramRun run(const std::string& start, const std::string& goal, const Words& more = {},
                 const std::string& order = "order.yaml") const {
    return runProgram("semantic-map-plan",
                      joined({path("map.semantic"), "--start=" + start, "--goal=" + goal, "--order",
                              path(order), "--output", path("out"), "--vertices", "200", "-f"},
                             more));
  }
  nlohmann::json report() const { return nlohmann::json::parse(folder.read("out/path.json")); }

  void expectError(const ProgramRun& result, const std::string& part) const {
    EXPECT_NE(result.status, 0);
    EXPECT_NE(result.status, 2);
    EXPECT_TRUE(contains(result.errors, part));
    EXPECT_FALSE(std::filesystem::exists(folder / "out/path.json"));
  }
};

TEST_F(SemanticMapPlan, writesPathReportPictureAndScene) {
  succeeded(run("-8,0,0", "8,0,0"));
  EXPECT_EQ(report()["status"], "found");
  EXPECT_EQ(report()["lengthPerClass"].size(), 1u);
  EXPECT_GE(report()["lengthPerClass"]["road"], 16);
  EXPECT_GT(report()["milliseconds"]["ground"], 0);
  EXPECT_EQ(report()["vertices"], 0) << "no roadmap was needed";
  EXPECT_GE(report()["price"], 16);
  const std::string csv = folder.read("out/path.csv");
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "x,y,z,heading,curvature,gear,class,arc_length");
  EXPECT_GT(std::count(csv.begin(), csv.end(), '\n'), 160);
  EXPECT_TRUE(contains(csv, ",forward,road,"));
  for (const char* name : {"plan.png", "plan.3Dscene"})
    EXPECT_GT(folder.read(std::string("out/") + name).size(), 1000u) << name;
}

TEST_F(SemanticMapPlan, drawsWhatIsDrivenBackwardInAColorOfItsOwn) {
  const auto orange = [&](const std::string& goal, const std::string& gear) {
    EXPECT_EQ(run("0,0,0", goal).status, 0);
    EXPECT_TRUE(contains(folder.read("out/path.csv"), gear)) << goal;
    const cv::Mat picture = cv::imread(path("out/plan.png"));
    cv::Mat is;
    cv::inRange(picture, cv::Scalar(0, 159, 230), cv::Scalar(0, 159, 230), is);
    return cv::countNonZero(is);
  };
  EXPECT_EQ(orange("4,0,0", ",forward,road,"), 0);
  const int less = orange("-2,0,0", ",backward,road,");
  EXPECT_GT(orange("-4,0,0", ",backward,road,"), less + 20) << "not in the legend alone";
}

TEST_F(SemanticMapPlan, writesTheRoadmapForApplicationsOfMrpt) {
  ASSERT_EQ(run("-8,0,0", "8,0,0", {"--no-shorten"}).status, 0);
  const std::string graph = folder.read("out/roadmap.graph");
  EXPECT_TRUE(contains(graph, " | class road\n"));
  EXPECT_TRUE(contains(graph, " | class grass\n"));
  if (!std::filesystem::exists("/usr/bin/graph-slam"))
    GTEST_SKIP() << "needs graph-slam (mrpt-apps)";
  const ProgramRun info =
      runCommand("/usr/bin/graph-slam --2d --info -i '" + path("out/roadmap.graph") + "'");
  EXPECT_EQ(info.status, 0) << info.output;
  EXPECT_TRUE(contains(info.output, "202"));
}

TEST_F(SemanticMapPlan, setsOptionsOfGroundRoadmapAndSearch) {
  for (const char* graph : {"compressed", "halton", "halton_drivable"}) {
    const Words options = {"--graph", graph,        "--no-shorten", "--fill-gap",
                           "0.5",     "--keep-off", "--buffer",     "5"};
    EXPECT_EQ(run("-8,0,0", "8,0,0", options).status, 0) << graph;
    EXPECT_EQ(report()["cost"], report()["graphCost"]) << "--no-shorten";
    EXPECT_LE(report()["vertices"], 202);  // with start and goal
  }
}

TEST_F(SemanticMapPlan, withoutAPathItSaysWhyAndTheStatusIsTwo) {
  folder.write("out/path.csv", "of before");
  const ProgramRun result = run("0,4.2,0", "8,0,0");
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(contains(result.errors, "the start (0, 4.2) is blocked"));
  EXPECT_EQ(report()["status"], "start blocked");
  EXPECT_FALSE(std::filesystem::exists(folder / "out/path.csv"));
  EXPECT_EQ(run("-8,0,0", "50,0,0").status, 2);
  EXPECT_EQ(report()["status"], "goal off ground");
}

TEST_F(SemanticMapPlan, badInputIsAnErrorThatNamesIt) {
  folder.write("lava.yaml", "best_to_worst: [road, lava]\n");
  folder.write("table.yaml", "classes:\n - {id: 1, name: road, color: [1, 2, 3]}\n");
  folder.write("vehicle.yaml", "turning_radius: 0\n");
  const std::string goal = "8,0,0";
  expectError(run("-8,0,0", "8,0"), "8,0");
  expectError(run("nan,0,0", goal), "nan");
  expectError(run("-8,0,0", goal, {"--graph", "random"}), "random");
  expectError(run("-8,0,0", goal, {"--buffer", "-1"}), "--buffer is -1");
  expectError(run("-8,0,0", goal, {}, "lava.yaml"), "no class 'lava'");
  expectError(run("-8,0,0", goal, {}, "table.yaml"), "table.yaml:1: this is a class table; ");
  expectError(run("-8,0,0", goal, {"--vehicle", path("vehicle.yaml")}), "turning_radius is 0");
  folder.write("map.semantic", "no map");
  expectError(run("-8,0,0", goal), "map.semantic");
}

using namespace semantic_octree;

/** A road of 600 m between lawns, with much air above it. */
class PlanOfALongRoad : public FolderTest {
 protected:
  static constexpr double kHalf = 300, kPiece = 20;  // m

  void SetUp() override {
    PaintedWorld world;
    for (double x = -kHalf; x < kHalf; x += kPiece) {
      world.floor(x, x + kPiece, -15, 15, PaintedWorld::Grass);
      world.floor(x, x + kPiece, -3, 3, PaintedWorld::Road);
      world.map({x + kPiece / 2, 0.05, 20});
    }
    const SemanticOcTree& map = world.map();
    saveTree(map, path("map.semantic"));
    StoredMap tiles(emptyLike(map), path("tiles"), {500, 12.8});
    copyTo(tiles.tree(), map);
    tiles.folder()->save();
    m_megabytes = static_cast<double>(map.memoryUsage()) / 1e6;
    folder.write("order.yaml", "best_to_worst: [road, grass, mud]\n");
  }

  /** \return MB at its peak */
  double plan(const std::string& map, const std::string& start, const std::string& goal,
              const Words& more) const {
    const ProgramRun run = succeeded(runProgram(
        "semantic-map-plan", joined({path(map), "--start=" + start, "--goal=" + goal, "--order",
                                     path("order.yaml"), "--output", path("out"), "-f"},
                                    more)));
    return static_cast<double>(run.peakKilobytes) / 1e3;
  }
  double m_megabytes = 0;  ///< of the map in memory
};

}  // namespace

TEST_F(PlanOfALongRoad, keepsWithinABudgetOfATenthOfTheMap) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer takes memory of its own";
#endif
  const std::string budget = std::to_string(m_megabytes / 10);
  const Words narrow = {"--corridor", "6", "--vertices", "2000"};
  Words within = narrow;
  within.insert(within.end(), {"--memory", budget});
  const double least = plan("tiles", "-295,0,0", "-290,0,0", within);
  const double peak = plan("tiles", "-295,0,0", "295,0,0", within);
  const std::string way = folder.read("out/path.csv");
  const double whole = plan("map.semantic", "-295,0,0", "295,0,0", narrow);
  EXPECT_EQ(folder.read("out/path.csv"), way);
  // What the program takes anyhow, the budget, and 40 bytes for each column of the corridor.
  EXPECT_LT(peak, least + m_megabytes / 10 + 40e-6 * (2 * kHalf / 0.2) * (20 / 0.2));
  EXPECT_GT(whole, peak + 0.7 * m_megabytes);
}

TEST_F(PlanOfALongRoad, WithoutAPathItSaysWhatWasNotRead) {
  const auto reason = [&](const std::string& corridor) {
    const ProgramRun run =
        runProgram("semantic-map-plan",
                   {path("tiles"), "--start=0,0,0", "--goal=20,16,0", "--order", path("order.yaml"),
                    "--output", path("out"), "-f", "--corridor", corridor});
    EXPECT_EQ(run.status, 2);
    return run.errors;
  };
  EXPECT_TRUE(contains(reason("30"), "tiles beyond the --corridor were not read"));
  EXPECT_FALSE(contains(reason("inf"), "--corridor"));
}
