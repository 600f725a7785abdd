// Labels from images and networks, through the whole application.
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt_compat/Images.h>
#include <semantic_types/ClassTable.h>
#include <opencv2/imgcodecs.hpp>

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
  for (const std::string& source : {path("labels"), "front=" + path("labels")}) {
    const ProgramRun labeled = succeeded(run("camera.rawlog", {"--labels", source}));
    expectLabeledMap();
    EXPECT_EQ(summary()["observations"]["pictures"], 1);
    EXPECT_EQ(summary()["observations"]["insertedWithoutLabels"], 0);
    EXPECT_TRUE(contains(labeled.output, "100 % of 2 points have a label"));
    EXPECT_FALSE(contains(labeled.output, "Warning")) << labeled.output;
  }
  const ProgramRun unlabeled =
      succeeded(run("camera.rawlog", {"--labels", "rear=" + path("labels")}));
  EXPECT_EQ(summary()["map"]["occupiedWithoutClass"], 2);
  EXPECT_TRUE(contains(unlabeled.output, "0 % of 2 points have a label; 1 of 1 scans found none"));
  EXPECT_TRUE(contains(unlabeled.output, "Warning: less than half"));
  configure("[labels]\nunlabeled = skip\n");
  EXPECT_TRUE(contains(run("camera.rawlog").errors, "1 without labels"));
}

TEST_F(CameraMapping, aNetworkLabelsPicturesHardAndSoft) {
  for (const char* kind : {"soft", "hard"}) {
    configure(std::string("[labels]\nkind = ") + kind + "\n");
    succeeded(run("camera.rawlog", network()));
    expectLabeledMap();
  }
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
  succeeded(run("camera.rawlog", labels()));
  expectLabeledMap();
}

TEST_F(CameraMapping, aConfusionMatrixChangesTheBelief) {
  succeeded(run("camera.rawlog", labels()));
  const auto belief = [this] { return map().query(4.1, 1.1, 0.1).probability; };
  const double plain = belief();
  folder.write("confusion.yaml",
               "classes: [road, grass, car]\nconfusion: [[60, 40, 0], [40, 60, 0], [0, 0, 9]]\n");
  succeeded(run("camera.rawlog", joined(labels(), {"--confusion", path("confusion.yaml")})));
  EXPECT_LT(belief(), plain);
}

TEST_F(CameraMapping, theMapOfTheSavedLabelsIsTheSame) {
  for (const auto& source : {labels(), network()}) {
    succeeded(run("camera.rawlog", joined(source, {"--save-labeled", path("saved.rawlog")})));
    const std::string direct = folder.read("out/map.semantic");
    succeeded(run("saved.rawlog"));
    EXPECT_EQ(folder.read("out/map.semantic"), direct);
    EXPECT_EQ(summary()["points"]["labeled"], 2);
  }
}

TEST_F(CameraMapping, previewsShowLabelsAndPointsOverThePicture) {
  succeeded(run("camera.rawlog",
                joined(labels(), {"--preview", path("preview"), "--preview-every", "1"})));
  const cv::Mat3b sheet = cv::imread(path("preview/000000.png"));
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
  succeeded(run("camera.rawlog", network()));
  expectLabeledMap();
}

TEST_F(CameraMapping, whatCannotBeUsedIsNamedOrLeftOutAndCounted) {
  cv::imwrite(path("labels/10.01.png"), cv::Mat(20, 20, CV_8UC1, cv::Scalar(1)));
  writeSmallRawlog(folder / "back.rawlog", robotPose(10, 0), robotPose(9, 0), smallScan(10),
                   smallScan(9));
  expectRefusal({"10.01.png", "20 x 20", "40 x 40"}, "camera.rawlog", labels());
  expectRefusal({"back.rawlog: observation 4", "1 s before"}, "back.rawlog");
  configure("[labels]\non_problem = skip\n");
  succeeded(run("camera.rawlog", labels()));
  EXPECT_EQ(summary()["problems"]["count"], 1);
  EXPECT_TRUE(contains(summary()["problems"]["first"][0], "20 x 20"));
  EXPECT_EQ(summary()["observations"]["insertedWithoutLabels"], 1);
  succeeded(run("back.rawlog"));
  EXPECT_EQ(summary()["observations"]["inserted"], 1);
  EXPECT_EQ(summary()["observations"]["skipped"]["unusable"], 1);
}

TEST_F(CameraMapping, badNetworksAndSourcesAreRefused) {
  auto words = network();
  const auto refuse = [this](const Words& parts, const Words& arguments) {
    expectRefusal(parts, "camera.rawlog", arguments);
  };
  refuse({"--network and --network-config belong together"}, {words[0], words[1]});
  refuse({"not from both"}, joined(words, labels()));
  folder.write("net.yaml", "input: {width: 40, height: 40}\nclasses: [road, car]\n");
  refuse({"net.onnx", "answers 3 channels", "names 2 classes"}, words);
  words[1] = path("none.onnx");
  refuse({"none.onnx: there is no such network"}, words);
  refuse({"/none: there is no such folder"}, {"--labels", "/none"});
  configure("[camera front]\nfx = 20\n");
  refuse({"[camera front]", "cols is missing"}, labels());
}
