#include <gtest/gtest.h>
#include <map_view/CellSource.h>
#include <map_view/LiveCompression.h>

#include <algorithm>
#include <cmath>

#include "RandomMap.h"

namespace {

using map_view::LiveCompression;
using semantic_octree::SemanticOcTree;
using Node = semantic_octree::SemanticOcTreeNode;
using Distribution = std::vector<double>;  // free space, the classes, unknown space

constexpr double kBlock = 1.6;  // m: voxels of 0.2 m, 8 to an edge
constexpr int kBlockDepth = 13;

double h(double p) {
  const auto part = [](double x) { return x > 0 ? -x * std::log(x) : 0; };
  return part(p) + part(1 - p);
}

/** The definitions, from the map's leaves. */
class Definition {
 public:
  Definition(const SemanticOcTree& map, const LiveCompression& live) : m_map(map), m_live(live) {}

  Distribution distribution(const Node& node) const {
    Distribution p(std::size_t(m_map.numClasses()) + 2, 0.0);
    if (!node) {
      p.back() = 1;
    } else if (node.isLeaf()) {
      const std::vector<double> known = m_map.distribution(node);
      std::copy(known.begin(), known.end(), p.begin());
    } else {
      for (int i = 0; i < 8; ++i) {
        const Distribution child = distribution(node.child(i));
        for (std::size_t k = 0; k < p.size(); ++k) p[k] += child[k] / 8;
      }
    }
    return p;
  }
  double divergence(const Node& node, std::size_t k) const {
    double js = h(distribution(node)[k]);
    for (int i = 0; i < 8; ++i) js -= h(distribution(node.child(i))[k]) / 8;
    return js;
  }
  double gain(const Node& node) const {
    double sum = 0;
    for (std::size_t t = 0; t < m_live.numTerms(); ++t)
      sum += m_live.weight(t) * divergence(node, classOf(t));
    return sum;
  }
  double ofChildren(const Node& node) const {
    double sum = 0;
    for (int i = 0; i < 8; ++i) sum += gValue(node.child(i)) / 8;
    return sum;
  }
  double gValue(const Node& node) const {
    if (!node || node.isLeaf()) return 0;
    return std::max(0.0, gain(node) - m_live.alpha() * std::log(8) + ofChildren(node));
  }
  /** What a block's inner nodes tell of what is relevant, and what those tell that are expanded. */
  struct Relevant {
    double all = 0, kept = 0;
  };
  void addRelevant(const Node& node, double share, bool isAboveExpanded, Relevant& sums) const {
    if (!node || node.isLeaf()) return;
    double told = 0;
    for (std::size_t t = 0; t < m_live.numTerms(); ++t)
      told += std::max(0.0, m_live.weight(t)) * divergence(node, classOf(t));
    const bool isExpanded = isAboveExpanded && gValue(node) > 1e-9;
    sums.all += share * told;
    if (isExpanded) sums.kept += share * told;
    for (int i = 0; i < 8; ++i) addRelevant(node.child(i), share / 8, isExpanded, sums);
  }
  /** A term's class; 0: free space. */
  std::size_t classOf(std::size_t term) const {
    return m_map.classes().find(m_live.name(term)).value_or(0);
  }

 private:
  const SemanticOcTree& m_map;
  const LiveCompression& m_live;
};

/** Inner nodes around a voxel, from the block's down. */
std::vector<Node> nodesAround(const SemanticOcTree& map, const Eigen::Array3i& key) {
  std::vector<Node> nodes;
  Node node = map.root();
  for (int depth = 0; node && !node.isLeaf(); ++depth) {
    if (depth >= kBlockDepth) nodes.push_back(node);
    const int bit = 15 - depth;
    node = node.child((key.x() >> bit & 1) | (key.y() >> bit & 1) << 1 | (key.z() >> bit & 1) << 2);
  }
  return nodes;
}

}  // namespace

TEST(Balances, AreThoseOfTheDefinitionsTermByTerm) {
  SemanticOcTree map = randomMap(61);
  semantic_octree::AbstractionOptions space;
  space.blockSize = kBlock;
  LiveCompression live(map, LiveCompression::allClasses(map, space));
  for (std::size_t t = 0; t < live.numTerms(); ++t) live.setWeight(t, 0.3 + 0.4 * double(t));
  const Definition expected(map, live);
  int expanded = 0, all = 0;
  for (const double alpha : {0.0005, 0.05, 0.2, 0.4}) {
    live.setAlpha(alpha);
    for (const semantic_types::ClassId id : {1, 2, 3}) {
      const Eigen::Array3i key = voxelOfClass(map, id);
      const auto nodes = nodesAround(map, key);
      const auto balances = live.balancesAround(key);
      ASSERT_EQ(balances.size(), nodes.size());
      ASSERT_FALSE(nodes.empty());
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto& b = balances[i];
        for (std::size_t t = 0; t < live.numTerms(); ++t)
          EXPECT_NEAR(b.divergences.at(t), expected.divergence(nodes[i], expected.classOf(t)),
                      1e-6);
        EXPECT_NEAR(b.gain, expected.gain(nodes[i]), 1e-6);
        EXPECT_NEAR(b.splitEntropy, std::log(8), 1e-9);
        EXPECT_NEAR(b.ofChildren, expected.ofChildren(nodes[i]), 1e-6);
        EXPECT_NEAR(b.gValue, expected.gValue(nodes[i]), 1e-6);
        const bool aboveIs = i == 0 || live.isExpanded(balances[i - 1].node);
        EXPECT_EQ(live.isExpanded(b.node), aboveIs && b.gValue > 1e-9);
        expanded += live.isExpanded(b.node), ++all;
      }
    }
  }
  EXPECT_TRUE(live.balancesAround(Eigen::Array3i(1, 1, 1)).empty()) << "beside the map";
  EXPECT_GT(expanded, 0);
  EXPECT_LT(expanded, all);
}

TEST(Balances, ReachUpToTheRootWhereTheFrameIsCharged) {
  SemanticOcTree map = randomMap(62);
  semantic_octree::AbstractionOptions space;
  space.frame = semantic_octree::AbstractionOptions::Frame::Charged;
  LiveCompression live(map, LiveCompression::allClasses(map, space));
  const auto balances = live.balancesAround(voxelOfClass(map, 1));
  EXPECT_EQ(balances.size(), 16u);
  EXPECT_EQ(balances.front().node, 0);
  EXPECT_EQ(live.isExpanded(0), balances.front().gValue > 0);
}

TEST(Balances, OfABlockItsShareOfWhatIsRelevantIsRetained) {
  SemanticOcTree map = randomMap(64);
  semantic_octree::AbstractionOptions space;
  space.blockSize = kBlock;
  LiveCompression live(map, LiveCompression::allClasses(map, space));
  live.setWeight(1, -0.2);
  int between = 0;
  const double low = live.lowestAlpha(), high = live.highestAlpha();
  for (double at = 0.5; at < 1; at += 0.01) {
    const double alpha = low * std::pow(high / low, at);
    live.setAlpha(alpha);
    for (const semantic_types::ClassId id : {1, 2, 3}) {
      const Eigen::Array3i key = voxelOfClass(map, id);
      Definition::Relevant sums;
      Definition(map, live).addRelevant(nodesAround(map, key).front(), 1, true, sums);
      ASSERT_GT(sums.all, 0);
      const float retained =
          live.retainedAround(map_view::CellSource(map, &live).at(key).around);
      EXPECT_NEAR(retained, sums.kept / sums.all, 1e-5) << alpha << ' ' << int(id);
      between += retained > 0.01f && retained < 0.99f;
    }
  }
  EXPECT_GT(between, 5);
}

TEST(Balances, WhatIsRetainedIsGreenAndWhatIsLostRed) {
  SemanticOcTree map = randomMap(65);
  LiveCompression live(map, LiveCompression::allClasses(map));
  const map_view::CellSource cells(map, &live);
  map_view::CellLook look(map);
  map_view::ViewStyle style;
  style.coloring = map_view::ViewColoring::Retained;
  look.setStyle(style);
  const auto colorAt = [&](double alpha) {
    live.setAlpha(alpha);
    return look.colorOf(cells.at(voxelOfClass(map, 1)));
  };
  const semantic_types::Color green{0, 215, 30}, red{235, 0, 30};
  EXPECT_EQ(colorAt(10), green) << "of the full map all is there";
  look.setCompression(&live);
  EXPECT_EQ(colorAt(0), green);
  EXPECT_EQ(colorAt(10), red);
}
