#include "SensorScale.h"

#include <gtest/gtest.h>

#include <random>

using namespace semantic_slam;

namespace {

/** Returns from all sides, half of them nearer than a distance, m. */
LabeledCloud cloudOf(double median) {
  std::mt19937 random(1);
  const auto uniform = [&random] { return static_cast<float>(random()) / 2147483648.f - 1; };
  LabeledCloud cloud;
  for (int i = 1; i < 1000; ++i) {
    const Eigen::Vector3f direction = Eigen::Vector3f(uniform(), uniform(), uniform()).normalized();
    cloud.points.push_back(direction * static_cast<float>(median * i / 500));
  }
  return cloud;
}

}  // namespace

TEST(SensorScale, aSceneOfHalfTheSizeHasHalfTheLengths) {
  for (const double factor : {0.8, 1., 1.3})
    for (const double smaller : {0.5, 0.25}) {
      const SensorScale street = SensorScale::of(cloudOf(8 * factor), false),
                        s = SensorScale::of(cloudOf(8 * factor * smaller), false);
      EXPECT_DOUBLE_EQ(s.keyframeDistance, smaller * street.keyframeDistance);
      EXPECT_DOUBLE_EQ(s.cube, smaller * street.cube);
      EXPECT_DOUBLE_EQ(s.registeredCube, smaller * street.registeredCube);
      EXPECT_DOUBLE_EQ(s.gridCell, smaller * street.gridCell);
      EXPECT_DOUBLE_EQ(s.loopLength, smaller * street.loopLength);
      ASSERT_EQ(s.cells.size(), street.cells.size());
      for (std::size_t i = 0; i < s.cells.size(); ++i)
        EXPECT_DOUBLE_EQ(s.cells[i], smaller * street.cells[i]);
      EXPECT_EQ(s.keyframeAngle, street.keyframeAngle);
      EXPECT_EQ(s.submapKeyframes, street.submapKeyframes);
    }
}

TEST(SensorScale, isOfStreetsAtMostAndOfRoomsAtLeast) {
  EXPECT_EQ(SensorScale::of(cloudOf(40), false).cube, SensorScale::of(cloudOf(8), false).cube);
  EXPECT_EQ(SensorScale::of(cloudOf(0.3), false).cube, SensorScale::of(cloudOf(2), false).cube);
  EXPECT_EQ(SensorScale::of({}, false).cube, SensorScale::of(cloudOf(2), false).cube);
}
