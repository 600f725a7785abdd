// Bags of ROS 2, written by the tests, become rawlogs.
#include <gtest/gtest.h>
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <sys/stat.h>

#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "BagWriter.h"
#include "ConvertedScans.h"
#include "TemporaryFolder.h"

using Eigen::Isometry3d;
using Eigen::Vector3d;
using semantic_types::ClassId;
using semantic_types::ClassTable;

namespace {

using Rosbag2 = FolderTest;

Isometry3d at(double x, double y, double z, double heading = 0) {
  return Eigen::Translation3d(x, y, z) * Isometry3d(Eigen::AngleAxisd(heading, Vector3d::UnitZ()));
}

/** A robot turns by 90 degrees within two seconds, drives 2 m, and sees three points each half
 * second. Its LiDAR is 0.5 m ahead, 1 m up, and looks to the left. The last cloud comes before the
 * transforms that tell where it is. */
std::vector<BagMessage> drive(bool bigEndian = false) {
  std::vector<BagMessage> bag = {
      transformMessage("/tf_static", 100, "base_link", "lidar", at(0.5, 0, 1, M_PI / 2)),
      transformMessage("/tf", 100, "map", "odom", at(10, 0, 0)),
      transformMessage("/tf", 103, "map", "odom", at(10, 0, 0))};
  for (int i = 0; i <= 3; ++i)
    bag.push_back(cloudMessage("/points", 100 + 0.5 * i, "lidar",
                               {{1, 0, 0, 40}, {0, 2, 0, 70}, {0, 0, -1, 0}}, bigEndian));
  for (int i = 0; i <= 2; ++i)
    bag.push_back(transformMessage("/tf", 100 + i, "odom", "base_link", at(i, 0, 0, i * M_PI / 4)));
  return bag;
}

ClassTable tableIn(const TemporaryFolder& folder) {
  return semantic_types::loadClassTable(folder.write("classes.yaml", kThreeClasses));
}

std::vector<PosedScan> scansOf(const std::string& bag, const TemporaryFolder& folder) {
  const ClassTable table = tableIn(folder);
  return convertAndRead("rosbag2 --classes " + quoted(folder / "classes.yaml") + " " + bag,
                        folder / "out.rawlog", table);
}

void expectDrive(const std::vector<PosedScan>& scans) {
  ASSERT_EQ(scans.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    const double share = 0.5 * i;
    const Isometry3d T = at(10 + share, 0, 0, share * M_PI / 4) * at(0.5, 0, 1, M_PI / 2);
    ASSERT_EQ(scans[i].scan.cloud.size(), 3u);
    EXPECT_LT((scans[i].inMap(0) - T * Vector3d(1, 0, 0)).norm(), 1e-5) << i;
    EXPECT_LT((scans[i].inMap(1) - T * Vector3d(0, 2, 0)).norm(), 1e-5) << i;
    EXPECT_EQ(scans[i].scan.cloud.classes, (std::vector<ClassId>{1, 2, 0}));
    EXPECT_NEAR(mrpt::Clock::toDouble(scans[i].scan.timestamp), 100 + share, 1e-6);
    EXPECT_EQ(scans[i].scan.sensorLabel, "/points");
  }
}

std::string messageOf(const std::string& arguments, const TemporaryFolder& folder) {
  return failureOf("rosbag2 " + arguments + " -o " + quoted(folder / "bad.rawlog"));
}

TEST_F(Rosbag2, mcapOfAnyCompressionHasTheScansAndWhereTheyWere) {
  for (const char* chunks : {"none", "", "zstd", "lz4"})
    for (const bool bigEndian : {false, true}) {
      SCOPED_TRACE(std::string(chunks) + (bigEndian ? " big" : ""));
      const TemporaryFolder fresh;
      expectDrive(scansOf(quoted(fresh.write("a.mcap", mcapOf(drive(bigEndian), chunks))), fresh));
    }
}

TEST_F(Rosbag2, sqliteHasThemTooAndWhatItsRecorderDidNotWriteToItsPlaceYet) {
  writeSqliteBag(folder / "a.db3", drive());
  expectDrive(scansOf(quoted(folder / "a.db3"), folder));
  sqlite3* recorder = nullptr;
  sqlite3_open((folder / "a.db3").c_str(), &recorder);
  sqlite3_exec(recorder,
               "PRAGMA journal_mode = WAL;"
               "INSERT INTO messages SELECT NULL, m.topic_id, m.timestamp, m.data FROM messages m, "
               "messages n, messages o",
               nullptr, nullptr, nullptr);
  EXPECT_EQ(scansOf(quoted(folder / "a.db3"), folder).size(), 4u + 4 * 10 * 10);
  sqlite3_close(recorder);
}

TEST_F(Rosbag2, aFolderHasSeveralFilesInTheOrderOfTheirNumbers) {
  const std::vector<BagMessage> all = drive();
  for (std::size_t i = 0; i < all.size(); ++i)
    folder.write("bag/bag_" + std::to_string(i + 5) + ".mcap", mcapOf({all[i]}, "zstd"));
  folder.write("bag/metadata.yaml", "of no use");
  expectDrive(scansOf(quoted(folder / "bag"), folder));
}

TEST_F(Rosbag2, odometryCountsWhereNoTransformTells) {
  std::vector<BagMessage> bag = {
      transformMessage("/tf_static", 0, "base_link", "lidar", at(0, 0, 1)),
      odometryMessage(100, at(0, 0, 0)), odometryMessage(102, at(4, 2, 0))};
  bag.push_back(cloudMessage("/points", 101, "lidar", {{1, 0, 0, 40}}));
  const auto scans = scansOf(quoted(folder.write("a.mcap", mcapOf(bag, "lz4"))), folder);
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_LT((scans[0].inMap(0) - Vector3d(3, 1, 1)).norm(), 1e-5);
  bag.push_back(transformMessage("/tf", 100, "odom", "base_link", at(7, 0, 0)));
  bag.push_back(transformMessage("/tf", 102, "odom", "base_link", at(7, 0, 0)));
  const auto others = scansOf(quoted(folder.write("b.mcap", mcapOf(bag, ""))), folder);
  EXPECT_LT((others.at(0).inMap(0) - Vector3d(8, 0, 1)).norm(), 1e-5);
}

TEST_F(Rosbag2, scansThatNoTransformPlacesAreSkippedAndCounted) {
  auto bag = drive();
  bag.push_back(cloudMessage("/points", 102.5, "lidar", {{1, 0, 0, 40}}));
  bag.push_back(cloudMessage("/points", 99, "lidar", {{1, 0, 0, 40}}));
  tableIn(folder);
  const ProgramRun run = dataset2rawlog("rosbag2 --classes " + quoted(folder / "classes.yaml") +
                                        " " + quoted(folder.write("a.mcap", mcapOf(bag, ""))) +
                                        " -o " + quoted(folder / "out.rawlog"));
  EXPECT_TRUE(contains(run.output, "4 scans"));
  EXPECT_TRUE(contains(run.output, "2 frames skipped"));
}

TEST_F(Rosbag2, timesOfPointsComeAlong) {
  auto bag = drive();
  bag.push_back(cloudMessage("/other", 101, "lidar", {{1, 0, 0, 0}, {2, 0, 0, 50000}}, false, "t"));
  const auto scans = scansOf(
      "--no-labels --topics /other -- " + quoted(folder.write("a.mcap", mcapOf(bag, ""))), folder);
  EXPECT_EQ(scans.at(0).scan.times, (std::vector<float>{0, 50000e-9f}));
}

TEST_F(Rosbag2, topicsAreChosenWhereThereAreSeveral) {
  auto bag = drive();
  bag.push_back(cloudMessage("/other", 101, "base_link", {{1, 0, 0, 40}, {2, 0, 0, 40}}));
  const std::string file = quoted(folder.write("a.mcap", mcapOf(bag, "zstd")));
  EXPECT_TRUE(contains(messageOf("--no-labels " + file, folder),
                       "--topics has to choose the topics of points; there are: /other, /points"));
  EXPECT_TRUE(contains(messageOf("--no-labels --topics /nowhere -- " + file, folder),
                       "no topic '/nowhere'"));
  const auto other = scansOf("--topics /other -- " + file, folder);
  ASSERT_EQ(other.size(), 1u);
  EXPECT_EQ(other[0].scan.cloud.size(), 2u);
  EXPECT_LT((other[0].inMap(0) - at(11, 0, 0, M_PI / 4) * Vector3d(1, 0, 0)).norm(), 1e-5);
}

constexpr std::uint32_t kWidth = 4;

/** A camera 1 m up that looks ahead, on a robot that drives 1 m a second. */
std::vector<BagMessage> cameraDrive() {
  Isometry3d T_base_optical = at(0, 0, 1);
  T_base_optical.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {transformMessage("/tf_static", 100, "base_link", "optical", T_base_optical),
          transformMessage("/tf", 100, "odom", "base_link", at(0, 0, 0)),
          transformMessage("/tf", 110, "odom", "base_link", at(10, 0, 0)),
          cameraMessage("/cam/depth/camera_info", 100, kWidth, 2, 2),
          cameraMessage("/cam/color/camera_info", 100, 640, 480, 500)};
}

/** Pixels of 2 m, one without a return. */
template <class Pixel>
std::vector<Pixel> depths(Pixel twoMeters) {
  std::vector<Pixel> pixels(2 * kWidth, twoMeters);
  pixels[3] = 0;
  return pixels;
}

BagMessage depthImage(double seconds, const std::string& topic = "/cam/depth/image") {
  return imageMessage(topic, seconds, "optical", "16UC1", kWidth, depths<std::uint16_t>(2000));
}

/** Raw ids of road, but the first pixel, which is grass. */
BagMessage labelImage(double seconds, const std::string& topic = "/net/labels") {
  std::vector<std::uint8_t> ids(2 * kWidth, 40);
  ids[0] = 70;
  return imageMessage(topic, seconds, "optical", "mono8", kWidth, ids);
}

void expectDepth(const PosedScan& scan, double x) {
  ASSERT_EQ(scan.scan.cloud.size(), 7u);
  EXPECT_LT((scan.inMap(0) - Vector3d(x + 2, 1.5, 1.5)).norm(), 1e-4);
  EXPECT_LT((scan.inMap(6) - Vector3d(x + 2, -1.5, 0.5)).norm(), 1e-4);
  EXPECT_EQ(scan.scan.cloud.classes, (std::vector<ClassId>{2, 1, 1, 1, 1, 1, 1}));
}

}  // namespace

TEST_F(Rosbag2, depthImagesHaveTheLabelsOfTheirStampThoughTheseComeLater) {
  auto bag = cameraDrive();
  bag.push_back(imageMessage("/cam/color/image", 101, "optical", "rgb8", 1,
                             std::vector<std::array<std::uint8_t, 3>>(4)));
  for (const double seconds : {101., 102., 103.}) bag.push_back(depthImage(seconds));
  bag.push_back(labelImage(103));
  bag.push_back(labelImage(101));
  for (const bool isSqlite : {false, true}) {
    const std::filesystem::path file = folder / (isSqlite ? "a.db3" : "a.mcap");
    isSqlite ? writeSqliteBag(file, bag) : void(folder.write("a.mcap", mcapOf(bag, "zstd")));
    const auto scans = scansOf(quoted(file), folder);
    ASSERT_EQ(scans.size(), 2u);  // nothing says what was seen after 102 s
    expectDepth(scans[0], 1);
    expectDepth(scans[1], 3);
    EXPECT_EQ(scans[0].scan.sensorLabel, "/cam/depth/image");
  }
}

TEST_F(Rosbag2, depthImagesHaveTheLabelsOfAFolderByTimeOrByTheirNumber) {
  auto bag = cameraDrive();
  for (const double seconds : {101., 102., 103.}) bag.push_back(depthImage(seconds));
  bag.push_back(labelImage(102));  // the folder counts
  const std::string file = quoted(folder.write("a.mcap", mcapOf(bag, "zstd")));
  cv::Mat ids(2, kWidth, CV_8UC1, cv::Scalar(40));
  ids.at<std::uint8_t>(0, 0) = 70;
  for (const auto& names : {std::array{"101.0", "103.01"}, std::array{"000000", "000002"}}) {
    const TemporaryFolder labels;
    for (const char* name : names)
      cv::imwrite((labels / (std::string(name) + ".png")).string(), ids);
    const std::string given = "--label-images " + quoted(labels.path()) + " ";
    const auto scans = scansOf(given + file, folder);
    ASSERT_EQ(scans.size(), 2u) << names[0];
    expectDepth(scans[0], 1);
    expectDepth(scans[1], 3);
    const auto odd = scansOf("--frames 1:1: " + given + file, folder);
    ASSERT_EQ(odd.size(), 1u) << names[0];
    expectDepth(odd[0], 3);
    EXPECT_EQ(scansOf("--no-labels " + given + file, folder).at(1).scan.counts.labeled, 0u);
  }
  EXPECT_TRUE(contains(messageOf("--classes " + quoted(folder / "classes.yaml") +
                                     " --label-images " + quoted(folder.path()) + " " + file,
                                 folder),
                       "no label image in this folder"));
}

TEST_F(Rosbag2, depthImagesMayBeMetersAndComeWithoutLabels) {
  auto bag = cameraDrive();
  auto meters = depths(2.f);
  meters[4] = NAN;
  bag.push_back(imageMessage("/cam/depth/image", 101, "optical", "32FC1", kWidth, meters));
  bag.push_back(labelImage(101));
  const std::string file = quoted(folder.write("a.mcap", mcapOf(bag, "lz4")));
  const auto unlabeled = scansOf("--no-labels " + file, folder);
  ASSERT_EQ(unlabeled.size(), 1u);
  EXPECT_EQ(unlabeled[0].scan.cloud.size(), 6u);
  EXPECT_EQ(unlabeled[0].scan.counts.labeled, 0u);
  EXPECT_EQ(scansOf("--label-images /net/labels " + file, folder).at(0).scan.counts.labeled, 6u);
}

TEST_F(Rosbag2, laserScansAreSeenFromTheirBeams) {
  std::vector<BagMessage> bag = {
      transformMessage("/tf_static", 0, "base_link", "laser", at(0.5, 0, 1, M_PI / 2)),
      transformMessage("/tf", 100, "odom", "base_link", at(0, 0, 0)),
      transformMessage("/tf", 102, "odom", "base_link", at(2, 0, 0))};
  const auto quarter = float(M_PI / 2);
  bag.push_back(laserMessage("/scan", 101, "laser", 0, quarter, {2, INFINITY, 3}));
  bag.push_back(laserMessage("/scan", 102, "laser", quarter, -quarter, {NAN, 4, 0.01f, 5, 30}));
  const auto scans = scansOf(quoted(folder.write("a.mcap", mcapOf(bag, ""))), folder);
  ASSERT_EQ(scans.size(), 2u);
  const auto points = [&](int i) {
    std::vector<Vector3d> all;
    for (std::size_t p = 0; p < scans[i].scan.cloud.size(); ++p) all.push_back(scans[i].inMap(p));
    return all;
  };
  ASSERT_EQ(points(0).size(), 2u);
  EXPECT_LT((points(0)[0] - Vector3d(1.5, 2, 1)).norm(), 1e-4);
  EXPECT_LT((points(0)[1] - Vector3d(1.5, -3, 1)).norm(), 1e-4);
  ASSERT_EQ(points(1).size(), 2u);
  EXPECT_LT((points(1)[0] - Vector3d(2.5, 4, 1)).norm(), 1e-4);
  EXPECT_LT((points(1)[1] - Vector3d(2.5, -5, 1)).norm(), 1e-4);
  std::vector<float> ranges;
  labeled_cloud::RawlogReader reader(folder / "out.rawlog");
  while (const auto entry = reader.next())
    for (const auto& observation : entry->observations)
      if (const auto* laser =
              dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(observation.get()))
        for (std::size_t i = 0; i < laser->getScanSize(); ++i)
          ranges.push_back(laser->getScanRange(i));
  EXPECT_EQ(ranges, (std::vector<float>{2, 20, 3, 0, 4, 0, 5, 0})) << "infinite alone: nothing";
}

TEST_F(Rosbag2, laserScansWhoseBeamsTakeTimeHaveTheirTimes) {
  const std::vector<BagMessage> bag = {
      transformMessage("/tf", 100, "odom", "laser", at(0, 0, 0)),
      transformMessage("/tf", 102, "odom", "laser", at(2, 0, 0)),
      laserMessage("/scan", 101, "laser", 0, float(M_PI / 2), {2, INFINITY, 3}, 0.25f)};
  const auto scans = scansOf(quoted(folder.write("a.mcap", mcapOf(bag, ""))), folder);
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_EQ(scans[0].scan.times, (std::vector<float>{0, 0.5f}));
  EXPECT_LT((scans[0].inMap(1) - Vector3d(-2, 0, 0)).norm(), 1e-5);
}

TEST_F(Rosbag2, whatIsWrongWithImagesIsNamed) {
  tableIn(folder);
  const auto expectFailure = [&](const std::vector<BagMessage>& more, const std::string& part,
                                 const std::string& arguments = "") {
    auto bag = cameraDrive();
    bag.insert(bag.end(), more.begin(), more.end());
    const std::string file = quoted(folder.write("a.mcap", mcapOf(bag, "")));
    EXPECT_TRUE(contains(
        messageOf("--classes " + quoted(folder / "classes.yaml") + " " + arguments + " " + file,
                  folder),
        part));
  };
  const auto depth = depthImage(101);
  auto tooShort = depth, unknown = labelImage(101);
  tooShort.bytes.resize(tooShort.bytes.size() - 3);
  unknown.bytes[unknown.bytes.size() - 3] = 41;
  const auto otherSize =
      imageMessage("/net/labels", 101, "optical", "mono8", 2, std::vector<std::uint8_t>(4, 40));
  expectFailure({tooShort}, "a message of /cam/depth/image: ends too early");
  expectFailure({depth, otherSize}, "label image has 2 x 2 pixels, the depth image 4 x 2");
  expectFailure({depth, unknown}, "/net/labels: raw class id 41");
  expectFailure({depth, labelImage(101), labelImage(101, "/b/labels")},
                "--label-images has to choose one of /b/labels, /net/labels");
  expectFailure({depth}, "no topic '/gone' of images", "--label-images /gone");
  expectFailure({depthImage(101, "/other/image")}, "there is no /other/camera_info");
  expectFailure({depth, depthImage(101, "/b/image")},
                "--topics has to choose the topics of points; there are: /b/image, /cam/depth/");
  expectFailure({laserMessage("/scan", 101, "laser", NAN, 1, {1})}, "angles that are no numbers");
  expectFailure({laserMessage("/scan", 101, "laser", 0, 1, {})}, "without beams");
  auto bag = cameraDrive();
  bag[3] = cameraMessage("/cam/depth/camera_info", 100, 8, 8, 2);
  bag.push_back(depth);
  EXPECT_TRUE(
      contains(messageOf("--no-labels " + quoted(folder.write("b.mcap", mcapOf(bag, ""))), folder),
               "the camera's calibration is for 8 x 8 pixels, the image has 4 x 2"));
}

TEST_F(Rosbag2, whatIsWrongIsNamed) {
  tableIn(folder);
  const std::string labels = "--classes " + quoted(folder / "classes.yaml"), none = "--no-labels",
                    good = mcapOf(drive(), "zstd");
  std::string damaged = mcapOf(drive(), ""), packed = good;
  damaged[damaged.find("base_link")] ^= 1;
  packed[300] ^= 0x55;
  auto early = drive(), encoded = drive(), unknown = drive();
  early[4].bytes.resize(60);
  encoded[4].bytes[1] = 7;
  unknown[5] = cloudMessage("/points", 101, "lidar", {{1, 0, 0, 41}});
  ASSERT_EQ(mkfifo((folder / "pipe.db3").c_str(), 0600), 0);
  for (const auto& [name, bytes, arguments, part] : std::vector<std::array<std::string, 4>>{
           {"a.mcap", "no bag at all", none, "is no MCAP file"},
           {"a.mcap", good.substr(0, 200), none, "is cut off"},
           {"a.mcap", damaged, none, "its checksum is another"},
           {"a.mcap", packed, none, "is damaged"},
           {"a.mcap", mcapOf(early, ""), labels, "message 1 of /points: ends too early"},
           {"a.mcap", mcapOf(encoded, ""), labels, "message 1 of /points: has the encoding 7"},
           {"a.mcap", mcapOf(unknown, ""), labels, "2 of /points: field 'label': raw class id 41"},
           {"a.mcap", good, labels + " --label-field class", "no field 'class'"},
           {"a.bag", "x", none, "expected a bag of ROS 2"},
           {"a.db3", "no database", none, "is no bag that can be read"},
           {"gone.mcap", "", none, "no such bag"},
           {"pipe.db3", "", none, "a pipe"}}) {
    if (!bytes.empty()) folder.write(name, bytes);
    const std::string message = messageOf(arguments + " " + quoted(folder / name), folder);
    EXPECT_TRUE(contains(message, name) && contains(message, part)) << message;
  }
}

TEST_F(Rosbag2, aChunkThatAnnouncesMoreThanItHoldsTakesNoMemory) {
  std::string bomb = mcapOf(drive(), "zstd");
  const std::size_t chunk = bomb.find('\6', 33);  // behind the file's head
  const std::uint64_t huge = (std::uint64_t{1} << 30) - 1;
  bomb.replace(chunk + 9 + 16, 8, raw(huge));
  const std::string message =
      runCommand("ulimit -v 600000; " MSO_BIN_DIR "/dataset2rawlog rosbag2 --no-labels " +
                 quoted(folder.write("a.mcap", bomb)) + " -o " + quoted(folder / "o.rawlog"))
          .output;
  EXPECT_TRUE(contains(message, "not of the announced size"));
}
