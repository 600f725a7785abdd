#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_types/ClassTable.h>

#include <cmath>
#include <random>

#include "../semantic_octree/SmallScans.h"
#include "CompressionOptions.h"
#include "DataSets.h"
#include "LeafObjective.h"
#include "SharedData.h"

using namespace semantic_octree;
using tree_abstraction::irrelevant;
using tree_abstraction::relevant;

namespace {

SemanticOcTree smallPlace() {
  SemanticOcTree map(0.2, numberedClasses(6));
  for (const PosedCloud& scan : scansOfSmallPlace(3, 4000, 6, 2))
    map.insert(scan.cloud, scan.T_map_sensor);
  setAbstraction(map,
                 optionsOf({relevant("posts", 1, {1}), irrelevant("ground", 0.4, {2, 3})}, 0.01));
  return map;
}

SemanticOcTree street() {
  const auto table = semantic_types::loadClassTable(std::filesystem::path(MSO_SOURCE_DIR) /
                                                    "config/classes/semantic_kitti.yaml");
  SemanticOcTree map(0.2, table);
  InsertionOptions options;
  options.minRange = 2.5;
  options.maxRange = 50;
  for (const LabeledFrame& frame : readSemanticKitti(sharedDataDir() / "semantic_kitti/00", table))
    map.insert(frame.cloud, frame.T_map_sensor, options);
  const int vegetation = *table.find("vegetation"), terrain = *table.find("terrain");
  setAbstraction(map, optionsOf({relevant("road", 1, {*table.find("road")}),
                                 irrelevant("greenery", 0.3, {vegetation, terrain})},
                                0.005));
  return map;
}

void expectObjectiveOfLeaves(SemanticOcTree map) {
  const LeafObjective tree(map);
  const auto& items = tree.items();
  const double best = Abstraction(map).objective();
  const auto optimal = [&](std::size_t i) { return items[i].isExpanded; };
  ASSERT_GT(best, 0);
  EXPECT_NEAR(tree.objective(optimal), best, 1e-9 * best);
}

void expectNoBetterTreeNextToIt(SemanticOcTree map) {
  const LeafObjective tree(map);
  const auto& items = tree.items();
  const auto optimal = [&](std::size_t i) { return items[i].isExpanded; };
  // Rounding of values that are sums of terms of at most p ln p.
  const auto rounding = [](const LeafObjective::Item& item) {
    return 1e-14 * item.weight * (1 - std::log(item.weight));
  };
  std::size_t collapses = 0, expansions = 0;
  const std::function<void(std::size_t)> visit = [&](std::size_t i) {
    if (items[i].children.empty()) return;
    double split = 0;
    if (items[i].isExpanded) {
      ++collapses;
      ASSERT_LT(tree.asLeaf(items[i]), tree.below(i, optimal) + rounding(items[i]));
      for (const std::size_t child : items[i].children) visit(child);
    } else {
      ++expansions;
      for (const std::size_t child : items[i].children) split += tree.asLeaf(items[child]);
      ASSERT_LT(split, tree.asLeaf(items[i]) + rounding(items[i]));
    }
  };
  for (const std::size_t block : tree.blocks()) visit(block);
  EXPECT_GT(collapses, 50u);
  EXPECT_GT(expansions, 50u);
}

void expectRandomTreesBelowIt(SemanticOcTree map) {
  const LeafObjective tree(map);
  const auto& items = tree.items();
  const double best = Abstraction(map).objective();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int trial = 0; trial < 20; ++trial) {
    // From the optimal tree with a few changes to a tree that has nothing to do with it.
    const double share = std::pow(0.5, trial), expansion = uniform(random);
    const auto changed = [&](std::size_t i) {
      return uniform(random) < share ? uniform(random) < expansion : items[i].isExpanded;
    };
    EXPECT_LE(tree.objective(changed), best * (1 + 1e-12)) << "share changed " << share;
  }
}

}  // namespace

TEST(OptimalityOfLeaves, objectiveOfTheLeavesOfASmallPlaceIsGAtTheRoot) {
  expectObjectiveOfLeaves(smallPlace());
}
TEST(OptimalityOfLeaves, noExpansionOrCollapseImprovesASmallPlace) {
  expectNoBetterTreeNextToIt(smallPlace());
}
TEST(OptimalityOfLeaves, randomTreesOfASmallPlaceAreNoBetter) {
  expectRandomTreesBelowIt(smallPlace());
}
TEST(OptimalityOfLeaves, objectiveOfTheLeavesOfARealStreetIsGAtTheRoot) {
  SKIP_WITHOUT_DATA("semantic_kitti/00");
  expectObjectiveOfLeaves(street());
}
TEST(OptimalityOfLeaves, noExpansionOrCollapseImprovesARealStreet) {
  SKIP_WITHOUT_DATA("semantic_kitti/00");
  expectNoBetterTreeNextToIt(street());
}
TEST(OptimalityOfLeaves, randomTreesOfARealStreetAreNoBetter) {
  SKIP_WITHOUT_DATA("semantic_kitti/00");
  expectRandomTreesBelowIt(street());
}
