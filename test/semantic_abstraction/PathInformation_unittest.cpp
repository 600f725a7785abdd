#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>

#include <numeric>

#include "SmallScans.h"

using namespace semantic_octree;

namespace {

constexpr int kPathClasses = 6;

AbstractionOptions optionsWith(double blockSize, AbstractionOptions::Frame frame) {
  AbstractionOptions o;
  o.weights.terms = {tree_abstraction::relevant("posts", 1.0, {1}),
                     tree_abstraction::irrelevant("ground", 0.3, {2, 3}),
                     tree_abstraction::wholeClassVariable("everything", 0.05, kPathClasses)};
  o.blockSize = blockSize;
  o.frame = frame;
  return o;
}

SemanticOcTree smallMap(const AbstractionOptions& options) {
  SemanticOcTree map(0.2, numberedClasses(kPathClasses));
  setAbstraction(map, options);
  InsertionOptions insertion;
  insertion.maxRange = 9;
  for (const PosedCloud& s : scansOfSmallPlace(3, 2000, kPathClasses, 5))
    map.insert(s.cloud, s.T_map_sensor, insertion);
  return map;
}

double weighted(const std::vector<double>& weights, const std::vector<double>& information) {
  return std::inner_product(weights.begin(), weights.end(), information.begin(), 0.0);
}

}  // namespace

TEST(PathInformation, isThatOfTheCompressedTreeOfEachAlphaForAnyWeights) {
  using Frame = AbstractionOptions::Frame;
  for (const double blockSize : {0.0, 0.8, 3.2})
    for (const Frame frame : {Frame::Free, Frame::Charged}) {
      SemanticOcTree map = smallMap(optionsWith(blockSize, frame));
      Abstraction abstraction(map);
      const Abstraction::Path path = abstraction.alphaPath();
      for (const std::vector<double>& weights :
           {std::vector<double>{1, 0, 0}, {0, 0.3, 0}, {0.5, 2, 0.1}}) {
        const auto information = abstraction.pathInformation(weights);
        const auto along = path.trees.totals(information.added, information.ofRoots);
        const std::size_t last = along.size() - 1;
        for (std::size_t k = 0; k <= last; k += 1 + last / 7) {
          abstraction.setAlpha(path.trees.alpha(k));
          EXPECT_NEAR(along[k], weighted(weights, abstraction.measures().compressed.information),
                      1e-12 * along[last])
              << "block " << blockSize << ", tree " << k << " of " << last;
        }
        EXPECT_NEAR(std::accumulate(information.added.begin(), information.added.end(),
                                    information.ofRoots),
                    weighted(weights, abstraction.measures().full.information),
                    1e-12 * along[last]);
      }
    }
}

TEST(PathInformation, isToldNodeByNodeToo) {
  using Frame = AbstractionOptions::Frame;
  for (const Frame frame : {Frame::Free, Frame::Charged}) {
    SemanticOcTree map = smallMap(optionsWith(0.8, frame));
    const Abstraction abstraction(map);
    const std::vector<double> weights = {0.5, 2, 0.1};
    const auto expected = abstraction.pathInformation(weights);
    const Abstraction::Path path = abstraction.alphaPath();
    double ofRoots = 0;
    std::size_t i = 0;
    int depthBefore = -1;
    abstraction.forEachPathNode([&](const Abstraction::PathNode& n, const auto& information) {
      EXPECT_LE(n.depth, depthBefore + 1) << "below one that was told, or beside it";
      depthBefore = n.depth;
      if (n.isFree) {
        ofRoots += weighted(weights, information);
        return;
      }
      ASSERT_LT(i, expected.added.size());
      EXPECT_NEAR(weighted(weights, information), expected.added[i], 1e-15);
      EXPECT_EQ(n.addedLeaves, path.addedLeaves[i]);
      EXPECT_GE(n.price, 0);
      ++i;
    });
    EXPECT_EQ(i, expected.added.size());
    EXPECT_NEAR(ofRoots, expected.ofRoots, 1e-12);
  }
}

TEST(PathInformation, isNoneWhereNothingIsKnownOrCounts) {
  const AbstractionOptions options = optionsWith(0.8, AbstractionOptions::Frame::Free);
  SemanticOcTree empty(0.2, numberedClasses(kPathClasses));
  setAbstraction(empty, options);
  EXPECT_TRUE(Abstraction(empty).pathInformation({1, 1, 1}).added.empty());
  SemanticOcTree map = smallMap(options);
  Abstraction abstraction(map);
  const double far = 1e4;
  abstraction.setRegions({{Region::Shape::Box, {-far, -far, -far}, {far, far, far}, 0, 0}});
  const auto information = abstraction.pathInformation({1, 1, 1});
  EXPECT_EQ(information.ofRoots, 0);
  EXPECT_EQ(information.added, std::vector<double>(abstraction.alphaPath().addedLeaves.size()));
}

TEST(PathInformation, asksForAsManyWeightsAsTerms) {
  SemanticOcTree map = smallMap(optionsWith(0.8, AbstractionOptions::Frame::Free));
  EXPECT_THROW(Abstraction(map).pathInformation({1, 1}), std::invalid_argument);
}
