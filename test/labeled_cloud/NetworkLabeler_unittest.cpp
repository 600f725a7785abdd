// Networks whose answers are known.
#include <gtest/gtest.h>
#include <labeled_cloud/NetworkLabeler.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt_compat/Images.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <random>

#include "NearestColorNetwork.h"
#include "TemporaryFolder.h"

using namespace labeled_cloud;
using mrpt::obs::CObservationImage;
using semantic_types::ClassTable;

namespace {

ClassTable twoColors() {
  ClassTable table;
  table.add("red", {255, 0, 0});
  table.add("blue", {0, 0, 255});
  return table;
}

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

namespace {

/** Layers as FCHarDNet has them, computed in plain loops. */
struct Planes {
  int channels, rows, cols;
  std::vector<float> v;
  Planes(int c, int h, int w) : channels(c), rows(h), cols(w), v(std::size_t(c) * h * w) {}
  float& at(int c, int y, int x) { return v[(std::size_t(c) * rows + y) * cols + x]; }
  float padded(int c, int y, int x) {
    return y < 0 || x < 0 || y >= rows || x >= cols ? 0 : at(c, y, x);
  }
};

Planes convolve(Planes in, const std::vector<float>& w, int out, int kernel) {
  Planes result(out, in.rows, in.cols);
  for (int o = 0; o < out; ++o)
    for (int y = 0; y < in.rows; ++y)
      for (int x = 0; x < in.cols; ++x)
        for (int c = 0; c < in.channels; ++c)
          for (int i = 0; i < kernel * kernel; ++i)
            result.at(o, y, x) +=
                w[(std::size_t(o) * in.channels + c) * kernel * kernel + i] *
                in.padded(c, y + i / kernel - kernel / 2, x + i % kernel - kernel / 2);
  return result;
}

Planes average(Planes in) {
  Planes result(in.channels, in.rows / 2, in.cols / 2);
  for (int c = 0; c < in.channels; ++c)
    for (int y = 0; y < result.rows; ++y)
      for (int x = 0; x < result.cols; ++x)
        result.at(c, y, x) = (in.at(c, 2 * y, 2 * x) + in.at(c, 2 * y + 1, 2 * x) +
                              in.at(c, 2 * y, 2 * x + 1) + in.at(c, 2 * y + 1, 2 * x + 1)) /
                             4;
  return result;
}

/** Corners stay corners. */
Planes upsample(Planes in, int rows, int cols) {
  Planes result(in.channels, rows, cols);
  for (int c = 0; c < in.channels; ++c)
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < cols; ++x) {
        const float v = float(y) * (in.rows - 1) / (rows - 1);
        const float u = float(x) * (in.cols - 1) / (cols - 1);
        const int top = std::min(int(v), in.rows - 2), left = std::min(int(u), in.cols - 2);
        const float a = v - top, b = u - left;
        result.at(c, y, x) =
            (1 - a) * ((1 - b) * in.at(c, top, left) + b * in.at(c, top, left + 1)) +
            a * ((1 - b) * in.at(c, top + 1, left) + b * in.at(c, top + 1, left + 1));
      }
  return result;
}

}  // namespace

TEST_F(NetworkLabelers, runTheLayersOfFchardnetAsTheyAreDefined) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto weights = [&](int n) {
    std::vector<float> w(n);
    for (float& value : w) value = uniform(random);
    return w;
  };
  const auto w1 = weights(4 * 3 * 9), w2 = weights(2 * 7), gain = weights(4), shift = weights(4);
  using O = SmallOnnx;
  SmallOnnx net;
  net.constant("w1", {4, 3, 3, 3}, w1);
  net.constant("w2", {2, 7, 1, 1}, w2);
  net.constant("gain", {4}, gain);
  net.constant("shift", {4}, shift);
  net.constant("mean", {4}, {0, 0, 0, 0});
  net.constant("variance", {4}, {1, 1, 1, 1});
  net.constant("roi", {0}, {});
  net.constant("scales", {4}, {1, 1, 2, 2});
  net.node("Conv", {"image", "w1"}, "conv",
           {O::list("kernel_shape", {3, 3}), O::list("pads", {1, 1, 1, 1})});
  net.node("BatchNormalization", {"conv", "gain", "shift", "mean", "variance"}, "norm");
  net.node("Relu", {"norm"}, "relu");
  net.node("Concat", {"relu", "image"}, "dense", {O::number("axis", 1)});
  net.node("AveragePool", {"dense"}, "pool",
           {O::list("kernel_shape", {2, 2}), O::list("strides", {2, 2})});
  net.node("Resize", {"pool", "roi", "scales"}, "up",
           {O::word("mode", "linear"), O::word("coordinate_transformation_mode", "align_corners")});
  net.node("Conv", {"up", "w2"}, "scores",
           {O::list("kernel_shape", {1, 1}), O::list("pads", {0, 0, 0, 0})});
  const auto file = net.save(folder / "layers.onnx", {1, 3, 4, 8}, {1, 2, 4, 8});

  cv::Mat3b noise(4, 8);
  cv::theRNG().state = 1;
  cv::randu(noise, 0, 255);
  const auto image =
      NetworkLabeler(file, 2, options(nearestColorConfig(4, 8, table))).label(picture(noise));

  Planes in(3, 4, 8);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x)
      for (int c = 0; c < 3; ++c) in.at(c, y, x) = float(noise(y, x)[2 - c]) / 255;
  const Planes conv = convolve(in, w1, 4, 3);
  Planes dense(7, 4, 8);
  for (int i = 0; i < 32; ++i) {
    for (int c = 0; c < 4; ++c)  // ONNX adds 1e-5 to the variance
      dense.v[c * 32 + i] =
          std::max(0.f, conv.v[c * 32 + i] * gain[c] / std::sqrt(1 + 1e-5f) + shift[c]);
    for (int c = 0; c < 3; ++c) dense.v[(4 + c) * 32 + i] = in.v[c * 32 + i];
  }
  const Planes scores = convolve(upsample(average(dense), 4, 8), w2, 2, 1);
  for (int i = 0; i < 32; ++i)
    EXPECT_NEAR(image->probabilities[i], 1 / (1 + std::exp(scores.v[32 + i] - scores.v[i])), 1e-4);
}
