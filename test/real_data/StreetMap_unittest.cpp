// The whole way of a real data set through the programs.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "RunProgram.h"
#include "SharedData.h"
#include "TemporaryFolder.h"

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
  const ProgramRun conversion =
      runProgram("dataset2rawlog",
                 {"semantic-kitti", (sharedDataDir() / "semantic_kitti/00").string(), "--classes",
                  (kSources / "config/classes/semantic_kitti.yaml").string(), "-o", rawlog});
  ASSERT_EQ(conversion.status, 0) << conversion.errors;
  const ProgramRun mapping = runProgram(
      "rawlog2semantic-map", {"--config", (kSources / "config/maps/semantic-kitti.ini").string(),
                              "--output", (folder / "out").string(), rawlog});
  ASSERT_EQ(mapping.status, 0) << mapping.errors;

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
