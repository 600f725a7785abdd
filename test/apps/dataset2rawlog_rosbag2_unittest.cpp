// Bags of ROS 2, written by the tests, become rawlogs.
#include <gtest/gtest.h>

#include "BagWriter.h"
#include "ConvertedScans.h"
#include "FolderTest.h"

using Eigen::Isometry3d;
using Eigen::Vector3d;
using semantic_types::ClassId;
using semantic_types::ClassTable;

namespace {

using Rosbag2 = FolderTest;

Isometry3d at(double x, double y, double z, double heading = 0) {
  return Eigen::Translation3d(x, y, z) * Isometry3d(Eigen::AngleAxisd(heading, Vector3d::UnitZ()));
}

/** A robot that turns by 90 degrees within two seconds and drives 2 m, and sees three points at
 * each half of a second; its LiDAR is 0.5 m ahead, 1 m up, and looks to the left. The last cloud
 * comes before the transforms that tell where it is. */
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

}  // namespace

TEST_F(Rosbag2, mcapOfAnyCompressionHasTheScansAndWhereTheyWere) {
  for (const char* chunks : {"none", "", "zstd", "lz4"})
    for (const bool bigEndian : {false, true}) {
      SCOPED_TRACE(std::string(chunks) + (bigEndian ? " big" : ""));
      const TemporaryFolder fresh;
      expectDrive(scansOf(quoted(fresh.write("a.mcap", mcapOf(drive(bigEndian), chunks))), fresh));
    }
}

TEST_F(Rosbag2, sqliteHasThemToo) {
  writeSqliteBag(folder / "a.db3", drive());
  expectDrive(scansOf(quoted(folder / "a.db3"), folder));
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
  EXPECT_NE(run.output.find("4 scans"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("2 frames skipped"), std::string::npos) << run.output;
}

TEST_F(Rosbag2, topicsAreChosenWhereThereAreSeveral) {
  auto bag = drive();
  bag.push_back(cloudMessage("/other", 101, "base_link", {{1, 0, 0, 40}, {2, 0, 0, 40}}));
  const std::string file = quoted(folder.write("a.mcap", mcapOf(bag, "zstd")));
  EXPECT_NE(messageOf("--no-labels " + file, folder)
                .find("--topics has to choose the topics of points; there are: /other, /points"),
            std::string::npos);
  EXPECT_NE(
      messageOf("--no-labels --topics /nowhere -- " + file, folder).find("no topic '/nowhere'"),
      std::string::npos);
  const auto other = scansOf("--topics /other -- " + file, folder);
  ASSERT_EQ(other.size(), 1u);
  EXPECT_EQ(other[0].scan.cloud.size(), 2u);
  EXPECT_LT((other[0].inMap(0) - at(11, 0, 0, M_PI / 4) * Vector3d(1, 0, 0)).norm(), 1e-5);
}

TEST_F(Rosbag2, whatIsWrongIsNamed) {
  tableIn(folder);
  const auto failureWith = [&](const std::string& bytes,
                               const std::string& arguments = "--no-labels") {
    return messageOf(arguments + " " + quoted(folder.write("a.mcap", bytes)), folder);
  };
  const std::string labels = "--classes " + quoted(folder / "classes.yaml");
  const auto has = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find("a.mcap"), std::string::npos) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  const std::string good = mcapOf(drive(), "zstd");
  has(failureWith("no bag at all"), "is no MCAP file");
  has(failureWith(good.substr(0, 200)), "is cut off");
  std::string damaged = mcapOf(drive(), "");
  damaged[damaged.find("base_link")] ^= 1;
  has(failureWith(damaged), "its checksum is another");
  damaged = good;
  damaged[300] ^= 0x55;
  has(failureWith(damaged), "is damaged");
  auto bag = drive();
  bag[4].bytes.resize(60);
  has(failureWith(mcapOf(bag, ""), labels), "message 1 of /points: ends too early");
  bag = drive();
  bag[4].bytes[1] = 7;
  has(failureWith(mcapOf(bag, ""), labels), "message 1 of /points: has the encoding 7");
  bag = drive();
  bag[5] = cloudMessage("/points", 101, "lidar", {{1, 0, 0, 41}});
  has(failureWith(mcapOf(bag, ""), labels), "message 2 of /points: field 'label': raw class id 41");
  has(failureWith(good, labels + " --label-field class"), "no field 'class'");
  EXPECT_NE(messageOf("--no-labels " + quoted(folder.write("a.bag", "x")), folder)
                .find("expected a bag of ROS 2"),
            std::string::npos);
  EXPECT_NE(messageOf("--no-labels " + quoted(folder.write("a.db3", "no database")), folder)
                .find("is no bag that can be read"),
            std::string::npos);
  EXPECT_NE(messageOf("--no-labels " + quoted(folder / "gone.mcap"), folder).find("no such bag"),
            std::string::npos);
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
  EXPECT_NE(message.find("not of the announced size"), std::string::npos) << message;
}
