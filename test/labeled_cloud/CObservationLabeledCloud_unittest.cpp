#include <gtest/gtest.h>
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cstring>

#include "TemporaryFolder.h"

using labeled_cloud::CObservationLabeledCloud;
using mrpt::serialization::archiveFrom;

namespace {

CObservationLabeledCloud exampleCloud() {
  CObservationLabeledCloud obs;
  obs.timestamp = mrpt::Clock::fromDouble(1234.5);
  obs.sensorLabel = "lidar";
  obs.sensorPose = mrpt::poses::CPose3D(1, 2, 3, 0.1, 0.2, 0.3);
  obs.cloud.points = {{1.5f, -2, 0.25f}, {NAN, 0, INFINITY}, {-7, 8, 9}};
  obs.cloud.classes = {1, 0, 2};
  obs.classNames = {"road", "grass"};
  return obs;
}

std::vector<std::uint8_t> streamed(const CObservationLabeledCloud& obs) {
  mrpt::io::CMemoryStream stream;
  archiveFrom(stream) << obs;
  const auto* data = static_cast<const std::uint8_t*>(stream.getRawBufferData());
  return {data, data + stream.getTotalBytesCount()};
}

CObservationLabeledCloud::Ptr readBack(const std::vector<std::uint8_t>& bytes) {
  mrpt::io::CMemoryStream stream(bytes.data(), bytes.size());
  auto archive = archiveFrom(stream);
  return archive.ReadObject<CObservationLabeledCloud>();
}

void expectSame(const CObservationLabeledCloud& a, const CObservationLabeledCloud& b) {
  EXPECT_EQ(a.timestamp, b.timestamp);
  EXPECT_EQ(a.sensorLabel, b.sensorLabel);
  EXPECT_EQ(a.sensorPose, b.sensorPose);
  EXPECT_EQ(a.classNames, b.classNames);
  EXPECT_EQ(a.cloud.classes, b.cloud.classes);
  EXPECT_EQ(a.cloud.probabilities, b.cloud.probabilities);
  EXPECT_EQ(a.times, b.times);
  EXPECT_EQ(a.emptyFrom, b.emptyFrom);
  ASSERT_EQ(a.cloud.size(), b.cloud.size());
  for (std::size_t i = 0; i < a.cloud.size(); ++i)  // bit by bit: NaNs come back as they were
    EXPECT_EQ(0, std::memcmp(a.cloud.points[i].data(), b.cloud.points[i].data(), 12));
}

/** Position of the number of points in the stream of exampleCloud(). */
std::size_t countPosition(const std::vector<std::uint8_t>& bytes) {
  const char* lastName = "grass";
  const auto it = std::search(bytes.begin(), bytes.end(), lastName, lastName + 5);
  return it - bytes.begin() + 5;
}

}  // namespace

TEST(CObservationLabeledCloud, streamsWithoutLossWhateverLabelsThereAre) {
  CObservationLabeledCloud obs = exampleCloud();
  expectSame(obs, *readBack(streamed(obs)));
  obs.cloud.probabilities = {0.25f, 0.75f, 0, 0, 1, 0};
  expectSame(obs, *readBack(streamed(obs)));
  obs.times = {0, 0.05f, -0.1f};
  expectSame(obs, *readBack(streamed(obs)));
  obs.emptyFrom = 25;
  expectSame(obs, *readBack(streamed(obs)));
  obs.cloud.probabilities.clear();
  obs.cloud.classes.clear();
  expectSame(obs, *readBack(streamed(obs)));
  const CObservationLabeledCloud empty;
  expectSame(empty, *readBack(streamed(empty)));
}

TEST(CObservationLabeledCloud, takesThirteenBytesPerPointAndAllClassIds) {
  CObservationLabeledCloud none, many;
  many.cloud.points.assign(100000, {1, 2, 3});
  many.cloud.classes.assign(100000, 254);
  EXPECT_EQ(streamed(many).size() - streamed(none).size(), 13u * 100000);
  EXPECT_EQ(readBack(streamed(many))->cloud.classes, many.cloud.classes);
}

TEST(CObservationLabeledCloud, everyTruncationIsAnError) {
  const auto bytes = streamed(exampleCloud());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_ANY_THROW(readBack({bytes.begin(), bytes.begin() + size})) << size;
}

TEST(CObservationLabeledCloud, aCorruptCountIsAnErrorAndTakesNoMemory) {
  auto bytes = streamed(exampleCloud());
  const std::uint32_t huge = 0xfffffff0;  // 48 GB of points
  std::memcpy(bytes.data() + countPosition(bytes), &huge, sizeof huge);
  const std::string error = errorOf([&] { readBack(bytes); });
  EXPECT_FALSE(error.empty());
  EXPECT_FALSE(contains(error, "bad_alloc")) << error;
}

TEST(CObservationLabeledCloud, namesWithControlCharactersAreRefusedWhenWrittenAndWhenRead) {
  CObservationLabeledCloud obs = exampleCloud();
  auto bytes = streamed(obs);
  obs.classNames[1] = "\n!id\n";
  EXPECT_TRUE(contains(errorOf([&] { obs.validate(); }), "the class name '\\x0a!id\\x0a'"));
  bytes[countPosition(bytes) - 1] = '\n';
  EXPECT_TRUE(contains(errorOf([&] { readBack(bytes); }), "the class name 'gras\\x0a'"));
}

TEST(CObservationLabeledCloud, aClassWithoutANameIsRefusedWhenWrittenAndWhenRead) {
  CObservationLabeledCloud obs = exampleCloud();
  auto bytes = streamed(obs);
  obs.cloud.classes[2] = 3;
  EXPECT_THROW(obs.validate(), std::invalid_argument);
  EXPECT_ANY_THROW(streamed(obs));
  bytes[countPosition(bytes) + 4 + 1 + 3 * 12] = 3;
  EXPECT_ANY_THROW(readBack(bytes));
}

TEST(CObservationLabeledCloud, numbersThatDoNotFitAreNamed) {
  CObservationLabeledCloud obs = exampleCloud();
  obs.cloud.classes.pop_back();
  EXPECT_EQ(errorOf([&] { obs.validate(); }), "CObservationLabeledCloud: 2 classes for 3 points");
  obs = exampleCloud();
  obs.cloud.probabilities = {1, 0};
  EXPECT_THROW(obs.validate(), std::invalid_argument);
}
