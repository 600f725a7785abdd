#include <gtest/gtest.h>
#include <map_view/LiveCompression.h>

#include <set>
#include <tuple>

#include "RandomMap.h"
#include "TemporaryFolder.h"

namespace {

using map_view::LiveCompression;
using semantic_octree::Abstraction;
using semantic_octree::AbstractionOptions;
using semantic_octree::LeafCell;
using semantic_octree::SemanticOcTree;
using semantic_octree::Solution;

std::size_t termNamed(const LiveCompression& live, const std::string& name) {
  std::size_t term = 0;
  while (live.name(term) != name) ++term;
  return term;
}

using Cube = std::tuple<int, int, int, int>;

std::set<Cube> leavesOf(SemanticOcTree& map) {
  std::set<Cube> leaves;
  for (const LeafCell& leaf : Abstraction(map).leaves())
    leaves.insert({leaf.lowest().x(), leaf.lowest().y(), leaf.lowest().z(), int(leaf.depth)});
  return leaves;
}

/** What semantic-map-compress finds for a solution: with its terms alone. */
std::set<Cube> leavesOfSolution(SemanticOcTree map, const Solution& solution,
                                const AbstractionOptions& space) {
  const semantic_octree::TermCatalog catalog(map.classes(), {solution});
  AbstractionOptions options = space;
  options.weights.terms = catalog.terms(0);
  map.setAbstraction(options);
  Abstraction(map).setWeights(catalog.weights(solution, 0), *solution.alpha);
  return leavesOf(map);
}

}  // namespace

TEST(LiveCompression, CountsTheLeavesOfItsTree) {
  SemanticOcTree map = randomMap(51);
  LiveCompression live(map, LiveCompression::allClasses(map), {});
  std::size_t before = map.getNumLeafNodes() + 1;
  for (const double alpha : {0.0, 1e-4, 0.003, 0.02, 0.3, 10.0}) {
    live.setAlpha(alpha);
    EXPECT_EQ(live.numLeaves(), live.measures().compressed.numKnownLeaves) << alpha;
    EXPECT_LE(live.numLeaves(), before);
    before = live.numLeaves();
  }
  live.setAlpha(live.highestAlpha());
  EXPECT_EQ(live.numLeaves(), before) << "the tree of the roots";
  live.setAlpha(0.99 * live.highestAlpha());
  EXPECT_GT(live.numLeaves(), before);
  live.setAlpha(live.lowestAlpha() * 0.5);
  const std::size_t largest = live.numLeaves();
  live.setAlpha(0);
  EXPECT_EQ(live.numLeaves(), largest) << "below the lowest alpha nothing changes";
}

TEST(LiveCompression, FindsTheTreeOfAWantedNumberOfLeaves) {
  SemanticOcTree map = randomMap(52);
  LiveCompression live(map, LiveCompression::allClasses(map), {});
  for (const std::size_t wanted : {100u, 700u, 3000u}) {
    live.setLeaves(wanted);
    EXPECT_LE(live.numLeaves(), wanted);
    EXPECT_GT(live.numLeaves(), wanted / 2);
    EXPECT_EQ(live.numLeaves(), live.measures().compressed.numKnownLeaves);
  }
  live.setLeaves(1);
  EXPECT_GE(live.numLeaves(), 1u);
  live.setLeaves(100'000'000);
  EXPECT_LE(live.numLeaves(), map.getNumLeafNodes());
}

TEST(LiveCompression, HasTheLeavesOfItsSolutionAlone) {
  const SemanticOcTree original = randomMap(53);
  std::mt19937 random(54);
  SemanticOcTree map = original;
  LiveCompression live(map, LiveCompression::allClasses(map), {});
  for (int i = 0; i < 12; ++i) {
    const std::size_t term = random() % live.numTerms();
    live.setWeight(term, 0.25 * double(random() % 13) - 1);
    live.setAlpha(1e-3 * double(1 + random() % 40));
    EXPECT_EQ(leavesOf(map), leavesOfSolution(original, live.solution(), live.space())) << i;
    EXPECT_EQ(live.numLeaves(), live.measures().compressed.numKnownLeaves) << i;
  }
}

TEST(LiveCompression, TellsWhichLeavesCameAndWent) {
  SemanticOcTree map = randomMap(55);
  LiveCompression live(map, LiveCompression::allClasses(map), {});
  std::set<Cube> told;
  for (const double alpha : {0.002, 0.1, 0.0005, 0.0005}) {
    live.setAlpha(alpha);
    const auto change = live.takeChange();
    const auto cube = [](const LeafCell& leaf) {
      return Cube{leaf.lowest().x(), leaf.lowest().y(), leaf.lowest().z(), int(leaf.depth)};
    };
    for (const LeafCell& leaf : change.removed) EXPECT_EQ(told.erase(cube(leaf)), 1u);
    for (const LeafCell& leaf : change.added) told.insert(cube(leaf));
    EXPECT_EQ(told, leavesOf(map));
  }
}

TEST(LiveCompression, RefusesContradictionsAndStaysAsItWas) {
  SemanticOcTree map = randomMap(56);
  Solution solution;
  solution.name = "ground";
  solution.alpha = 0.002;
  solution.terms = {{"ground", 1, {{1, 2}}}};
  LiveCompression live(map, solution, {});
  const std::size_t road = termNamed(live, "road");
  EXPECT_EQ(live.weight(road), 0);
  const auto before = leavesOf(map);
  EXPECT_NE(errorOf([&] { live.setWeight(road, -1); }), "");
  EXPECT_EQ(live.weight(road), 0);
  EXPECT_EQ(leavesOf(map), before);
  live.setWeight(termNamed(live, "wall"), -1);
  EXPECT_NE(errorOf([&] { live.setAlpha(-1); }), "");
  EXPECT_EQ(live.alpha(), 0.002);
}

TEST(LiveCompression, OfAnEmptyMapIsRefused) {
  SemanticOcTree map(0.2, threeClasses());
  EXPECT_EQ(errorOf([&] { LiveCompression(map, {}, {}); }), "the map is empty");
}
