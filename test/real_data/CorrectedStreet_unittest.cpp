// A street that was mapped at wrong poses, and is put right.
#include <gtest/gtest.h>
#include <map_correction/KeyframeMap.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_types/ClassTable.h>

#include <random>

#include "DataSets.h"
#include "SharedData.h"

using namespace semantic_octree;

namespace {

class CorrectedStreet : public testing::TestWithParam<const char*> {};

/** Up to 0.5 m along each axis, and 2 degrees. */
Eigen::Isometry3d perturbed(Eigen::Isometry3d T, std::mt19937& random) {
  const auto uniform = [&random] { return static_cast<double>(random()) / 2147483648.0 - 1; };
  const double angle = uniform() * 2 * M_PI / 180;
  T.translation() += 0.5 * Eigen::Vector3d(uniform(), uniform(), uniform());
  T.linear() *= Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return T;
}

}  // namespace

TEST_P(CorrectedStreet, isTheMapOfTheTruePosesToTheBit) {
  const std::string sequence = std::string("semantic_kitti/") + GetParam();
  SKIP_WITHOUT_DATA(sequence);
  const auto table = semantic_types::loadClassTable(std::filesystem::path(MSO_SOURCE_DIR) /
                                                    "config/classes/semantic_kitti.yaml");
  const auto frames = readSemanticKitti(sharedDataDir() / sequence, table);
  SemanticOcTree map(0.2, table), expected(0.2, table);
  AbstractionOptions abstraction;
  abstraction.weights.terms = {tree_abstraction::relevant("1", 1, {1})};
  abstraction.weights.alpha = 0.002;
  setAbstraction(map, abstraction);
  setAbstraction(expected, abstraction);
  KeyframeMap keyframes(map);
  InsertionOptions options;
  options.maxRange = 30;
  std::mt19937 random(2);
  std::vector<KeyframePose> truth;
  for (const LabeledFrame& frame : frames) {
    truth.push_back({keyframes.begin(perturbed(frame.T_map_sensor, random)), frame.T_map_sensor});
    keyframes.insert(frame.cloud, Eigen::Isometry3d::Identity(), options);
    expected.insert(frame.cloud, frame.T_map_sensor, options);
  }
  EXPECT_FALSE(map == expected);
  keyframes.move({truth.begin(), truth.begin() + 3});
  EXPECT_FALSE(map == expected);
  keyframes.move(truth);
  EXPECT_TRUE(map == expected);
}

INSTANTIATE_TEST_SUITE_P(Sequences, CorrectedStreet, testing::Values("00", "07"));
