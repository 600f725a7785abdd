// Rawlogs, options and files that are refused.
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>

#include <map>
#include <string>
#include <vector>

#include "MappingFixture.h"

namespace fs = std::filesystem;

TEST_F(Rawlog2SemanticMap, aRawlogThatCannotBeMappedIsRefused) {
  const std::string whole = folder.read("small.rawlog");
  std::string corrupt = whole;
  corrupt[corrupt.size() / 2] ^= 0x55;
  folder.write("empty.rawlog", "");
  folder.write("half.rawlog", whole.substr(0, whole.size() / 2));
  folder.write("cut.rawlog", whole.substr(0, whole.size() - 1));
  folder.write("corrupt.rawlog", corrupt);
  folder.write("text.rawlog", "This is no rawlog.");
  writeSmallRawlog(folder / "lost.rawlog", smallScan(10));
  writeSmallRawlog(folder / "late.rawlog", robotPose(10, 0), smallScan(20));
  writeSmallRawlog(folder / "far.rawlog", robotPose(10, 1e6), smallScan(10));
  const std::map<std::string, Words> cases = {
      {"none.rawlog", {"none.rawlog"}},
      {"empty.rawlog", {"empty.rawlog", "empty"}},
      {"half.rawlog", {"half.rawlog", "cut off"}},
      {"cut.rawlog", {"cut.rawlog", "cut off"}},
      {"corrupt.rawlog", {"corrupt.rawlog"}},
      {"text.rawlog", {"text.rawlog: ", "object 1"}},
      {"lost.rawlog", {"lost.rawlog", "no robot poses", "or --static-pose if"}},
      {"late.rawlog", {"nothing to map", "1 outside the trajectory"}},
      {"far.rawlog", {"far.rawlog: observation 2", "outside the map"}}};
  for (const auto& [rawlog, parts] : cases) expectRefusal(parts, rawlog);
  folder.write("classes.yaml", "classes:\n  - {id: 1, name: road, color: [1, 2, 3]}\n");
  expectRefusal({"small.rawlog: observation 2", "lidar", "car"});
}

TEST_F(Rawlog2SemanticMap, aHostileRawlogIsRefusedInLittleMemory) {
  for (const char* name :
       {"actions_of_poses", "actions_of_too_many", "clouds_in_clouds", "frame_in_a_frame",
        "frame_of_nothing", "frame_of_poses", "frame_of_too_many", "frame_with_a_longer_name",
        "image_beyond_memory", "image_of_a_bad_table", "movement_of_too_many_particles",
        "movement_without_estimate", "old_frame_in_a_frame", "old_frame_of_nothing",
        "text_of_too_many_letters", "velodyne_calibration_beyond_memory"}) {
    const std::string rawlog = std::string(name) + ".rawlog";
    fs::copy_file(fs::path(MSO_SOURCE_DIR) / "test/fuzz/corpus/rawlog" / name, folder / rawlog);
    const ProgramRun refused = run(rawlog);
    ::expectRefusal(refused, {"rawlog2semantic-map: ", rawlog, "object "});
    EXPECT_LT(refused.peakKilobytes, 300'000) << name;
  }
}

TEST_F(Rawlog2SemanticMap, manyActionsWhoseParticlesAreDrawnAnewAreRead) {
  mrpt::obs::CActionRobotMovement2D action;
  auto model = action.motionModelConfiguration;
  model.modelSelection = action.mmThrun, model.thrunModel.nParticlesCount = 20'000;
  action.computeFromOdometry({1, 0, 0}, model);
  mrpt::obs::CActionCollection actions;
  actions.insert(action);
  labeled_cloud::RawlogWriter rawlog(folder / "many.rawlog");
  rawlog.write(robotPose(10, 1.1)), rawlog.write(smallScan(10));
  for (int i = 0; i < 200; ++i) rawlog.write(actions);
  rawlog.finish();
  succeeded(run("many.rawlog"));
}

TEST_F(Rawlog2SemanticMap, whatIsNoRawlogIsCalledByItsNameWithTheCommandThatMakesOne) {
  for (const char* file :
       {"00/velodyne/000000.bin", "desk/depth.txt", "bag/a.mcap", "logs/b.rawlog"})
    folder.write(file, "x");
  folder.write("intel.log", "# CARMEN\nPARAM x y\nFLASER 180 1.0\n");
  const std::string isNone = ": is no rawlog, but ";
  for (const auto& [name, what] : std::map<std::string, std::string>{
           {"00", "a KITTI sequence; dataset2rawlog semantic-kitti"},
           {"desk", "a TUM RGB-D sequence; dataset2rawlog tum"},
           {"bag", "a bag of ROS 2; dataset2rawlog rosbag2"},
           {"bag/a.mcap", "a bag of ROS 2; dataset2rawlog rosbag2 " + path("bag/a.mcap") +
                              " --classes TABLE.yaml -o a.rawlog makes a rawlog of it"},
           {"intel.log", "a log of CARMEN; dataset2rawlog carmen"},
           {"logs", "a folder; did you mean '" + path("logs/b.rawlog") + "'?"}})
    expectRefusal({name + isNone + what}, name);
  expectRefusal({"small.rawlog: is given twice"}, "small.rawlog", {path("./small.rawlog")});
}

TEST_F(Rawlog2SemanticMap, posesOfKittiThatDoNotFitTheScansAreRefused) {
  const auto refuse = [&](const std::string& poses, const Words& parts) {
    folder.write("poses.txt", poses);
    expectRefusal(parts, "small.rawlog", {"--trajectory", path("poses.txt")});
  };
  const std::string here = "1 0 0 0 0 1 0 0 0 0 1 0\n", forward = "1 0 0 2 0 1 0 0 0 0 1 0\n";
  refuse(here + forward, {"poses.txt: 2 poses for 1 scans"});
  refuse(here + "1 0 0 0 0 1 0 0 0 0 1 2\n", {"poses.txt: these are poses of a camera"});
  refuse("2 0 0 0 0 1 0 0 0 0 1 0\n", {"poses.txt:1", "no rotation"});
  refuse(here + "1 0 0 2 0 1 0 0 0 0 1\n", {"poses.txt:2", "expected 12 numbers, found 11"});
}

TEST_F(Rawlog2SemanticMap, aRawlogThatBreaksOffWhileItIsMappedLeavesNothing) {
  const std::string whole = folder.read("small.rawlog");
  folder.write("cut.rawlog", whole.substr(0, whole.size() - 1));
  folder.write("poses.tum", "9 3.1 0 0 0 0 0 1\n11 5.1 0 0 0 0 0 1\n");
  const Words poses = {"--trajectory", path("poses.tum")};
  expectRefusal({"cut.rawlog", "cut off"}, "cut.rawlog", poses);
  fs::remove_all(folder / "out");
  EXPECT_EQ(run("cut.rawlog", poses).status, 1);
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(Rawlog2SemanticMap, aConfigurationWithAWrongLineIsRefused) {
  const std::string small = kSmallConfig;
  const std::vector<std::pair<std::string, Words>> cases = {
      {"[map]\nresolutoin = 1\n", {"[map]", "'resolutoin'"}},
      {small + "[inserting]\nmax_range = 3\n", {"[inserting]", "did you mean 'insertion'?"}},
      {small + "[abstraction]\nrelevant = rode: 1\n",
       {"[abstraction] with the classes of ", "classes.yaml: relevant: ", "unknown class 'rode'",
        "known are free_space, road", "did you mean 'road'?"}}};
  for (const auto& [text, parts] : cases) {
    folder.write("small.ini", text);
    Words all = parts;
    all.push_back("small.ini");
    expectRefusal(all);
  }
}

TEST_F(Rawlog2SemanticMap, missingFilesAreRefusedByName) {
  expectRefusal({"none.yaml"}, "small.rawlog", {"--classes", path("none.yaml")});
  expectRefusal({"none.tum"}, "small.rawlog", {"--trajectory", path("none.tum")});
  fs::remove(folder / "small.ini");
  expectRefusal({"small.ini"});
}

TEST_F(Rawlog2SemanticMap, anOutputFolderThatCannotBeWrittenIsRefusedByName) {
  const fs::path file = folder.write("file", "of before");
  for (const fs::path& output : {file, file / "below"}) {
    ::expectRefusal(runProgram("rawlog2semantic-map", {"--config", path("small.ini"), "--output",
                                                       output.string(), path("small.rawlog")}),
                    {output.string() + ": cannot write"});
    EXPECT_EQ(folder.read("file"), "of before");
  }
}
