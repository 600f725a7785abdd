// Labels from images and networks, through the whole application.
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt_compat/Images.h>
#include <semantic_types/ClassTable.h>
#include <opencv2/imgcodecs.hpp>

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
