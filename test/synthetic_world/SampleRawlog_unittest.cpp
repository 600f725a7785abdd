#include <gtest/gtest.h>

#include <regex>

#include "SynthRawlogRun.h"

namespace {

using namespace synth_rawlog_run;
using labeled_cloud::CObservationLabeledCloud;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationRobotPose;

const fs::path kSamples = fs::path(MSO_SOURCE_DIR) / "rawlog-samples";

/** The arguments of the command that the samples' README says made them. */
std::string documentedArguments() {
  const std::string readme =
      std::regex_replace(contents(kSamples / "README.md"), std::regex("\\\\\n\\s*"), "");
  std::smatch match;
  if (!std::regex_search(readme, match, std::regex("\n    synth-rawlog ([^\n]*)")))
    throw std::runtime_error("rawlog-samples/README.md: no command");
  return match[1];
}

// Processors differ in the last digit of sines and logarithms: a value on the brink between two
// millimeters or two classes may fall to either side, in a few pixels of a million.
constexpr double kFewPixels = 1e-4;

void expectSameImage(const CObservation3DRangeScan& a, const CObservation3DRangeScan& b) {
  ASSERT_EQ(a.rangeImage.rows(), b.rangeImage.rows());
  ASSERT_EQ(a.rangeImage.cols(), b.rangeImage.cols());
  int different = 0;
  for (int row = 0; row < a.rangeImage.rows(); ++row)
    for (int column = 0; column < a.rangeImage.cols(); ++column)
      different += a.rangeImage(row, column) != b.rangeImage(row, column) ||
                   labelBits(a, row, column) != labelBits(b, row, column);
  EXPECT_LE(different, 1 + kFewPixels * a.rangeImage.size());
  EXPECT_EQ(a.cameraParams, b.cameraParams);
  EXPECT_EQ(a.sensorPose, b.sensorPose);
}

void expectSameCloud(const CObservationLabeledCloud& a, const CObservationLabeledCloud& b) {
  ASSERT_EQ(a.cloud.size(), b.cloud.size());
  int different = 0;
  for (std::size_t i = 0; i < a.cloud.size(); ++i)
    different += (a.cloud.points[i] - b.cloud.points[i]).norm() > 1e-4 ||
                 a.cloud.classes[i] != b.cloud.classes[i];
  EXPECT_LE(different, 1 + kFewPixels * a.cloud.size());
  EXPECT_EQ(a.classNames, b.classNames);
  EXPECT_EQ(a.sensorPose, b.sensorPose);
}

TEST(SampleRawlog, isWhatTheDocumentedCommandWrites) {
  const Folder folder;
  ASSERT_EQ(run(folder, documentedArguments()).status, 0) << documentedArguments();
  const auto sample = observationsOf(kSamples / "village.rawlog");
  const auto made = observationsOf(folder / "village.rawlog");
  ASSERT_EQ(sample.size(), made.size());
  for (std::size_t i = 0; i < sample.size(); ++i)
    EXPECT_EQ(sample[i]->timestamp, made[i]->timestamp);

  const auto poses = only<CObservationRobotPose>(sample),
             otherPoses = only<CObservationRobotPose>(made);
  const auto images = only<CObservation3DRangeScan>(sample),
             otherImages = only<CObservation3DRangeScan>(made);
  const auto clouds = only<CObservationLabeledCloud>(sample),
             otherClouds = only<CObservationLabeledCloud>(made);
  ASSERT_EQ(poses.size(), images.size());
  ASSERT_EQ(poses.size(), clouds.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT(poses[i]->pose.mean.distanceTo(otherPoses[i]->pose.mean), 1e-9);
    expectSameImage(*images[i], *otherImages[i]);
    expectSameCloud(*clouds[i], *otherClouds[i]);
  }
  EXPECT_EQ(contents(kSamples / "village.tum"), contents(folder / "village.tum"));
  EXPECT_EQ(contents(kSamples / "village.truth.yaml"), contents(folder / "village.truth.yaml"));
}

TEST(SampleRawlog, isSmall) {
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::directory_iterator(kSamples)) bytes += entry.file_size();
  EXPECT_LT(bytes, 5u << 20);
}

}  // namespace
