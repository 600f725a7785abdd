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
  const auto frames = readReplica(sharedDataDir() / "replica_apartment_0", 55);
  const MapQuality quality =
      splitQuality(frames, shippedTable("replica_apartment.yaml"), kReplicaResolution, HUGE_VAL);
  EXPECT_GE(quality.accuracy(), 0.98);
  EXPECT_GE(quality.coverage(), 0.92);
}

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
