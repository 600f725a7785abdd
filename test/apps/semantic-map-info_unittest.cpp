#include <gtest/gtest.h>
#include <semantic_octree/TreeFile.h>

#include <nlohmann/json.hpp>

#include <algorithm>

#include "Classes.h"
#include "RunProgram.h"
#include "TemporaryFolder.h"

using semantic_octree::SemanticOcTree;
using semantic_types::ClassTable;
using semantic_types::LabeledCloud;

namespace {

/** A map of one ray along x that ends in grass at (3.75, 0.25, 0.25), voxels of 0.5 m. */
class SemanticMapInfo : public FolderTest {
 protected:
  void SetUp() override {
    SemanticOcTree tree(0.5, tableOf({{"road", {255, 0, 0}}, {"tall grass", {0, 255, 0}}}));
    LabeledCloud cloud;
    cloud.points = {{3.5f, 0, 0}};
    cloud.classes = {2};
    tree.insert(cloud, Eigen::Isometry3d(Eigen::Translation3d(0.25, 0.25, 0.25)));
    m_probability = tree.query(3.75, 0.25, 0.25).probability;
    m_occupancy = tree.query(3.75, 0.25, 0.25).occupancy;
    saveTree(tree, map());
  }

  std::string map() const { return path("map.semantic"); }

  ProgramRun query(const std::string& points) const {
    folder.write("points.txt", points);
    return runProgram("semantic-map-info", {map(), "--query", path("points.txt")});
  }
  std::string info(const Words& options) const {
    return succeeded(runProgram("semantic-map-info", joined({map()}, options))).output;
  }
  double m_probability, m_occupancy;
};

}  // namespace

TEST_F(SemanticMapInfo, saysTheClockAndTheHalfLives) {
  EXPECT_FALSE(contains(info({}), "clock"));
  SemanticOcTree tree = semantic_octree::loadTree(map());
  ClassTable halfLives = tree.classes();
  halfLives.setHalfLife(2, 2.5);
  halfLives.setHalfLife(semantic_types::kNoClass, 3600);
  tree.setHalfLives(halfLives);
  tree.age(0.25);
  saveTree(tree, map());
  EXPECT_TRUE(contains(info({}), "  clock         0.25 s\n"));
  EXPECT_TRUE(contains(info({}), "  half-lives    tall grass 2.5 s, free space 3600.0 s\n"));
  const auto json = nlohmann::json::parse(info({"--json"}));
  EXPECT_EQ(json["clock"], 0.25);
  EXPECT_EQ(json["classes"][1]["halfLife"], 2.5);
  EXPECT_FALSE(json["classes"][0].contains("halfLife"));
  EXPECT_EQ(json["freeSpace"]["halfLife"], 3600);
}

TEST_F(SemanticMapInfo, tellsWhatIsInTheMapAsTextAndJson) {
  for (const char* part : {"0.5 m", "x 0 to 4,", "1 occupied, 7 free", "tall grass"})
    EXPECT_TRUE(contains(info({}), part));
  EXPECT_FALSE(contains(info({}), "road"));
  const auto json = nlohmann::json::parse(info({"--json"}));
  EXPECT_EQ(json["resolution"], 0.5);
  EXPECT_EQ(json["freeVoxels"], 7);
  EXPECT_EQ(json["occupiedVoxels"], 1);
  EXPECT_EQ(json["occupiedWithoutClass"], 0);
  EXPECT_EQ(json["nodes"], json["leaves"].get<int>() + json["innerNodes"].get<int>());
  EXPECT_EQ(json["boundingBox"], nlohmann::json({{"min", {0, 0, 0}}, {"max", {4, 0.5, 0.5}}}));
  EXPECT_EQ(json["filter"]["accuracy"], semantic_octree::FilterParameters().accuracy);
  const nlohmann::json road = {{"id", 1}, {"name", "road"}, {"color", {255, 0, 0}}, {"voxels", 0}};
  const nlohmann::json grass = {
      {"id", 2}, {"name", "tall grass"}, {"color", {0, 255, 0}}, {"voxels", 1}};
  EXPECT_EQ(json["classes"], nlohmann::json({road, grass}));
}

TEST_F(SemanticMapInfo, pointsAreAnsweredWithStateClassAndOccupancy) {
  const ProgramRun run =
      succeeded(query("3.6 0.1 0.2\n\n# free:\n1.1 0.2 0.3  # here\n9 -9 9\n1e9 0 0\n"));
  std::istringstream lines(run.output);
  double x, y, z, probability, occupancy;
  std::string state, tall, grass;
  int id;
  lines >> x >> y >> z >> state >> id >> tall >> grass >> probability >> occupancy;
  EXPECT_EQ(x, 3.6);
  EXPECT_EQ(state, "occupied");
  EXPECT_EQ(id, 2);
  EXPECT_EQ(tall + " " + grass, "tall grass");
  EXPECT_NEAR(probability, m_probability, 1e-5);
  EXPECT_NEAR(occupancy, m_occupancy, 1e-5);
  lines >> x >> y >> z >> state >> id >> grass >> probability >> occupancy;
  EXPECT_EQ(state + grass, "free-");
  EXPECT_LT(occupancy, 0.5);
  for (int far = 0; far < 2; ++far) {
    lines >> x >> y >> z >> state >> id >> grass >> probability >> occupancy;
    EXPECT_EQ(state + grass, "unknown-");
    EXPECT_EQ(occupancy, 0.5);
  }
}

TEST_F(SemanticMapInfo, pointsOfTheCommandLineAndOfTheStandardInputAreAnsweredAlike) {
  const std::string expected = query("3.6 0.1 0.2\n-1 0 0\n").output;
  EXPECT_EQ(info({"--at", "3.6,0.1,0.2", "--at", "-1,0,0"}), expected);
  EXPECT_EQ(runCommand("printf '3.6 0.1 0.2\\n-1 0 0\\n' | " MSO_BIN_DIR "/semantic-map-info " +
                       map() + " --query -")
                .output,
            expected);
}

TEST_F(SemanticMapInfo, theDistributionAtAPointHasAllClassesAndFreeSpace) {
  const Words there = {"--at", "3.6,0.1,0.2", "--distribution"};
  const auto answers = nlohmann::json::parse(info(joined(there, {"--json", "--at", "9,-9,9"})));
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0]["class"], "tall grass");
  std::map<std::string, double> at;
  double sum = 0;
  for (const auto& part : answers[0]["distribution"])
    sum += at[part["class"]] = part["probability"];
  EXPECT_NEAR(sum, 1, 1e-9);
  EXPECT_NEAR(at["tall grass"], m_probability, 1e-9);
  EXPECT_NEAR(at["(free)"], 1 - m_occupancy, 1e-4);
  EXPECT_TRUE(answers[1]["distribution"].empty());
  const std::string text = info(there);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + std::ptrdiff_t(at.size())) << text;
}

TEST_F(SemanticMapInfo, linesThatAreNoPointsAreRefusedByNumber) {
  for (const char* line : {"1 2", "1 2 3 4", "1 2 x", "nan 0 0", "inf 0 0"})
    expectRefusal(query(std::string("0 0 0\n") + line + "\n"), {"points.txt:2", line});
  const ProgramRun ofLong = query("1 2 " + std::string(1000000, 'x'));
  expectRefusal(ofLong, {"points.txt:1", "x ... x"});
  EXPECT_LT(ofLong.errors.size(), 3000u);
}

TEST_F(SemanticMapInfo, missingFilesAreRefusedByName) {
  expectRefusal(runProgram("semantic-map-info", {path("none.semantic")}), {"none.semantic"});
  expectRefusal(runProgram("semantic-map-info", {folder.path().string()}),
                {folder.path().string() + ": is a folder of results; did you mean '" + map()});
  expectRefusal(runProgram("semantic-map-info", {map(), "--query", path("none.txt")}),
                {"none.txt"});
}

TEST_F(SemanticMapInfo, namesDoNotReachATerminalAsTheyAre) {
  const std::string name =
      "map\x1b[2J\n\xC2\x9B"
      "1m.semantic";
  const ProgramRun missing = runProgram("semantic-map-info", {path(name)});
  expectRefusal(missing, {"map\\x1b[2J\\x0a\\xc2\\x9b1m.semantic"});
  std::filesystem::rename(map(), folder / name);
  const ProgramRun run = succeeded(runProgram("semantic-map-info", {path(name)}));
  EXPECT_TRUE(contains(run.output, "map\\x1b[2J"));
  EXPECT_FALSE(contains(run.output, "\x1b"));
  EXPECT_FALSE(contains(run.output, "\xC2\x9B"));
}
