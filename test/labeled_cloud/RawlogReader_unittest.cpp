#include <gtest/gtest.h>
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <zstd.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <random>

#include "RawlogFile.h"
#include "TemporaryFolder.h"

using labeled_cloud::CObservationLabeledCloud;
using labeled_cloud::RawlogReader;
using mrpt::io::CFileOutputStream;
using mrpt::maps::CPointsMap;
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

/** As MRPT 3 writes it: one frame with a checksum, here with a block for each piece. */
std::string zstd(const std::vector<std::string>& pieces) {
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(),
                                                                     ZSTD_freeCCtx);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::string packed(1u << 20, 0);
  ZSTD_outBuffer output{packed.data(), packed.size(), 0};
  for (const std::string& piece : pieces) {
    ZSTD_inBuffer input{piece.data(), piece.size(), 0};
    ZSTD_compressStream2(context.get(), &output, &input, ZSTD_e_flush);
  }
  ZSTD_inBuffer nothing{nullptr, 0, 0};
  ZSTD_compressStream2(context.get(), &output, &nothing, ZSTD_e_end);
  packed.resize(output.pos);
  return packed;
}

/** \return what Zstandard makes of it at once; empty if that fails. */
std::string unzstd(const std::string& packed) {
  std::string bytes(1u << 20, 0);
  const std::size_t size =
      ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size());
  bytes.resize(ZSTD_isError(size) ? 0 : size);
  return bytes;
}

/** The objects of a plain rawlog, one by one. */
std::vector<std::string> piecesOf(const TemporaryFolder& folder) {
  std::vector<std::string> pieces;
  for (const auto& cloud : threeClouds()) {
    writeRawlog<CFileOutputStream>(folder / "piece.rawlog", {cloud});
    pieces.push_back(folder.read("piece.rawlog"));
  }
  return pieces;
}

/** A rawlog compressed with gzip, and compressed with Zstandard. */
std::vector<std::string> compressedBothWays(const TemporaryFolder& folder) {
  writeRawlog(folder / "gz.rawlog", threeClouds());
  return {folder.read("gz.rawlog"), zstd(piecesOf(folder))};
}

std::string errorReadingRawlog(const std::filesystem::path& file) {
  return errorOf([&] { countEntries(file); });
}

}  // namespace

TEST(RawlogReader, readsPlainObservationsCompressedOrNot) {
  const TemporaryFolder folder;
  const auto plain = writeRawlog<CFileOutputStream>(folder / "plain.rawlog", threeClouds());
  const std::vector<std::string> pieces = piecesOf(folder);
  for (const auto& file :
       {plain, writeRawlog(folder / "gz.rawlog", threeClouds()),
        folder.write("zst.rawlog", zstd(pieces)),
        folder.write("two.rawlog", zstd({pieces[0]}) + zstd({pieces[1], pieces[2]}))}) {
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
    EXPECT_EQ(reader.bytesRead(), std::filesystem::file_size(file));
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

/** Frames before version 2 have a number, those of version 0 a time as well. */
TEST(RawlogReader, readsSensoryFramesOfOldVersions) {
  const TemporaryFolder folder;
  for (const std::uint8_t version : {0, 1, 2}) {
    CFileOutputStream stream((folder / "old.rawlog").string());
    auto archive = mrpt::serialization::archiveFrom(stream);
    const std::string name = "CSensoryFrame";
    archive << static_cast<std::uint8_t>(0x80 | name.size());
    archive.WriteBuffer(name.data(), name.size());
    archive << version;
    if (version < 2) archive << std::uint32_t{7};
    if (version == 0) archive << mrpt::Clock::fromDouble(9);
    archive << std::uint32_t{1} << *cloudAt(4, 1) << std::uint8_t{0x88};
    stream.close();
    RawlogReader reader(folder / "old.rawlog");
    const auto entry = reader.next();
    ASSERT_EQ(entry->observations.size(), 1u);
    EXPECT_NEAR(mrpt::Clock::toDouble(entry->observations[0]->timestamp), version == 0 ? 9 : 4,
                1e-6);
  }
}

TEST(RawlogReader, readsEachKindOfObservationActionAndPointsThatMrptHas) {
  const TemporaryFolder folder;
  std::vector<CSerializable::Ptr> objects;
  const auto add = [&](const CSerializable::Ptr& object) {
    if (object) objects.push_back(object);
  };
  for (const auto* kind : mrpt::rtti::getAllRegisteredClassesChildrenOf(CLASS_ID(CPointsMap))) {
    auto cloud = mrpt::obs::CObservationPointCloud::Create();
    cloud->pointcloud = mrpt::ptr_cast<CPointsMap>::from(kind->createObject());
    if (cloud->pointcloud) add(cloud);
  }
  for (const auto* kind :
       mrpt::rtti::getAllRegisteredClassesChildrenOf(CLASS_ID(mrpt::obs::CObservation)))
    add(mrpt::ptr_cast<CSerializable>::from(kind->createObject()));
  ASSERT_GT(objects.size(), 20u);
  auto actions = mrpt::obs::CActionCollection::Create();
  mrpt::obs::CActionRobotMovement2D::TMotionModelOptions options;
  for (const auto model : {mrpt::obs::CActionRobotMovement2D::mmGaussian,
                           mrpt::obs::CActionRobotMovement2D::mmThrun}) {
    options.modelSelection = model;
    mrpt::obs::CActionRobotMovement2D movement;
    movement.computeFromOdometry({1, 0, 0}, options);
    actions->insert(movement);
  }
  add(actions);
  for (const auto& object : objects)
    EXPECT_EQ(countEntries(writeRawlog(folder / "one.rawlog", {object})), 1)
        << object->GetRuntimeClass()->className;
}

/** MRPT reads any object where points are to come, also another observation, as often as a file
 * wants: its messages grow with each. */
TEST(RawlogReader, anObservationWithinAnObservationIsRefused) {
  const TemporaryFolder folder;
  const auto file = folder / "nested.rawlog";
  mrpt::io::CFileOutputStream stream(file.string());
  auto archive = mrpt::serialization::archiveFrom(stream);
  mrpt::obs::CObservationPointCloud cloud;
  archive << cloud;  // its points are nothing: they come last but for the mark
  stream.close();
  std::ifstream written(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(written), {}}, nothing = "\x87nullptr";
  const std::size_t at = bytes.find(nothing);
  ASSERT_NE(at, std::string::npos);
  const std::string nested = bytes.substr(0, at) + bytes + bytes.substr(at + nothing.size());
  const std::string error = errorReadingRawlog(folder.write("nested.rawlog", nested));
  EXPECT_TRUE(contains(error, "CObservationPointCloud does not belong there")) << error;
}

TEST(RawlogReader, readsTheRawlogsThatMrptShips) {
  const std::filesystem::path folder = "/usr/share/mrpt/datasets";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "needs Debian's mrpt-common";
  EXPECT_EQ(countEntries(folder / "2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog"), 449);
  EXPECT_GE(countEntries(folder / "test_velodyne_VLP16.rawlog"), 1);
}

TEST(RawlogReader, missingFilesFoldersAndEmptyRawlogsAreNamed) {
  const TemporaryFolder folder;
  EXPECT_EQ(errorReadingRawlog("/nowhere/a.rawlog"), "/nowhere/a.rawlog: there is no such file");
  EXPECT_TRUE(contains(errorReadingRawlog(folder.path()), "there is no such file"));
  const std::string empty = folder.write("empty.rawlog", "").string();
  EXPECT_EQ(errorReadingRawlog(empty), empty + ": the rawlog is empty (object 1, near byte 0)");
  EXPECT_TRUE(contains(errorReadingRawlog(writeRawlog(folder / "none.rawlog", {})), "empty"));
}

TEST(RawlogReader, everyTruncationOfACompressedRawlogIsNoticed) {
  const TemporaryFolder folder;
  for (const std::string& whole : compressedBothWays(folder))
    for (std::size_t size = 0; size < whole.size();
         size += 1 + (size > 30 && size + 30 < whole.size()) * 97) {
      const auto file = folder.write("cut.rawlog", whole.substr(0, size));
      EXPECT_TRUE(contains(errorReadingRawlog(file), "cut.rawlog: "))
          << size << " of " << whole.size();
    }
}

TEST(RawlogReader, aPlainRawlogThatEndsWithinAnObjectIsNoticed) {
  const TemporaryFolder folder;
  writeRawlog<CFileOutputStream>(folder / "one.rawlog", {cloudAt(1, 4)});
  const std::string one = folder.read("one.rawlog");
  for (std::size_t size = 1; size < one.size(); ++size) {
    const auto file = folder.write("cut.rawlog", one + one.substr(0, size));
    EXPECT_TRUE(contains(errorReadingRawlog(file), "(object 2, near byte ")) << size;
  }
}

TEST(RawlogReader, alteredBytesAreNoticed) {
  const TemporaryFolder folder;
  const std::vector<std::string> pieces = piecesOf(folder);
  std::mt19937 random(5);
  for (const std::string& whole : compressedBothWays(folder))
    for (int i = 0; i < 200; ++i) {
      std::string altered = whole;
      altered[10 + random() % (whole.size() - 10)] ^= 1 << random() % 8;
      const std::string error = errorReadingRawlog(folder.write("bad.rawlog", altered));
      if (error.empty()) {  // Zstandard has bits that mean nothing
        EXPECT_EQ(unzstd(altered), pieces[0] + pieces[1] + pieces[2]) << i;
      } else {
        EXPECT_TRUE(contains(error, "bad.rawlog: ")) << i;
      }
    }
}

TEST(RawlogReader, somethingElseThanARawlogIsRefusedWithoutACallStack) {
  const TemporaryFolder folder;
  const auto text = folder.write("text.rawlog", "This is no rawlog, but a text of some length.");
  EXPECT_TRUE(contains(errorReadingRawlog(text), "text.rawlog: "));
  EXPECT_FALSE(contains(errorReadingRawlog(text), "stack")) << errorReadingRawlog(text);
  const auto pose = std::make_shared<mrpt::poses::CPose3DPDFGaussian>();
  const auto other = writeRawlog(folder / "pose.rawlog", {pose});
  EXPECT_TRUE(
      contains(errorReadingRawlog(other), "CPose3DPDFGaussian does not belong in a rawlog"));
}

TEST(RawlogReader, aFlagThatIsNeitherZeroNorOneIsRefused) {
  const TemporaryFolder folder;
  auto scan = mrpt::obs::CObservation2DRangeScan::Create();
  scan->sensorLabel = "laser";
  for (const unsigned char byte : {0, 1, 4, 255}) {
    std::memcpy(&scan->rightToLeft, &byte, 1);
    const std::string error = errorReadingRawlog(writeRawlog(folder / "a.rawlog", {scan}));
    EXPECT_EQ(byte > 1,
              contains(error, "2DRangeScan 'laser'") && contains(error, "neither 0 nor 1"))
        << error;
  }
}

TEST(RawlogReader, aClassThatIsNotRegisteredIsNamed) {
  const TemporaryFolder folder;
  writeRawlog<CFileOutputStream>(folder / "a.rawlog", {cloudAt(1, 4)});
  std::string bytes = folder.read("a.rawlog");
  bytes.replace(bytes.find("Labeled"), 7, "Unheard");
  const std::string error = errorReadingRawlog(folder.write("b.rawlog", bytes));
  EXPECT_TRUE(contains(error, "CObservationUnheardCloud' which is not registered"));
}

using namespace labeled_cloud;

TEST(RawlogWriter, theFileAppearsWhenItIsCompleteAndReplacesTheOldOne) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.rawlog", "old");
  {
    RawlogWriter writer(file);
    writer.write(CObservationLabeledCloud());
    EXPECT_EQ(folder.read("a.rawlog"), "old");
    writer.finish();
  }
  RawlogReader reader(file);
  EXPECT_TRUE(reader.next());
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(RawlogWriter, whatWasThereStaysIfItIsNotFinished) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.rawlog", "old");
  CObservationLabeledCloud bad;
  bad.cloud.classes = {1};
  EXPECT_ANY_THROW(RawlogWriter(file).write(bad));
  EXPECT_EQ(folder.read("a.rawlog"), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}
