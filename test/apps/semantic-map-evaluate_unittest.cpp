#include <gtest/gtest.h>
#include <semantic_octree/TreeFile.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include <cmath>

#include "Classes.h"
#include "Evaluation.h"
#include "RunProgram.h"
#include "SmallRawlogs.h"
#include "TemporaryFolder.h"

using namespace semantic_octree;
using nlohmann::json;
using semantic_map_evaluate::Evaluation;
using semantic_map_evaluate::LabelCounts;

namespace {

ClassTable roadGrassCar() { return tableOf({"road", "grass", "car"}); }

/** Voxels of 1 m: road at x = 4.5 (seen twice), grass at 6.5, something without a label at 8.5.
 * Before 4 it is free, and 0.5 m to the side unknown. */
SemanticOcTree smallMap(const ClassTable& table = roadGrassCar()) {
  SemanticOcTree map(1.0, table);
  LabeledCloud cloud;
  cloud.points = {{4, 0, 0}, {6, 0.1f, 0}, {8, 0.2f, 0}};
  cloud.classes = {1, 2, kNoClass};
  const Eigen::Isometry3d T(Eigen::Translation3d(0.5, 0.5, 0.5));
  map.insert(cloud, T);
  cloud.points.resize(1), cloud.classes.resize(1);
  map.insert(cloud, T);
  return map;
}

/** The small map, and scans that ask for it. */
class SemanticMapEvaluate : public FolderTest {
 protected:
  void SetUp() override {
    saveTree(smallMap(), file("map.semantic"));
    writeSmallRawlog(file("scans.rawlog"), robotPose(10, 0.5),
                     labeledCloud(10, {{4.2f, 0.4f, 0.3f}, {6.2f, 0.4f, 0.3f}, {4.1f, 0.3f, 0.2f}},
                                  {1, 3, kNoClass}));
  }
  std::string file(const std::string& name) const { return path(name); }
  ProgramRun evaluate(Words arguments) const {
    arguments.insert(arguments.end(), {"--output", file("out")});
    return runProgram("semantic-map-evaluate", arguments);
  }
  json reportOf(const Words& arguments) const {
    succeeded(evaluate(arguments));
    return json::parse(folder.read("out/quality.json"));
  }
  void expectRefusal(const ProgramRun& run, const std::string& part) const {
    ::expectRefusal(run, {part});
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  }
};

}  // namespace

TEST(Evaluation, tellsWhereAMapAnswersHowOftenItIsRightAndHowSureItIs) {
  const SemanticOcTree map = smallMap();
  const SmoothedView view(map, {0.0});
  Evaluation e(3);
  e.ask(view, {4.5, 0.5, 0.5}, 1);  // right
  e.ask(view, {4.1, 0.1, 0.1}, 2);  // wrong
  e.ask(view, {6.5, 0.5, 0.5}, 2);  // right
  e.ask(view, {8.5, 0.5, 0.5}, 3);  // occupied, no class
  e.ask(view, {2.5, 0.5, 0.5}, 1);  // free
  e.ask(view, {4.5, 9.5, 0.5}, 1);  // unknown
  e.ask(view, {1e9, 0.5, 0.5}, 1);  // outside
  EXPECT_EQ(e.points(), 7u);
  EXPECT_EQ(e.coverage(), 4 / 7.0);
  EXPECT_EQ(e.rightOfAll(), 2 / 7.0);
  EXPECT_EQ(e.answered(), 3u);
  EXPECT_EQ(e.accuracy(), 2 / 3.0);
  EXPECT_EQ(e.meanRecall(), (1 + 0.5) / 2);
  const auto given = [&](double x, int k) {
    const auto p = map.distribution(*map.search(map.coordToKey(x, 0.5, 0.5)));
    return p[k] / (1 - p[0]);
  };
  const double road = given(4.5, 1), grass = given(6.5, 2);
  EXPECT_NEAR(e.logLoss(), -(std::log(road) + std::log(given(4.5, 2)) + std::log(grass)) / 3, 1e-6);
  EXPECT_GT(road, 0.95);
  EXPECT_LT(grass, 0.95);
  EXPECT_NEAR(e.calibrationError(), (std::fabs(2 * road - 1) + (1 - grass)) / 3, 1e-6);
  EXPECT_EQ(e.reliability().back().points, 2u);
  EXPECT_EQ(e.reliability().back().shareRight(), 0.5);
  EXPECT_NEAR(e.reliability().back().meanStated(), road, 1e-6);
  EXPECT_EQ(e.ofClass()[2].points, 2u);
  EXPECT_EQ(e.ofClass()[2].right, 1u);
}

TEST(Evaluation, countsRightAnswersOfVoxelsThatWereNotHit) {
  const SemanticOcTree map = smallMap();
  Evaluation e(3);
  e.ask(SmoothedView(map), {4.5, 1.5, 0.5}, 1);
  EXPECT_EQ(e.rightOfAll(), 1);
  EXPECT_EQ(e.answered(), 0u);
}

TEST(LabelCounts, statesTheMeanOfADirichletDistributionOfLabelsOrOfScans) {
  const SemanticOcTree map(1.0, roadGrassCar());
  LabelCounts labels(map, LabelCounts::Counted::Labels), scans(map, LabelCounts::Counted::Scans);
  LabeledCloud cloud;
  cloud.points = {{4, 0, 0}, {4.1f, 0, 0}, {4.2f, 0, 0}, {4.3f, 0, 0}, {9, 0, 0}};
  cloud.classes = {3, 3, 3, 1, kNoClass};
  const Eigen::Isometry3d T(Eigen::Translation3d(0.5, 0.5, 0.5));
  for (LabelCounts* counts : {&labels, &scans}) {
    counts->add(cloud, T);
    LabeledCloud other;
    other.points = {{4, 0, 0}};
    other.classes = {1};
    counts->add(other, T);
    EXPECT_FALSE(counts->answer({9.5, 0.5, 0.5}, 1).isOccupied);
    EXPECT_FALSE(counts->answer({1e9, 0.5, 0.5}, 1).isOccupied);
  }
  const auto byLabels = labels.answer({4.9, 0.1, 0.1}, 1),
             byScans = scans.answer({4.9, 0.1, 0.1}, 2);
  EXPECT_EQ(byLabels.likeliest, 3);  // 3 of 5 labels
  EXPECT_NEAR(byLabels.ofLikeliest, (3 + 0.1 / 3) / 5.1, 1e-12);
  EXPECT_NEAR(byLabels.ofTruth, (2 + 0.1 / 3) / 5.1, 1e-12);
  EXPECT_EQ(byScans.likeliest, 1);  // 1.25 of 2 scans
  EXPECT_NEAR(byScans.ofLikeliest, (1.25 + 0.1 / 3) / 2.1, 1e-12);
  EXPECT_NEAR(byScans.ofTruth, 0.1 / 3 / 2.1, 1e-12);
}

TEST_F(SemanticMapEvaluate, tellsInATableWhatMapsAndCountingKnowOfTheLabeledPointsOfTheScans) {
  const ProgramRun run = succeeded(evaluate({file("map.semantic"), "--scans", file("scans.rawlog"),
                                             "--made-from", file("scans.rawlog")}));
  EXPECT_TRUE(contains(run.output, "map: 100.0 % of 2 points lie in occupied voxels; 50.0 % of"));
  for (const char* line : {"\nmap ", "\nlabels counted ", "\nscans counted "})
    EXPECT_TRUE(contains(run.output, line));
  const json report = json::parse(folder.read("out/quality.json")), map = report["map"];
  EXPECT_EQ(report["labels counted"]["accuracy"], 1);
  EXPECT_NEAR(report["labels counted"]["stated"], (1 + 0.1 / 3) / 1.1, 1e-12);
  EXPECT_EQ(map["meanRecall"], 0.5);
  EXPECT_EQ(map["points"], 2);
  EXPECT_EQ(map["coverage"], 1);
  EXPECT_EQ(map["accuracy"], 0.5);
  EXPECT_EQ(map["classes"]["road"]["right"], 1);
  EXPECT_EQ(map["classes"]["car"]["right"], 0);
  EXPECT_FALSE(map["classes"].contains("grass"));
  std::size_t inBins = 0;
  for (const json& bin : map["reliability"]) inBins += bin["points"].get<std::size_t>();
  EXPECT_EQ(inBins, 2u);
  EXPECT_GT(cv::imread(file("out/reliability.png")).total(), 100000u);
}

TEST_F(SemanticMapEvaluate, withoutGnuplotAllButTheFigureIsWritten) {
  const std::string path = getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  const ProgramRun run = evaluate({file("map.semantic"), "--scans", file("scans.rawlog")});
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(run.status, 1);
  EXPECT_TRUE(contains(run.errors, "gnuplot-nox"));
  EXPECT_TRUE(contains(run.output, "2 points lie in occupied voxels"));
  EXPECT_TRUE(contains(folder.read("out/quality.json"), "meanRecall"));
}

TEST_F(SemanticMapEvaluate, comparesMapsAndTakesRangeAndNeighbors) {
  saveTree(SemanticOcTree(1.0, roadGrassCar()), file("empty.semantic"));
  const json both = reportOf({file("map.semantic"), file("empty.semantic"), "--max-range", "5",
                              "--neighbor-weight", "0.4", "--scans", file("scans.rawlog")});
  EXPECT_EQ(both["map"]["points"], 1);
  EXPECT_EQ(both["empty"]["points"], 1);
  EXPECT_EQ(both["empty"]["coverage"], 0);
  EXPECT_TRUE(both["empty"]["accuracy"].is_null());
}

TEST_F(SemanticMapEvaluate, callsMapsOfOneNameByTheirPathsAndDoubtsThoseOfOtherPlaces) {
  std::filesystem::create_directory(file("other"));
  saveTree(SemanticOcTree(1.0, roadGrassCar()), file("other/map.semantic"));
  const ProgramRun run = succeeded(evaluate(
      {file("map.semantic"), file("other/map.semantic"), "--scans", file("scans.rawlog")}));
  const json both = json::parse(folder.read("out/quality.json"));
  EXPECT_EQ(both[file("map")]["coverage"], 1);
  EXPECT_TRUE(contains(run.output, file("other/map") + ": only 0 % of the points are in the map"));
  EXPECT_FALSE(contains(run.output, file("map") + ": only"));
  const ProgramRun nothing =
      succeeded(evaluate({file("other/map.semantic"), "--scans", file("scans.rawlog"), "-f"}));
  EXPECT_TRUE(contains(nothing.output, "map: 0.0 % of 2 points lie in occupied voxels\n"));
  for (const char* unwanted : {"nan", "arning"}) EXPECT_FALSE(contains(nothing.output, unwanted));
}

TEST_F(SemanticMapEvaluate, namesAreNoCommandsForGnuplot) {
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  saveTree(smallMap(), "a'\n!touch x\n`touch x`.semantic");
  succeeded(runProgram("semantic-map-evaluate", {"a'\n!touch x\n`touch x`.semantic", "--scans",
                                                 "scans.rawlog", "-o", "|touch x"}));
  EXPECT_FALSE(cv::imread("|touch x/reliability.png").empty());
  EXPECT_FALSE(std::filesystem::exists("x"));
  std::filesystem::current_path(before);
}

TEST_F(SemanticMapEvaluate, refusesMapsOfOtherClassesOrOneNameAndScansWithoutLabels) {
  ClassTable other;
  for (const char* name : {"wall", "tree"}) other.add(name, {});
  saveTree(smallMap(other), file("other.semantic"));
  expectRefusal(
      evaluate({file("map.semantic"), file("other.semantic"), "--scans", file("scans.rawlog")}),
      "different classes: map, other");
  expectRefusal(
      evaluate({file("map.semantic"), file("map.semantic"), "--scans", file("scans.rawlog")}),
      " is given twice");
  writeSmallRawlog(file("bare.rawlog"), robotPose(10, 0), labeledCloud(10, {{4, 0, 0}}, {0}));
  expectRefusal(evaluate({file("map.semantic"), "--scans", file("bare.rawlog")}),
                "no point of the scans has a class");
}
