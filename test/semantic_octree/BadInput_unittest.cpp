#include <gtest/gtest.h>

#include "PlainMap.h"
#include "RandomScans.h"
#include "TemporaryFolder.h"

using namespace semantic_octree;

namespace {

/** Expects that an insertion is refused, saying so, and that the map is what it was. */
void expectRefused(const std::string& words, const LabeledCloud& cloud,
                   const Eigen::Isometry3d& T_map_sensor = Eigen::Isometry3d::Identity(),
                   const InsertionOptions& options = {}) {
  SemanticOcTree tree(0.1, numberedClasses(3));
  LabeledCloud good;
  good.points = {{1.f, 2.f, 0.3f}};
  good.classes = {2};
  tree.insert(good, Eigen::Isometry3d::Identity());
  SemanticOcTree before = tree;
  const std::string error = errorOf([&] { tree.insert(cloud, T_map_sensor, options); });
  EXPECT_TRUE(contains(error, words)) << error;
  EXPECT_TRUE(tree == before);
  // Nothing of the refused scan may come up with the next one.
  tree.insert(good, Eigen::Isometry3d::Identity());
  before.insert(good, Eigen::Isometry3d::Identity());
  EXPECT_TRUE(tree == before);
}

LabeledCloud threePoints() {
  LabeledCloud cloud;
  cloud.points = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  return cloud;
}

Eigen::Isometry3d at(double x, double y, double z) {
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
  T_map_sensor.translation() << x, y, z;
  return T_map_sensor;
}

}  // namespace

TEST(BadInput, sensorOutsideTheMapIsRefused) {
  expectRefused("sensor at (4000, 0, 0) m", threePoints(), at(4000, 0, 0));
  expectRefused("outside the map", threePoints(), at(0, -3277, 0));
  expectRefused("outside the map", threePoints(), at(0, 0, 3276.8));
  expectRefused("not finite", threePoints(), at(0, 0, NAN));
  Eigen::Isometry3d twisted = at(0, 0, 0);
  twisted.linear()(0, 0) = INFINITY;
  expectRefused("the sensor's pose has numbers that are not finite", threePoints(), twisted);
}

TEST(BadInput, labelsThatCannotBeAreRefused) {
  LabeledCloud cloud = threePoints();
  cloud.classes = {1, 2};
  expectRefused("2 classes, expected 3", cloud);
  cloud.classes = {1, 3, 4};
  expectRefused("class 4", cloud);
  cloud.classes.clear();
  cloud.probabilities.assign(8, 0.1f);
  expectRefused("8 probabilities, expected 9", cloud);
  cloud.probabilities.push_back(0.1f);
  for (const float bad : {-0.1f, 1.5f, NAN}) {
    cloud.probabilities[7] = bad;
    expectRefused("probability", cloud);
  }
}

TEST(BadInput, scansThatNeedMoreMemoryThanThereIsOrThanAllowedAreRefused) {
  LabeledCloud cloud;
  cloud.points = {{3276, 3276, 3276}, {-3276, -3276, -3276}};
  expectRefused("too large", cloud);
  cloud.points = {{60, 60, 20}, {-60, -60, 0}};
  InsertionOptions options;
  options.maxScanMemory = 1;
  expectRefused("set max_range", cloud, at(0, 0, 0), options);
}

TEST(BadInput, insertionOptionsAreRefusedByName) {
  using O = InsertionOptions;
  const std::pair<void (*)(O&), const char*> faults[] = {
      {[](O& o) { o.maxRange = -1; }, "max_range is -1"},
      {[](O& o) { o.maxRange = NAN; }, "max_range"},
      {[](O& o) { o.minRange = 1e30; }, "min_range"},
      {[](O& o) { o.minRange = 5, o.maxRange = 4; }, "less than max_range"},
      {[](O& o) { o.carvingMargin = HUGE_VAL; }, "carving_margin"},
      {[](O& o) { o.threads = 0; }, "threads is 0"},
      {[](O& o) { o.threads = 257; }, "threads"}};
  EXPECT_EQ(errorOf([] { O().validate(); }), "");
  for (const auto& [change, words] : faults) {
    O options;
    change(options);
    expectRefused(words, threePoints(), at(0, 0, 0), options);
  }
}

TEST(BadInput, treesThatCannotBeAreRefused) {
  for (const double resolution : {0.0, -0.1, static_cast<double>(NAN), HUGE_VAL})
    EXPECT_TRUE(
        contains(errorOf([&] { SemanticOcTree(resolution, numberedClasses(2)); }), "resolution"))
        << resolution;
  EXPECT_TRUE(
      contains(errorOf([] { SemanticOcTree(0.1, ClassTable()); }), "number of classes is 0"));
}
