#include <gtest/gtest.h>
#include <semantic_octree/TreeFile.h>

#include <nlohmann/json.hpp>

#include "MapQuality.h"
#include "RunProgram.h"
#include "SampleScans.h"
#include "TemporaryFolder.h"

namespace fs = std::filesystem;

TEST(SampleMap, theVillageIsMappedWithItsClasses) {
  const TemporaryFolder folder;
  const fs::path sources = MSO_SOURCE_DIR;
  const ProgramRun run =
      runProgram("rawlog2semantic-map",
                 {"--config", (sources / "config/maps/synthetic.ini").string(), "--output",
                  folder.path().string(), (sources / "rawlog-samples/village.rawlog").string()});
  ASSERT_EQ(run.status, 0) << run.errors;

  const auto summary = nlohmann::json::parse(folder.read("summary.json"));
  EXPECT_EQ(summary["observations"]["inserted"], 48);
  for (const char* name : {"road", "sidewalk", "grass", "canopy", "building", "roof"})
    EXPECT_GT(summary["map"]["voxelsPerClass"][name], 500) << name;

  const auto map = semantic_octree::loadTree((folder / "map.semantic").string());
  MapQuality quality;
  for (const LabeledFrame& frame : readSampleScans()) judge(map, frame, 25, quality);
  EXPECT_GT(quality.coverage(), 0.95);
  EXPECT_GT(quality.accuracy(), 0.93);  // 2 % of the labels are wrong
}
