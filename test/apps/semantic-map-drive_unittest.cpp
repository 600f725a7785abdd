#include <gtest/gtest.h>
#include <map_folders/MapFolder.h>
#include <mrpt/nav/reactive/CLogFileRecord.h>
#include <mrpt/serialization/CArchive.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>

#include "CompressedInput.h"
#include "RunProgram.h"
#include "TemporaryFolder.h"
#include "XServer.h"

namespace {

/** Runs semantic-map-drive over some meters of the village. */
class SemanticMapDrive : public FolderTest {
 protected:
  Words argumentsWith(const Words& more) const {
    return joined({"--world", "village", "--start=-14,-19,10", "--goal=-6,-17,20", "--order",
                   kConfig + "orders/synthetic.yaml", "--no-pictures", "-f"},
                  more);
  }

  ProgramRun drive(const Words& more) const {
    return runProgram("semantic-map-drive",
                      joined(argumentsWith({"--config", kConfig + "drives/synthetic.ini",
                                            "--output", path("drive")}),
                             more));
  }

  /** A configuration whose section [drive] says this; other keys have their defaults. */
  std::string configWith(const std::string& lines) const {
    return folder
        .write("drive.ini", "[planner]\nvehicle = " + kConfig +
                                "vehicles/robot.yaml\nkeepOff = 1\n" +
                                "[drive]\nreactive = " + kConfig + "reactive/robot.ini\n" + lines)
        .string();
  }

  nlohmann::json jsonIn(const std::string& file) const {
    return nlohmann::json::parse(std::ifstream(path(file)));
  }
  bool has(const std::string& file) const { return std::filesystem::exists(path(file)); }

  const std::string kConfig = std::string(MSO_SOURCE_DIR) + "/config/";
};

TEST_F(SemanticMapDrive, DrawsAnAnimationUnlessItIsNotWanted) {
  auto arguments = argumentsWith(
      {"--config", configWith("timeLimit = 3\n"), "--output", path("drive"), "--no-rawlog"});
  EXPECT_EQ(runProgram("semantic-map-drive", arguments).status, 2);  // not arrived
  EXPECT_FALSE(has("drive/drive.gif"));
  arguments.erase(std::find(arguments.begin(), arguments.end(), "--no-pictures"));
  const ProgramRun run = runProgram("semantic-map-drive", arguments);
  EXPECT_EQ(run.status, 2) << run.errors;
  const std::string gif = folder.read("drive/drive.gif");
  EXPECT_EQ(gif.substr(0, 6), "GIF89a");
  EXPECT_GE(static_cast<unsigned char>(gif[6]) + 256 * static_cast<unsigned char>(gif[7]), 960)
      << "pixels of width";
  EXPECT_TRUE(has("drive/drive.png"));
}

TEST_F(SemanticMapDrive, WritesARawlogThatBecomesAMap) {
  ASSERT_EQ(drive({}).status, 0);
  const auto cycles = jsonIn("drive/drive.json")["milliseconds"]["insert"]["cycles"].get<int>();
  const ProgramRun made = succeeded(
      runProgram("rawlog2semantic-map", {path("drive/drive.rawlog"), "--config",
                                         kConfig + "maps/synthetic.ini", "--output", path("map")}));
  // An image and a LiDAR scan each time.
  EXPECT_TRUE(contains(made.output, std::to_string(2 * cycles) + " scans inserted"));
  EXPECT_TRUE(has("map/map.semantic"));
}

TEST_F(SemanticMapDrive, LogsWhatMrptsNavigatorDid) {
  ASSERT_EQ(drive({"--no-rawlog", "--navlog", "--person", "0,-5,-17,-13,-18.7"}).status, 0);
  EXPECT_EQ(jsonIn("drive/drive.json")["collisions"], 0);
  CompressedInput file(path("drive/drive.reactivenavlog"));
  auto archive = mrpt::serialization::archiveFrom(file);
  int records = 0, withObstacles = 0;
  try {
    for (;; ++records) {
      mrpt::nav::CLogFileRecord record;
      archive >> record;
      withObstacles += record.WS_Obstacles.size() > 0;
      // Between start and goal.
      EXPECT_GT(record.robotPoseLocalization.x, -16);
      EXPECT_LT(record.robotPoseLocalization.x, -5);
    }
  } catch (const std::exception&) {  // the end
  }
  EXPECT_GT(records, 20);
  EXPECT_GT(withObstacles, 0);
}

TEST_F(SemanticMapDrive, RefusesAGoalOutsideOfTheWorld) {
  const ProgramRun run =
      runProgram("semantic-map-drive", {"--start=-14,-19,10", "--goal=500,-17,20", "--order",
                                        kConfig + "orders/synthetic.yaml", "--config",
                                        kConfig + "drives/synthetic.ini", "--output", path("x")});
  EXPECT_EQ(run.status, 1);
  EXPECT_TRUE(contains(run.errors, "--goal: outside of the world")) << run.errors;
}

const std::string kProgram = std::string(MSO_BIN_DIR) + "/semantic-map-drive";

/** Some seconds, as a window shows them in real time. */
class LiveDrive : public SemanticMapDrive {
 protected:
  Words shortDrive(const std::string& output) const {
    return argumentsWith(
        {"--config", configWith("timeLimit = 4\n"), "--output", path(output), "--no-rawlog"});
  }
  std::string csvIn(const std::string& output) const { return folder.read(output + "/drive.csv"); }
};

/** Pixels of a color, as it is or a little darker. */
int countPixels(const cv::Mat& screen, const cv::Vec3b& color) {
  int count = 0;
  for (auto it = screen.begin<cv::Vec3b>(); it != screen.end<cv::Vec3b>(); ++it) {
    const double shade = cv::norm(*it) / cv::norm(color);
    count += shade > 0.85 && shade < 1.03 &&
             cv::norm(cv::Vec3d(*it) - shade * cv::Vec3d(color), cv::NORM_INF) <= 3;
  }
  return count;
}

/** What a drive said, but for the share of slow cycles, which is the machine's. */
std::string withoutTimes(const std::string& output) {
  return std::regex_replace(output, std::regex("Driving: .*\n|[0-9.]+ % of cycles"), "");
}

}  // namespace

TEST_F(LiveDrive, IsShownInAWindowAndEndsAsWithout) {
  SKIP_WITHOUT_WINDOWS();
#ifndef MSO_DROP_FILES
  GTEST_SKIP() << "needs libx11-dev to close windows";
#else
  const ProgramRun live = runInX(joined(
      {"/usr/bin/env", "DROP_FILES=" MSO_DROP_FILES, MSO_SOURCE_DIR "/test/apps/live-window.sh",
       path("screen.png"), path("live/drive.csv"), kProgram, "--live"},
      shortDrive("live")));
  EXPECT_EQ(live.status, 2) << live.output << live.errors;  // not arrived in so short a time
  const cv::Mat screen = cv::imread(path("screen.png"));
  ASSERT_FALSE(screen.empty()) << live.errors;
  EXPECT_GT(countPixels(screen, {40, 40, 220}), 100) << "the path";
  EXPECT_GT(countPixels(screen, {104, 92, 92}), 5000) << "the road";
  const cv::Mat corner = screen(cv::Rect(920, 460, 340, 240));  // in the window's lower right
  EXPECT_LT(countPixels(corner, {250, 250, 250}), 800) << "the camera's picture";

  const ProgramRun without = runProgram("semantic-map-drive", shortDrive("without"));
  EXPECT_EQ(without.status, 2);
  EXPECT_EQ(withoutTimes(live.output), withoutTimes(without.output));
  EXPECT_EQ(csvIn("live"), csvIn("without"));
#endif
}

namespace {

/** With a map of the sample village, in a file and in tiles. */
class DrivesInFolders : public SemanticMapDrive {
 protected:
  static void SetUpTestSuite() {
    made = std::make_unique<TemporaryFolder>();
    const std::string config = std::string(MSO_SOURCE_DIR) + "/config/maps/synthetic.ini";
    const std::string log = std::string(MSO_SOURCE_DIR) + "/rawlog-samples/village.rawlog";
    const auto path = [](const char* name) { return (*made / name).string(); };
    const Words mapping = {"--config", config, log, "--output"};
    Words whole = mapping, tiles = mapping;
    whole.push_back(path("map"));
    tiles.insert(tiles.end(), {path("log"), "--tiles", path("tiles"), "--tile-size", "12.8"});
    ASSERT_EQ(runProgram("rawlog2semantic-map", whole).status, 0);
    ASSERT_EQ(runProgram("rawlog2semantic-map", tiles).status, 0);
  }
  static void TearDownTestSuite() { made = nullptr; }

  static std::map<std::string, std::string> filesIn(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      std::ifstream in(entry.path(), std::ios::binary);
      files[entry.path().filename()] = {std::istreambuf_iterator<char>(in), {}};
    }
    return files;
  }
  /** The shipped configuration, with another latency. */
  std::string configWithLatency(const std::string& seconds) const {
    std::ifstream in(kConfig + "drives/synthetic.ini");
    std::string text{std::istreambuf_iterator<char>(in), {}};
    text = std::regex_replace(text, std::regex("\\.\\./"), kConfig);
    return folder
        .write("drive.ini", std::regex_replace(text, std::regex("mapping_latency = 0"),
                                               "mapping_latency = " + seconds))
        .string();
  }
  static std::string of(const char* name) { return (*made / name).string(); }

  static std::unique_ptr<TemporaryFolder> made;
};

std::unique_ptr<TemporaryFolder> DrivesInFolders::made;

}  // namespace

TEST_F(DrivesInFolders, AreTheDrivesInTheMapInOnePieceToTheLastBit) {
  const auto before = filesIn(of("tiles"));
  const Words ends = {"--no-rawlog", "--map"};
  for (const std::string latency : {"0", "0.3"}) {
    SCOPED_TRACE(latency);
    const auto driveIn = [&](const std::string& map, const std::string& output) {
      auto arguments = argumentsWith(
          {"--config", configWithLatency(latency), "--output", path(output), "--memory", "1"});
      arguments.insert(arguments.end(), ends.begin(), ends.end());
      arguments.push_back(map);
      succeeded(runProgram("semantic-map-drive", arguments));
    };
    driveIn(of("map/map.semantic"), "whole");
    driveIn(of("tiles"), "tiles");
    for (const char* file : {"drive.csv", "map.semantic", "drive.png"}) {
      SCOPED_TRACE(file);
      EXPECT_FALSE(folder.read("whole/" + std::string(file)).empty());
      EXPECT_TRUE(folder.read("whole/" + std::string(file)) ==
                  folder.read("tiles/" + std::string(file)));
    }
    EXPECT_EQ(jsonIn("whole/drive.json")["compressedLeaves"],
              jsonIn("tiles/drive.json")["compressedLeaves"]);
  }
  EXPECT_TRUE(filesIn(of("tiles")) == before);
  EXPECT_TRUE(semantic_octree::loadMap(of("tiles")) ==
              semantic_octree::loadMap(of("map/map.semantic")));
}

TEST_F(DrivesInFolders, HaveNoWindow) {
  expectRefusal(drive({"--map", of("tiles"), "--live"}),
                {"--live: a map in a folder of tiles is not shown"});
}
