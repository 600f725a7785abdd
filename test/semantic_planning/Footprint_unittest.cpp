#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <semantic_planning/vehicle/Footprint.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "TemporaryFolder.h"

using namespace semantic_planning;
using Corners = std::vector<Eigen::Vector2d>;

namespace {

double number(int low, int high) { return *rc::gen::inRange(low, high) / 100.0; }

/** Corners on an ellipse that may lie anywhere about the origin. */
Footprint anyConvex() {
  const auto gaps =
      *rc::gen::container<std::vector<int>>(*rc::gen::inRange(3, 9), rc::gen::inRange(10, 60));
  double sum = 0;
  for (const int gap : gaps) sum += gap;
  const double length = number(20, 300), width = number(20, 300), lean = number(-100, 100);
  const double x = number(-150, 150), y = number(-150, 150);
  Corners corners;
  double angle = number(0, 600);
  for (const int gap : gaps) {
    const double along = length * std::cos(angle), across = width * std::sin(angle);
    corners.emplace_back(x + along + lean * across, y + across);
    angle += 2 * M_PI * gap / sum;
  }
  return Footprint(corners);
}

/** Whether a ray along x crosses the outline an odd number of times. */
bool within(const Footprint& outline, const Eigen::Vector2d& p) {
  bool odd = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d a = outline[i], b = outline[(i + 1) % outline.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    odd ^= p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
  }
  return odd;
}

/** How far a point lies beyond a side's line, meters; negative: on the outline's side. */
double beyond(const Footprint& outline, std::size_t i, const Eigen::Vector2d& p) {
  const Eigen::Vector2d a = outline[i], b = outline[(i + 1) % outline.size()];
  return ((p - a).x() * (b - a).y() - (p - a).y() * (b - a).x()) / (b - a).norm();
}

double mostBeyond(const Footprint& outline, const Eigen::Vector2d& p) {
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) most = std::max(most, beyond(outline, i, p));
  return most;
}

/** Distance from the nearest of many points on the outline, and how far apart these are. */
std::pair<double, double> sampledDistance(const Footprint& outline, const Eigen::Vector2d& p) {
  constexpr int kPoints = 400;
  double least = std::numeric_limits<double>::infinity(), gap = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d a = outline[i], side = outline[(i + 1) % outline.size()] - a;
    gap = std::max(gap, side.norm() / kPoints);
    for (int k = 0; k < kPoints; ++k) least = std::min(least, (a + side * k / kPoints - p).norm());
  }
  return {least, gap};
}

bool covered(const std::vector<Disc>& discs, const Eigen::Vector2d& p) {
  return std::any_of(discs.begin(), discs.end(), [&](const Disc& d) {
    return std::hypot(p.x() - d.x, p.y() - d.y) <= d.radius + 1e-9;
  });
}

std::string refusal(const Corners& corners) {
  return errorOf([&] { Footprint{corners}; });
}

}  // namespace

TEST(Footprint, inflatedHoldsThePointsThatAreNotFartherThanTheMarginBeyondAnySide) {
  EXPECT_TRUE(rc::check([] {
    const Footprint outline = anyConvex();
    const double margin = number(0, 60);
    const Footprint inflated = outline.inflated(margin);
    RC_ASSERT(inflated.size() == outline.size());
    for (std::size_t i = 0; i < outline.size(); ++i) {
      RC_ASSERT(std::abs(beyond(outline, i, inflated[i]) - margin) < 1e-9);
      RC_ASSERT(std::abs(beyond(outline, i, inflated[(i + 1) % outline.size()]) - margin) < 1e-9);
    }
    for (int k = 0; k < 100; ++k) {
      const Eigen::Vector2d p(number(-600, 600), number(-600, 600));
      const double most = mostBeyond(outline, p);
      if (std::abs(most - margin) > 1e-9) RC_ASSERT(within(inflated, p) == (most < margin));
    }
  }));
}

TEST(Footprint, aRectangleIsInflatedToTheBit) {
  const Corners corners = Footprint::rectangle(-0.25, 0.55, 0.6).inflated(0.1).corners();
  const double back = -0.25 - 0.1, front = 0.55 + 0.1, side = 0.3 + 0.1;
  EXPECT_EQ(corners, (Corners{{back, -side}, {front, -side}, {front, side}, {back, side}}));
}

TEST(Footprint, distanceIsThatOfTheNearestPointOfTheOutline) {
  EXPECT_TRUE(rc::check([] {
    const Footprint outline = anyConvex();
    for (int k = 0; k < 20; ++k) {
      const Eigen::Vector2d p(number(-600, 600), number(-600, 600));
      const auto [sampled, gap] = sampledDistance(outline, p);
      const double distance = outline.distance(p);
      if (mostBeyond(outline, p) < 0) {
        RC_ASSERT(distance == 0);
      } else {
        RC_ASSERT(distance <= sampled + 1e-9);
        RC_ASSERT(distance >= sampled - gap);
      }
    }
  }));
}

TEST(Footprint, inscribedRadiusIsTheNearestOutlinesDistanceFromAnOriginWithin) {
  EXPECT_TRUE(rc::check([] {
    const Footprint outline = anyConvex();
    const auto [sampled, gap] = sampledDistance(outline, {0, 0});
    const bool inside = within(outline, {0, 0});
    RC_CLASSIFY(inside);
    const double radius = outline.inscribedRadius();
    if (!inside) {
      RC_ASSERT(radius == 0);
    } else {
      RC_ASSERT(radius <= sampled + 1e-9);
      RC_ASSERT(radius >= sampled - gap);
    }
  }));
  EXPECT_EQ(Footprint::rectangle(-0.25, 0.55, 0.6).inscribedRadius(), 0.25);
}

TEST(Footprint, discsCoverEveryPointOfIt) {
  EXPECT_TRUE(rc::check([] {
    const Footprint outline = anyConvex();
    const auto discs = outline.coveringDiscs(number(0, 200));
    for (int k = 0; k < 100; ++k) {
      double sum = 0;
      Eigen::Vector2d p = Eigen::Vector2d::Zero();
      for (const Eigen::Vector2d& corner : outline) {
        const double weight = std::pow(number(0, 100), 4);
        p += weight * corner;
        sum += weight;
      }
      if (sum > 0) RC_ASSERT(covered(discs, p / sum));
    }
  }));
  for (const Eigen::Vector2d& corner : Footprint()) {
    EXPECT_TRUE(covered(Footprint().coveringDiscs(), corner));
  }
}

TEST(Footprint, discsOfARectangleStickOutByATenthOfItsWidth) {
  for (const Disc& d : Footprint::rectangle(-0.9, 3.4, 1.7).coveringDiscs()) {
    EXPECT_LE(d.radius, 0.85 + 0.11 * 1.7);
    EXPECT_DOUBLE_EQ(d.y, 0);
  }
}

TEST(Footprint, pairsOfDiscsStickOutLessAtFrontAndBack) {
  for (const Disc& d : Footprint::rectangle(-0.9, 3.4, 1.7).coveringDiscs(0.2)) {
    EXPECT_LE(d.x + d.radius, 3.4 + 0.15 * 1.7);
    EXPECT_GE(d.x - d.radius, -0.9 - 0.15 * 1.7);
    EXPECT_LE(std::abs(d.y) + d.radius, 0.85 + 0.05 * 1.7);
  }
}

TEST(Footprint, isCounterclockwiseHoweverItsCornersWereListed) {
  const Corners left = {{0, 0}, {2, 0}, {1, 1}}, right = {{1, 1}, {2, 0}, {0, 0}};
  EXPECT_EQ(Footprint(left).corners(), left);
  EXPECT_EQ(Footprint(right).corners(), left);
}

TEST(Footprint, mayHaveCornersOnItsSides) {
  EXPECT_EQ(refusal({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {0, 1}}), "");
}

TEST(Footprint, refusesWhatIsNoConvexOutlineNamingTheCorner) {
  EXPECT_TRUE(contains(refusal({}), "0 corners"));
  EXPECT_TRUE(contains(refusal({{0, 0}, {1, 1}}), "2 corners"));
  EXPECT_TRUE(contains(refusal({{0, 0}, {1, NAN}, {1, 1}}), "not finite: (1, nan)"));
  EXPECT_TRUE(contains(refusal({{0, 0}, {1, 0}, {1, 0}, {0, 1}}), "at one place, (1, 0)"));
  EXPECT_TRUE(contains(refusal({{0, 0}, {1, 1}, {2, 2}}), "turns back on itself"));
  EXPECT_TRUE(contains(refusal({{0, 0}, {2, 0}, {1, 0.5}, {0, 2}}), "not convex at (1, 0.5)"));
  EXPECT_TRUE(contains(refusal({{0, 2}, {1, 0.5}, {2, 0}, {0, 0}}), "not convex at (1, 0.5)"));
  EXPECT_TRUE(contains(refusal({{0, 0}, {1, 1}, {1, 0}, {0, 2}}), "not convex"));  // an hourglass
  Corners star;
  for (int i = 0; i < 5; ++i) star.emplace_back(std::cos(0.8 * i * M_PI), std::sin(0.8 * i * M_PI));
  EXPECT_TRUE(contains(refusal(star), "sides that cross"));
}

TEST(Footprint, refusesAMarginBelowZero) {
  EXPECT_TRUE(contains(errorOf([] { Footprint().inflated(-0.1); }), "margin is -0.1"));
}
