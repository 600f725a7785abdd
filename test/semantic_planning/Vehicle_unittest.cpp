#include <gtest/gtest.h>
#include <semantic_planning/vehicle/VehicleOptions.h>

#include <cmath>

#include "TemporaryFolder.h"

using namespace semantic_planning;

namespace {

std::string refusal(void (*spoil)(VehicleOptions&)) {
  VehicleOptions vehicle;
  spoil(vehicle);
  return errorOf([&] { vehicle.validate(); });
}

class VehicleFile : public testing::Test {
 protected:
  std::string error(const std::string& text) const {
    const auto file = folder.write("vehicle.yaml", text);
    return errorOf([&] { loadVehicle(file); });
  }

  TemporaryFolder folder;
};

}  // namespace

TEST(VehicleOptions, refuseWhatIsNoVehicleNamingTheOption) {
  EXPECT_EQ(refusal([](VehicleOptions&) {}), "");
  EXPECT_TRUE(contains(refusal([](auto& v) { v.turningRadius = 0; }), "turning_radius is 0"));
  EXPECT_TRUE(contains(refusal([](auto& v) { v.turningRadius = NAN; }), "turning_radius"));
  EXPECT_TRUE(contains(refusal([](auto& v) { v.height = -1; }), "height is -1"));
  EXPECT_TRUE(contains(refusal([](auto& v) { v.maxSlope = 90; }), "max_slope is 90"));
  EXPECT_TRUE(contains(refusal([](auto& v) { v.clearance = INFINITY; }), "clearance"));
}

TEST_F(VehicleFile, hasDefaultsForWhatIsNotSaid) {
  const auto file =
      folder.write("vehicle.yaml", "turning_radius: 3\nfootprint: [[0, -1], [2, 0], [0, 1]]\n");
  const VehicleOptions vehicle = loadVehicle(file);
  EXPECT_EQ(vehicle.turningRadius, 3);
  EXPECT_EQ(vehicle.footprint.size(), 3u);
  EXPECT_EQ(vehicle.height, VehicleOptions().height);
}

TEST_F(VehicleFile, setsEveryOption) {
  const auto file = folder.write("vehicle.yaml",
                                 "footprint: [[0, -1], [0, 1], [2, 0]]\nheight: 2\n"
                                 "turning_radius: 3\nclearance: 0.4\nstep_height: 0.5\n"
                                 "max_slope: 6\nwheel_track: 0.7\nreverse_weight: inf\n"
                                 "gear_change: 4\n");
  const VehicleOptions v = loadVehicle(file);
  EXPECT_EQ(v.footprint[0], Eigen::Vector2d(2, 0)) << "the corners are turned round";
  EXPECT_EQ(std::tie(v.height, v.turningRadius, v.clearance), std::tuple(2, 3, 0.4));
  EXPECT_EQ(std::tie(v.stepHeight, v.maxSlope, v.wheelTrack), std::tuple(0.5, 6, 0.7));
  EXPECT_EQ(std::tie(v.reverseWeight, v.gearChange),
            std::tuple(std::numeric_limits<double>::infinity(), 4));
}

TEST_F(VehicleFile, isReadStrictly) {
  EXPECT_TRUE(contains(error("turning_radius: 0"), "turning_radius is 0"));
  EXPECT_TRUE(contains(error("height: tall"), "height is 'tall'"));
  EXPECT_TRUE(contains(error("hight: 1"), "did you mean 'height'"));
  EXPECT_TRUE(contains(error("footprint: [[0, 1, 2]]"), "expected [x, y]"));
  EXPECT_TRUE(contains(error("height: 1\nfootprint: [[0, 0], [2, 0], [1, 0.5], [0, 2]]"),
                       "vehicle.yaml:2: footprint is not convex at (1, 0.5)"));
}
