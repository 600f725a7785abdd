#include <gtest/gtest.h>
#include <semantic_driving/DrivePath.h>

#include <cmath>

using namespace semantic_driving;
using namespace semantic_planning;

TEST(DrivenTrack, LeadsBackTheWayTheVehicleCame) {
  constexpr double kRadius = 2;
  DrivenTrack track;
  for (double a = 0; a < 1; a += 0.01)  // ahead on an arc to the left
    track.add({kRadius * std::sin(a), kRadius * (1 - std::cos(a)), a});
  const DrivePath back(track.back());
  EXPECT_NEAR(back.length(), kRadius, 0.2);
  EXPECT_NEAR(back.stretchEnd(0.1), back.length(), 1e-9);
  for (double s = 0; s < back.length() - 0.2; s += 0.1) {
    EXPECT_FALSE(back.at(s).forward);
    EXPECT_NEAR(back.at(s).curvature, 1 / kRadius, 0.01);
  }
  EXPECT_NEAR(std::hypot(back.at(2).x, back.at(2).y), 0, 0.1);
}

TEST(DrivenTrack, ForgetsWhatTheVehicleWentBackOnAndWhatIsLongAgo) {
  DrivenTrack track(3);
  for (double x = 0; x <= 5; x += 0.05) track.add({x, 0, 0});
  const double kept = DrivePath(track.back()).length();
  EXPECT_GE(kept, 2.9);
  EXPECT_LE(kept, 4.5);
  for (double x = 5; x >= 4; x -= 0.05) track.add({x, 0, 0});
  const DrivePath back(track.back());
  EXPECT_NEAR(back.points().front().x, 4, 0.15);
  EXPECT_NEAR(back.length(), kept - 1, 0.2);
  EXPECT_NEAR(back.stretchEnd(0), back.length(), 1e-9);
}
