// Labels from images and networks, through the whole application.
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt_compat/Images.h>
#include <semantic_types/ClassTable.h>
#include <opencv2/imgcodecs.hpp>

#include <map>
#include <random>
#include <string>
#include <vector>

#include "MappingFixture.h"
#include "NearestColorNetwork.h"

namespace {

/** A camera of 40 x 40 pixels and 90 degrees looks along the robot's x axis. A scan has two points
 * ahead: (4, 1, 0), in the left half of its image, and (4, -1, 0). */
class CameraMapping : public Rawlog2SemanticMap {
 protected:
  static mrpt::obs::CObservationImage picture(double seconds) {
    mrpt::obs::CObservationImage o;
    o.sensorLabel = "front";
    o.timestamp = at(seconds);
    o.cameraParams.ncols = o.cameraParams.nrows = 40;
    o.cameraParams.setIntrinsicParamsFromValues(20, 20, 19.5, 19.5);
    const double right = -M_PI / 2;
    o.cameraPose = mrpt::poses::CPose3D(0, 0, 0, right, 0, right);
    o.image = mrpt_compat::toMrpt(redAndBlue());
    return o;
  }

  /** Left half the color of road, right half that of car. */
  static cv::Mat redAndBlue() {
    cv::Mat image(40, 40, CV_8UC3, cv::Scalar(0, 0, 255));
    image.colRange(20, 40) = cv::Scalar(255, 0, 0);
    return image;
  }

  static labeled_cloud::CObservationLabeledCloud unlabeledScan(double seconds) {
    auto scan = labeledCloud(seconds, {{4.1f, 1.1f, 0.1f}, {4.1f, -1.1f, 0.1f}}, {});
    scan.classNames.clear();
    return scan;
  }

  void SetUp() override {
    Rawlog2SemanticMap::SetUp();
    mrpt_compat::writeImagesWithoutLoss();
    writeSmallRawlog(folder / "camera.rawlog", robotPose(10, 0), unlabeledScan(10), picture(10.01));
    std::filesystem::create_directory(folder / "labels");
    cv::imwrite((folder / "labels/10.01.png").string(), redAndBlue());
  }

  Words labels() const { return {"--labels", (folder / "labels").string()}; }
  Words network() const {
    const auto table = semantic_types::loadClassTable(folder / "classes.yaml");
    folder.write("net.yaml", nearestColorConfig(40, 40, table));
    return {"--network", saveNearestColorNetwork(folder / "net.onnx", 40, 40, table).string(),
            "--network-config", (folder / "net.yaml").string()};
  }
  void configure(const std::string& more) const { folder.write("small.ini", kSmallConfig + more); }

  void expectLabeledMap() const {
    EXPECT_EQ(map().query(4.1, 1.1, 0.1).likeliestClass, 1);
    EXPECT_EQ(map().query(4.1, -1.1, 0.1).likeliestClass, 3);
  }
};

}  // namespace

namespace fs = std::filesystem;

TEST_F(CameraMapping, labelImagesOfACameraLabelTheScansOfAnotherSensor) {
  ASSERT_EQ(run("camera.rawlog", labels()).status, 0);
  expectLabeledMap();
  EXPECT_EQ(summary()["observations"]["pictures"], 1);
  EXPECT_EQ(summary()["observations"]["insertedWithoutLabels"], 0);
}

TEST_F(CameraMapping, aFolderMayBelongToOneCamera) {
  ASSERT_EQ(run("camera.rawlog", {"--labels", "front=" + path("labels")}).status, 0);
  expectLabeledMap();
  ASSERT_EQ(run("camera.rawlog", {"--labels", "rear=" + path("labels")}).status, 0);
  EXPECT_EQ(summary()["observations"]["insertedWithoutLabels"], 1);
  EXPECT_EQ(map().query(4.1, 1.1, 0.1).likeliestClass, 0);
}

TEST_F(CameraMapping, aNetworkLabelsPicturesHardAndSoft) {
  for (const char* kind : {"soft", "hard"}) {
    configure(std::string("[labels]\nkind = ") + kind + "\n");
    succeeded(run("camera.rawlog", network()));
    expectLabeledMap();
  }
}

TEST_F(CameraMapping, withoutLabelsOrWithThemSkippedIsAnOption) {
  ASSERT_EQ(run("camera.rawlog").status, 0);
  EXPECT_EQ(summary()["map"]["occupiedWithoutClass"], 2);
  configure("[labels]\nunlabeled = skip\n");
  EXPECT_TRUE(contains(run("camera.rawlog").errors, "1 without labels"));
}

TEST_F(CameraMapping, tellsTheShareOfLabeledPointsAndWarnsBelowAHalf) {
  const ProgramRun labeled = run("camera.rawlog", labels());
  EXPECT_TRUE(contains(labeled.output, "100 % of 2 points have a label"));
  EXPECT_FALSE(contains(labeled.output, "Warning")) << labeled.output;
  fs::rename(folder / "labels/10.01.png", folder / "labels/000000.png");  // read as 0 s
  const ProgramRun misnamed = succeeded(run("camera.rawlog", labels()));
  EXPECT_TRUE(contains(misnamed.output, "0 % of 2 points have a label; 1 of 1 scans found none"));
  EXPECT_TRUE(contains(misnamed.output, "Warning: less than half"));
}

TEST_F(CameraMapping, labelImagesNeedAClassTable) {
  ::expectRefusal(
      runProgram("rawlog2semantic-map", {path("camera.rawlog"), "--labels", path("labels"),
                                         "--output", path("without-classes")}),
      {"labels need a class table: --classes"});
}

TEST_F(CameraMapping, theIniFileMayCalibrateTheCamera) {
  auto uncalibrated = picture(10.01);
  uncalibrated.cameraParams = {};
  uncalibrated.cameraPose = {};
  writeSmallRawlog(folder / "camera.rawlog", robotPose(10, 0), unlabeledScan(10), uncalibrated);
  expectRefusal({"camera.rawlog: observation 2", "'front' at 10.01", "not calibrated"},
                "camera.rawlog", labels());
  configure(
      "[camera front]\ncols = 40\nrows = 40\nfx = 20\nfy = 20\ncx = 19.5\ncy = 19.5\n"
      "pose_x = 0\npose_y = 0\npose_z = 0\npose_yaw = -90\npose_pitch = 0\npose_roll = -90\n");
  ASSERT_EQ(run("camera.rawlog", labels()).status, 0);
  expectLabeledMap();
}

TEST_F(CameraMapping, confidencesAndAConfusionMatrixChangeTheBelief) {
  ASSERT_EQ(run("camera.rawlog", labels()).status, 0);
  const auto belief = [this] { return map().query(4.1, 1.1, 0.1).probability; };
  const double plain = belief();
  cv::imwrite(path("labels/10.01.confidence.png"), cv::Mat(40, 40, CV_8UC1, cv::Scalar(128)));
  ASSERT_EQ(run("camera.rawlog", labels()).status, 0);
  EXPECT_LT(belief(), plain);
  fs::remove(folder / "labels/10.01.confidence.png");
  folder.write("confusion.yaml",
               "classes: [road, grass, car]\nconfusion: [[60, 40, 0], [40, 60, 0], [0, 0, 9]]\n");
  auto arguments = labels();
  arguments.insert(arguments.end(), {"--confusion", path("confusion.yaml")});
  ASSERT_EQ(run("camera.rawlog", arguments).status, 0);
  EXPECT_LT(belief(), plain);
}

TEST_F(CameraMapping, theMapOfTheSavedLabelsIsTheSame) {
  for (const auto& source : {labels(), network()}) {
    auto arguments = source;
    arguments.insert(arguments.end(), {"--save-labeled", path("saved.rawlog")});
    ASSERT_EQ(run("camera.rawlog", arguments).status, 0);
    const std::string direct = folder.read("out/map.semantic");
    ASSERT_EQ(run("saved.rawlog").status, 0);
    EXPECT_EQ(folder.read("out/map.semantic"), direct);
    EXPECT_EQ(summary()["points"]["labeled"], 2);
  }
}

TEST_F(CameraMapping, previewsShowLabelsAndPointsOverThePicture) {
  const fs::path preview = folder / "preview";
  auto arguments = labels();
  arguments.insert(arguments.end(), {"--preview", preview.string(), "--preview-every", "1"});
  ASSERT_EQ(run("camera.rawlog", arguments).status, 0);
  const cv::Mat3b sheet = cv::imread((preview / "000000.png").string());
  ASSERT_EQ(sheet.size(), cv::Size(40, 80));
  EXPECT_EQ(sheet(10, 5), cv::Vec3b(0, 0, 255));  // red over red
  // (4.1, 1.1): 20 * 1.1 / 4.1 pixels to the left of the middle
  EXPECT_EQ(sheet(40 + 19, 14), cv::Vec3b(0, 0, 255));
  EXPECT_EQ(sheet(40 + 19, 25), cv::Vec3b(255, 0, 0));
  EXPECT_NEAR(sheet(40 + 5, 5)[2], 127, 2);  // the darkened picture
}

TEST_F(CameraMapping, anExternalPictureIsReadFromTheFolderBesideTheRawlog) {
  auto external = picture(10.01);
  external.image = {};
  external.image.setExternalStorage("front_1.png");
  writeSmallRawlog(folder / "camera.rawlog", robotPose(10, 0), unlabeledScan(10), external);
  expectRefusal({"'front' at 10.01", "front_1.png"}, "camera.rawlog", network());
  fs::create_directory(folder / "camera_Images");
  cv::imwrite(path("camera_Images/front_1.png"), redAndBlue());
  ASSERT_EQ(run("camera.rawlog", network()).status, 0);
  expectLabeledMap();
  configure("[labels]\nmatch = name\n");
  fs::rename(folder / "labels/10.01.png", folder / "labels/front_1.png");
  ASSERT_EQ(run("camera.rawlog", labels()).status, 0);
  expectLabeledMap();
}

TEST_F(CameraMapping, whatCannotBeUsedIsNamedOrLeftOutAndCounted) {
  const std::string skip = "[labels]\non_problem = skip\n";
  cv::imwrite(path("labels/10.01.png"), cv::Mat(20, 20, CV_8UC1, cv::Scalar(1)));
  expectRefusal({"10.01.png", "20 x 20", "40 x 40"}, "camera.rawlog", labels());
  configure(skip);
  ASSERT_EQ(run("camera.rawlog", labels()).status, 0);
  EXPECT_EQ(summary()["problems"]["count"], 1);
  EXPECT_TRUE(contains(summary()["problems"]["first"][0], "20 x 20"));
  EXPECT_EQ(summary()["observations"]["insertedWithoutLabels"], 1);

  configure("");
  writeSmallRawlog(folder / "back.rawlog", robotPose(10, 0), robotPose(9, 0), smallScan(10),
                   smallScan(9));
  expectRefusal({"back.rawlog: observation 4", "1 s before"}, "back.rawlog");
  configure(skip);
  ASSERT_EQ(run("back.rawlog").status, 0);
  EXPECT_EQ(summary()["observations"]["inserted"], 1);
  EXPECT_EQ(summary()["observations"]["skipped"]["unusable"], 1);
}

TEST_F(CameraMapping, badNetworksAndSourcesAreRefused) {
  auto arguments = network();
  expectRefusal({"--network and --network-config belong together"}, "camera.rawlog",
                {arguments[0], arguments[1]});
  const auto both = [&] {
    auto all = arguments;
    all.insert(all.end(), {"--labels", path("labels")});
    return all;
  };
  expectRefusal({"not from both"}, "camera.rawlog", both());
  folder.write("net.yaml", "input: {width: 40, height: 40}\nclasses: [road, car]\n");
  expectRefusal({"net.onnx", "answers 3 channels", "names 2 classes"}, "camera.rawlog", arguments);
  arguments[1] = path("none.onnx");
  expectRefusal({"none.onnx: there is no such network"}, "camera.rawlog", arguments);
  expectRefusal({"/none: there is no such folder"}, "camera.rawlog", {"--labels", "/none"});
  configure("[camera front]\nfx = 20\n");
  expectRefusal({"[camera front]", "cols is missing"}, "camera.rawlog", labels());
  configure("[labels]\nkind = wavy\n");
  expectRefusal({"[labels]", "'wavy'", "one of soft, hard"}, "camera.rawlog", labels());
}

TEST_F(Rawlog2SemanticMap, howFarLabelsAreTrustedIsTold) {
  std::mt19937 random(1);
  for (const double wrong : {0.0, 0.3}) {
    auto scan = labeledCloud(10, {}, {});
    for (int voxel = 0; voxel < 1000; ++voxel)
      for (int i = 0; i < 10; ++i) {
        const int shift = std::bernoulli_distribution(wrong)(random) ? 1 + int(random() % 2) : 0;
        scan.cloud.points.emplace_back(0.5f * (voxel % 40) - 10, 0.5f * (voxel / 40) + 2, 1.2f);
        scan.cloud.classes.push_back(semantic_types::ClassId(1 + (voxel + shift) % 3));
      }
    writeSmallRawlog(folder / "noisy.rawlog", robotPose(10, 1.1), scan);
    const ProgramRun result = succeeded(run("noisy.rawlog"));
    const std::string told = "agree as if 7";  // 70 %, within the prior's pull and rounding
    EXPECT_EQ(contains(result.output, told), wrong > 0) << result.output;
    EXPECT_NEAR(summary()["labels"]["accuracy"], wrong > 0 ? 0.72 : 0.93, 0.025);
    EXPECT_NEAR(summary()["labels"]["correlation"], wrong > 0 ? 0.02 : 0.8, 1e-9);
  }
}

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

TEST_F(Rawlog2SemanticMap, aRawlogIsNotCountedTwice) {
  expectRefusal({"small.rawlog: is given twice"}, "small.rawlog", {path("./small.rawlog")});
}

TEST_F(Rawlog2SemanticMap, whatIsNoRawlogIsCalledByItsNameWithTheCommandThatMakesOne) {
  folder.write("00/velodyne/000000.bin", "x");
  expectRefusal({"00: is no rawlog, but a KITTI sequence; dataset2rawlog semantic-kitti"}, "00");
  folder.write("desk/depth.txt", "x");
  expectRefusal({"desk: is no rawlog, but a TUM RGB-D sequence; dataset2rawlog tum"}, "desk");
  folder.write("bag/a.mcap", "x");
  expectRefusal({"bag: is no rawlog, but a bag of ROS 2; dataset2rawlog rosbag2"}, "bag");
  expectRefusal({"a.mcap: is no rawlog, but a bag of ROS 2; dataset2rawlog rosbag2 ",
                 "bag/a.mcap --classes TABLE.yaml -o a.rawlog makes a rawlog of it"},
                "bag/a.mcap");
  folder.write("intel.log", "# CARMEN\nPARAM x y\nFLASER 180 1.0\n");
  expectRefusal({"intel.log: is no rawlog, but a log of CARMEN; dataset2rawlog carmen"},
                "intel.log");
  folder.write("logs/b.rawlog", "x");
  expectRefusal({"logs: is no rawlog, but a folder; did you mean '", "logs/b.rawlog'?"}, "logs");
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

TEST_F(Rawlog2SemanticMap, labelImagesThatDoNotFitAreRefused) {
  const Words labels = {"--labels", path("labels")};
  expectRefusal({"labels"}, "small.rawlog", labels);
  writeSmallRawlog(folder / "depth.rawlog", robotPose(10, 0), depthImage(10, 40, 40));
  fs::create_directory(folder / "labels");
  const std::string image = path("labels/10.00.png");
  cv::imwrite(image, cv::Mat(40, 30, CV_8UC1, cv::Scalar(2)));
  expectRefusal({"depth.rawlog: observation 2", "10.00.png", "30", "40"}, "depth.rawlog", labels);
  cv::imwrite(image, cv::Mat(40, 40, CV_8UC1, cv::Scalar(77)));
  expectRefusal({"10.00.png", "77"}, "depth.rawlog", labels);
}

TEST_F(Rawlog2SemanticMap, aConfigurationWithAWrongLineIsRefused) {
  const std::string small = kSmallConfig;
  const std::vector<std::pair<std::string, Words>> cases = {
      {"[map]\nresolutoin = 1\n", {"[map]", "'resolutoin'"}},
      {"[insertion]\nmaxrnage = 1\n", {"[insertion]", "'maxrnage'"}},
      {"[labels]\nfolder = 1\n", {"[labels]", "'folder'"}},
      {"[pictures]\nsize = 1\n", {"[pictures]", "'size'"}},
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
