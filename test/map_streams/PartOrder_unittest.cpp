#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "AllAlphas.h"
#include "FirstTrees.h"
#include "StreamedMaps.h"
#include "TreeParts.h"

using namespace streamed_maps;

namespace {

/** By cell: the first tree of the alpha path that expands an inner node. */
std::map<CellPath, std::size_t> firstTrees(const Abstraction& abstraction,
                                           const tree_abstraction::AlphaPath& trees) {
  const auto first = firstTreesOf(trees);
  std::map<CellPath, std::size_t> byCell;
  std::size_t i = 0;
  abstraction.forEachPathNode([&](const Abstraction::PathNode& n, const auto&) {
    if (!n.isFree) byCell[CellPath::of(n)] = first[i++];
  });
  return byCell;
}

void expectTheOrderOfThePath(SemanticOcTree& map) {
  const Abstraction abstraction(map);
  const tree_abstraction::AlphaPath trees = AllAlphas(abstraction).trees;
  const auto first = firstTrees(abstraction, trees);
  const TreeParts parts = partsOfChange(map, nullptr);
  ASSERT_GT(parts.parts.size(), 10u);
  std::size_t octets = 0;
  std::pair<std::size_t, CellPath> before{0, {}};
  for (std::size_t i = 0; i < parts.parts.size(); ++i) {
    const TreePart part = parts.parts.part(i);
    const std::size_t tree = part.isOctet ? first.at(part.cell) : 0, step = parts.parts.step(i);
    octets += part.isOctet;
    EXPECT_EQ(step == 0, tree == 0);
    if (i > 0) {
      EXPECT_EQ(step == parts.parts.step(i - 1), tree == before.first);
      EXPECT_TRUE(before < std::pair(tree, part.cell));
    }
    before = {tree, part.cell};
    if (tree == trees.numTrees()) continue;
    EXPECT_EQ(parts.alphas[step], trees.alpha(tree));
    EXPECT_EQ(parts.ties[step], trees.highestAlpha(tree));
  }
  std::size_t expanded = 0;
  for (const auto& [cell, tree] : first) {
    const VoxelIndex lowest = VoxelIndex::NullaryExpr([&, c = cell](auto axis) {
      int key = 0;
      for (int depth = 1; depth <= c.depth; ++depth)
        key |= (c.childAt(depth) >> axis & 1) << (kTreeDepth - depth);
      return key;
    });
    const auto node = map.search(octomapKey(lowest.x(), lowest.y(), lowest.z()),
                                 static_cast<unsigned>(cell.depth));
    expanded += node && !node.isLeaf() && abstraction.isExpanded(node);
  }
  EXPECT_GE(expanded, octets);  // some are below one that is not expanded
  EXPECT_EQ(parts.alphas.back(), abstraction.options().weights.alpha);
}

StreamLeaf someLeaf(std::mt19937& random) {
  StreamLeaf leaf;
  leaf.kind = static_cast<StreamLeaf::Kind>(random() % 3);
  if (leaf.kind == StreamLeaf::Kind::None) return leaf;
  leaf.value = static_cast<Units>(random());
  if (leaf.kind == StreamLeaf::Kind::Plain) return leaf;
  leaf.record = {
      {static_cast<Units>(random()), -3, 4}, 5, {1, static_cast<ClassId>(random()), 3}, 3};
  return leaf;
}

}  // namespace

TEST(PartOrder, isThatOfTheAlphaPath) {
  for (const double alpha : {0.0, 1e-9, 0.0005})
    for (const auto frame : {AbstractionOptions::Frame::Free, AbstractionOptions::Frame::Charged})
      for (unsigned seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE(seed);
        AbstractionOptions options = someOptions(alpha);
        options.frame = frame;
        SemanticOcTree map = smallPlace(options, seed);
        expectTheOrderOfThePath(map);
      }
}

TEST(PartOrder, partsComeBackAsTheyWere) {
  std::mt19937 random(1);
  std::vector<std::tuple<std::size_t, std::size_t, bool, TreePart>> expected;
  PartList list;
  for (std::size_t i = 0; i < 30000; ++i) {
    TreePart part;
    part.cell = {random() % 4096, static_cast<int>(random() % 17)};
    part.isOctet = random() % 3 > 0;
    part.mask = part.isOctet ? static_cast<std::uint8_t>(1 + random() % 255) : 1;
    for (int leaf = 0; leaf < 8; ++leaf)
      if (part.mask >> leaf & 1) part.leaves[static_cast<std::size_t>(leaf)] = someLeaf(random);
    const std::size_t step = random() % 50;
    const bool begins = random() % 2;
    list.add(part, step, begins);
    expected.emplace_back(step, i, begins, part);
  }
  list.sort();
  std::sort(expected.begin(), expected.end(), [](const auto& a, const auto& b) {
    return std::pair(std::get<0>(a), std::get<1>(a)) < std::pair(std::get<0>(b), std::get<1>(b));
  });
  ASSERT_EQ(list.size(), expected.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto& [step, number, begins, part] = expected[i];
    const TreePart back = list.part(i);
    ASSERT_EQ(list.step(i), step);
    ASSERT_EQ(list.begins(i), begins);
    ASSERT_TRUE(back.cell == part.cell && back.isOctet == part.isOctet && back.mask == part.mask);
    ASSERT_TRUE(back.leaves == part.leaves);
  }
}
