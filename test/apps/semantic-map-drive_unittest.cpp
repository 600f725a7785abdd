#include <mrpt/nav/reactive/CLogFileRecord.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>

#include "CompressedInput.h"
#include "SemanticMapDrive.h"

TEST_F(SemanticMapDrive, KeepsPicturesOnTheWayAndNoneOfALongerDrive) {
  ASSERT_EQ(drive({"--no-rawlog", "--picture-every", "5"}).status, 0);
  const double seconds = jsonIn("drive/drive.json")["seconds"];
  const int last = static_cast<int>(seconds / 5) + 1;  // and one at the end
  EXPECT_TRUE(has("drive/drive-000" + std::to_string(last) + ".png"));
  EXPECT_FALSE(has("drive/drive-000" + std::to_string(last + 1) + ".png"));
  const std::string ofMap = folder.read("drive/drive.png"), map = folder.read("drive/map.semantic");
  ASSERT_EQ(drive({"--no-rawlog", "--picture-every", "100", "--compressed-pictures"}).status, 0);
  EXPECT_TRUE(has("drive/drive-0001.png"));
  EXPECT_FALSE(has("drive/drive-0002.png"));
  EXPECT_NE(folder.read("drive/drive.png"), ofMap);
  EXPECT_EQ(folder.read("drive/map.semantic"), map);
}

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
  const ProgramRun made =
      runProgram("rawlog2semantic-map", {path("drive/drive.rawlog"), "--config",
                                         kConfig + "maps/synthetic.ini", "--output", path("map")});
  ASSERT_EQ(made.status, 0) << made.errors;
  // An image and a LiDAR scan each time.
  EXPECT_NE(made.output.find(std::to_string(2 * cycles) + " scans inserted"), std::string::npos)
      << made.output;
  EXPECT_TRUE(has("map/map.semantic"));
}

TEST_F(SemanticMapDrive, ArrivesWithObstaclesOfTheCompressedTreeAndLogsWhatTheNavigatorDid) {
  const std::string config = configWith("compressedObstacles = 1\n");
  const ProgramRun run =
      runProgram("semantic-map-drive",
                 argumentsWith({"--config", config, "--output", path("drive"), "--no-rawlog",
                                "--navlog", "--person", "0,-9.5,-18.6,-9.5,-18.6"}));
  ASSERT_EQ(run.status, 0) << run.output << run.errors;
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

TEST_F(SemanticMapDrive, SaysWhatIsMissing) {
  const ProgramRun run =
      runProgram("semantic-map-drive", {"--order", kConfig + "orders/synthetic.yaml", "--config",
                                        kConfig + "drives/synthetic.ini", "--output", path("x")});
  EXPECT_EQ(run.status, 64);
  EXPECT_NE(run.errors.find("--start is required"), std::string::npos) << run.errors;
}
