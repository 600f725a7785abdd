#include <gtest/gtest.h>
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/RawlogReader.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <random>

#include "RawlogFile.h"
#include "TemporaryFolder.h"

using labeled_cloud::CObservationLabeledCloud;
using labeled_cloud::RawlogReader;
using mrpt::io::CFileOutputStream;
using mrpt::serialization::CSerializable;

namespace {

CObservationLabeledCloud::Ptr cloudAt(double time, int points) {
  auto obs = CObservationLabeledCloud::Create();
  obs->timestamp = mrpt::Clock::fromDouble(time);
  std::mt19937 random(1);
  for (int i = 0; i < points; ++i) {
    obs->cloud.points.emplace_back(random() % 1000, random() % 1000, random() % 1000);
    obs->cloud.classes.push_back(random() % 255);
  }
  return obs;
}

std::vector<CSerializable::Ptr> threeClouds() {
  return {cloudAt(1, 400), cloudAt(2, 500), cloudAt(3, 600)};
}

/** Number of entries of the whole file. */
int countEntries(const std::filesystem::path& file) {
  RawlogReader reader(file);
  int count = 0;
  while (reader.next()) ++count;
  return count;
}

std::string errorReading(const std::filesystem::path& file) {
  return errorOf([&] { countEntries(file); });
}

}  // namespace

TEST(RawlogReader, readsPlainObservationsCompressedOrNot) {
  const TemporaryFolder folder;
  for (const auto& file :
       {writeRawlog(folder / "gz.rawlog", threeClouds()),
        writeRawlog<CFileOutputStream>(folder / "plain.rawlog", threeClouds())}) {
    RawlogReader reader(file);
    for (const int time : {1, 2, 3}) {
      const auto entry = reader.next();
      ASSERT_TRUE(entry && entry->observations.size() == 1 && !entry->actions);
      const auto cloud =
          std::dynamic_pointer_cast<CObservationLabeledCloud>(entry->observations.front());
      ASSERT_TRUE(cloud);
      EXPECT_EQ(cloud->cloud.classes, cloudAt(time, 300 + 100 * time)->cloud.classes);
    }
    EXPECT_FALSE(reader.next());
    EXPECT_FALSE(reader.next());
    EXPECT_EQ(reader.bytesRead(), reader.bytesTotal());
    EXPECT_EQ(reader.bytesTotal(), std::filesystem::file_size(file));
  }
}

TEST(RawlogReader, readsActionsAndSensoryFrames) {
  const TemporaryFolder folder;
  auto frame = mrpt::obs::CSensoryFrame::Create();
  frame->insert(cloudAt(1, 1));
  frame->insert(cloudAt(2, 2));
  const auto file =
      writeRawlog(folder / "a.rawlog", {mrpt::obs::CActionCollection::Create(), frame});
  RawlogReader reader(file);
  EXPECT_TRUE(reader.next()->actions);
  EXPECT_EQ(reader.next()->observations.size(), 2u);
  EXPECT_FALSE(reader.next());
}

TEST(RawlogReader, readsTheRawlogsThatMrptShips) {
  const std::filesystem::path folder = "/usr/share/mrpt/datasets";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "needs Debian's mrpt-common";
  EXPECT_EQ(countEntries(folder / "2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog"), 449);
  EXPECT_GE(countEntries(folder / "test_velodyne_VLP16.rawlog"), 1);
}

TEST(RawlogReader, missingFilesFoldersAndEmptyRawlogsAreNamed) {
  const TemporaryFolder folder;
  EXPECT_EQ(errorReading("/nowhere/a.rawlog"), "/nowhere/a.rawlog: there is no such file");
  EXPECT_TRUE(contains(errorReading(folder.path()), "there is no such file"));
  const std::string empty = folder.write("empty.rawlog", "").string();
  EXPECT_EQ(errorReading(empty), empty + ": the rawlog is empty (object 1, near byte 0)");
  EXPECT_TRUE(contains(errorReading(writeRawlog(folder / "none.rawlog", {})), "empty"));
}

TEST(RawlogReader, rawlogsOfMrpt3InZstandardAreNamed) {
  const TemporaryFolder folder;
  const std::string file = folder.write("zstd.rawlog", "\x28\xb5\x2f\xfd and so on").string();
  EXPECT_EQ(errorReading(file), file + ": is compressed with Zstandard, expected gzip");
}

TEST(RawlogReader, everyTruncationOfACompressedRawlogIsNoticed) {
  const TemporaryFolder folder;
  writeRawlog(folder / "whole.rawlog", threeClouds());
  const std::string whole = folder.read("whole.rawlog");
  for (std::size_t size = 0; size < whole.size();
       size += 1 + (size > 30 && size + 30 < whole.size()) * 97) {
    const auto file = folder.write("cut.rawlog", whole.substr(0, size));
    EXPECT_TRUE(contains(errorReading(file), "cut.rawlog: ")) << size << " of " << whole.size();
  }
}

TEST(RawlogReader, aPlainRawlogThatEndsWithinAnObjectIsNoticed) {
  const TemporaryFolder folder;
  writeRawlog<CFileOutputStream>(folder / "one.rawlog", {cloudAt(1, 4)});
  const std::string one = folder.read("one.rawlog");
  for (std::size_t size = 1; size < one.size(); ++size) {
    const auto file = folder.write("cut.rawlog", one + one.substr(0, size));
    EXPECT_TRUE(contains(errorReading(file), "(object 2, near byte ")) << size;
  }
}

TEST(RawlogReader, alteredBytesAreNoticed) {
  const TemporaryFolder folder;
  writeRawlog(folder / "whole.rawlog", threeClouds());
  const std::string whole = folder.read("whole.rawlog");
  std::mt19937 random(5);
  for (int i = 0; i < 200; ++i) {
    std::string altered = whole;
    altered[10 + random() % (whole.size() - 10)] ^= 1 << random() % 8;
    EXPECT_TRUE(contains(errorReading(folder.write("bad.rawlog", altered)), "bad.rawlog: ")) << i;
  }
}

TEST(RawlogReader, somethingElseThanARawlogIsRefusedWithoutACallStack) {
  const TemporaryFolder folder;
  const auto text = folder.write("text.rawlog", "This is no rawlog, but a text of some length.");
  EXPECT_TRUE(contains(errorReading(text), "text.rawlog: ")) << errorReading(text);
  EXPECT_FALSE(contains(errorReading(text), "stack")) << errorReading(text);
  const auto pose = std::make_shared<mrpt::poses::CPose3DPDFGaussian>();
  const auto other = writeRawlog(folder / "pose.rawlog", {pose});
  EXPECT_TRUE(contains(errorReading(other), "CPose3DPDFGaussian does not belong in a rawlog"));
}

TEST(RawlogReader, aClassThatIsNotRegisteredIsNamed) {
  const TemporaryFolder folder;
  writeRawlog<CFileOutputStream>(folder / "a.rawlog", {cloudAt(1, 4)});
  std::string bytes = folder.read("a.rawlog");
  bytes.replace(bytes.find("Labeled"), 7, "Unheard");
  const std::string error = errorReading(folder.write("b.rawlog", bytes));
  EXPECT_TRUE(contains(error, "CObservationUnheardCloud' which is not registered")) << error;
}
