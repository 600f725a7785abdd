#include <gtest/gtest.h>

#include "ConvertedScans.h"
#include "TemporaryFolder.h"

using Eigen::Vector3d;

namespace {

/** Three beams, to the right, ahead and to the left: 2, 3 and 4 m. */
const std::string kBeams = "0 -1.5707963 3.1415927 1.5707963 50 0.01 0 3 2 3 4 0 ";

std::string ranges(int n, double meters) {
  std::string text = std::to_string(n);
  for (int i = 0; i < n; ++i) text += " " + std::to_string(meters);
  return text;
}

std::string flaser(int n, double time = 976052857.5) {
  return "FLASER " + ranges(n, 5) + " 9 9 9 1 2 1.5707963 " + std::to_string(time) + " host 0.1\n";
}

std::vector<PosedScan> scansOf(const std::string& log) {
  const TemporaryFolder folder;
  return convertAndRead("carmen " + quoted(folder.write("a.log", log)), folder / "out.rawlog", {});
}

void expectInMap(const PosedScan& scan, std::size_t i, const Vector3d& point) {
  EXPECT_LT((scan.inMap(i) - point).norm(), 1e-4) << i << ": " << scan.inMap(i).transpose();
}

std::string messageOf(const std::string& log) {
  const TemporaryFolder folder;
  return failureOf("carmen " + quoted(folder.write("a.log", log)) + " -o " +
                   quoted(folder / "out.rawlog"));
}

}  // namespace

TEST(Carmen, oldLasersSeeHalfACircle) {
  for (const int n : {181, 361}) {
    const auto scans =
        scansOf("# carmen\nPARAM robot_frontlaser_offset 0.5 # m\nSYNC x\n" + flaser(n));
    ASSERT_EQ(scans.size(), 1u);
    ASSERT_EQ(scans[0].scan.cloud.size(), static_cast<std::size_t>(n));
    // The robot looks along y, with the laser half a meter ahead.
    expectInMap(scans[0], 0, {6, 2.5, 0});
    expectInMap(scans[0], static_cast<std::size_t>(n / 2), {1, 7.5, 0});
    expectInMap(scans[0], static_cast<std::size_t>(n - 1), {-4, 2.5, 0});
    EXPECT_NEAR(mrpt::Clock::toDouble(scans[0].scan.timestamp), 976052857.5, 1e-6);
  }
}

TEST(Carmen, ofOtherNumbersOfBeamsAParameterSaysHowFarTheyAreApart) {
  EXPECT_TRUE(contains(messageOf(flaser(91)), "a.log:1: FLASER: 91 ranges: how far"));
  const auto scans = scansOf("PARAM laser_front_laser_resolution 2\n" + flaser(91));
  expectInMap(scans.at(0), 0, {6, 2, 0});
  expectInMap(scans[0], 90, {-4, 2, 0});
}

TEST(Carmen, newLasersSayWhereTheirBeamsAre) {
  const auto scans = scansOf("ODOM 0 0 0 0 0 0 100 host 0\nRAWLASER1 " + kBeams +
                             "100.5 host 0\nODOM 2 0 0 0 0 0 101 host 0\nROBOTLASER1 " + kBeams +
                             "5.3 1 0 5 1 0 0 0 0 0 0 102 host 0\n");
  ASSERT_EQ(scans.size(), 2u);
  expectInMap(scans[0], 0, {1, -2, 0});
  expectInMap(scans[0], 1, {4, 0, 0});
  expectInMap(scans[0], 2, {1, 4, 0});
  expectInMap(scans[1], 1, {8.3, 1, 0});
}

TEST(Carmen, whatIsAsFarAsTheLargestRangeIsNothing) {
  const std::string near = flaser(181), far = "PARAM robot_front_laser_max 5\n" + flaser(181);
  EXPECT_EQ(scansOf(near).at(0).scan.cloud.size(), 181u);
  EXPECT_EQ(scansOf("RAWLASER1 0 0 1 1 3 0 0 2 2.9 3 0 1 h 0\nODOM 0 0 0 0 0 0 1 h 1\n")
                .at(0)
                .scan.cloud.size(),
            1u);
  EXPECT_EQ(scansOf(far).at(0).scan.cloud.size(), 0u);
}

TEST(Carmen, badLinesAreNamed) {
  for (const auto& [line, message] : std::vector<std::pair<std::string, std::string>>{
           {"FLASER 181 1 2", "FLASER: ends before number 3 of 181 ranges"},
           {"FLASER x", "FLASER: the number of its ranges is no number: 'x'"},
           {"FLASER -1", "FLASER: has no such number of ranges"},
           {"FLASER 1e9", "FLASER: has no such number of ranges"},
           {"FLASER 2 1 nan 0 0 0", "FLASER: number 2 of 2 ranges is no number: 'nan'"},
           {"ODOM 1 2 3 0 0 0 1e20 host 0", "ODOM: "},
           {"ODOM 1 2 3 0 0 0", "ODOM: ends before its time"},
           {"RAWLASER1 0 -1.57 3.14 0.1 50 0 0 3 1 2 3 0 1 h 0", "do not fill its field of view"},
           {"RAWLASER1 0 -1.57 90 0.1 50 0 0 1 1 0 1 h 0", "do not fill its field of view"},
           {flaser(181, 50), "is of a time before the one before it"}})
    EXPECT_TRUE(contains(messageOf(flaser(181) + line), "a.log:2: ") &&
                contains(messageOf(flaser(181) + line), message))
        << messageOf(flaser(181) + line);
}

TEST(Carmen, aLogWithoutScansMakesNoRawlog) {
  EXPECT_TRUE(contains(messageOf("ODOM 1 2 3 0 0 0 1 host 0\n"), "no frame was selected"));
}
