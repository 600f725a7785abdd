#include <gtest/gtest.h>
#include <semantic_driving/DynamicObstacles.h>

#include <algorithm>
#include <random>

#include "Classes.h"

using namespace semantic_driving;
using Eigen::Vector2d;

namespace {

constexpr semantic_types::ClassId kWall = 1, kPerson = 2;

semantic_types::ClassTable table() { return tableOf({"wall", "person"}); }

class Follower {
 public:
  explicit Follower(const DynamicObstacleOptions& options = {}) : m_tracker(options, table()) {}

  /** Some points around each place. */
  void scan(const std::vector<Vector2d>& places, double seconds,
            semantic_types::ClassId id = kPerson) {
    std::normal_distribution<double> noise(0, 0.08);
    semantic_types::LabeledCloud cloud;
    for (const Vector2d& p : places)
      for (int i = 0; i < 12; ++i)
        cloud.points.emplace_back(
            Eigen::Vector3d(p.x() + noise(m_random), p.y() + noise(m_random), -1 + 0.1 * i)
                .cast<float>());
    cloud.classes.assign(cloud.points.size(), id);
    m_tracker.see(cloud, Eigen::Isometry3d::Identity());
    m_tracker.update(seconds);
  }
  DynamicObstacles at(double seconds) const { return m_tracker.at(seconds); }
  /** How many points, one of each class at a place, a scan keeps without those who pass. */
  std::size_t lastingAt(const Vector2d& place) const {
    semantic_types::LabeledCloud cloud;
    cloud.points.assign(2, {static_cast<float>(place.x()), static_cast<float>(place.y()), 0});
    cloud.classes = {kWall, kPerson};
    return m_tracker.withoutPassing(cloud, Eigen::Isometry3d::Identity()).size();
  }
  std::vector<Vector2d> takeLeft() { return m_tracker.takeLeft(); }
  /** Seen nearest to a place. */
  DynamicObstacle near(const Vector2d& place, double seconds) const {
    const DynamicObstacles movers = at(seconds);
    return *std::min_element(movers.begin(), movers.end(),
                             [&](const DynamicObstacle& a, const DynamicObstacle& b) {
                               return (a.place - place).norm() < (b.place - place).norm();
                             });
  }

 private:
  DynamicObstacleTracker m_tracker;
  std::mt19937 m_random{3};
};

}  // namespace

TEST(DynamicObstacleTracker, KnowsAfterAFewScansWhereSomebodyWalks) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-6, 6), speed(-1.4, 1.4);
  for (int i = 0; i < 50; ++i) {
    const Vector2d from(place(random), place(random)), velocity(speed(random), speed(random));
    Follower follower;
    for (double t = 0; t < 2.1; t += 0.5) follower.scan({from + t * velocity}, t);
    const DynamicObstacles movers = follower.at(3);
    ASSERT_EQ(movers.size(), 1u) << i;
    if (velocity.norm() > 0.5) {
      EXPECT_LT((movers[0].velocity - velocity).norm(), 0.3) << i;
      EXPECT_LT((movers[0].place - from - 3 * velocity).norm(), 0.4) << i;
    }
    EXPECT_LT(movers[0].speedNoise, 0.7) << i;
  }
}

TEST(DynamicObstacleTracker, LeavesThoseOutOfAScanWhoPassButNotWhoStands) {
  Follower follower;
  const Vector2d standing(3, 2), passing(-3, -2), velocity(0.8, 0.8);
  for (double t = 0; t < 5; t += 0.5) {
    follower.scan({standing, passing + t * velocity}, t);
    EXPECT_EQ(follower.lastingAt(passing + t * velocity), 1u) << t;
    if (t < 1.9) {
      EXPECT_EQ(follower.lastingAt(standing), 1u) << "who was just seen may walk on";
    }
    EXPECT_EQ(follower.lastingAt({-8, 0}), 2u) << "nobody is there";
  }
  EXPECT_EQ(follower.lastingAt(standing), 2u);
}

TEST(DynamicObstacleTracker, TellsOnceWhereSomebodyStoodWhoWalksAway) {
  Follower follower;
  const Vector2d place(2, 1);
  for (double t = 0; t < 5; t += 0.5) follower.scan({place}, t);
  EXPECT_TRUE(follower.takeLeft().empty());
  std::vector<Vector2d> left;
  for (double t = 5; t < 8; t += 0.5) {
    follower.scan({place + Vector2d(0, 1.2 * (t - 5))}, t);
    for (const Vector2d& p : follower.takeLeft()) left.push_back(p);
  }
  ASSERT_EQ(left.size(), 1u);
  EXPECT_LT((left[0] - place).norm(), 0.2);
}

TEST(DynamicObstacleTracker, TellsThoseApartWhoCross) {
  Follower follower;
  for (double t = 0; t < 5; t += 0.5)
    follower.scan({{-3 + 1.2 * t, 0.4}, {3 - 1.2 * t, -0.4}}, t);  // side by side at 2.5 s
  EXPECT_EQ(follower.at(5).size(), 2u);
  EXPECT_NEAR(follower.near({3, 0.4}, 5).velocity.x(), 1.2, 0.2);
  EXPECT_NEAR(follower.near({-3, -0.4}, 5).velocity.x(), -1.2, 0.2);
}

TEST(DynamicObstacleTracker, WhoStandsStandsAndIsKnownBetterThanWhoIsNew) {
  Follower follower;
  follower.scan({{2, 1}}, 0);
  ASSERT_EQ(follower.at(0).size(), 1u);
  EXPECT_TRUE(follower.at(0)[0].stands());
  const double first = follower.at(0)[0].speedNoise;
  for (double t = 0.5; t < 4; t += 0.5) {
    follower.scan({{2, 1}}, t);
    EXPECT_TRUE(follower.at(t)[0].stands()) << t;
    EXPECT_LT(follower.at(t)[0].speedNoise, first / 2);
  }
}

TEST(DynamicObstacleTracker, ForgetsWhoIsNotSeenAnyMore) {
  Follower follower;
  for (double t = 0; t < 2; t += 0.5) follower.scan({{t, 0}}, t);
  follower.scan({}, 3);
  ASSERT_EQ(follower.at(3).size(), 1u);
  EXPECT_NEAR(follower.at(3)[0].place.x(), 3, 0.5);
  follower.scan({}, 3.5);
  EXPECT_TRUE(follower.at(3.5).empty());
  follower.scan({{0, 0}}, 1e6);  // a stamp that lies
  follower.scan({}, 4);
  EXPECT_TRUE(follower.at(4).empty());
}

TEST(DynamicObstacleTracker, FollowsOnlyClassesThatMove) {
  Follower follower;
  follower.scan({{1, 0}}, 0, kWall);
  EXPECT_TRUE(follower.at(0).empty());
  DynamicObstacleOptions both;
  both.classes = "wall, person";
  Follower other(both);
  other.scan({{1, 0}}, 0, kWall);
  EXPECT_EQ(other.at(0).size(), 1u);
  both.classes = "wall,ghost";
  EXPECT_THROW(DynamicObstacleTracker(both, table()), std::invalid_argument);
  both.classes = "";
  Follower nobody(both);
  nobody.scan({{1, 0}}, 0);
  EXPECT_TRUE(nobody.at(0).empty());
}
