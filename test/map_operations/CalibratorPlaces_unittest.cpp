// Errors that all scans make in the same places.
#include <gtest/gtest.h>
#include <map_operations/Calibrator.h>

#include <cmath>
#include <random>

#include "LabelEdges.h"

using namespace semantic_octree;

namespace {

constexpr int kNamed = 10, kStripes = 6, kPatched = 120, kPatchEdge = 4, kLooks = 6;

ClassId stripeOf(int x) { return static_cast<ClassId>(1 + x * kStripes / kPatched); }

/** A floor of stripes of six classes, beside each other. Patches of it are taken for one of the
 * classes two to four further. */
struct PatchedFloor {
  /** \param once, always share of the patches that are wrong in one scan, and in all of them */
  PatchedFloor(double once, double always) {
    const Patches fixed = drawn(always);
    for (auto& scan : labels) {
      const Patches fresh = drawn(once);
      for (int x = 0; x < kPatched; ++x)
        for (int y = 0; y < kPatched; ++y) {
          const int patch = x / kPatchEdge * (kPatched / kPatchEdge) + y / kPatchEdge;
          const bool errs = fixed[patch] || fresh[patch];
          const int seen = stripeOf(x) - 1 + (errs ? 2 + patch % 3 : 0);
          scan.push_back(static_cast<ClassId>(1 + seen % kNamed));
        }
    }
  }
  /** By their voxels. */
  PlacedLabels placed() const {
    PlacedLabels voxels;
    for (int i = 0; i < kPatched * kPatched; ++i)
      for (const auto& scan : labels)
        voxels[(1000ull + i / kPatched) << 32 | (1000ull + i % kPatched) << 16].push_back(
            static_cast<char>(scan[i]));
    return voxels;
  }
  /** Mean of p(likeliest class | occupied) in a map, less the share of voxels in which it is true.
   */
  double statedLessRight() const {
    ClassTable classes;
    for (int i = 1; i <= kNamed; ++i) classes.add("class " + std::to_string(i), {});
    SemanticOcTree map(1, classes);
    Calibrator calibrator(1, kNamed);
    LabeledCloud cloud;
    for (int i = 0; i < kPatched * kPatched; ++i)
      cloud.points.emplace_back(i / kPatched + 0.5f, i % kPatched + 0.5f, -2.5f);
    for (const auto& scan : labels) {
      cloud.classes = scan;
      calibrator.add(cloud, Eigen::Isometry3d::Identity());
      map.insert(cloud, Eigen::Isometry3d::Identity());
    }
    map.setCalibration(calibrator.fit(map));
    double gap = 0;
    for (int i = 0; i < kPatched * kPatched; ++i) {
      const CellState state =
          map.query(map.coordToKey(i / kPatched + 0.5, i % kPatched + 0.5, -2.5));
      gap += state.probability / state.occupancy - (state.likeliestClass == stripeOf(i / kPatched));
    }
    return gap / (kPatched * kPatched);
  }

  std::vector<ClassId> labels[kLooks];

 private:
  using Patches = std::vector<bool>;
  Patches drawn(double share) {
    Patches patches(kPatched / kPatchEdge * (kPatched / kPatchEdge));
    for (std::size_t i = 0; i < patches.size(); ++i)
      patches[i] = std::ldexp(static_cast<double>(m_random()), -32) < share;
    return patches;
  }

  std::mt19937 m_random{3};
};

/** \param surely p(each class) of any labels */
double alwaysWrong(double once, double always, double surely) {
  return semantic_octree::alwaysWrong(PatchedFloor(once, always).placed(), [=](const std::string&) {
    return std::vector<double>(kNamed, surely);
  });
}

}  // namespace

TEST(LabelEdges, tellHowOftenPlacesAreWrongInAllScans) {
  EXPECT_NEAR(alwaysWrong(0.1, 0, 1), 0, 0.02);
  EXPECT_NEAR(alwaysWrong(0.1, 0.05, 1), 0.5, 0.15);
  EXPECT_NEAR(alwaysWrong(0.1, 0.1, 1), 1, 0.15);
}

TEST(LabelEdges, doNotCountWhatIsWrongByChance) {
  EXPECT_NEAR(alwaysWrong(0.1, 0.05, 0.7), 0.49 * alwaysWrong(0.1, 0.05, 1), 0.08);
}

TEST(LabelEdges, ofNoLabelsTellNothing) {
  const auto never = [](const std::string&) -> std::vector<double> { throw std::logic_error(""); };
  EXPECT_NEAR(semantic_octree::alwaysWrong({}, never), 0, 0.001);
  EXPECT_NEAR(semantic_octree::alwaysWrong({{1, "\1\2\3"}, {2, "\1"}}, never), 0, 0.001);
}

TEST(Calibrator, statesLessWherePlacesAreWrongInAllScans) {
  EXPECT_NEAR(PatchedFloor(0.1, 0).statedLessRight(), 0, 0.02);
  EXPECT_NEAR(PatchedFloor(0.1, 0.1).statedLessRight(), 0, 0.04);
}
