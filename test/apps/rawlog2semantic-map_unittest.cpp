#include <gtest/gtest.h>
#include <semantic_octree/MapContents.h>
#include <semantic_octree/TreeFile.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "RunProgram.h"
#include "SmallRawlogs.h"
#include "TemporaryFolder.h"

using Eigen::Vector3f;
using semantic_octree::CellState;
using semantic_octree::loadTree;
using semantic_octree::SemanticOcTree;
namespace fs = std::filesystem;

namespace {

const char* const kSmallConfig =
    "[map]\n"
    "resolution = 0.5\n"
    "classes = classes.yaml\n"
    "[pictures]\n"
    "width = 300\n"
    "height = 200\n";

/** A folder with a configuration, a class table and a rawlog of one scan: road at (2, 0, 0), a car
 * at (0, 3, 0), both from (1, 0, 0). */
class Rawlog2SemanticMap : public testing::Test {
 protected:
  void SetUp() override {
    folder.write("small.ini", kSmallConfig);
    folder.write("classes.yaml", kSmallTable);
    writeSmallRawlog(folder / "small.rawlog", robotPose(10, 1.1), smallScan(10));
  }

  static labeled_cloud::CObservationLabeledCloud smallScan(double seconds) {
    return labeledCloud(seconds, {{1.1f, 0.2f, 0.2f}, {-1, 3, 0.2f}}, {1, 3});
  }

  ProgramRun run(const std::string& rawlog = "small.rawlog",
                 const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"--config", (folder / "small.ini").string(), "--output",
                                          (folder / "out").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    arguments.push_back((folder / rawlog).string());
    return runProgram("rawlog2semantic-map", arguments);
  }

  SemanticOcTree map() const { return loadTree((folder / "out/map.semantic").string()); }
  nlohmann::json summary() const { return nlohmann::json::parse(folder.read("out/summary.json")); }

  /** Runs it where results are already; it must fail with one line that holds all of these, and
   * leave the results as they were. */
  void expectRefusal(const std::vector<std::string>& parts,
                     const std::string& rawlog = "small.rawlog",
                     const std::vector<std::string>& more = {}) const {
    for (const char* name : {"map.semantic", "summary.json", "top.png", "view.png"})
      folder.write(std::string("out/") + name, "of before");
    const ProgramRun result = run(rawlog, more);
    EXPECT_EQ(result.status, 1) << result.errors;
    EXPECT_TRUE(contains(result.errors, "rawlog2semantic-map: ")) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    for (const std::string& part : parts)
      EXPECT_TRUE(contains(result.errors, part)) << part << " is not in: " << result.errors;
    for (const char* name : {"map.semantic", "summary.json", "top.png", "view.png"})
      EXPECT_EQ(folder.read(std::string("out/") + name), "of before");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "out"), {}), 4);
  }

  TemporaryFolder folder;
};

}  // namespace

// --------------------------------------------------------------------------- what it makes

TEST_F(Rawlog2SemanticMap, scansBecomeAMapASummaryAndTwoPictures) {
  const ProgramRun result = run();
  ASSERT_EQ(result.status, 0) << result.errors;
  const SemanticOcTree tree = map();
  EXPECT_DOUBLE_EQ(tree.getResolution(), 0.5);
  EXPECT_EQ(tree.query(2.2, 0.2, 0.2).likeliestClass, 1);
  EXPECT_EQ(tree.query(0.1, 3, 0.2).likeliestClass, 3);
  EXPECT_EQ(tree.query(1.6, 0.2, 0.2).status, CellState::Status::Free);
  EXPECT_EQ(tree.query(2.2, 2, 0.2).status, CellState::Status::Unknown);
  for (const char* name : {"top.png", "view.png"})
    EXPECT_FALSE(cv::imread((folder / "out" / name).string()).empty()) << name;
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "out"), {}), 4);
}

TEST_F(Rawlog2SemanticMap, summaryCountsObservationsPointsAndVoxels) {
  ASSERT_EQ(run().status, 0);
  const auto s = summary();
  EXPECT_EQ(s["observations"]["read"], 2);
  EXPECT_EQ(s["observations"]["inserted"], 1);
  EXPECT_EQ(s["observations"]["skipped"].size(), 1u);
  EXPECT_EQ(s["points"]["read"], 2);
  EXPECT_EQ(s["points"]["labeled"], 2);
  const semantic_octree::MapContents contents = contentsOf(map());
  EXPECT_EQ(s["map"]["leaves"], contents.leaves);
  EXPECT_EQ(s["map"]["innerNodes"], contents.innerNodes);
  EXPECT_EQ(s["map"]["bytes"], contents.bytes);
  EXPECT_EQ(s["map"]["voxelsPerClass"], nlohmann::json({{"road", 1}, {"grass", 0}, {"car", 1}}));
  const auto insertion = s["millisecondsPerScan"]["insertion"];
  EXPECT_GT(insertion["median"], 0);
  EXPECT_GE(insertion["percentile95"], insertion["median"]);
}

TEST_F(Rawlog2SemanticMap, optionsOnTheCommandLineGoBeforeTheConfiguration) {
  folder.write("other.yaml",
               "classes:\n  - {id: 1, name: car, color: [1, 2, 3]}\n"
               "  - {id: 2, name: road, color: [1, 2, 4]}\n");
  ASSERT_EQ(run("small.rawlog", {"--resolution", "0.25", "--max-range", "2", "--classes",
                                 (folder / "other.yaml").string()})
                .status,
            0);
  EXPECT_DOUBLE_EQ(map().getResolution(), 0.25);
  EXPECT_EQ(map().query(2.2, 0.2, 0.2).likeliestClass, 2);
  EXPECT_EQ(map().query(0.1, 3, 0.2).status, CellState::Status::Unknown);
  EXPECT_EQ(summary()["points"]["beyondMaxRange"], 1);
}

TEST_F(Rawlog2SemanticMap, severalRawlogsMakeOneMap) {
  writeSmallRawlog(folder / "more.rawlog", robotPose(11, 5.1), smallScan(11));
  ASSERT_EQ(run("more.rawlog", {(folder / "small.rawlog").string()}).status, 0);
  EXPECT_EQ(map().query(2.2, 0.2, 0.2).likeliestClass, 1);
  EXPECT_EQ(map().query(6.2, 0.2, 0.2).likeliestClass, 1);
  EXPECT_EQ(summary()["rawlogs"].size(), 2u);
}

TEST_F(Rawlog2SemanticMap, whatLiesOutsideTheTrajectoryIsSkippedAndCounted) {
  writeSmallRawlog(folder / "late.rawlog", robotPose(10, 1.1), smallScan(10), smallScan(20));
  const ProgramRun result = run("late.rawlog");
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(summary()["observations"]["inserted"], 1);
  EXPECT_EQ(summary()["observations"]["skipped"]["outside the trajectory"], 1);
  EXPECT_TRUE(contains(result.output, "1 outside the trajectory")) << result.output;
}

TEST_F(Rawlog2SemanticMap, aTrajectoryFileGoesBeforeTheRawlogsPoses) {
  folder.write("poses.tum", "9 3.1 0 0 0 0 0 1\n11 5.1 0 0 0 0 0 1\n");
  ASSERT_EQ(run("small.rawlog", {"--trajectory", (folder / "poses.tum").string()}).status, 0);
  EXPECT_EQ(map().query(5.2, 0.2, 0.2).likeliestClass, 1);
  EXPECT_EQ(map().query(2.2, 0.2, 0.2).status, CellState::Status::Unknown);
}

TEST_F(Rawlog2SemanticMap, depthImagesTakeTheirLabelsFromAFolder) {
  writeSmallRawlog(folder / "depth.rawlog", robotPose(10, 0), depthImage(10, 40, 40),
                   robotPose(11, 0), depthImage(11, 40, 40));
  fs::create_directory(folder / "labels");
  cv::imwrite((folder / "labels/10.00.png").string(), cv::Mat(40, 40, CV_8UC1, cv::Scalar(2)));
  const ProgramRun result = run("depth.rawlog", {"--labels", (folder / "labels").string()});
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(map().query(2.1, 0.2, 0.2).likeliestClass, 2);
  EXPECT_EQ(summary()["observations"]["inserted"], 2);
  EXPECT_EQ(summary()["observations"]["insertedWithoutLabels"], 1);
}

TEST_F(Rawlog2SemanticMap, pointsThatAreNotFiniteAreSkippedAndCounted) {
  const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  writeSmallRawlog(
      folder / "holes.rawlog", robotPose(10, 1.1),
      labeledCloud(10, {{1.1f, 0.2f, 0.2f}, {nan, 0, 0}, {0, infinity, 0}}, {1, 2, 3}));
  ASSERT_EQ(run("holes.rawlog").status, 0);
  EXPECT_EQ(summary()["points"]["read"], 3);
  EXPECT_EQ(summary()["points"]["withoutRange"], 2);
  EXPECT_EQ(summary()["map"]["occupiedVoxels"], 1);
}

TEST_F(Rawlog2SemanticMap, memoryDoesNotGrowWithTheRawlog) {
  const auto writeScans = [this](const std::string& name, int scans) {
    std::vector<Vector3f> points(200000, {1.1f, 0.2f, 0.2f});
    const std::vector<semantic_octree::ClassId> classes(points.size(), 1);
    labeled_cloud::RawlogWriter writer(folder / name);
    writer.write(robotPose(0, 1.1));
    writer.write(robotPose(1000, 1.1));
    for (int i = 0; i < scans; ++i) writer.write(labeledCloud(i, points, classes));
    writer.finish();
  };
  writeScans("short.rawlog", 10);
  writeScans("long.rawlog", 40);  // 78 MB more of points
  const ProgramRun shortRun = run("short.rawlog"), longRun = run("long.rawlog");
  ASSERT_EQ(shortRun.status, 0) << shortRun.errors;
  ASSERT_EQ(longRun.status, 0) << longRun.errors;
  EXPECT_EQ(summary()["observations"]["inserted"], 40);
  EXPECT_LT(longRun.peakKilobytes, shortRun.peakKilobytes + 10000);
}

// --------------------------------------------------------------------------- bad input

TEST_F(Rawlog2SemanticMap, aMissingRawlogIsRefused) {
  expectRefusal({"none.rawlog"}, "none.rawlog");
}

TEST_F(Rawlog2SemanticMap, anEmptyRawlogIsRefused) {
  folder.write("empty.rawlog", "");
  expectRefusal({"empty.rawlog", "empty"}, "empty.rawlog");
}

TEST_F(Rawlog2SemanticMap, aTruncatedRawlogIsRefused) {
  const std::string whole = folder.read("small.rawlog");
  for (const std::size_t bytes : {whole.size() / 2, whole.size() - 1}) {
    folder.write("cut.rawlog", whole.substr(0, bytes));
    expectRefusal({"cut.rawlog", "cut off"}, "cut.rawlog");
  }
}

TEST_F(Rawlog2SemanticMap, aCorruptRawlogIsRefused) {
  std::string bytes = folder.read("small.rawlog");
  bytes[bytes.size() / 2] ^= 0x55;
  folder.write("corrupt.rawlog", bytes);
  expectRefusal({"corrupt.rawlog"}, "corrupt.rawlog");
  folder.write("text.rawlog", "This is no rawlog.");
  expectRefusal({"text.rawlog: ", "object 1"}, "text.rawlog");
}

TEST_F(Rawlog2SemanticMap, aRawlogThatBreaksOffWhileItIsMappedLeavesNothing) {
  const std::string whole = folder.read("small.rawlog");
  folder.write("cut.rawlog", whole.substr(0, whole.size() - 1));
  folder.write("poses.tum", "9 3.1 0 0 0 0 0 1\n11 5.1 0 0 0 0 0 1\n");
  const std::vector<std::string> poses = {"--trajectory", (folder / "poses.tum").string()};
  expectRefusal({"cut.rawlog", "cut off"}, "cut.rawlog", poses);
  fs::remove_all(folder / "out");
  EXPECT_EQ(run("cut.rawlog", poses).status, 1);
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(Rawlog2SemanticMap, aRawlogWithoutPosesIsRefused) {
  writeSmallRawlog(folder / "lost.rawlog", smallScan(10));
  expectRefusal({"lost.rawlog", "no robot poses"}, "lost.rawlog");
}

TEST_F(Rawlog2SemanticMap, aRawlogOfWhichNothingCanBeInsertedIsRefused) {
  writeSmallRawlog(folder / "late.rawlog", robotPose(10, 0), smallScan(20));
  expectRefusal({"nothing to map", "1 outside the trajectory"}, "late.rawlog");
}

TEST_F(Rawlog2SemanticMap, aClassThatTheTableLacksIsRefused) {
  folder.write("classes.yaml", "classes:\n  - {id: 1, name: road, color: [1, 2, 3]}\n");
  expectRefusal({"small.rawlog: observation 2", "lidar", "car"});
}

TEST_F(Rawlog2SemanticMap, aLabelImageOfTheWrongSizeIsRefused) {
  writeSmallRawlog(folder / "depth.rawlog", robotPose(10, 0), depthImage(10, 40, 40));
  fs::create_directory(folder / "labels");
  cv::imwrite((folder / "labels/10.00.png").string(), cv::Mat(40, 30, CV_8UC1, cv::Scalar(2)));
  expectRefusal({"depth.rawlog: observation 2", "10.00.png", "30", "40"}, "depth.rawlog",
                {"--labels", (folder / "labels").string()});
}

TEST_F(Rawlog2SemanticMap, anUnknownClassInALabelImageIsRefused) {
  writeSmallRawlog(folder / "depth.rawlog", robotPose(10, 0), depthImage(10, 40, 40));
  fs::create_directory(folder / "labels");
  cv::imwrite((folder / "labels/10.00.png").string(), cv::Mat(40, 40, CV_8UC1, cv::Scalar(77)));
  expectRefusal({"10.00.png", "77"}, "depth.rawlog", {"--labels", (folder / "labels").string()});
}

TEST_F(Rawlog2SemanticMap, aFolderWithoutLabelImagesIsRefused) {
  expectRefusal({"no-labels"}, "small.rawlog", {"--labels", (folder / "no-labels").string()});
}

TEST_F(Rawlog2SemanticMap, anUnknownKeyIsRefusedWithFileSectionAndKey) {
  const std::vector<std::pair<std::string, std::string>> wrong = {{"map", "resolutoin"},
                                                                  {"insertion", "maxrnage"},
                                                                  {"trajectory", "gap"},
                                                                  {"labels", "folder"},
                                                                  {"pictures", "size"}};
  for (const auto& [section, key] : wrong) {
    folder.write("small.ini", "[" + section + "]\n" + key + " = 1\n");
    expectRefusal({"small.ini", "[" + section + "]", "'" + key + "'"});
  }
}

TEST_F(Rawlog2SemanticMap, anUnknownSectionIsRefused) {
  folder.write("small.ini", std::string(kSmallConfig) + "[inserting]\nmaxRange = 3\n");
  expectRefusal({"small.ini", "[inserting]"});
}

TEST_F(Rawlog2SemanticMap, valuesOutOfRangeAreRefused) {
  const std::vector<std::array<std::string, 3>> wrong = {
      {"map", "resolution", "-0.1"},    {"map", "resolution", "fine"},
      {"insertion", "accuracy", "1.5"}, {"insertion", "maxRange", "-1"},
      {"trajectory", "tolerance", "x"}, {"labels", "match", "Guess"},
      {"pictures", "width", "12.5"},    {"pictures", "tilt", "nan"}};
  for (const auto& [section, key, value] : wrong) {
    folder.write("small.ini", "[" + section + "]\n" + key + " = " + value + "\n");
    expectRefusal({key});
  }
  folder.write("small.ini", kSmallConfig);
  expectRefusal({"resolution"}, "small.rawlog", {"--resolution", "0"});
  expectRefusal({"maxRange"}, "small.rawlog", {"--max-range", "-3"});
}

TEST_F(Rawlog2SemanticMap, missingFilesAreRefusedByName) {
  expectRefusal({"none.yaml"}, "small.rawlog", {"--classes", (folder / "none.yaml").string()});
  expectRefusal({"none.tum"}, "small.rawlog", {"--trajectory", (folder / "none.tum").string()});
  fs::remove(folder / "small.ini");
  expectRefusal({"small.ini"});
}

TEST_F(Rawlog2SemanticMap, anOutputFolderThatCannotBeWrittenIsRefusedByName) {
  const fs::path file = folder.write("file", "of before");
  for (const fs::path& output : {file, file / "below"}) {
    const ProgramRun result =
        runProgram("rawlog2semantic-map", {"--config", (folder / "small.ini").string(), "--output",
                                           output.string(), (folder / "small.rawlog").string()});
    EXPECT_EQ(result.status, 1);
    EXPECT_TRUE(contains(result.errors, output.string() + ": cannot write")) << result.errors;
    EXPECT_EQ(folder.read("file"), "of before");
  }
}

TEST_F(Rawlog2SemanticMap, aScanFromOutsideTheMapIsRefused) {
  writeSmallRawlog(folder / "far.rawlog", robotPose(10, 1e6), smallScan(10));
  expectRefusal({"far.rawlog: observation 2", "outside the map"}, "far.rawlog");
}
