// Classes of cells that stand for many voxels, free ones among them.
#include <gtest/gtest.h>
#include <map_operations/MapOperations.h>
#include <semantic_abstraction/Abstraction.h>

#include <cmath>

#include "Voxels.h"

using namespace semantic_octree;

namespace {

constexpr int kNamedClasses = 3;  // all of them are named: nothing is truncated

SemanticOcTree smallMap() {
  SemanticOcTree map(0.2, numberedClasses(kNamedClasses));
  InsertionOptions insertion;
  insertion.maxRange = 9;
  for (const PosedCloud& s : scansOfSmallPlace(4, 4000, kNamedClasses, 6))
    map.insert(s.cloud, s.T_map_sensor, insertion);
  return map;
}

/** By cell of 2^levels voxels: sum of the distributions of the voxels in which labels were seen. */
std::map<VoxelId, std::vector<double>> labeledSums(const SemanticOcTree& map, unsigned levels) {
  std::map<VoxelId, std::vector<double>> sums;
  for (const auto& [id, p] : voxelsOf(map)) {
    if (map.query(keyOf(id)).likeliestClass == kNoClass) continue;
    const VoxelId cell = {id[0] >> levels, id[1] >> levels, id[2] >> levels};
    auto& sum = sums.emplace(cell, std::vector<double>(kNamedClasses + 1)).first->second;
    for (int k = 1; k <= kNamedClasses; ++k) sum[k] += p[k];
  }
  return sums;
}

/** p(class | occupied) of a node. */
std::vector<double> givenOccupied(const SemanticOcTree& map, const SemanticOcTree::Node& node) {
  std::vector<double> p = map.distribution(node);
  for (int k = 1; k <= kNamedClasses; ++k) p[k] /= 1 - p[0];
  return p;
}

void expectShares(const std::vector<double>& sum, const std::vector<double>& p) {
  const double all = sum[1] + sum[2] + sum[3];
  for (int k = 1; k <= kNamedClasses; ++k)
    EXPECT_NEAR(p[k], sum[k] / all, 5e-4) << "class " << k;  // the grid
}

AbstractionOptions keepingPosts() {
  AbstractionOptions options;
  options.weights.terms = {tree_abstraction::relevant("posts", 1.0, {1})};
  options.weights.alpha = 0.02;
  options.blockSize = 3.2;
  return options;
}

}  // namespace

TEST(CompressedClasses, ofACompressedCellAreThoseOfItsVoxelsInWhichLabelsWereSeen) {
  SemanticOcTree map = smallMap();
  setAbstraction(map, keepingPosts());
  const Abstraction abstraction(map);
  const SemanticOcTree compressed = abstraction.compressedMap();
  std::map<unsigned, std::map<VoxelId, std::vector<double>>> sums;
  for (unsigned levels = 0; levels <= 4; ++levels) sums[levels] = labeledSums(map, levels);
  int merged = 0;
  for (const LeafCell& leaf : abstraction.leaves()) {
    const auto levels = static_cast<unsigned>(kTreeDepth - leaf.depth);
    const VoxelId id = voxelAt(leaf.key()[0], leaf.key()[1], leaf.key()[2]);
    const auto sum = sums.at(levels).find({id[0] >> levels, id[1] >> levels, id[2] >> levels});
    const CellState state = compressed.query(leaf.key());
    EXPECT_EQ(state.likeliestClass != kNoClass, sum != sums.at(levels).end());
    if (state.likeliestClass == kNoClass) continue;
    expectShares(sum->second, givenOccupied(compressed, *compressed.search(leaf.key())));
    EXPECT_EQ(state.occupancy, map.query(leaf.key(), leaf.depth).occupancy);
    merged += levels > 0;
  }
  EXPECT_GT(merged, 50);
}

TEST(CompressedClasses, ofACoarsenedVoxelAreThoseOfItsVoxelsInWhichLabelsWereSeen) {
  const SemanticOcTree map = smallMap(), coarse = coarsened(map, 2);
  for (const auto& [cell, sum] : labeledSums(map, 2))
    expectShares(sum, givenOccupied(coarse, *coarse.search(keyOf(cell))));
}

TEST(CompressedClasses, areThoseThatAreBelievedWhateverIsStated) {
  SemanticOcTree map = smallMap();
  setAbstraction(map, keepingPosts());
  SemanticOcTree before = map;
  map.setCalibration({0.6, 0.2});
  SemanticOcTree again = map;
  setAbstraction(again, keepingPosts());
  EXPECT_TRUE(again == before);  // its G-values, too
  const SemanticOcTree compressed = Abstraction(map).compressedMap();
  EXPECT_TRUE(compressed == Abstraction(before).compressedMap());
  EXPECT_TRUE(compressed.filterParameters().calibration.isIdentity());
}
