#include <gtest/gtest.h>
#include <semantic_octree/TreeFile.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "../semantic_planning/PaintedWorld.h"
#include "RunProgram.h"
#include "ShellCommand.h"
#include "TemporaryFolder.h"

namespace {

/** A folder with a map of a road along x in grass, a wall in the grass, and an order of classes. */
class SemanticMapPlan : public testing::Test {
 protected:
  void SetUp() override {
    PaintedWorld world;
    world.floor(-10, 10, -6, 6, PaintedWorld::Grass);
    world.floor(-10, 10, -2, 2, PaintedWorld::Road);
    world.box(-2, 2, 4, 4.4, 0, 2, PaintedWorld::Wall);
    semantic_octree::saveTree(world.map(), (folder / "map.semantic").string());
    folder.write("order.yaml", "best_to_worst: [road, grass, mud]\n");
  }

  ProgramRun run(const std::string& start, const std::string& goal,
                 const std::vector<std::string>& more = {},
                 const std::string& order = "order.yaml") const {
    std::vector<std::string> arguments = {(folder / "map.semantic").string(),
                                          "--start=" + start,
                                          "--goal=" + goal,
                                          "--order",
                                          (folder / order).string(),
                                          "--output",
                                          (folder / "out").string(),
                                          "--vertices",
                                          "200",
                                          "-f"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram("semantic-map-plan", arguments);
  }
  nlohmann::json report() const { return nlohmann::json::parse(folder.read("out/path.json")); }

  void expectError(const ProgramRun& result, const std::string& part) const {
    EXPECT_NE(result.status, 0);
    EXPECT_NE(result.status, 2);
    EXPECT_TRUE(contains(result.errors, part)) << result.errors;
    EXPECT_FALSE(std::filesystem::exists(folder / "out/path.json"));
  }

  TemporaryFolder folder;
};

}  // namespace

TEST_F(SemanticMapPlan, writesPathReportPictureAndScene) {
  const ProgramRun result = run("-8,0,0", "8,0,0");
  ASSERT_EQ(result.status, 0) << result.errors;
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
    const cv::Mat picture = cv::imread((folder / "out/plan.png").string());
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
  const CommandRun info = runCommand("/usr/bin/graph-slam --2d --info -i '" +
                                     (folder / "out/roadmap.graph").string() + "'");
  EXPECT_EQ(info.status, 0) << info.output;
  EXPECT_TRUE(contains(info.output, "202")) << info.output;
}

TEST_F(SemanticMapPlan, everyKindOfGraphAndReadingIsKnown) {
  for (const char* graph : {"compressed", "halton", "halton_drivable", "full"})
    EXPECT_EQ(run("-8,0,0", "8,0,0", {"--graph", graph, "--no-shorten"}).status, 0) << graph;
  for (const char* reading : {"likeliest", "expected", "cautious"})
    EXPECT_EQ(run("-8,0,0", "8,0,0", {"--reading", reading}).status, 0) << reading;
}

TEST_F(SemanticMapPlan, setsOptionsOfGroundRoadmapReadingAndSearch) {
  EXPECT_EQ(
      run("-8,0,0", "8,0,0", {"--fill-gap", "0.5", "--keep-off", "--buffer", "5", "--no-shorten"})
          .status,
      0);
  EXPECT_EQ(report()["cost"], report()["graphCost"]) << "--no-shorten";
  EXPECT_LE(report()["vertices"], 202);  // with start and goal
}

TEST_F(SemanticMapPlan, withoutAPathItSaysWhyAndTheStatusIsTwo) {
  folder.write("out/path.csv", "of before");
  const ProgramRun result = run("0,4.2,0", "8,0,0");
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(contains(result.errors, "the start (0, 4.2) is blocked")) << result.errors;
  EXPECT_EQ(report()["status"], "start blocked");
  EXPECT_FALSE(std::filesystem::exists(folder / "out/path.csv"));
  EXPECT_EQ(run("-8,0,0", "50,0,0").status, 2);
  EXPECT_EQ(report()["status"], "goal off ground");
}

TEST_F(SemanticMapPlan, badInputIsAnErrorThatNamesIt) {
  expectError(run("-8,0,0", "8,0"), "8,0");
  expectError(run("nan,0,0", "8,0,0"), "nan");
  expectError(run("-8,0,0", "8,0,0", {"--graph", "random"}), "random");
  expectError(run("-8,0,0", "8,0,0", {"--buffer", "-1"}), "--buffer is -1");
  folder.write("lava.yaml", "best_to_worst: [road, lava]\n");
  expectError(run("-8,0,0", "8,0,0", {}, "lava.yaml"), "no class 'lava'");
  folder.write("table.yaml", "classes:\n - {id: 1, name: road, color: [1, 2, 3]}\n");
  expectError(run("-8,0,0", "8,0,0", {}, "table.yaml"), "table.yaml:1: this is a class table; ");
  EXPECT_TRUE(contains(run("-8,0,0", "8,0,0", {"--classes", "order.yaml"}).errors,
                       "unknown option '--classes'; an order of classes is --order"));
  const auto vehicle = folder.write("vehicle.yaml", "turning_radius: 0\n");
  expectError(run("-8,0,0", "8,0,0", {"--vehicle", vehicle.string()}), "turning_radius is 0");
  folder.write("map.semantic", "no map");
  expectError(run("-8,0,0", "8,0,0"), "map.semantic");
}
