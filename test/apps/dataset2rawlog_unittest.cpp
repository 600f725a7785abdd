#include <gtest/gtest.h>
#include <labeled_cloud/ClassTableFile.h>
#include <labeled_cloud/LabelFolder.h>
#include <labeled_cloud/RawlogReader.h>
#include <labeled_cloud/RawlogTrajectory.h>
#include <labeled_cloud/ScanConverter.h>
#include <mrpt/obs/CObservationImage.h>
#include <sys/wait.h>

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <sstream>

#include "SharedData.h"
#include "TemporaryFolder.h"

using namespace labeled_cloud;
using Eigen::Vector3d;
using semantic_octree::ClassId;
using semantic_octree::ClassTable;
namespace fs = std::filesystem;

namespace {

struct RunResult {
  int status = -1;
  std::string output;  // what it printed, errors too
};

RunResult runCommand(const std::string& command) {
  RunResult result;
  FILE* pipe = popen((command + " 2>&1 </dev/null").c_str(), "r");
  std::array<char, 4096> part;
  while (const std::size_t n = fread(part.data(), 1, part.size(), pipe))
    result.output.append(part.data(), n);
  result.status = WEXITSTATUS(pclose(pipe));
  return result;
}

RunResult dataset2rawlog(const std::string& arguments) {
  return runCommand(std::string(MSO_BIN_DIR) + "/dataset2rawlog " + arguments);
}

/** Runs it and expects failure; returns the message. */
std::string failureOf(const std::string& arguments) {
  const RunResult result = dataset2rawlog(arguments);
  EXPECT_NE(result.status, 0) << result.output;
  EXPECT_TRUE(contains(result.output, "dataset2rawlog: ")) << result.output;
  return result.output;
}

std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }

fs::path shippedTable(const std::string& name) {
  return fs::path(MSO_SOURCE_DIR) / "config/classes" / name;
}

/** A scan and where the robot was, as the map applications see them. */
struct PosedScan {
  LabeledScan scan;
  mrpt::poses::CPose3D T_map_robot;

  Vector3d inMap(std::size_t i) const {
    const auto T =
        (T_map_robot + scan.T_robot_sensor).getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>();
    return (T.asEigen() * scan.cloud.points[i].cast<double>().homogeneous()).head<3>();
  }
};

std::vector<PosedScan> readScans(const fs::path& rawlog, const ClassTable& table,
                                 std::shared_ptr<ImageLabeler> labeler = nullptr) {
  const Trajectory trajectory = readTrajectory({rawlog});
  ScanConverter converter(table, {}, labeler);
  RawlogReader reader(rawlog);
  std::vector<PosedScan> scans;
  while (const auto entry = reader.next())
    for (const auto& observation : entry->observations)
      if (auto scan = converter.convert(*observation)) {
        const auto pose = trajectory.at(scan->timestamp);
        EXPECT_TRUE(pose);
        scans.push_back({std::move(*scan), *pose});
      }
  return scans;
}

std::vector<PosedScan> convertAndRead(const std::string& arguments, const fs::path& rawlog,
                                      const ClassTable& table) {
  const RunResult result = dataset2rawlog(arguments + " " + quoted(rawlog));
  EXPECT_EQ(result.status, 0) << result.output;
  if (result.status != 0) return {};
  return readScans(rawlog, table);
}

/** Share of the labeled points, in voxels seen by two scans or more, that have the class of most of
 * their voxel's points. */
double agreement(const std::vector<PosedScan>& scans, double resolution) {
  struct Voxel {
    std::map<ClassId, std::size_t> votes;
    std::set<std::size_t> seenBy;
  };
  std::map<std::array<int, 3>, Voxel> voxels;
  for (std::size_t s = 0; s < scans.size(); ++s)
    for (std::size_t i = 0; i < scans[s].scan.cloud.size(); ++i) {
      if (scans[s].scan.cloud.classes[i] == 0) continue;
      const Eigen::Vector3i key = (scans[s].inMap(i) / resolution).array().floor().cast<int>();
      Voxel& voxel = voxels[{key.x(), key.y(), key.z()}];
      ++voxel.votes[scans[s].scan.cloud.classes[i]];
      voxel.seenBy.insert(s);
    }
  std::size_t agreeing = 0, all = 0;
  for (const auto& [key, voxel] : voxels) {
    if (voxel.seenBy.size() < 2) continue;
    std::size_t most = 0;
    for (const auto& [id, votes] : voxel.votes) most = std::max(most, votes), all += votes;
    agreeing += most;
  }
  return static_cast<double>(agreeing) / all;
}

const char* const kThreeClasses =
    "no_class: [0]\n"
    "classes:\n"
    "  - {id: 1, name: road, color: [255, 0, 0], raw: [40]}\n"
    "  - {id: 2, name: grass, color: [0, 255, 0], raw: [70]}\n"
    "  - {id: 3, name: car, color: [0, 0, 255], raw: [10, 252]}\n";

}  // namespace

// ---------------------------------------------------------------------------- SemanticKITTI

namespace {

/** Tr of the small sequence: LiDAR (x forward, z up) to camera (z forward, y down), displaced. */
const char* const kTr = "Tr: 0 -1 0 0.1 0 0 -1 0.2 1 0 0 0.3\n";

template <typename T>
std::string bytesOf(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/** Two scans of three points; the camera drives 2 m forward and then turns left by 90 degrees. */
void writeSmallKitti(const TemporaryFolder& folder) {
  folder.write("classes.yaml", kThreeClasses);
  folder.write("calib.txt", std::string("P0: 1 0 0 0 0 1 0 0 0 0 1 0\n") + kTr);
  folder.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n0 0 -1 0 0 1 0 0 1 0 0 2\n");
  folder.write("times.txt", "0.0\n1.5e-01\n");
  const std::vector<float> points = {5, 0, -1, 0.5f, 0, 6, 0, 0.25f, 1, 2, 3, 0};
  for (const char* name : {"000000", "000001"}) {
    folder.write(std::string("velodyne/") + name + ".bin", bytesOf(points));
    folder.write(std::string("labels/") + name + ".label",
                 bytesOf<std::uint32_t>({40 | 7 << 16, 252, 0}));
  }
}

std::string kittiArguments(const TemporaryFolder& folder) {
  return "semantic-kitti " + quoted(folder.path()) + " --classes " +
         quoted(folder / "classes.yaml");
}

std::string kittiFailure(const TemporaryFolder& folder) {
  return failureOf(kittiArguments(folder) + " " + quoted(folder / "out.rawlog"));
}

}  // namespace

TEST(SemanticKitti, posesAreThoseOfTheLidarAndClassesThoseOfTheTable) {
  const TemporaryFolder folder;
  writeSmallKitti(folder);
  const auto scans = convertAndRead(kittiArguments(folder), folder / "out.rawlog",
                                    loadClassTable(folder / "classes.yaml"));
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[0].scan.cloud.classes, (std::vector<ClassId>{1, 3, 0}));
  EXPECT_EQ(scans[0].scan.timestamp, mrpt::Clock::fromDouble(0));
  EXPECT_EQ(scans[1].scan.timestamp, mrpt::Clock::fromDouble(0.15));
  // By hand. The camera is 0.3 m behind the LiDAR, 0.1 m to its left... : p_cam = (-y + 0.1,
  // -z + 0.2, x + 0.3). First scan: the map's frame is the LiDAR's.
  EXPECT_LT((scans[0].inMap(0) - Vector3d(5, 0, -1)).norm(), 1e-5);
  // Second: (5, 0, -1) is (0.1, 1.2, 5.3) in the camera, (-5.3, 1.2, 2.1) in the first camera,
  // hence x = 2.1 - 0.3, y = 0.1 + 5.3, z = 0.2 - 1.2 in the first LiDAR.
  EXPECT_LT((scans[1].inMap(0) - Vector3d(1.8, 5.4, -1)).norm(), 1e-5);
}

TEST(SemanticKitti, imagesComeAlongAsFilesAndLabelsCanBeLeftOut) {
  const TemporaryFolder folder;
  writeSmallKitti(folder);
  const fs::path out = folder / "out.rawlog";
  const std::string arguments =
      "semantic-kitti " + quoted(folder.path()) + " --no-labels --images " + quoted(out);
  // P2 = K [I | t] with f = 10, center (3, 2), t = (0.5, 0, 0)
  folder.write("calib.txt", std::string("P2: 10 0 3 5 0 10 2 0 0 0 1 0\n") + kTr);
  EXPECT_TRUE(contains(failureOf(arguments), "image_2/000000.png: cannot be read as an image"));
  fs::create_directory(folder / "image_2");
  for (const char* name : {"image_2/000000.png", "image_2/000001.png"})
    cv::imwrite((folder / name).string(), cv::Mat(4, 6, CV_8UC3, cv::Scalar(10, 20, 30)));
  ASSERT_EQ(dataset2rawlog(arguments).status, 0);

  RawlogReader reader(out);
  std::size_t pictures = 0, clouds = 0;
  while (const auto entry = reader.next())
    for (const auto& o : entry->observations) {
      if (const auto* cloud = dynamic_cast<const CObservationLabeledCloud*>(o.get())) {
        EXPECT_TRUE(cloud->cloud.classes.empty());
        ++clouds;
      }
      const auto* picture = dynamic_cast<const mrpt::obs::CObservationImage*>(o.get());
      if (!picture) continue;
      ++pictures;
      EXPECT_EQ(picture->cameraParams.ncols, 6u);
      EXPECT_EQ(picture->cameraParams.cx(), 3);
      // The LiDAR's point (5, 0, -1) is (0.1, 1.2, 5.3) in the first camera, t further in this one.
      mrpt::math::TPoint3D p;
      picture->cameraPose.inverseComposePoint(5, 0, -1, p.x, p.y, p.z);
      EXPECT_LT((Vector3d(p.x, p.y, p.z) - Vector3d(0.6, 1.2, 5.3)).norm(), 1e-6);
      EXPECT_TRUE(fs::exists(folder / "out_Images" / picture->image.getExternalStorageFile()));
    }
  EXPECT_EQ(pictures, 2u);
  EXPECT_EQ(clouds, 2u);
}

TEST(SemanticKitti, framesAreChosenByNumber) {
  const TemporaryFolder folder;
  writeSmallKitti(folder);
  const ClassTable table = loadClassTable(folder / "classes.yaml");
  const auto timesWith = [&](const std::string& frames) {
    std::vector<double> times;
    for (const auto& s : convertAndRead(kittiArguments(folder) + " --frames " + frames,
                                        folder / "out.rawlog", table))
      times.push_back(mrpt::Clock::toDouble(s.scan.timestamp));
    return times;
  };
  EXPECT_EQ(timesWith("0:2:9").size(), 1u);
  EXPECT_NEAR(timesWith("1:2:").at(0), 0.15, 1e-6);
  EXPECT_EQ(timesWith("0:1:1").size(), 2u);
  const auto failure = [&](const std::string& frames) {
    return failureOf(kittiArguments(folder) + " --frames " + frames + " " + quoted(folder / "x"));
  };
  EXPECT_TRUE(contains(failure("0:0:3"), "--frames 0:0:3: STEP must be 1 or more"));
  EXPECT_TRUE(contains(failure("3:1:2"), "LAST is before FIRST"));
  EXPECT_TRUE(contains(failure("1-2"), "expected FIRST:STEP:LAST"));
  EXPECT_TRUE(contains(failure("7:1:9"), "no frame was selected"));
}

TEST(SemanticKitti, badInputIsNamedAndTheOldRawlogStays) {
  const auto failureWith = [](const std::string& file, const std::string& text) {
    const TemporaryFolder folder;
    writeSmallKitti(folder);
    folder.write("out.rawlog", "old");
    folder.write(file, text);
    const std::string failure = kittiFailure(folder);
    EXPECT_EQ(folder.read("out.rawlog"), "old");
    EXPECT_FALSE(fs::exists(folder / "out.rawlog.tmp"));
    EXPECT_TRUE(contains(failure, file)) << failure;
    return failure;
  };
  const std::string label = "labels/000001.label", points = "velodyne/000001.bin";
  EXPECT_TRUE(
      contains(failureWith(label, bytesOf<std::uint32_t>({40, 10})), "2 labels for 3 points"));
  EXPECT_TRUE(contains(failureWith(label, bytesOf<std::uint32_t>({40, 10, 1234})),
                       "point 2: raw class id 1234 is not in the class table"));
  EXPECT_TRUE(contains(failureWith(points, "seventeen bytes.."), "17 bytes, expected a multiple"));
  EXPECT_TRUE(contains(failureWith(points, ""), "0 bytes"));
  EXPECT_TRUE(contains(failureWith("calib.txt", "P0: 1 2 3\n"), "no line 'Tr:'"));
  EXPECT_TRUE(
      contains(failureWith("calib.txt", "Tr: 1 2 3\n"), ":1: expected 12 numbers, found 3"));
  EXPECT_TRUE(contains(failureWith("calib.txt", "Tr: 2 0 0 0 0 1 0 0 0 0 1 0\n"), "no rotation"));
  EXPECT_TRUE(
      contains(failureWith("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 x 0 0 0 1 0 0 0 0 1 0\n"),
               ":2: expected a number, found 'x'"));
  EXPECT_TRUE(contains(failureWith("times.txt", "0\n"), "1 times for 2 poses"));
  EXPECT_TRUE(contains(failureWith("classes.yaml", "classes: []"), "1 to 254 classes"));
}

TEST(SemanticKitti, missingFilesAreNamed) {
  for (const char* file : {"labels/000001.label", "velodyne/000000.bin", "calib.txt", "poses.txt",
                           "times.txt", "classes.yaml"}) {
    const TemporaryFolder folder;
    writeSmallKitti(folder);
    fs::remove(folder / file);
    EXPECT_TRUE(contains(kittiFailure(folder), file));
  }
}

TEST(SemanticKitti, scansOfRealStreetsFallIntoPlaceAndOnlyWithTheCalibration) {
  SKIP_WITHOUT_DATA("semantic_kitti");
  const ClassTable table = loadClassTable(shippedTable("semantic_kitti.yaml"));
  const std::string classes = " --classes " + quoted(shippedTable("semantic_kitti.yaml"));
  for (const char* name : {"00", "07"}) {
    const TemporaryFolder folder;
    const fs::path real = sharedDataDir() / "semantic_kitti" / name;
    const auto scans =
        convertAndRead("semantic-kitti " + quoted(real) + classes, folder / "a.rawlog", table);
    ASSERT_EQ(scans.size(), 10u);
    const double right = agreement(scans, 0.2);
    EXPECT_GE(right, 0.975) << name;

    for (const char* part : {"velodyne", "labels", "poses.txt", "times.txt"})
      fs::create_symlink(fs::absolute(real / part), folder / part);
    folder.write("calib.txt", "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
    const double wrong =
        agreement(convertAndRead("semantic-kitti " + quoted(folder.path()) + classes,
                                 folder / "b.rawlog", table),
                  0.2);
    EXPECT_LT(wrong, right - 0.02) << name;
    std::cout << name << ": " << right << ", without Tr " << wrong << "\n";
  }
}

// -------------------------------------------------------------------------------- label noise

TEST(LabelNoise, replacesThatShareByOtherClassesTheSameForASeed) {
  const TemporaryFolder folder;
  writeSmallKitti(folder);
  const std::size_t n = 30000;
  std::vector<float> points;
  std::vector<std::uint32_t> labels;
  for (std::size_t i = 0; i < n; ++i) {
    points.insert(points.end(), {1, 2, 3, 0});
    labels.push_back(std::array{40, 70, 10, 0}[i % 4]);
  }
  folder.write("velodyne/000000.bin", bytesOf(points));
  folder.write("labels/000000.label", bytesOf(labels));
  const ClassTable table = loadClassTable(folder / "classes.yaml");
  const auto classesWith = [&](const std::string& options) {
    return convertAndRead(kittiArguments(folder) + " --frames 0:1:0 " + options,
                          folder / "out.rawlog", table)
        .at(0)
        .scan.cloud.classes;
  };
  const auto clean = classesWith(""), noisy = classesWith("--label-noise 0.3 --seed 5");
  EXPECT_EQ(noisy, classesWith("--label-noise 0.3 --seed 5"));
  EXPECT_NE(noisy, classesWith("--label-noise 0.3 --seed 6"));

  std::map<std::pair<int, int>, double> changes;  // (before, after)
  for (std::size_t i = 0; i < n; ++i) ++changes[{clean[i], noisy[i]}];
  EXPECT_EQ((changes[{0, 0}]), n / 4.0);
  for (const int before : {1, 2, 3})
    for (const int after : {1, 2, 3})
      EXPECT_NEAR((changes[{before, after}]) / (n / 4.0), before == after ? 0.7 : 0.15, 0.02);
}

TEST(LabelNoise, badSharesAreNamed) {
  const TemporaryFolder folder;
  writeSmallKitti(folder);
  EXPECT_TRUE(
      contains(failureOf(kittiArguments(folder) + " --label-noise 1.5 " + quoted(folder / "x")),
               "--label-noise 1.5"));
}

// ---------------------------------------------------------------------------------------- TUM

namespace {

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

TEST(Tum, depthImagesWithPixelLabelsLandRightInTheWorld) {
  const TemporaryFolder folder;
  writeSmallTum(folder);
  expectSmallTum(convertAndRead(tumArguments(folder), folder / "out.rawlog",
                                loadClassTable(folder / "classes.yaml")));
  const auto all = observationsOf(folder / "out.rawlog");
  const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(all.at(1));
  ASSERT_TRUE(scan && scan->hasRangeImage && scan->hasPixelLabels() && scan->hasIntensityImage);
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kCols; ++c)
      for (const int channel : {0, 1, 2})
        EXPECT_EQ(scan->intensityImage.at<std::uint8_t>(c, r, channel), colorOf(r, c)[channel]);
}

TEST(Tum, withMoreThan64ClassesTheyAreLabeledClouds) {
  const TemporaryFolder folder;
  writeSmallTum(folder);
  folder.write("classes.yaml", hundredClasses());
  expectSmallTum(convertAndRead(tumArguments(folder), folder / "out.rawlog",
                                loadClassTable(folder / "classes.yaml")));
  EXPECT_TRUE(std::dynamic_pointer_cast<CObservationLabeledCloud>(
      observationsOf(folder / "out.rawlog").at(1)));
}

TEST(Tum, labelsCanBeLeftOutThenNoTableIsNeeded) {
  const TemporaryFolder folder;
  writeSmallTum(folder);
  fs::remove(folder / "label.txt");
  const auto scans = convertAndRead("tum --no-labels " + quoted(folder.path()),
                                    folder / "out.rawlog", ClassTable());
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[0].scan.counts.points, 40u);
  EXPECT_TRUE(scans[0].scan.labelsMissing);
  EXPECT_TRUE(contains(failureOf("tum " + quoted(folder.path()) + " " + quoted(folder / "x")),
                       "--classes is required"));
}

TEST(Tum, framesWithoutAPoseOrALabelImageAreSkippedAndReported) {
  const TemporaryFolder folder;
  writeSmallTum(folder);
  folder.write("depth.txt", "1.0 depth/a.png\n1.5 depth/a.png\n2.0 depth/b.png\n9 depth/b.png\n");
  const RunResult result =
      dataset2rawlog(tumArguments(folder) + " " + quoted(folder / "out.rawlog"));
  EXPECT_EQ(result.status, 0);
  EXPECT_TRUE(contains(result.output, ": 2 scans, 80 points, 75.0 % with a class"))
      << result.output;
  EXPECT_TRUE(contains(result.output, "2 frames skipped")) << result.output;
}

TEST(Tum, badInputIsNamed) {
  const auto failureWith = [](const std::string& file, const std::string& text) {
    const TemporaryFolder folder;
    writeSmallTum(folder);
    folder.write(file, text);
    const std::string failure =
        failureOf(tumArguments(folder) + " " + quoted(folder / "out.rawlog"));
    EXPECT_TRUE(contains(failure, file)) << failure;
    EXPECT_FALSE(fs::exists(folder / "out.rawlog"));
    return failure;
  };
  failureWith("depth/a.png", "no image");
  failureWith("label/b.png", "no image");
  failureWith("rgb/b.png", "no image");
  const std::string noCamera = failureWith("camera.ini", "[CAMERA_PARAMS]\n");
  EXPECT_FALSE(contains(noCamera, "stack")) << noCamera;
  EXPECT_TRUE(contains(failureWith("depth.txt", "1.0\n"), "depth.txt:1: expected 'time file'"));
  EXPECT_TRUE(contains(failureWith("depth.txt", "# none\n"), "no image in this list"));
  EXPECT_TRUE(contains(failureWith("groundtruth.txt", "1 2 3\n"), "groundtruth.txt:1"));
}

TEST(Tum, framesOfARealFlatAgreeWithEachOther) {
  SKIP_WITHOUT_DATA("replica_apartment_0");
  const TemporaryFolder folder;
  const ClassTable table = loadClassTable(shippedTable("replica_apartment.yaml"));
  const auto scans = convertAndRead("tum " + quoted(sharedDataDir() / "replica_apartment_0") +
                                        " --frames 0:5:20 --classes " +
                                        quoted(shippedTable("replica_apartment.yaml")),
                                    folder / "out.rawlog", table);
  ASSERT_EQ(scans.size(), 5u);
  EXPECT_GE(agreement(scans, 0.05), 0.98);

  // The same through depth images and a folder of label images.
  const fs::path flat = sharedDataDir() / "replica_apartment_0";
  const RunResult plain = dataset2rawlog("tum --no-labels --frames 0:5:20 " + quoted(flat) + " " +
                                         quoted(folder / "plain.rawlog"));
  ASSERT_EQ(plain.status, 0) << plain.output;
  const auto labels = std::make_shared<LabelFolder>(flat / "label", table);
  const auto same = readScans(folder / "plain.rawlog", table, labels);
  ASSERT_EQ(same.size(), 5u);
  for (std::size_t s = 0; s < 5; ++s) {
    EXPECT_EQ(same[s].scan.cloud.classes, scans[s].scan.cloud.classes);
    EXPECT_EQ(same[s].scan.cloud.points, scans[s].scan.cloud.points);
  }
}

// ---------------------------------------------------------------------------------------- PCD

namespace {

const char* const kPcdHead =
    "# .PCD v0.7\nVERSION 0.7\nFIELDS intensity x y z label\nSIZE 4 4 4 4 4\nTYPE F F F F U\n"
    "COUNT 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
    "VIEWPOINT 1 2 3 0.70710678 0 0 0.70710678\nPOINTS 2\nDATA ascii\n";

}  // namespace

TEST(Pcd, pointsComeBackInTheWorldAndTheSensorIsAtTheViewpoint) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.pcd", std::string(kPcdHead) + "9 5 6 7 3 -1\n9 1 2 3.5 0\n");
  ClassTable table;
  for (const char* name : {"a", "b", "c"}) table.add(name, {});
  const auto scans =
      convertAndRead("pcd " + quoted(file) + " " + quoted(file), folder / "out.rawlog", table);
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_LT((scans[1].inMap(0) - Vector3d(5, 6, 7)).norm(), 1e-5);
  // turned left by 90 degrees at (1, 2, 3): 4 m to its right is what lies 4 m ahead in the world
  EXPECT_LT((scans[1].scan.cloud.points[0] - Eigen::Vector3f(4, -4, 4)).norm(), 1e-5);
  EXPECT_EQ(scans[0].scan.cloud.classes, (std::vector<ClassId>{3, 0}));
}

TEST(Pcd, aClassTableFoldsTheLabels) {
  const TemporaryFolder folder;
  folder.write("classes.yaml", kThreeClasses);
  const auto file = folder.write("a.pcd", std::string(kPcdHead) + "9 5 6 7 252\n9 1 2 4 70\n");
  const auto scans =
      convertAndRead("pcd --classes " + quoted(folder / "classes.yaml") + " " + quoted(file),
                     folder / "out.rawlog", loadClassTable(folder / "classes.yaml"));
  EXPECT_EQ(scans.at(0).scan.cloud.classes, (std::vector<ClassId>{3, 2}));
}

TEST(Pcd, badInputIsNamed) {
  const auto failureWith = [](const std::string& text) {
    const TemporaryFolder folder;
    const auto file = folder.write("a.pcd", text);
    const std::string failure =
        failureOf("pcd " + quoted(file) + " " + quoted(folder / "out.rawlog"));
    EXPECT_TRUE(contains(failure, "a.pcd")) << failure;
    return failure;
  };
  const std::string head = kPcdHead;
  EXPECT_TRUE(contains(failureWith(head + "9 5 6 7 3\n"), "1 lines of data for 2 points"));
  EXPECT_TRUE(contains(failureWith(head + "9 5 6 7 3\n9 5 6\n"), "a.pcd:13"));
  EXPECT_TRUE(contains(failureWith(head + "9 5 6 7 3\n9 5 x 7 3\n"), "a.pcd:13"));
  EXPECT_TRUE(contains(failureWith(head + "9 5 6 7 3\n9 5 6 7 255\n"), "label 255 is not one of"));
  EXPECT_TRUE(contains(failureWith(head + "9 5 6 7 3\n9 5 6 7 -1\n"), "no class id"));
  EXPECT_TRUE(
      contains(failureWith("FIELDS x y z\nPOINTS 1\nDATA ascii\n1 2 3\n"), "no field 'label'"));
  EXPECT_TRUE(contains(failureWith("FIELDS x y z label\nPOINTS 1\nDATA binary\n"), "DATA ascii"));
  EXPECT_TRUE(contains(failureWith("nothing\n"), "no FIELDS"));
  EXPECT_TRUE(contains(failureOf("pcd only_one"), "expected FILE... and then OUT.rawlog"));
}

TEST(Pcd, realOnesKeepTheirWorldCoordinates) {
  SKIP_WITHOUT_DATA("sim_unstructured");
  const TemporaryFolder folder;
  ClassTable table;
  for (const char* name : {"a", "b", "c"}) table.add(name, {});
  const auto file = sharedDataDir() / "sim_unstructured/sim_unstructured_annotated_1.pcd";
  const auto scans = convertAndRead("pcd " + quoted(file), folder / "out.rawlog", table);
  ASSERT_EQ(scans.at(0).scan.counts.labeled, 3394u);
  EXPECT_LT((scans[0].inMap(0) - Vector3d(1.3917038, 1.4300275, 0.19733357)).norm(), 1e-5);
  EXPECT_NEAR(scans[0].T_map_robot.x(), 0.999984, 1e-6);
}

// ---------------------------------------------------------------------------- stock MRPT tools

TEST(StockRawlogEdit, readsTheRawlogs) {
  if (runCommand("which rawlog-edit").status != 0) GTEST_SKIP() << "needs Debian's mrpt-apps";
  const TemporaryFolder folder;
  writeSmallKitti(folder);
  const auto rawlog = folder / "out.rawlog";
  ASSERT_EQ(dataset2rawlog(kittiArguments(folder) + " " + quoted(rawlog)).status, 0);
  const RunResult info = runCommand("rawlog-edit --info -i " + quoted(rawlog) + " -p " +
                                    quoted(fs::path(MSO_LIB_DIR) / "libmso_labeled_cloud.so"));
  EXPECT_EQ(info.status, 0) << info.output;
  EXPECT_TRUE(contains(info.output, "Overall number of objects         : 4")) << info.output;
  EXPECT_TRUE(contains(info.output, "velodyne")) << info.output;
}
