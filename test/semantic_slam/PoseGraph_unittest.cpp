#include <gtest/gtest.h>
#include <semantic_slam/PoseGraph.h>

#include <cmath>
#include <random>

using namespace semantic_slam;

namespace {

Vector6 randomVector(std::mt19937& random, double meters, double radians) {
  const auto uniform = [&random] { return static_cast<double>(random()) / 2147483648.0 - 1; };
  Vector6 v;
  for (int i = 0; i < 6; ++i) v[i] = (i < 3 ? meters : radians) * uniform();
  return v;
}

/** Around a circle of 30 m, a little up and down. */
std::vector<Eigen::Isometry3d> ring(int n) {
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * M_PI * i / n;
    Vector6 v;
    v << 30 * std::cos(angle), 30 * std::sin(angle), std::sin(3 * angle), 0, 0, 0;
    poses.push_back(poseOf(v) * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
  }
  return poses;
}

PoseEdge edgeOf(const std::vector<Eigen::Isometry3d>& poses, std::size_t a, std::size_t b) {
  return {a, b, poses[a].inverse() * poses[b], informationOf(0.02, 0.01)};
}

double largestError(const std::vector<Eigen::Isometry3d>& a,
                    const std::vector<Eigen::Isometry3d>& b) {
  double error = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    error = std::max(error, vectorOf(a[i].inverse() * b[i]).norm());
  return error;
}

}  // namespace

TEST(PoseGraph, vectorsAndPosesAreEachOthersInverse) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const Vector6 v = randomVector(random, 10, 1);
    EXPECT_LT((vectorOf(poseOf(v)) - v).norm(), 1e-12);
  }
}

TEST(PoseGraph, measurementsThatAgreeGiveThePosesFromWhereverTheyBegin) {
  std::mt19937 random(2);
  const auto truth = ring(40);
  std::vector<PoseEdge> edges;
  for (std::size_t i = 1; i < truth.size(); ++i) edges.push_back(edgeOf(truth, i - 1, i));
  edges.push_back(edgeOf(truth, truth.size() - 1, 0));
  edges.push_back(edgeOf(truth, 25, 3));
  auto poses = truth;
  for (std::size_t i = 1; i < poses.size(); ++i)
    poses[i] = poses[i] * poseOf(randomVector(random, 1, 0.2));
  optimize(poses, edges);
  EXPECT_LT(largestError(poses, truth), 1e-4);
}

TEST(PoseGraph, wrongLoopsAreFoundOut) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    std::mt19937 random(seed);
    const auto truth = ring(60);
    std::vector<PoseEdge> right, wrong;
    std::vector<Eigen::Isometry3d> drifted = {truth[0]};
    for (std::size_t i = 1; i < truth.size(); ++i) {
      right.push_back(edgeOf(truth, i - 1, i));
      right.back().T_a_b = right.back().T_a_b * poseOf(randomVector(random, 0.02, 0.01));
      drifted.push_back(drifted.back() * right.back().T_a_b);
    }
    for (std::size_t i = 30; i < 60; i += 3) {
      right.push_back(edgeOf(truth, i, i - 30));
      right.back().isDoubtful = true;
    }
    for (int i = 0; i < 4; ++i) {  // each elsewhere
      wrong.push_back(edgeOf(truth, random() % 20, 30 + random() % 20));
      wrong.back().T_a_b = wrong.back().T_a_b * poseOf(randomVector(random, 10, 1));
      wrong.back().isDoubtful = true;
    }
    auto withoutThem = drifted, withThem = drifted, believed = drifted;
    optimize(withoutThem, right);
    auto all = right;
    all.insert(all.end(), wrong.begin(), wrong.end());
    optimize(withThem, all);
    EXPECT_LT(largestError(withThem, withoutThem), 0.3) << seed << ": each pulls a little";
    for (PoseEdge& edge : all) edge.isDoubtful = false;
    optimize(believed, all);
    EXPECT_GT(largestError(believed, withoutThem), 2) << seed;
  }
}

TEST(PoseGraph, edgesFromTheMapSayWhereTheFirstPoseIs) {
  std::mt19937 random(1);
  const auto truth = ring(40);
  std::vector<PoseEdge> edges;
  for (std::size_t i = 1; i < truth.size(); ++i) edges.push_back(edgeOf(truth, i - 1, i));
  auto poses = truth;
  const Eigen::Isometry3d T_off = poseOf(randomVector(random, 1, 0.2));
  for (Eigen::Isometry3d& pose : poses) pose = T_off * pose;
  const auto elsewhere = poses;
  optimize(poses, edges);
  EXPECT_LT(largestError(poses, elsewhere), 1e-9) << "nothing says where they are";
  for (const std::size_t i : {7, 20, 33})
    edges.push_back({PoseEdge::kMap, i, truth[i], informationOf(0.1, 0.01), true});
  optimize(poses, edges);
  EXPECT_LT(largestError(poses, truth), 1e-4);
}

TEST(PoseGraph, twoStepsInARowErrByBothErrors) {
  std::mt19937 random(3);
  const auto T = poseOf(randomVector(random, 2, 1));
  const Matrix6 first = informationOf(0.1, 0.02), second = informationOf(0.03, 0.05);
  Matrix6 turn;  // what a small error before the second step is after it
  for (int i = 0; i < 6; ++i)
    turn.col(i) = vectorOf(T.inverse() * poseOf(1e-6 * Vector6::Unit(i)) * T) / 1e-6;
  const Matrix6 both = turn * first.inverse() * turn.transpose() + second.inverse();
  EXPECT_TRUE(inSeries(first, {0, 1, T, second}).inverse().isApprox(both, 1e-5));
}

TEST(PoseGraph, refusesEdgesOfPosesThatAreNotThere) {
  std::vector<Eigen::Isometry3d> poses = ring(3);
  EXPECT_THROW(optimize(poses, {edgeOf(ring(4), 0, 3)}), std::invalid_argument);
}

namespace {

/** What optimize() makes least. */
double costOf(const std::vector<PoseEdge>& edges, const std::vector<Eigen::Isometry3d>& poses) {
  double cost = 0;
  for (const PoseEdge& edge : edges) {
    const double squared = squaredError(edge, poses);
    cost += edge.isDoubtful ? 16 * std::log1p(squared / 16) : squared;
  }
  return cost;
}

}  // namespace

TEST(PoseGraph, loopsThatAreFarOffAtFirstAreBelieved) {
  struct Case {
    double drift, deviation;  // m a step; of each step, m
    int wrong;                // loops
  };
  // A way that is well known needs stages, one that is not is better without them.
  for (const Case& c : {Case{0.1, 0.02, 0},
                        {0.1, 0.02, 2},
                        {0.1, 0.02, 4},
                        {0.2, 0.05, 0},
                        {0.05, 0.05, 2},
                        {0.1, 0.05, 2},
                        {0.1, 0.1, 4}})
    for (unsigned seed = 1; seed <= 8; ++seed) {
      std::mt19937 random(seed);
      const auto truth = ring(60);
      Vector6 bias;
      bias << c.drift, 0, 0, 0, 0, 0.2 * c.drift;
      std::vector<PoseEdge> edges;
      std::vector<Eigen::Isometry3d> poses = {truth[0]};
      for (std::size_t i = 1; i < truth.size(); ++i) {
        edges.push_back({i - 1, i, truth[i - 1].inverse() * truth[i] * poseOf(bias),
                         informationOf(c.deviation, c.deviation / 2)});
        poses.push_back(poses.back() * edges.back().T_a_b);
      }
      const auto addLoop = [&](std::size_t a, std::size_t b, const Vector6& off) {
        edges.push_back(
            {a, b, truth[a].inverse() * truth[b] * poseOf(off), informationOf(0.03, 0.0017), true});
      };
      for (const std::size_t i : {0, 2}) addLoop(i, 57 + i, Vector6::Zero());
      auto right = truth;
      optimize(right, edges);
      for (int i = 0; i < c.wrong; ++i) {  // each elsewhere
        const std::size_t a = random() % 20, b = 40 + random() % 20;
        addLoop(a, b, randomVector(random, 5, 1));
      }
      optimize(poses, edges);
      EXPECT_LT(costOf(edges, poses), 1.15 * costOf(edges, right))
          << c.drift << " " << c.deviation << " " << c.wrong << ", seed " << seed;
    }
}
