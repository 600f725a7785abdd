#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "roadmap/NearestPoses.h"

using namespace semantic_planning;
using colored_graph::VertexId;
using mrpt::math::TPose2D;

namespace {

constexpr int kNeighbors = 4;
constexpr double kRadius = 6;

class NearestPosesTest : public testing::Test {
 protected:
  TPose2D randomPose() { return {m_at(m_random), m_at(m_random), m_heading(m_random)}; }

  /** New poses take the ids of those that go, as they do in a graph. */
  void replace(int removed, int inserted) {
    std::vector<VertexId> gone, ids;
    std::vector<GroundPose> poses;
    for (int i = 0; i < removed && !m_poses.empty(); ++i) {
      auto victim = std::next(m_poses.begin(), static_cast<int>(m_random() % m_poses.size()));
      gone.push_back(victim->first);
      m_poses.erase(victim);
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(inserted); ++i) {
      ids.push_back(i < gone.size() ? gone[i] : m_next++);
      poses.push_back({randomPose(), 0});
      m_poses[ids.back()] = poses.back().pose;
    }
    nearest.replace(gone, ids, poses);
  }

  void expectLikeBruteForce() {
    for (const auto& [id, pose] : m_poses) {
      std::vector<NearestPoses::Neighbor> expected;
      for (const auto& [other, otherPose] : m_poses) {
        const double distance = shepp.distance(pose, otherPose);
        if (other != id && distance <= kRadius)
          expected.push_back({other, distance, {otherPose, 0}});
      }
      std::sort(expected.begin(), expected.end());
      if (expected.size() > kNeighbors) expected.resize(kNeighbors);
      ASSERT_EQ(nearest.of(id).size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(nearest.of(id)[i].distance, expected[i].distance, 1e-9);
    }
  }

  ReedsShepp shepp{1};
  NearestPoses nearest{shepp, kNeighbors, kRadius};

 private:
  std::mt19937 m_random{3};
  std::uniform_real_distribution<double> m_at{-10, 10}, m_heading{-M_PI, M_PI};
  std::map<VertexId, TPose2D> m_poses;
  VertexId m_next = 0;
};

}  // namespace

TEST_F(NearestPosesTest, areThoseOfBruteForceWhilePosesComeAndGo) {
  replace(0, 60);
  for (int round = 0; round < 6; ++round)
    for (const auto& [removed, inserted] : {std::pair(9, 0), {0, 11}, {9, 11}, {11, 9}}) {
      replace(removed, inserted);
      expectLikeBruteForce();
    }
}
