#include <gtest/gtest.h>
#include <labeled_cloud/Rawlogs.h>
#include <map_operations/MapOperations.h>
#include <semantic_octree/TreeFile.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "MappingFixture.h"
#include "RunProgram.h"
#include "TemporaryFolder.h"
#include "XServer.h"

using Eigen::Vector3f;
using semantic_octree::CellState;
using semantic_octree::SemanticOcTree;
namespace fs = std::filesystem;

TEST_F(Rawlog2SemanticMap, scansBecomeAMapASummaryAndTwoPictures) {
  succeeded(run());
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

TEST_F(Rawlog2SemanticMap, isInPlaceBeforeOpenGlMayEndTheProcess) {
  runCommand("cd '" + folder.path().string() +
             "'; mkfifo waits; __EGL_VENDOR_LIBRARY_FILENAMES=$PWD/waits " MSO_BIN_DIR
             "/rawlog2semantic-map -q --config small.ini -o out small.rawlog & "
             "for i in $(seq 600); do test ! -e out/map.semantic && kill -0 $! || break; "
             "sleep 0.1; done; kill -9 $!");
  EXPECT_FALSE(map().empty());
  EXPECT_EQ(summary()["observations"]["inserted"], 1);
}

TEST_F(Rawlog2SemanticMap, summaryCountsObservationsPointsAndVoxels) {
  ASSERT_EQ(run().status, 0);
  const auto s = summary();
  EXPECT_EQ(s["observations"]["read"], 2);
  EXPECT_EQ(s["observations"]["inserted"], 1);
  EXPECT_EQ(s["observations"]["poses"], 1);  // used, not lost
  EXPECT_TRUE(s["observations"]["skipped"].empty());
  EXPECT_EQ(s["stopped"], false);
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

TEST_F(Rawlog2SemanticMap, classesWithAHalfLifeAreForgottenByTheStamps) {
  const auto road = labeledCloud(18, {{1.1f, 0.2f, 0.2f}}, {1});
  writeSmallRawlog(folder / "later.rawlog", robotPose(18, 1.1), road);
  const auto carAfter = [&](const Words& more) {
    succeeded(run("later.rawlog", joined({path("small.rawlog")}, more)));
    return map().query(0.1, 3, 0.2).status;
  };
  EXPECT_EQ(carAfter({}), CellState::Status::Occupied);
  std::string table = kSmallTable;
  table.insert(table.rfind('}'), ", half_life: 1");  // of the last class, car
  folder.write("classes.yaml", table);
  EXPECT_EQ(carAfter({}), CellState::Status::Unknown);
  EXPECT_EQ(map().query(2.2, 0.2, 0.2).status, CellState::Status::Occupied);
  EXPECT_DOUBLE_EQ(map().clock(), 8);
  EXPECT_EQ(carAfter({"--slam"}), CellState::Status::Unknown);
  EXPECT_DOUBLE_EQ(map().clock(), 8);
  folder.write("small.ini", std::string(kSmallConfig) + "[insertion]\nmax_gap = 5\n");
  EXPECT_EQ(carAfter({}), CellState::Status::Occupied) << "another recording";
}

TEST_F(Rawlog2SemanticMap, optionsOnTheCommandLineGoBeforeTheConfiguration) {
  folder.write("other.yaml",
               "classes:\n  - {id: 1, name: car, color: [1, 2, 3]}\n"
               "  - {id: 2, name: road, color: [1, 2, 4]}\n");
  ASSERT_EQ(run("small.rawlog",
                {"--resolution", "0.25", "--max-range", "2", "--classes", path("other.yaml")})
                .status,
            0);
  EXPECT_DOUBLE_EQ(map().getResolution(), 0.25);
  EXPECT_EQ(map().query(2.2, 0.2, 0.2).likeliestClass, 2);
  EXPECT_EQ(map().query(0.1, 3, 0.2).status, CellState::Status::Unknown);
  EXPECT_EQ(summary()["points"]["beyondMaxRange"], 1);
}

TEST_F(Rawlog2SemanticMap, withoutAConfigurationTakesTheClassesThatTheRawlogNames) {
  auto scan = smallScan(10);
  scan.classNames = {"tarmac", "lawn", "van"};
  writeSmallRawlog(folder / "named.rawlog", robotPose(10, 1.1), scan);
  scan.classNames.clear();
  writeSmallRawlog(folder / "nameless.rawlog", robotPose(10, 1.1), scan);
  const auto nameAt = [this](double x, const std::string& rawlog, const Words& more) {
    succeeded(
        runProgram("rawlog2semantic-map", joined({path(rawlog), "-f", "-o", path("out")}, more)));
    const SemanticOcTree tree = map();
    return tree.classes().name(tree.query(x, 0.2, 0.2).likeliestClass);
  };
  EXPECT_EQ(nameAt(2.2, "named.rawlog", {}), "tarmac");
  EXPECT_EQ(nameAt(2.2, "named.rawlog", {"--config", MSO_SOURCE_DIR "/config/maps/generic.ini"}),
            "tarmac");
  EXPECT_EQ(nameAt(1.1, "nameless.rawlog", {"--static-pose"}), "class 1");
}

TEST_F(Rawlog2SemanticMap, ofMrptsOwnSamplesWithoutPosesOrLabelsIsAMapOfOccupancy) {
  for (const char* name : {"tests_rgbd.rawlog", "test_velodyne_VLP16.rawlog"}) {
    const fs::path rawlog = fs::path("/usr/share/mrpt/datasets") / name;
    if (!fs::exists(rawlog)) GTEST_SKIP() << "no " << rawlog << " here";
    succeeded(runProgram("rawlog2semantic-map", {rawlog.string(), "--static-pose", "--resolution",
                                                 "0.2", "-f", "-o", path("out")}));
    EXPECT_GT(contentsOf(map()).occupiedVoxels, 200u) << name;
    EXPECT_EQ(map().numClasses(), 1);
  }
}

TEST_F(Rawlog2SemanticMap, aTrajectoryFileGoesBeforeTheRawlogsPosesAndWhatIsOutsideIsSkipped) {
  writeSmallRawlog(folder / "late.rawlog", robotPose(10, 1.1), smallScan(10), smallScan(20));
  folder.write("poses.tum", "9 3.1 0 0 0 0 0 1\n11 5.1 0 0 0 0 0 1\n");
  const ProgramRun result = succeeded(run("late.rawlog", {"--trajectory", path("poses.tum")}));
  EXPECT_EQ(map().query(5.2, 0.2, 0.2).likeliestClass, 1);
  EXPECT_EQ(map().query(2.2, 0.2, 0.2).status, CellState::Status::Unknown);
  EXPECT_EQ(summary()["observations"]["inserted"], 1);
  EXPECT_EQ(summary()["observations"]["skipped"]["outside the trajectory"], 1);
  EXPECT_TRUE(contains(result.output, "1 outside the trajectory"));
}

TEST_F(Rawlog2SemanticMap, posesOfKittiBelongToTheScansInTheirOrder) {
  writeSmallRawlog(folder / "two.rawlog", smallScan(10), smallScan(11));
  folder.write("poses.txt", "1 0 0 4.1 0 1 0 0 0 0 1 0\n0 -1 0 6.1 1 0 0 0 0 0 1 0\n");
  succeeded(run("two.rawlog", {"--trajectory", path("poses.txt")}));
  EXPECT_EQ(map().query(5.2, 0.2, 0.2).likeliestClass, 1);
  EXPECT_EQ(map().query(5.9, 1.1, 0.2).likeliestClass, 1) << "turned to the left";
}

TEST_F(Rawlog2SemanticMap, depthImagesTakeTheirLabelsFromAFolder) {
  writeSmallRawlog(folder / "depth.rawlog", robotPose(10, 0), depthImage(10, 40, 40),
                   robotPose(11, 0), depthImage(11, 40, 40));
  fs::create_directory(folder / "labels");
  cv::imwrite(path("labels/10.00.png"), cv::Mat(40, 40, CV_8UC1, cv::Scalar(2)));
  succeeded(run("depth.rawlog", {"--labels", path("labels")}));
  EXPECT_EQ(map().query(2.1, 0.2, 0.2).likeliestClass, 2);
  EXPECT_EQ(summary()["observations"]["inserted"], 2);
  EXPECT_EQ(summary()["observations"]["insertedWithoutLabels"], 1);
}

TEST_F(Rawlog2SemanticMap, memoryDoesNotGrowWithTheRawlog) {
  const auto writeScans = [this](const std::string& name, int scans) {
    std::vector<Vector3f> points(200000, {1.1f, 0.2f, 0.2f});
    const std::vector<semantic_types::ClassId> classes(points.size(), 1);
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

TEST_F(Rawlog2SemanticMap, saysAsMuchAsIsWanted) {
  EXPECT_EQ(run("small.rawlog", {"-q"}).output, "");
  EXPECT_TRUE(contains(run().output, "1 scans inserted, 0 skipped"));
  const std::string text = run("small.rawlog", {"-v"}).output;
  EXPECT_TRUE(contains(text, "CObservationRobotPose ''): a pose\n"));
  EXPECT_TRUE(contains(text, "CObservationLabeledCloud 'lidar'): inserted\n"));
}

namespace {

const std::string kProgram = std::string(MSO_BIN_DIR) + "/rawlog2semantic-map";

class LiveMapping : public Rawlog2SemanticMap {
 protected:
  LiveMapping() {
    folder.write("weights.ini",
                 std::string(kSmallConfig) + "[abstraction]\nrelevant = road: 1\nalpha = 0.001\n");
  }
  /** Four scans of a field of road; cars behind it come with the second one. */
  void SetUp() override {
    Rawlog2SemanticMap::SetUp();
    std::vector<Eigen::Vector3f> points;
    std::vector<semantic_types::ClassId> classes;
    for (float x = 2; x < 14; x += 0.25f)
      for (float y = -6; y < 6; y += 0.25f) {
        points.emplace_back(x, y, -1.3f);
        classes.push_back(x < 12 ? 1 : 3);
      }
    const auto scan = [&](double seconds) { return labeledCloud(seconds, points, classes); };
    const std::size_t cars = std::size_t(std::count(classes.begin(), classes.end(), 3));
    const auto onlyRoad = labeledCloud(10, {points.begin(), points.end() - std::ptrdiff_t(cars)},
                                       {classes.begin(), classes.end() - std::ptrdiff_t(cars)});
    writeSmallRawlog(folder / "field.rawlog", robotPose(10, 0), onlyRoad, robotPose(11, 0.3),
                     scan(11), robotPose(12, 0.6), scan(12), robotPose(13, 0.9), scan(13));
  }
  Words arguments(const std::string& output) const {
    return {"--config", path("weights.ini"), "--output", path(output), path("field.rawlog")};
  }
};

TEST_F(LiveMapping, ShowsTheMapScanByScanAndMakesTheSame) {
  SKIP_WITHOUT_WINDOWS();
  // In the panel at the upper left: "step", twice, and "pause", which lets it go on.
  const ProgramRun live =
      succeeded(runInX(joined({MSO_SOURCE_DIR "/test/apps/view-window.sh", path("said.txt"),
                               kProgram, "--live", "--pause", "-v"},
                              arguments("live"),
                              {"--", "140 53 inserted", "140 53 inserted",
                               "picture " + path("screen.png"), "25 53 voxels of"})));
  const cv::Mat screen = cv::imread(path("screen.png"));
  ASSERT_FALSE(screen.empty());
  int road = 0, car = 0;
  for (auto it = screen.begin<cv::Vec3b>(); it != screen.end<cv::Vec3b>(); ++it) {
    road += (*it)[2] > 200 && (*it)[0] < 10 && (*it)[1] < 10;
    car += (*it)[0] > 200 && (*it)[1] < 10 && (*it)[2] < 10;
  }
  EXPECT_GT(road, 3000);
  EXPECT_GT(car, 200) << "more than beside its name";

  const ProgramRun without = succeeded(runProgram("rawlog2semantic-map", arguments("without")));
  for (const std::string name : {"/map.semantic", "/compressed.semantic", "/top.png"})
    EXPECT_EQ(folder.read("live" + name), folder.read("without" + name)) << name;
}

TEST_F(LiveMapping, ShowsTheCamerasPictureWithItsLabels) {
  SKIP_WITHOUT_WINDOWS();
  // The first scan of the sample is a camera's: half of its colors are those of the classes.
  succeeded(runInX(
      {MSO_SOURCE_DIR "/test/apps/view-window.sh", path("said.txt"), kProgram, "--live", "--pause",
       "-v", "--config", MSO_SOURCE_DIR "/config/maps/synthetic.ini", "-o", path("live"),
       MSO_SOURCE_DIR "/rawlog-samples/village.rawlog", "--", "140 53 'CAMERA'): inserted",
       "140 53 'LIDAR'): inserted", "picture " + path("screen.png")}));
  const cv::Mat screen = cv::imread(path("screen.png"));
  ASSERT_FALSE(screen.empty());
  int paper = 0, all = 0;
  for (int row = 460; row < 700; ++row)
    for (int col = 920; col < 1260; ++col)
      paper += screen.at<cv::Vec3b>(row, col) == cv::Vec3b(250, 250, 250), ++all;
  EXPECT_LT(paper, all / 100) << "the picture is opaque";
}

TEST_F(LiveMapping, IsAnErrorWithoutADisplay) {
  const ProgramRun run = runProgram(
      "/usr/bin/env",
      joined({"-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", kProgram, "--live"}, arguments("live")));
  EXPECT_EQ(run.status, 1);
  const char* const problem = hasWindows() ? "--live: there is no display" : "without windows";
  EXPECT_TRUE(contains(run.errors, problem));
  EXPECT_FALSE(fs::exists(folder / "live"));
}

}  // namespace

TEST(SampleMap, theVillageIsMappedWithItsClasses) {
  const TemporaryFolder folder;
  const fs::path sources = MSO_SOURCE_DIR;
  succeeded(
      runProgram("rawlog2semantic-map",
                 {"--config", (sources / "config/maps/synthetic.ini").string(), "--output",
                  folder.path().string(), (sources / "rawlog-samples/village.rawlog").string()}));

  const auto summary = nlohmann::json::parse(folder.read("summary.json"));
  EXPECT_EQ(summary["observations"]["inserted"], 48);
  for (const char* name : {"road", "sidewalk", "grass", "canopy", "building", "roof"})
    EXPECT_GT(summary["map"]["voxelsPerClass"][name], 500) << name;
}
