#include <gtest/gtest.h>
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/LabelImage.h>
#include <labeled_cloud/Rawlogs.h>
#include <mrpt_compat/Images.h>
#include <semantic_types/ClassTable.h>

#include <Eigen/Geometry>
#include <array>
#include <opencv2/imgcodecs.hpp>

#include "ConvertedScans.h"
#include "SharedData.h"
#include "TemporaryFolder.h"

using namespace labeled_cloud;
using namespace semantic_types;
using Eigen::Vector3d;
using semantic_types::ClassTable;
namespace fs = std::filesystem;

namespace {

using Tum = FolderTest;

constexpr int kRows = 6, kCols = 8;

/** A pattern that JPEG would spoil. */
cv::Vec3b colorOf(int r, int c) {
  return cv::Vec3b(std::uint8_t(97 * r + 31 * c), std::uint8_t(53 * r + 89 * c),
                   std::uint8_t(11 * r + 151 * c));
}

/** Two frames of a tilted plane of three classes, with the camera at two poses. */
void writeSmallTum(const TemporaryFolder& folder) {
  folder.write("classes.yaml", kThreeClasses);
  folder.write("camera.ini",
               "[CAMERA_PARAMS]\nresolution = [8 6]\ncx = 3.5\ncy = 2.25\nfx = 5\nfy = 4\n"
               "dist = [0 0 0 0 0]\ndepth_factor = 2000\n");
  folder.write("groundtruth.txt",
               "1.0 1 2 3 -0.5 0.5 -0.5 0.5\n2.0 4 5 6 -0.70710678 0 0 0.70710678\n");
  folder.write("depth.txt", "# depth\n1.0 depth/a.png\n2.0 depth/b.png\n");
  folder.write("label.txt", "1.01 label/a.png\n1.99 label/b.png\n");
  folder.write("rgb.txt", "1.0 rgb/a.png\n2.0 rgb/b.png\n");
  cv::Mat depth(kRows, kCols, CV_16UC1), label(kRows, kCols, CV_8UC1), color(kRows, kCols, CV_8UC3);
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kCols; ++c) {
      depth.at<std::uint16_t>(r, c) = r == 0 ? 0 : 2000 + 100 * r + 10 * c;
      color.at<cv::Vec3b>(r, c) = colorOf(r, c);
      label.at<std::uint8_t>(r, c) = std::array{40, 70, 252, 0}[c % 4];
    }
  for (const char* part : {"depth", "label", "rgb"}) fs::create_directory(folder / part);
  for (const char* name : {"a.png", "b.png"}) {
    cv::imwrite((folder / "depth" / name).string(), depth);
    cv::imwrite((folder / "label" / name).string(), label);
    cv::imwrite((folder / "rgb" / name).string(), color);
  }
}

/** The first three classes and 97 more. */
std::string hundredClasses() {
  std::string text = kThreeClasses;
  for (int id = 4; id <= 100; ++id)
    text += "  - {id: " + std::to_string(id) + ", name: c" + std::to_string(id) +
            ", color: [1, 2, " + std::to_string(id) + "]}\n";
  return text;
}

std::string tumArguments(const TemporaryFolder& folder) {
  return "tum " + quoted(folder.path()) + " --classes " + quoted(folder / "classes.yaml");
}

/** Checks points and classes against the pinhole model and the quaternion, by hand. */
void expectSmallTum(const std::vector<PosedScan>& scans) {
  ASSERT_EQ(scans.size(), 2u);
  const Eigen::Isometry3d poses[] = {
      Eigen::Translation3d(1, 2, 3) * Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5),
      Eigen::Translation3d(4, 5, 6) * Eigen::Quaterniond(M_SQRT1_2, -M_SQRT1_2, 0, 0)};
  for (int s = 0; s < 2; ++s) {
    ASSERT_EQ(scans[s].scan.cloud.size(), std::size_t((kRows - 1) * kCols));
    for (int r = 1, i = 0; r < kRows; ++r)
      for (int c = 0; c < kCols; ++c, ++i) {
        const double d = (2000 + 100 * r + 10 * c) / 2000.0;
        const Vector3d optical((c - 3.5) / 5 * d, (r - 2.25) / 4 * d, d);
        EXPECT_LT((scans[s].inMap(i) - poses[s] * optical).norm(), 1e-5) << s << r << c;
        EXPECT_EQ(scans[s].scan.cloud.classes[i], (c + 1) % 4);
      }
  }
}

std::vector<mrpt::obs::CObservation::Ptr> observationsOf(const fs::path& rawlog) {
  RawlogReader reader(rawlog);
  std::vector<mrpt::obs::CObservation::Ptr> all;
  while (const auto entry = reader.next())
    all.insert(all.end(), entry->observations.begin(), entry->observations.end());
  return all;
}

}  // namespace

TEST_F(Tum, depthImagesWithPixelLabelsLandRightInTheWorld) {
  writeSmallTum(folder);
  expectSmallTum(convertAndRead(tumArguments(folder), folder / "out.rawlog",
                                loadClassTable(folder / "classes.yaml")));
  const auto all = observationsOf(folder / "out.rawlog");
  const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(all.at(1));
  ASSERT_TRUE(scan && scan->hasRangeImage && scan->hasPixelLabels() && scan->hasIntensityImage);
  const cv::Mat color = mrpt_compat::toOpenCv(scan->intensityImage);
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kCols; ++c) EXPECT_EQ(color.at<cv::Vec3b>(r, c), colorOf(r, c));
}

TEST_F(Tum, withMoreThan64ClassesTheyAreLabeledClouds) {
  writeSmallTum(folder);
  folder.write("classes.yaml", hundredClasses());
  expectSmallTum(convertAndRead(tumArguments(folder), folder / "out.rawlog",
                                loadClassTable(folder / "classes.yaml")));
  EXPECT_TRUE(std::dynamic_pointer_cast<CObservationLabeledCloud>(
      observationsOf(folder / "out.rawlog").at(1)));
}

TEST_F(Tum, labelsCanBeLeftOutThenNoTableIsNeeded) {
  writeSmallTum(folder);
  fs::remove(folder / "label.txt");
  const auto scans = convertAndRead("tum --no-labels " + quoted(folder.path()),
                                    folder / "out.rawlog", ClassTable());
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[0].scan.counts.points, 40u);
  EXPECT_TRUE(scans[0].scan.labelsMissing);
  EXPECT_TRUE(contains(failureOf("tum " + quoted(folder.path()) + " -o " + quoted(folder / "x")),
                       "--classes (except with --no-labels) is required"));
}

TEST_F(Tum, framesWithoutAPoseOrALabelImageAreSkippedAndReported) {
  writeSmallTum(folder);
  folder.write("depth.txt", "1.0 depth/a.png\n1.5 depth/a.png\n2.0 depth/b.png\n9 depth/b.png\n");
  const ProgramRun result =
      dataset2rawlog(tumArguments(folder) + " -o " + quoted(folder / "out.rawlog"));
  EXPECT_EQ(result.status, 0);
  EXPECT_TRUE(contains(result.output, ": 2 scans, 80 points, 75.0 % with a class"));
  EXPECT_TRUE(contains(result.output, "2 frames skipped"));
}

TEST_F(Tum, badInputIsNamed) {
  const std::string head = "[CAMERA_PARAMS]\n",
                    camera = head + "resolution = [8 6]\nfx = 5\nfy = 4\ncx = 3.5\ncy = ",
                    jpeg("\xff\xd8\xff\xc2\0\x0b\x08\x75\x30\x75\x30\1\1\x11\0", 15);
  std::string dicom(200, ' ');
  dicom.replace(128, 4, "DICM");
  for (const auto& [file, text, message] : std::vector<std::array<std::string, 3>>{
           {"depth/a.png", "no image", ""},
           {"label/b.png", "no image", ""},
           {"rgb/b.png", "no image", ""},
           {"camera.ini", head, ""},
           {"camera.ini", camera + "wide\n", "cy is 'wide'"},
           {"camera.ini", camera + "2\ndepth_factor = 0\n", "above 0"},
           {"camera.ini", camera + "2\ndist = [0 x 0 0 0]\n", "dist: "},
           {"depth.txt", "1.0\n", "depth.txt:1: expected 'time file'"},
           {"depth.txt", "# none\n", "no image in this list"},
           {"depth.txt", "1e300 depth/a.png\n", "s is no time"},
           {"groundtruth.txt", "1 2 3\n", "groundtruth.txt:1"},
           {"depth/a.png", jpeg, "30000 x 30000 pixels, more than a file"},
           {"rgb/a.png", dicom, "it is no PNG"}}) {
    const TemporaryFolder fresh;
    writeSmallTum(fresh);
    fresh.write(file, text);
    const std::string failure =
        failureOf(tumArguments(fresh) + " -o " + quoted(fresh / "out.rawlog"));
    EXPECT_TRUE(contains(failure, file) && contains(failure, message)) << failure;
    EXPECT_FALSE(contains(failure, "stack")) << failure;
    EXPECT_FALSE(fs::exists(fresh / "out.rawlog"));
  }
}

TEST_F(Tum, framesOfARealFlatAgreeWithEachOther) {
  SKIP_WITHOUT_DATA("replica_apartment_0");
  const ClassTable table = loadClassTable(shippedTable("replica_apartment.yaml"));
  const auto scans = convertAndRead("tum " + quoted(sharedDataDir() / "replica_apartment_0") +
                                        " --frames 0:5:20 --classes " +
                                        quoted(shippedTable("replica_apartment.yaml")),
                                    folder / "out.rawlog", table);
  ASSERT_EQ(scans.size(), 5u);
  EXPECT_GE(agreement(scans, 0.05), 0.98);

  // Depth images and a folder of label images give equal scans.
  const fs::path flat = sharedDataDir() / "replica_apartment_0";
  const ProgramRun plain = dataset2rawlog("tum --no-labels --frames 0:5:20 " + quoted(flat) +
                                          " -o " + quoted(folder / "plain.rawlog"));
  ASSERT_EQ(plain.status, 0) << plain.output;
  const auto labels = std::make_shared<LabelFolder>(flat / "label", table);
  const auto same = readScans(folder / "plain.rawlog", table, labels);
  ASSERT_EQ(same.size(), 5u);
  for (std::size_t s = 0; s < 5; ++s) {
    EXPECT_EQ(same[s].scan.cloud.classes, scans[s].scan.cloud.classes);
    EXPECT_EQ(same[s].scan.cloud.points, scans[s].scan.cloud.points);
  }
}
