// Networks whose answers are known.
#include <gtest/gtest.h>
#include <labeled_cloud/NetworkLabeler.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt_compat/Images.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "Classes.h"
#include "NearestColorNetwork.h"
#include "TemporaryFolder.h"

using namespace labeled_cloud;
using mrpt::obs::CObservationImage;
using semantic_types::ClassTable;

namespace {

ClassTable twoColors() { return tableOf({{"red", {255, 0, 0}}, {"blue", {0, 0, 255}}}); }

CObservationImage picture(const cv::Mat3b& bgr) {
  CObservationImage observation;
  observation.sensorLabel = "camera";
  observation.image = mrpt_compat::toMrpt(bgr);
  return observation;
}

/** Left half red, right half blue. */
CObservationImage halves(int rows, int cols) {
  cv::Mat3b image(rows, cols, cv::Vec3b(0, 0, 255));
  image.colRange(cols / 2, cols) = cv::Vec3b(255, 0, 0);
  return picture(image);
}

class NetworkLabelers : public testing::Test {
 protected:
  NetworkOptions options(const std::string& yaml) const {
    return loadNetworkOptions(folder.write("net.yaml", yaml), table);
  }
  NetworkLabeler labeler(const std::string& yaml, int rows = 4, int cols = 8) const {
    return {saveNearestColorNetwork(folder / "net.onnx", rows, cols, table), table.size(),
            options(yaml)};
  }

  TemporaryFolder folder;
  ClassTable table = twoColors();
};

}  // namespace

TEST_F(NetworkLabelers, answerProbabilitiesThatAreTheSoftmaxOfTheScores) {
  const auto image = labeler(nearestColorConfig(4, 8, table)).label(halves(4, 8));
  ASSERT_TRUE(image);
  ASSERT_EQ(image->probabilities.size(), 2u * 32);
  const double sure = 1 / (1 + std::exp(-2.0 * kSharpness));  // squared distance red - blue: 2
  for (int col = 0; col < 8; ++col) {
    EXPECT_NEAR(image->probabilities[col], col < 4 ? sure : 1 - sure, 1e-5);
    EXPECT_EQ(image->classOf(*image->cellAt(col, 2)), col < 4 ? 1 : 2);
  }
}

TEST_F(NetworkLabelers, confuseTheColorsIfTheOrderOfChannelsIsWrong) {
  const std::string yaml = "input: {width: 8, height: 4, channels: bgr}\nclasses: [red, blue]\n";
  EXPECT_EQ(labeler(yaml).label(halves(4, 8))->classOf(0), 2);
}

TEST_F(NetworkLabelers, findTheCellOfAPixelInPicturesOfAnotherSize) {
  const auto image = labeler(nearestColorConfig(4, 8, table)).label(halves(40, 100));
  EXPECT_EQ(image->pictureCols(), 100);
  EXPECT_EQ(image->classOf(*image->cellAt(47, 20)), 1);
  EXPECT_EQ(image->classOf(*image->cellAt(52, 20)), 2);
  EXPECT_FALSE(image->cellAt(100, 20));
}

TEST_F(NetworkLabelers, cutTopRowsOffOrRepeatTheLastOneToKeepTheAspect) {
  const std::string yaml = "input: {width: 8, height: 4, fit: width}\nclasses: [red, blue]\n";
  cv::Mat3b high(16, 16, cv::Vec3b(0, 0, 255));  // the lower half is blue
  high.rowRange(8, 16) = cv::Vec3b(255, 0, 0);
  const auto cut = labeler(yaml).label(picture(high));
  EXPECT_FALSE(cut->cellAt(3, 7));
  EXPECT_EQ(cut->classOf(*cut->cellAt(3, 8)), 2);
  const auto wide = labeler(yaml).label(halves(4, 16));
  EXPECT_EQ(wide->classOf(*wide->cellAt(7, 3)), 1);
  EXPECT_EQ(wide->classOf(*wide->cellAt(9, 3)), 2);
}

TEST_F(NetworkLabelers, foldNames) {
  const std::string input = "input: {width: 8, height: 4}\n";
  const std::string folded = input + "classes: [rot, blue]\nfold: {rot: red, blue: no_class}\n";
  const auto image = labeler(folded).label(halves(4, 8));
  EXPECT_EQ(image->classOf(0), 1);
  EXPECT_EQ(image->classOf(7), 0);
}

TEST_F(NetworkLabelers, sayWhatIsWrong) {
  const std::string good = nearestColorConfig(4, 8, table);
  EXPECT_TRUE(contains(errorOf([&] { NetworkLabeler("/none.onnx", 2, options(good)); }),
                       "/none.onnx: there is no such network"));
  folder.write("bad.onnx", "no network");
  EXPECT_TRUE(contains(errorOf([&] { NetworkLabeler(folder / "bad.onnx", 2, options(good)); }),
                       "bad.onnx: OpenCV cannot read"));
  EXPECT_TRUE(
      contains(errorOf([&] {
                 labeler("input: {width: 8, height: 4}\nclasses: [red]\n").label(halves(4, 8));
               }),
               "answers 2 channels, but its configuration names 1 classes"));
  EXPECT_TRUE(
      contains(errorOf([&] { labeler(good).label(CObservationImage()); }), "uninitialized image"));
  EXPECT_TRUE(contains(errorOf([&] { options("input: {width: 8, height: 4}\nclasses: [rot]\n"); }),
                       "net.yaml:2: 'rot' is no class of the table"));
  EXPECT_TRUE(contains(errorOf([&] { options("input: {width: 0, height: 4}\nclasses: [red]\n"); }),
                       "net.yaml:1: width is 0"));
  EXPECT_TRUE(contains(errorOf([&] { options("classes: [red]\n"); }), "'input' is missing"));
}
