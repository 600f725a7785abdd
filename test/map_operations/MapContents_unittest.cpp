#include <gtest/gtest.h>
#include <map_operations/MapOperations.h>

#include "RandomScans.h"

using namespace semantic_octree;

namespace {

constexpr int kClasses = 5;

SemanticOcTree randomMap() {
  SemanticOcTree tree(0.3, numberedClasses(kClasses));
  std::mt19937 random(7);
  for (int i = 0; i < 6; ++i) {
    const PosedCloud scan = randomScan(random);
    tree.insert(scan.cloud, scan.T_map_sensor);
  }
  return tree;
}

}  // namespace

TEST(MapContents, countsAgreeWithAskingEveryVoxelOfTheBox) {
  const SemanticOcTree tree = randomMap();
  const MapContents contents = contentsOf(tree);
  MapContents asked;
  asked.voxelsOfClass.assign(kClasses + 1, 0);
  const auto first = tree.coordToKey(contents.box.min().x() + 0.1, contents.box.min().y() + 0.1,
                                     contents.box.min().z() + 0.1);
  const Eigen::Array3i size = (contents.box.sizes().array() / 0.3).round().cast<int>();
  for (int x = 0; x < size.x(); ++x)
    for (int y = 0; y < size.y(); ++y)
      for (int z = 0; z < size.z(); ++z) {
        const CellState state =
            tree.query(octomap::OcTreeKey(first[0] + x, first[1] + y, first[2] + z));
        asked.freeVoxels += state.status == CellState::Status::Free;
        if (state.status != CellState::Status::Occupied) continue;
        ++asked.occupiedVoxels;
        ++asked.voxelsOfClass[state.likeliestClass];
      }
  EXPECT_EQ(contents.freeVoxels, asked.freeVoxels);
  EXPECT_EQ(contents.occupiedVoxels, asked.occupiedVoxels);
  EXPECT_EQ(contents.voxelsOfClass, asked.voxelsOfClass);
  EXPECT_GT(contents.voxelsOfClass[0], 0u);
  EXPECT_EQ(contents.leaves, tree.getNumLeafNodes());
  EXPECT_EQ(contents.leaves + contents.innerNodes, tree.size());
}

TEST(MapContents, anEmptyMapHoldsNothing) {
  const MapContents contents = contentsOf(SemanticOcTree(0.3, numberedClasses(2)));
  EXPECT_EQ(contents.leaves + contents.innerNodes, 0u);
  EXPECT_EQ(contents.voxelsOfClass, std::vector<std::uint64_t>(3, 0));
  EXPECT_TRUE(contents.box.isEmpty());
}
