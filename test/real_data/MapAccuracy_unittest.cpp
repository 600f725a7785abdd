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

TEST(MapAccuracy, evenImagesOfAFlatAnswerTheOddOnes) {
  SKIP_WITHOUT_DATA("replica_apartment_0");
  const auto frames = readReplica(sharedDataDir() / "replica_apartment_0", 55);
  SemanticOcTree map(0.05, shippedTable("replica_apartment.yaml"));
  for (std::size_t i = 0; i < frames.size(); i += 2)
    map.insert(frames[i].cloud, frames[i].T_map_sensor);
  MapQuality quality;
  for (std::size_t i = 1; i < frames.size(); i += 2) judge(map, frames[i], HUGE_VAL, quality);
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
