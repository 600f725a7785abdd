#include <gtest/gtest.h>

#include "PackedScan.h"

using namespace semantic_octree;

namespace {

TEST(PackedScan, hasTheReliabilityOfLabelsAsPartOfWhatAScanSawInEachTile) {
  const auto scanOfTwoTiles = [](const LabelReliability& labels) {
    PackedScan scan(false, labels);
    for (const std::uint64_t code : {3, 8}) {
      scan.beginTile(code).push_back(1);
      scan.endTile();
    }
    return scan;
  };
  const PackedScan scan = scanOfTwoTiles({0.9, 0.5});
  EXPECT_EQ(differingTiles(scan, scanOfTwoTiles({0.9, 0.5})), TileCodes());
  EXPECT_EQ(differingTiles(scan, scanOfTwoTiles({0.9, 0.4})), (TileCodes{3, 8}));
}

}  // namespace
