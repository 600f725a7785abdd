#pragma once
#include <mrpt/obs/CObservationImage.h>
#include <mrpt_compat/Images.h>
#include <semantic_types/ClassTable.h>

#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "MappingFixture.h"
#include "NearestColorNetwork.h"

/** A camera of 40 x 40 pixels and 90 degrees that looks along the robot's x axis, and a scan of two
 * points ahead: (4, 1, 0), which it sees in the left half of its image, and (4, -1, 0). */
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
