#include <gtest/gtest.h>
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CObservationImage.h>
#include <semantic_types/ClassTable.h>

#include <algorithm>
#include <array>
#include <map>
#include <opencv2/imgcodecs.hpp>

#include "ConvertedScans.h"
#include "SharedData.h"
#include "TemporaryFolder.h"

using namespace labeled_cloud;
using namespace semantic_types;
using Eigen::Vector3d;
using semantic_types::ClassId;
using semantic_types::ClassTable;
namespace fs = std::filesystem;

namespace {

using NoisyLabels = FolderTest;
using SemanticKitti = FolderTest;

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
  return failureOf(kittiArguments(folder) + " -f -o " + quoted(folder / "out.rawlog"));
}

}  // namespace

TEST_F(SemanticKitti, posesAreThoseOfTheLidarAndClassesThoseOfTheTable) {
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

TEST_F(SemanticKitti, imagesComeAlongAsFilesAndLabelsCanBeLeftOut) {
  writeSmallKitti(folder);
  const fs::path out = folder / "out.rawlog";
  const std::string arguments =
      "semantic-kitti " + quoted(folder.path()) + " --no-labels --images -o " + quoted(out);
  // P2 = K [I | t] with f = 10, center (3, 2), t = (0.5, 0, 0)
  folder.write("calib.txt", std::string("P2: 10 0 3 5 0 10 2 0 0 0 1 0\n") + kTr);
  EXPECT_TRUE(contains(failureOf(arguments), "image_2/000000.png: there is no such file"));
  fs::create_directory(folder / "image_2");
  for (const char* name : {"image_2/000000.png", "image_2/000001.png"})
    cv::imwrite(path(name), cv::Mat(4, 6, CV_8UC3, cv::Scalar(10, 20, 30)));
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

TEST_F(SemanticKitti, framesAreChosenByNumber) {
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
    return failureOf(kittiArguments(folder) + " --frames " + frames + " -o " +
                     quoted(folder / "x"));
  };
  EXPECT_TRUE(contains(failure("0:0:3"), "--frames 0:0:3: STEP must be 1 or more"));
  EXPECT_TRUE(contains(failure("3:1:2"), "LAST is before FIRST"));
  EXPECT_TRUE(contains(failure("1-2"), "expected FIRST:STEP:LAST"));
  EXPECT_TRUE(contains(failure("7:1:9"), "no frame was selected"));
}

TEST_F(SemanticKitti, badInputIsNamedAndTheOldRawlogStays) {
  const std::string label = "labels/000001.label", points = "velodyne/000001.bin",
                    pose = "1 0 0 0 0 1 0 0 0 0 1 0\n", kGone = "gone";
  for (const auto& [file, text, message] : std::vector<std::array<std::string, 3>>{
           {label, bytesOf<std::uint32_t>({40, 10}), "2 labels for 3 points"},
           {label, bytesOf<std::uint32_t>({40, 10, 1234}),
            "point 2: raw class id 1234 is not in the class table"},
           {points, "seventeen bytes..", "17 bytes, expected a multiple"},
           {points, "", "0 bytes"},
           {"calib.txt", "P0: 1 2 3\n", "no line 'Tr:'"},
           {"calib.txt", "Tr: 1 2 3\n", ":1: expected 12 numbers, found 3"},
           {"calib.txt", "Tr: 2 0 0 0 0 1 0 0 0 0 1 0\n", "no rotation"},
           {"poses.txt", pose + "1 x 0 0 0 1 0 0 0 0 1 0\n", ":2: expected a number, found 'x'"},
           {"times.txt", "0\n", "1 times for 2 poses"},
           {"classes.yaml", "classes: []", "1 to 254 classes"},
           {label, kGone, label},
           {"velodyne/000000.bin", kGone, "000000.bin"},
           {"calib.txt", kGone, "calib.txt"},
           {"poses.txt", kGone, "poses.txt"},
           {"times.txt", kGone, "times.txt"},
           {"classes.yaml", kGone, "classes.yaml"}}) {
    const TemporaryFolder fresh;
    writeSmallKitti(fresh);
    fresh.write("out.rawlog", "old");
    fresh.write(file, text);
    if (text == kGone) fs::remove(fresh / file);
    const std::string failure = kittiFailure(fresh);
    EXPECT_EQ(fresh.read("out.rawlog"), "old");
    EXPECT_TRUE(contains(failure, file) && contains(failure, message)) << failure;
  }
}

TEST_F(SemanticKitti, posesMayBeInKittisOwnFolder) {
  writeSmallKitti(folder);
  const ClassTable table = loadClassTable(folder / "classes.yaml");
  convertAndRead(kittiArguments(folder), folder / "a.rawlog", table);
  const fs::path sequence = folder / "sequences/07";
  fs::create_directories(sequence);
  fs::create_directories(folder / "poses");
  for (const char* part : {"velodyne", "labels", "calib.txt", "times.txt"})
    fs::rename(folder / part, sequence / part);
  fs::rename(folder / "poses.txt", folder / "poses/07.txt");
  convertAndRead(
      "semantic-kitti " + quoted(sequence) + " --classes " + quoted(folder / "classes.yaml"),
      folder / "b.rawlog", table);
  EXPECT_EQ(folder.read("a.rawlog"), folder.read("b.rawlog"));
}

TEST_F(SemanticKitti, scansOfRealStreetsFallIntoPlaceAndOnlyWithTheCalibration) {
  SKIP_WITHOUT_DATA("semantic_kitti");
  const ClassTable table = loadClassTable(shippedTable("semantic_kitti.yaml"));
  const std::string classes = " --classes " + quoted(shippedTable("semantic_kitti.yaml"));
  for (const char* name : {"00", "07"}) {
    const TemporaryFolder fresh;
    const fs::path real = sharedDataDir() / "semantic_kitti" / name;
    const auto scans =
        convertAndRead("semantic-kitti " + quoted(real) + classes, fresh / "a.rawlog", table);
    ASSERT_EQ(scans.size(), 10u);
    const double right = agreement(scans, 0.2);
    EXPECT_GE(right, 0.975) << name;

    for (const char* part : {"velodyne", "labels", "poses.txt", "times.txt"})
      fs::create_symlink(fs::absolute(real / part), fresh / part);
    fresh.write("calib.txt", "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
    const double wrong =
        agreement(convertAndRead("semantic-kitti " + quoted(fresh.path()) + classes,
                                 fresh / "b.rawlog", table),
                  0.2);
    EXPECT_LT(wrong, right - 0.02) << name;
    std::cout << name << ": " << right << ", without Tr " << wrong << "\n";
  }
}

TEST_F(NoisyLabels, replacesThatShareByOtherClassesTheSameForASeed) {
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

TEST_F(NoisyLabels, blobsAreWrongAsAWholeAndPersistentOnesInAllScans) {
  writeSmallKitti(folder);
  // Things of 7 mm, farther apart than blobs are large.
  std::vector<float> points;
  std::vector<std::uint32_t> labels;
  for (int cube = 0; cube < 4000; ++cube)
    for (int i = 0; i < 8; ++i) {
      points.insert(points.end(), {5 + 7.123f * float(cube % 20) + 0.001f * float(i),
                                   7.123f * float(cube / 20 % 20), 7.123f * float(cube / 400), 0});
      labels.push_back(40);
    }
  folder.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0\n");
  folder.write("times.txt", "0\n1\n");
  for (const char* frame : {"000000", "000001"}) {
    folder.write(std::string("velodyne/") + frame + ".bin", bytesOf(points));
    folder.write(std::string("labels/") + frame + ".label", bytesOf(labels));
  }
  const ClassTable table = loadClassTable(folder / "classes.yaml");
  for (const bool persistent : {false, true}) {
    const auto scans =
        convertAndRead(kittiArguments(folder) + " --label-noise 0.3 --seed 2 --label-noise-kind " +
                           (persistent ? "persistent" : "blobs"),
                       folder / "out.rawlog", table);
    const auto& a = scans.at(0).scan.cloud.classes;
    const auto& b = scans.at(1).scan.cloud.classes;
    int wrong = 0, both = 0, split = 0;
    for (std::size_t i = 0; i < a.size(); i += 8) {
      wrong += a[i] != 1;
      both += a[i] != 1 && b[i] != 1;
      split += std::any_of(&a[i], &a[i] + 8, [&](auto label) { return label != a[i]; });
    }
    EXPECT_LT(split, 60);  // where a border crosses one
    const double share = wrong / 4000.0;
    EXPECT_GT(share, 0.3 / 4 - 0.03);
    EXPECT_LT(share, 0.3 * 7 / 4 + 0.03);
    if (persistent)
      EXPECT_GT(both / 4000.0, share / 2);
    else
      EXPECT_NEAR(both / 4000.0, share * share, 0.03);
  }
}
