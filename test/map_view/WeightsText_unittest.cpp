#include <gtest/gtest.h>
#include <map_view/LiveCompression.h>

#include "RandomMap.h"
#include "TemporaryFolder.h"

namespace {

using semantic_octree::AbstractionOptions;
using semantic_octree::Region;
using semantic_octree::Solution;
using semantic_octree::WeightsFile;

WeightsFile readAgain(const Solution& solution, const AbstractionOptions& space) {
  const TemporaryFolder folder;
  const auto classes = threeClasses();
  return semantic_octree::loadWeights(
      folder.write("weights.yaml", map_view::weightsText(solution, space, classes)), classes);
}

Solution someSolution() {
  Solution solution;
  solution.name = "view";
  solution.alpha = 0.1 + 0.2;  // more digits than a stream writes
  solution.terms = {{"free_space", 1.0 / 3, {{0}}},
                    {"road", -0.7, {{1}}},
                    {"high things", 2, {{2, 3}}},
                    {"everything", 0.125, {{0}, {1}, {2}, {3}}}};
  return solution;
}

}  // namespace

TEST(WeightsText, IsReadAgainToTheLastBit) {
  const Solution solution = someSolution();
  const WeightsFile file = readAgain(solution, {});
  ASSERT_EQ(file.solutions.size(), 1u);
  const Solution& read = file.solutions[0];
  EXPECT_EQ(read.name, "view");
  EXPECT_EQ(*read.alpha, *solution.alpha);
  ASSERT_EQ(read.terms.size(), solution.terms.size());
  for (const auto& term : solution.terms) {
    bool found = false;
    for (const auto& other : read.terms)
      if (other.name == term.name) {
        found = true;
        EXPECT_EQ(other.weight, term.weight) << term.name;
        EXPECT_EQ(other.groups, term.groups) << term.name;
      }
    EXPECT_TRUE(found) << term.name;
  }
}

TEST(WeightsText, HasHowSpaceCounts) {
  AbstractionOptions space;
  space.unknown = AbstractionOptions::Unknown::Uniform;
  space.blockSize = 0.1 + 0.7;
  Region box, sphere, corridor;
  box.a = {-1, -2.5, 0}, box.b = {1, 2, 3}, box.weight = 4;
  sphere.shape = Region::Shape::Sphere, sphere.a = {1, 2, 3}, sphere.radius = 2;
  corridor.shape = Region::Shape::Corridor, corridor.b = {9, 0, 0}, corridor.radius = 0.5;
  space.regions = {box, sphere, corridor};
  const AbstractionOptions read = readAgain(someSolution(), space).space;
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
  Solution solution = someSolution();
  for (auto& term : solution.terms) term.weight = 0;
  EXPECT_NE(errorOf([&] { map_view::weightsText(solution, {}, threeClasses()); }), "");
}
