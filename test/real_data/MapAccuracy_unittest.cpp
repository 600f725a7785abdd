// How well maps with the default parameters answer real data that they were not made from.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "CountedLabels.h"
#include "DataSets.h"
#include "MapQuality.h"
#include "RunProgram.h"
#include "SharedData.h"
#include "TemporaryFolder.h"

using semantic_octree::CellState;

namespace {

constexpr double kKittiResolution = 0.2, kKittiRange = 25, kReplicaResolution = 0.05;

/** Makes a map of the even frames and asks it for the points of the odd ones. */
MapQuality splitQuality(const std::vector<LabeledFrame>& frames, const ClassTable& table,
                        double resolution, double range) {
  SemanticOcTree map(resolution, table);
  for (std::size_t i = 0; i < frames.size(); i += 2)
    map.insert(frames[i].cloud, frames[i].T_map_sensor);
  MapQuality quality;
  for (std::size_t i = 1; i < frames.size(); i += 2) judge(map, frames[i], range, quality);
  return quality;
}

MapQuality kittiQuality(const std::string& sequence) {
  const ClassTable table = shippedTable("semantic_kitti.yaml");
  const auto frames = readSemanticKitti(sharedDataDir() / "semantic_kitti" / sequence, table);
  return splitQuality(frames, table, kKittiResolution, kKittiRange);
}

/** Right answers of a map and of counting, from the same labels to the same points. */
struct NoisyQuality {
  std::size_t points = 0, right = 0, rightCounted = 0;
  double accuracy() const { return static_cast<double>(right) / static_cast<double>(points); }
  double countedAccuracy() const {
    return static_cast<double>(rightCounted) / static_cast<double>(points);
  }
};

/** Even frames with 30 % of wrong labels are asked for the true classes of the odd ones' points. */
NoisyQuality noisyQuality(const std::vector<LabeledFrame>& frames, const ClassTable& table,
                          double resolution) {
  SemanticOcTree map(resolution, table);
  CountedLabels counted;
  std::mt19937 random(1);
  for (std::size_t i = 0; i < frames.size(); i += 2) {
    LabeledFrame noisy = frames[i];
    disturb(noisy.cloud.classes, 0.3, table.size(), random);
    map.insert(noisy.cloud, noisy.T_map_sensor);
    for (std::size_t k = 0; k < noisy.cloud.size(); ++k)
      counted.add(voxelOf(map, noisy, k), noisy.cloud.classes[k]);
  }
  NoisyQuality quality;
  for (std::size_t i = 1; i < frames.size(); i += 2)
    for (std::size_t k = 0; k < frames[i].cloud.size(); ++k) {
      const ClassId truth = frames[i].cloud.classes[k];
      if (truth == kNoClass || frames[i].isMoving(k)) continue;
      const Voxel voxel = voxelOf(map, frames[i], k);
      const CellState state = map.query(octomap::OcTreeKey(voxel[0], voxel[1], voxel[2]));
      if (state.status != CellState::Status::Occupied || counted.at(voxel) == kNoClass) continue;
      ++quality.points;
      quality.right += state.likeliestClass == truth;
      quality.rightCounted += counted.at(voxel) == truth;
    }
  return quality;
}

}  // namespace

TEST(MapAccuracy, evenScansOfAStreetAnswerTheOddOnes) {
  SKIP_WITHOUT_DATA("semantic_kitti");
  for (const char* sequence : {"00", "07"}) {
    const MapQuality quality = kittiQuality(sequence);
    EXPECT_GE(quality.accuracy(), 0.98) << sequence;
    EXPECT_GE(quality.coverage(), 0.90) << sequence;
    RecordProperty(std::string("accuracy_") + sequence, std::to_string(quality.accuracy()));
    RecordProperty(std::string("coverage_") + sequence, std::to_string(quality.coverage()));
  }
}

TEST(MapAccuracy, evenImagesOfAFlatAnswerTheOddOnes) {
  SKIP_WITHOUT_DATA("replica_apartment_0");
  const auto frames = readReplica(sharedDataDir() / "replica_apartment_0");
  const MapQuality quality =
      splitQuality(frames, shippedTable("replica_apartment.yaml"), kReplicaResolution, HUGE_VAL);
  EXPECT_GE(quality.accuracy(), 0.98);
  EXPECT_GE(quality.coverage(), 0.92);
}

TEST(MapAccuracy, theMapSeesThroughThirtyPercentOfWrongLabelsAsCountingDoes) {
  SKIP_WITHOUT_DATA("semantic_kitti");
  const ClassTable table = shippedTable("semantic_kitti.yaml");
  for (const char* sequence : {"00", "07"}) {
    const auto frames = readSemanticKitti(sharedDataDir() / "semantic_kitti" / sequence, table);
    for (const double resolution : {0.1, kKittiResolution}) {
      const NoisyQuality quality = noisyQuality(frames, table, resolution);
      EXPECT_GE(quality.accuracy(), quality.countedAccuracy() - 0.005)
          << sequence << " at " << resolution << " m";
      const std::string of = std::string("_") + sequence + (resolution < 0.2 ? "_fine" : "");
      RecordProperty("accuracy" + of, std::to_string(quality.accuracy()));
      RecordProperty("counted" + of, std::to_string(quality.countedAccuracy()));
    }
  }
}

namespace {

const std::filesystem::path kSources = MSO_SOURCE_DIR;

/** Pixels of this color, give or take the relief's shading (a factor on all three channels). */
int countColor(const cv::Mat& picture, const cv::Vec3d& bgr) {
  int pixels = 0;
  for (const cv::Vec3b& pixel : cv::Mat_<cv::Vec3b>(picture)) {
    const cv::Vec3d p(pixel);
    const double cosine = p.dot(bgr) / (cv::norm(p) * cv::norm(bgr) + 1e-9);
    pixels += cosine > 0.9995 && cv::norm(p) > 0.5 * cv::norm(bgr);
  }
  return pixels;
}

}  // namespace

TEST(StreetMap, theStreetFromAboveShowsRoadSidewalkCarsAndBuildings) {
  SKIP_WITHOUT_DATA("semantic_kitti");
  const TemporaryFolder folder;
  const std::string rawlog = (folder / "00.rawlog").string();
  succeeded(
      runProgram("dataset2rawlog",
                 {"semantic-kitti", (sharedDataDir() / "semantic_kitti/00").string(), "--classes",
                  (kSources / "config/classes/semantic_kitti.yaml").string(), "-o", rawlog}));
  succeeded(runProgram("rawlog2semantic-map",
                       {"--config", (kSources / "config/maps/semantic-kitti.ini").string(),
                        "--output", (folder / "out").string(), rawlog}));

  const auto summary = nlohmann::json::parse(folder.read("out/summary.json"));
  EXPECT_EQ(summary["observations"]["inserted"], 10);
  for (const char* name : {"road", "sidewalk", "car", "building", "vegetation"})
    EXPECT_GT(summary["map"]["voxelsPerClass"][name], 1000) << name;
  const cv::Mat top = cv::imread((folder / "out/top.png").string());
  EXPECT_GT(countColor(top, {255, 0, 255}), 5000);    // road
  EXPECT_GT(countColor(top, {75, 0, 75}), 2000);      // sidewalk
  EXPECT_GT(countColor(top, {245, 150, 100}), 2000);  // car
  EXPECT_GT(countColor(top, {0, 200, 255}), 2000);    // building
}
