#include <gtest/gtest.h>
#include <map_view/CellSource.h>
#include <map_view/LiveCompression.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/TreeFile.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "RandomMap.h"
#include "TemporaryFolder.h"

namespace {

using map_view::KeyBox;
using map_view::LiveCompression;
using semantic_octree::Abstraction;
using semantic_octree::AbstractionOptions;
using semantic_octree::LeafCell;
using semantic_octree::SemanticOcTree;

std::size_t termNamed(const LiveCompression& live, const std::string& name) {
  std::size_t term = 0;
  while (live.name(term) != name) ++term;
  return term;
}

std::set<CubeId> leavesOf(const SemanticOcTree& map, const LiveCompression& live) {
  map_view::CellLook look(map);
  map_view::ViewStyle style;
  style.freeSpace = true;
  look.setStyle(style);
  std::set<CubeId> leaves;
  map_view::CellSource(map, &live).forEachShown(
      KeyBox::everything(), semantic_octree::kTreeDepth, look, [&](const map_view::ViewCell& cell) {
        EXPECT_TRUE(leaves.insert(cubeOf(cell.lowest, cell.depth)).second);
      });
  return leaves;
}

/** With G-values: of a solution with its terms alone, as semantic-map-compress finds it. */
std::set<CubeId> leavesOfSolution(SemanticOcTree map, const AbstractionOptions& solution) {
  const semantic_octree::TermCatalog catalog(map.classes(), {solution});
  AbstractionOptions options = solution;
  options.weights.terms = catalog.terms({});
  setAbstraction(map, options);
  Abstraction abstraction(map);
  abstraction.setWeights(catalog.weights(solution), solution.weights.alpha);
  std::set<CubeId> leaves;
  for (const LeafCell& leaf : abstraction.leaves()) leaves.insert(cubeOf(leaf.lowest, leaf.depth));
  return leaves;
}

bool isIn(const CubeId& cube, const std::vector<KeyBox>& boxes) {
  const auto [x, y, z, depth] = cube;
  for (const KeyBox& box : boxes)
    if (box.meets({{x, y, z}, depth})) return true;
  return false;
}

/** The trees of all alphas; there are nodes above the blocks, which all of them expand. */
tree_abstraction::AlphaPath pathOf(const LiveCompression& live) {
  std::vector<double> taus;
  for (LiveCompression::Index node = 0; node < live.size(); ++node)
    if (std::isfinite(live.alphaOf(node))) taus.push_back(live.alphaOf(node));
  return tree_abstraction::AlphaPath(std::move(taus));
}

TEST(LiveCompression, CountsTheLeavesOfItsTree) {
  SemanticOcTree map = randomMap(51);
  LiveCompression live(map, LiveCompression::allClasses(map));
  std::size_t before = map.getNumLeafNodes() + 1;
  for (const double alpha : {0.0, 1e-4, 0.003, 0.02, 0.3, 10.0}) {
    live.setAlpha(alpha);
    EXPECT_EQ(live.numLeaves(), leavesOf(map, live).size()) << alpha;
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
  LiveCompression live(map, LiveCompression::allClasses(map));
  for (const std::size_t wanted : {100u, 700u, 3000u}) {
    live.setLeaves(wanted);
    EXPECT_LE(live.numLeaves(), wanted);
    EXPECT_GT(live.numLeaves(), wanted / 2);
    EXPECT_EQ(live.numLeaves(), leavesOf(map, live).size());
  }
  live.setLeaves(1);
  EXPECT_GE(live.numLeaves(), 1u);
  live.setLeaves(100'000'000);
  EXPECT_LE(live.numLeaves(), map.getNumLeafNodes());
}

TEST(LiveCompression, IsTheMapThatGValuesLeadTo) {
  SemanticOcTree map = randomMap(59), other = map;
  LiveCompression live(map, LiveCompression::allClasses(map));
  AbstractionOptions options;
  options.weights.terms = live.solution().weights.terms;
  options.weights.alpha = 0.004;
  live.setAlpha(0.004);
  setAbstraction(other, options);
  const SemanticOcTree expected = Abstraction(other).compressedMap();
  EXPECT_TRUE(live.compressedMap(map) == expected);
  EXPECT_LT(expected.getNumLeafNodes(), map.getNumLeafNodes());
}

TEST(LiveCompression, FindsTheTreeOfAWantedNumberOfBytes) {
  SemanticOcTree map = randomMap(60);
  LiveCompression live(map, LiveCompression::allClasses(map));
  const auto bytes = [&] { return semantic_octree::fileSize(live.compressedMap(map)); };
  live.setBytes(map, 10'000'000);
  const std::size_t most = bytes();
  for (const double share : {0.8, 0.3}) {
    const auto wanted = std::size_t(share * double(most));
    live.setBytes(map, wanted);
    EXPECT_LE(bytes(), wanted);
    const std::size_t leaves = live.numLeaves();
    // The next larger tree takes more.
    const auto path = pathOf(live);
    std::size_t k = 0;
    while (path.alpha(k) > live.alpha()) ++k;
    live.setAlpha(path.alpha(k + 1));
    EXPECT_GT(live.numLeaves(), leaves);
    EXPECT_GT(bytes(), wanted);
  }
  live.setBytes(map, 1);
  EXPECT_EQ(live.alpha(), pathOf(live).alpha(0)) << "the smallest one";
}

TEST(LiveCompression, HasTheLeavesOfItsSolutionAlone) {
  const SemanticOcTree original = randomMap(53);
  std::mt19937 random(54);
  for (const double blockSize : {AbstractionOptions().blockSize, 1.6}) {
    SemanticOcTree map = original;
    AbstractionOptions space;
    space.blockSize = blockSize;
    LiveCompression live(map, LiveCompression::allClasses(map, space));
    for (int i = 0; i < 8; ++i) {
      const std::size_t term = random() % live.numTerms();
      live.setWeight(term, 0.25 * double(random() % 13) - 1);
      live.setAlpha(i == 0 ? 5.0 : 1e-3 * double(1 + random() % 40));
      const auto leaves = leavesOf(map, live);
      EXPECT_EQ(leaves, leavesOfSolution(original, live.solution())) << i;
      EXPECT_EQ(live.numLeaves(), leaves.size()) << i;
    }
  }
}

TEST(LiveCompression, RetainsWhatGValuesSay) {
  SemanticOcTree map = randomMap(58), other = map;
  LiveCompression live(map, LiveCompression::allClasses(map));
  live.setLeaves(500);
  const semantic_octree::TermCatalog catalog(map.classes(), {LiveCompression::allClasses(map)});
  AbstractionOptions options;
  options.weights.terms = catalog.terms({});
  setAbstraction(other, options);
  Abstraction abstraction(other);
  abstraction.setWeights(catalog.weights(live.solution()), live.alpha());
  const auto measures = abstraction.measures();
  const auto retained = live.retained();
  ASSERT_EQ(retained.size(), live.numTerms());
  for (std::size_t term = 0; term < retained.size(); ++term) {
    ASSERT_TRUE(retained[term] && measures.retention(term)) << live.name(term);
    EXPECT_NEAR(*retained[term], *measures.retention(term), 1e-9) << live.name(term);
    EXPECT_LT(*retained[term], 1);
  }
}

TEST(LiveCompression, TellsWhereLeavesCameAndWent) {
  SemanticOcTree map = randomMap(55);
  LiveCompression live(map, LiveCompression::allClasses(map));
  EXPECT_EQ(live.takeChange().size(), 1u) << "all of it";
  EXPECT_TRUE(live.takeChange().empty());
  const auto check = [&](const auto& change) {
    const auto before = leavesOf(map, live);
    change();
    const auto after = leavesOf(map, live);
    const std::vector<KeyBox> boxes = live.takeChange();
    std::set<CubeId> differ;
    std::set_symmetric_difference(before.begin(), before.end(), after.begin(), after.end(),
                                  std::inserter(differ, differ.end()));
    EXPECT_FALSE(differ.empty());
    for (const CubeId& cube : differ) ASSERT_TRUE(isIn(cube, boxes));
    for (const KeyBox& box : boxes) {
      const auto isHere = [&](const CubeId& cube) { return isIn(cube, {box}); };
      ASSERT_TRUE(std::any_of(differ.begin(), differ.end(), isHere));
    }
  };
  for (const double alpha : {0.1, 0.0005, 0.02}) check([&] { live.setAlpha(alpha); });
  check([&] { live.setWeight(termNamed(live, "wall"), 0.1); });
  EXPECT_TRUE(live.takeChange().empty());
}

TEST(LiveCompression, RefusesContradictionsAndStaysAsItWas) {
  SemanticOcTree map = randomMap(56);
  AbstractionOptions solution;
  solution.weights = {{{"ground", 1, {{1, 2}}}}, 0.002};
  LiveCompression live(map, solution);
  const std::size_t road = termNamed(live, "road");
  EXPECT_EQ(live.weight(road), 0);
  const auto before = leavesOf(map, live);
  EXPECT_NE(errorOf([&] { live.setWeight(road, -1); }), "");
  EXPECT_EQ(live.weight(road), 0);
  EXPECT_EQ(leavesOf(map, live), before);
  live.setWeight(termNamed(live, "wall"), -1);
  EXPECT_NE(errorOf([&] { live.setAlpha(-1); }), "");
  EXPECT_EQ(live.alpha(), 0.002);
  SemanticOcTree empty(0.2, threeClasses());
  EXPECT_EQ(errorOf([&] { LiveCompression(empty, {}); }), "the map is empty");
}

using semantic_octree::Region;

std::vector<AbstractionOptions> readAgain(const AbstractionOptions& solution) {
  const auto classes = threeClasses();
  return semantic_octree::weightsOfText(map_view::weightsText(solution, classes), "it", classes);
}

AbstractionOptions someSolution() {
  AbstractionOptions solution;
  solution.name = "view";
  solution.weights.alpha = 0.1 + 0.2;  // more digits than a stream writes
  solution.weights.terms = {{"free_space", 1.0 / 3, {{0}}},
                            {"road", -0.7, {{1}}},
                            {"high things", 2, {{2, 3}}},
                            {"everything", 0.125, {{0}, {1}, {2}, {3}}}};
  return solution;
}

}  // namespace

TEST(WeightsText, IsReadAgainToTheLastBit) {
  const AbstractionOptions solution = someSolution();
  const std::vector<AbstractionOptions> all = readAgain(solution);
  ASSERT_EQ(all.size(), 1u);
  const AbstractionOptions& read = all[0];
  EXPECT_EQ(read.name, "view");
  EXPECT_EQ(read.weights.alpha, solution.weights.alpha);
  ASSERT_EQ(read.weights.terms.size(), solution.weights.terms.size());
  for (const auto& term : solution.weights.terms) {
    bool found = false;
    for (const auto& other : read.weights.terms)
      if (other.name == term.name) {
        found = true;
        EXPECT_EQ(other.weight, term.weight) << term.name;
        EXPECT_EQ(other.groups, term.groups) << term.name;
      }
    EXPECT_TRUE(found) << term.name;
  }
}

TEST(WeightsText, HasHowSpaceCounts) {
  AbstractionOptions space = someSolution();
  space.unknown = AbstractionOptions::Unknown::Uniform;
  space.blockSize = 0.1 + 0.7;
  Region box, sphere, corridor;
  box.a = {-1, -2.5, 0}, box.b = {1, 2, 3}, box.weight = 4;
  sphere.shape = Region::Shape::Sphere, sphere.a = {1, 2, 3}, sphere.radius = 2;
  corridor.shape = Region::Shape::Corridor, corridor.b = {9, 0, 0}, corridor.radius = 0.5;
  space.regions = {box, sphere, corridor};
  const AbstractionOptions read = readAgain(space).at(0);
  EXPECT_EQ(read.unknown, space.unknown);
  EXPECT_EQ(read.blockSize, space.blockSize);
  ASSERT_EQ(read.regions.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(read.regions[i].shape, space.regions[i].shape);
    EXPECT_EQ(read.regions[i].a, space.regions[i].a);
    EXPECT_EQ(read.regions[i].b, space.regions[i].b);
    EXPECT_EQ(read.regions[i].radius, space.regions[i].radius);
    EXPECT_EQ(read.regions[i].weight, space.regions[i].weight);
  }
}

TEST(WeightsText, IsRefusedWhereNothingHasAWeight) {
  AbstractionOptions solution = someSolution();
  for (auto& term : solution.weights.terms) term.weight = 0;
  EXPECT_NE(errorOf([&] { map_view::weightsText(solution, threeClasses()); }), "");
}
