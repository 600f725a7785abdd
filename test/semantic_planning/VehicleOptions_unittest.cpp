#include <gtest/gtest.h>
#include <semantic_planning/vehicle/VehicleOptions.h>

#include <cmath>

#include "TemporaryFolder.h"

using namespace semantic_planning;
using Polygon = std::vector<Eigen::Vector2d>;

namespace {

bool covered(const std::vector<Disc>& discs, const Eigen::Vector2d& p) {
  for (const Disc& d : discs)
    if (std::hypot(p.x() - d.x, p.y() - d.y) <= d.radius + 1e-9) return true;
  return false;
}

/** Points of a triangle fan around a corner: enough for star-shaped outlines. */
void expectCovered(const Polygon& polygon) {
  const auto discs = coveringDiscs(polygon);
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    for (double u = 0; u <= 1; u += 0.02)
      for (double v = 0; u + v <= 1; v += 0.02) {
        const Eigen::Vector2d p =
            polygon[0] + u * (polygon[i] - polygon[0]) + v * (polygon[i + 1] - polygon[0]);
        ASSERT_TRUE(covered(discs, p)) << p.transpose();
      }
}

std::string refusal(void (*spoil)(VehicleOptions&)) {
  VehicleOptions vehicle;
  spoil(vehicle);
  return errorOf([&] { vehicle.validate(); });
}

}  // namespace

TEST(VehicleOptions, discsCoverTheFootprint) {
  expectCovered(Footprint::rectangle(-0.9, 3.4, 1.7));
  expectCovered(Footprint::rectangle(-0.3, 0.3, 2));
  expectCovered({{-1, 0}, {2, -0.7}, {2.5, 0}, {2, 0.7}});
  expectCovered({{0, 0}, {1, -1}, {1, 1}});
}

TEST(VehicleOptions, discsOfARectangleStickOutByATenthOfItsWidth) {
  for (const Disc& d : coveringDiscs(Footprint::rectangle(-0.9, 3.4, 1.7))) {
    EXPECT_LE(d.radius, 0.85 + 0.11 * 1.7);
    EXPECT_DOUBLE_EQ(d.y, 0);
  }
}

TEST(VehicleOptions, refuseWhatIsNoVehicleNamingTheField) {
  EXPECT_EQ(refusal([](VehicleOptions&) {}), "");
  EXPECT_TRUE(contains(refusal([](auto& v) { v.turningRadius = 0; }), "turningRadius is 0"));
  EXPECT_TRUE(contains(refusal([](auto& v) { v.turningRadius = NAN; }), "turningRadius"));
  EXPECT_TRUE(contains(refusal([](auto& v) { v.height = -1; }), "height is -1"));
  EXPECT_TRUE(contains(refusal([](auto& v) { v.maxSlope = 90; }), "maxSlope is 90"));
  EXPECT_TRUE(contains(refusal([](auto& v) { v.clearance = INFINITY; }), "clearance"));
  EXPECT_TRUE(contains(refusal([](auto& v) { v.footprint.resize(2); }), "footprint"));
  EXPECT_TRUE(contains(refusal([](auto& v) { v.footprint[1].x() = NAN; }), "footprint"));
  EXPECT_TRUE(contains(refusal([](auto& v) {
                         v.footprint = {{0, 0}, {1, 1}, {2, 2}};
                       }),
                       "footprint"));
}
