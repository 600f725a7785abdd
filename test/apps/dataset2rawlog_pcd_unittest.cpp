#include <gtest/gtest.h>
#include <semantic_types/ClassTable.h>

#include "Classes.h"
#include "ConvertedScans.h"
#include "RunProgram.h"
#include "SharedData.h"
#include "TemporaryFolder.h"

using namespace labeled_cloud;
using namespace semantic_types;
using Eigen::Vector3d;
using semantic_types::ClassId;
using semantic_types::ClassTable;

namespace {

using Pcd = FolderTest;

const char* const kPcdHead =
    "# .PCD v0.7\nVERSION 0.7\nFIELDS intensity x y z label\nSIZE 4 4 4 4 4\nTYPE F F F F U\n"
    "COUNT 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
    "VIEWPOINT 1 2 3 0.70710678 0 0 0.70710678\nPOINTS 2\nDATA ascii\n";

TEST_F(Pcd, pointsComeBackInTheWorldAndTheSensorIsAtTheViewpoint) {
  const auto file = folder.write("a.pcd", std::string(kPcdHead) + "9 5 6 7 3 -1\n9 1 2 3.5 0\n");
  const ClassTable table = tableOf({"a", "b", "c"});
  const auto scans =
      convertAndRead("pcd " + quoted(file) + " " + quoted(file), folder / "out.rawlog", table);
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_LT((scans[1].inMap(0) - Vector3d(5, 6, 7)).norm(), 1e-5);
  // turned left by 90 degrees at (1, 2, 3): 4 m to its right is what lies 4 m ahead in the world
  EXPECT_LT((scans[1].scan.cloud.points[0] - Eigen::Vector3f(4, -4, 4)).norm(), 1e-5);
  EXPECT_EQ(scans[0].scan.cloud.classes, (std::vector<ClassId>{3, 0}));
}

TEST_F(Pcd, aClassTableFoldsTheLabels) {
  folder.write("classes.yaml", kThreeClasses);
  const auto file = folder.write("a.pcd", std::string(kPcdHead) + "9 5 6 7 252\n9 1 2 4 70\n");
  const auto scans =
      convertAndRead("pcd --classes " + quoted(folder / "classes.yaml") + " " + quoted(file),
                     folder / "out.rawlog", loadClassTable(folder / "classes.yaml"));
  EXPECT_EQ(scans.at(0).scan.cloud.classes, (std::vector<ClassId>{3, 2}));
}

TEST_F(Pcd, theLabelsFieldHasAnyName) {
  const ClassTable table = tableOf({"a", "b"});
  const auto file =
      folder.write("a.pcd", "FIELDS x y z scalar_Class\nPOINTS 2\nDATA ascii\n1 2 3 2\n4 5 6 1\n");
  const auto scans = convertAndRead("pcd --label-field scalar_Class " + quoted(file),
                                    folder / "out.rawlog", table);
  EXPECT_EQ(scans.at(0).scan.cloud.classes, (std::vector<ClassId>{2, 1}));
  EXPECT_EQ(scans[0].scan.cloud.points[1], Eigen::Vector3f(4, 5, 6));
  EXPECT_TRUE(contains(failureOf("pcd " + quoted(file) + " -o " + quoted(folder / "b.rawlog")),
                       "no field 'label' among 'x' 'y' 'z' 'scalar_Class'"));
  const auto bare =
      convertAndRead("pcd --no-labels " + quoted(file), folder / "out2.rawlog", table);
  EXPECT_EQ(bare.at(0).scan.counts.labeled, 0u);
}

TEST_F(Pcd, badInputIsNamed) {
  for (const auto& [row, message] : std::vector<std::pair<std::string, std::string>>{
           {"9 5 6 7 255\n", "label 255 is not one of"}, {"9 5 x 7 3\n", "a.pcd:13"}}) {
    const auto file = folder.write("a.pcd", std::string(kPcdHead) + "9 5 6 7 3\n" + row);
    const std::string failure =
        failureOf("pcd " + quoted(file) + " -o " + quoted(folder / "out.rawlog"));
    EXPECT_TRUE(contains(failure, "a.pcd") && contains(failure, message)) << failure;
  }
  EXPECT_TRUE(contains(failureOf("pcd only_one"), "--output is required"));
}

TEST_F(Pcd, realOnesKeepTheirWorldCoordinates) {
  SKIP_WITHOUT_DATA("sim_unstructured");
  const ClassTable table = tableOf({"a", "b", "c"});
  const auto file = sharedDataDir() / "sim_unstructured/sim_unstructured_annotated_1.pcd";
  const auto scans = convertAndRead("pcd " + quoted(file), folder / "out.rawlog", table);
  ASSERT_EQ(scans.at(0).scan.counts.labeled, 3394u);
  EXPECT_LT((scans[0].inMap(0) - Vector3d(1.3917038, 1.4300275, 0.19733357)).norm(), 1e-5);
  EXPECT_NEAR(scans[0].T_map_robot.x(), 0.999984, 1e-6);
}

TEST_F(Pcd, onATerminalABarSaysHowFarTheConversionIs) {
  if (runCommand("command -v script").status != 0) GTEST_SKIP() << "needs bsdutils";
  const auto file = folder.write("a.pcd", std::string(kPcdHead) + "9 5 6 7 3 0\n9 1 2 3.5 0\n");
  const std::string command =
      MSO_BIN_DIR "/dataset2rawlog pcd " + file.string() + " -f -o " + path("out.rawlog");
  const std::string shown = runCommand("script -qec '" + command + "' /dev/null").output;
  EXPECT_TRUE(contains(shown, "Converting: [....."));
  EXPECT_TRUE(contains(shown, "\r\033[K" + path("out.rawlog") + ": 1 scans"));
  EXPECT_FALSE(contains(runCommand(command).output, "Converting"));
}

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
  EXPECT_TRUE(contains(messageOf("ODOM 1 2 3 0 0 0 1 host 0\n"), "a.log: no line FLASER, RLASER"));
}
