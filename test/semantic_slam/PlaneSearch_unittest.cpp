// Branch and bound finds what trying everything finds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "PlaneSearch.h"
#include "SensorScale.h"

using namespace semantic_slam;

namespace {

constexpr double kCell = 0.1, kStep = 1.5 * kDegree;

class Uniform {
 public:
  explicit Uniform(unsigned seed) : m_random(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(m_random()) / 4294967296.0;
  }

 private:
  std::mt19937 m_random;
};

/** A room's two walls, and things in it. */
PlanePoints room(Uniform& uniform, int n) {
  PlanePoints points;
  for (int i = 0; i < n; ++i) {
    const double along = uniform(-3, 3);
    points.emplace_back(i % 3 == 0   ? Eigen::Vector2d(along, 2)
                        : i % 3 == 1 ? Eigen::Vector2d(-3, along)
                                     : Eigen::Vector2d(uniform(-3, 3), uniform(-3, 3)));
  }
  return points;
}

/** Scores by definition: for each point of the scan, how near the nearest of the others is. */
class Oracle {
 public:
  Oracle(const PlanePoints& others, const PlanePoints& scan, const Eigen::Vector3d& guess)
      : m_scan(scan), m_guess(guess), m_corner(others.front()) {
    Eigen::Vector2d high = m_corner;
    for (const Eigen::Vector2d& p : others) {
      m_corner = m_corner.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    m_corner.array() -= 4 * kCell;
    m_size = cellOf(high) + 5;
    m_scores.resize(static_cast<std::size_t>(m_size.prod()));
    for (const Eigen::Vector2d& p : others)
      for (int i = 0; i < 49; ++i) {
        const Eigen::Array2i off(i % 7 - 3, i / 7 - 3), at = cellOf(p) + off;
        const double squared = off.matrix().squaredNorm();
        int& score = m_scores[static_cast<std::size_t>(at.y() * m_size.x() + at.x())];
        score = std::max(score, static_cast<int>(std::lround(255 * std::exp(-squared / 2 / 1.44))));
      }
  }
  int scoreOf(int angle, int x, int y) const { return scoreOf(cellsAt(angle), {x, y}); }
  int bestWithin(int radius, int angles) const {
    int best = 0;
    for (int a = -angles; a <= angles; ++a) {
      const auto cells = cellsAt(a);
      for (int x = -radius; x <= radius; ++x)
        for (int y = -radius; y <= radius; ++y) best = std::max(best, scoreOf(cells, {x, y}));
    }
    return best;
  }

 private:
  using Cells = std::vector<Eigen::Array2i>;
  Cells cellsAt(int angle) const {
    const Eigen::Rotation2Dd turn(m_guess[2] + angle * kStep);
    Cells cells;
    for (const Eigen::Vector2d& p : m_scan) cells.push_back(cellOf(turn * p + m_guess.head<2>()));
    return cells;
  }
  int scoreOf(const Cells& cells, const Eigen::Array2i& moved) const {
    int score = 0;
    for (const Eigen::Array2i& cell : cells) {
      const Eigen::Array2i at = cell + moved;
      if ((at >= 0).all() && (at < m_size).all())
        score += m_scores[static_cast<std::size_t>(at.y() * m_size.x() + at.x())];
    }
    return score;
  }
  Eigen::Array2i cellOf(const Eigen::Vector2d& p) const {
    return ((p - m_corner).array() / kCell).floor().cast<int>();
  }
  PlanePoints m_scan;
  Eigen::Vector3d m_guess;
  Eigen::Vector2d m_corner;
  Eigen::Array2i m_size;
  std::vector<int> m_scores;
};

/** \param radius cells of the window \param angles steps of it */
void expectTheBest(const PlanePoints& others, const PlanePoints& scan, const Eigen::Vector3d& guess,
                   int radius, int angles) {
  const Oracle oracle(others, scan, guess);
  const int best = oracle.bestWithin(radius, angles);
  const PlaneSearch search(others, kCell);
  const PlaneSearch::Window window{(radius - 0.5) * kCell, (angles - 0.5) * kStep};
  const double share = best / (255. * static_cast<double>(scan.size()));
  const auto found = search.find(scan, guess, window, share - 0.01);
  ASSERT_TRUE(found);
  const Eigen::Vector3d off = found->pose - guess;
  EXPECT_EQ(oracle.scoreOf(static_cast<int>(std::lround(off[2] / kStep)),
                           static_cast<int>(std::lround(off[0] / kCell)),
                           static_cast<int>(std::lround(off[1] / kCell))),
            best);
  EXPECT_FALSE(search.find(scan, guess, window, share + 0.01));
}

}  // namespace

TEST(PlaneSearch, findsNoLessThanTryingEverything) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Uniform uniform(seed);
    const PlanePoints others = room(uniform, 40);
    PlanePoints scan;
    const Eigen::Vector3d truth(uniform(-1, 1), uniform(-1, 1), uniform(-0.2, 0.2));
    for (const Eigen::Vector2d& p : others)
      if (uniform(0, 1) < 0.3)
        scan.push_back(Eigen::Rotation2Dd(-truth[2]) * (p - truth.head<2>()));
    const Eigen::Vector3d guess(uniform(-1, 1), uniform(-1, 1), uniform(-0.1, 0.1));
    const int radius = 4 + static_cast<int>(seed % 9), angles = 2 + static_cast<int>(seed % 3);
    SCOPED_TRACE(seed);
    expectTheBest(others, scan, guess, radius, angles);
  }
}

namespace {

PlanePoints field(Uniform& uniform, int n, double half) {
  PlanePoints points;
  for (int i = 0; i < n; ++i) points.emplace_back(uniform(-half, half), uniform(-half, half));
  return points;
}

/** What a robot sees within some meters. \param T x, y, heading */
PlanePoints seenFrom(const Eigen::Vector3d& T, const PlanePoints& points, double range) {
  PlanePoints seen;
  for (const Eigen::Vector2d& p : points)
    if ((p - T.head<2>()).norm() < range)
      seen.push_back(Eigen::Rotation2Dd(-T[2]) * (p - T.head<2>()));
  return seen;
}

constexpr double kHalf = 75;
const PlaneSearch::Window kEverywhere{kHalf, M_PI};

}  // namespace

TEST(PlaneSearch, findsNoLessThanTryingEverythingInALargeWindow) {
  Uniform uniform(3);
  for (const int bushes : {30, 300, 1500}) {
    SCOPED_TRACE(bushes);
    const PlanePoints others = field(uniform, bushes, 8);
    const PlanePoints scan = seenFrom({3, -5, 1}, others, 4);
    const PlanePoints elsewhere = seenFrom({0, 0, 0}, field(uniform, bushes, 8), 4);
    const int radius = bushes > 1000 ? 10 : 50;
    expectTheBest(others, scan, {2, -3, 0}, radius, 120);
    expectTheBest(others, elsewhere, {2, -3, 0}, radius, 120);
  }
}

TEST(PlaneSearch, findsARobotWhereMuchIsAlike) {
  Uniform uniform(2);
  const PlanePoints bushes = field(uniform, 20000, kHalf);
  const Eigen::Vector3d truth(-31, 44, 96 * kStep);
  const auto found =
      PlaneSearch(bushes, kCell).find(seenFrom(truth, bushes, 12), {0, 0, 0}, kEverywhere, 0.65);
  ASSERT_TRUE(found);
  EXPECT_LT((found->pose.head<2>() - truth.head<2>()).norm(), 2 * kCell);
  EXPECT_NEAR(std::remainder(found->pose[2] - truth[2], 2 * M_PI), 0, kStep);
  EXPECT_TRUE(found->isAlone);
}

TEST(PlaneSearch, givesUpAfterSoManyLooks) {
  Uniform uniform(2);
  const PlanePoints bushes = field(uniform, 2000, 10);
  const PlanePoints scan = seenFrom({-3, 4, 96 * kStep}, bushes, 4);
  const PlaneSearch search(bushes, kCell);
  const auto within = [&](std::size_t looks) {
    return search.find(scan, {0, 0, 0}, {10, M_PI}, 0.65, looks);
  };
  const auto all = within(PlaneSearch::kMostLooks);
  ASSERT_TRUE(all && all->isAlone);
  EXPECT_FALSE(within(10'000));
  std::size_t left = 10'000;
  EXPECT_FALSE(search.find(scan, {0, 0, 0}, {10, M_PI}, 0.65, left));
  EXPECT_LT(left, 1'000u) << "for other searches";
  bool isFound = false;
  for (std::size_t looks = 10'000; looks < PlaneSearch::kMostLooks; looks *= 2) {
    const auto found = within(looks);
    EXPECT_GE(found.has_value(), isFound) << "more looks find no less";
    isFound = found.has_value();
    EXPECT_TRUE(!isFound || found->pose == all->pose);
  }
  EXPECT_TRUE(isFound);
}

TEST(PlaneSearch, takesNoPlaceForTheOnlyOneWhereMillionsFit) {
  PlanePoints full;
  for (int x = -200; x < 200; ++x)
    for (int y = -200; y < 200; ++y) full.emplace_back(kCell * (x + 0.5), kCell * (y + 0.5));
  const PlanePoints scan{{0, 0}, {1, 0}, {0, 1}};
  const auto found = PlaneSearch(full, kCell).find(scan, {0, 0, 0}, {15, M_PI}, 0.65);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->isAlone);
}

namespace {

/** A corridor of 16 m with a door each so many m; without: 0. */
PlanePoints corridor(double pitch) {
  PlanePoints points;
  for (double x = 0; x < 16; x += 0.05) {
    const bool isDoor = pitch > 0 && std::fmod(x, pitch) < 0.9;
    points.emplace_back(x, isDoor ? 1.3 : 1);
    points.emplace_back(x, -1);
  }
  return points;
}

/** Whether a robot in the middle of a corridor of what others saw is in one place alone. */
bool isAlone(PlanePoints others, double radius) {
  const PlanePoints scan = seenFrom({8, 0, 0}, others, 4);
  const auto found = PlaneSearch(others, kCell).find(scan, {8, 0, 0}, {radius, 0.1}, 0.65);
  return found && found->isAlone;
}

}  // namespace

TEST(PlaneSearch, saysWhereDoorsAreAlikeThatTwoPlacesFit) {
  EXPECT_FALSE(isAlone(corridor(3), 3.5));
  EXPECT_TRUE(isAlone(corridor(3), 2)) << "the next door is beyond the window";
  EXPECT_TRUE(isAlone(corridor(0), 3.5)) << "a corridor without doors is one place";
  PlanePoints withNiche = corridor(3);
  for (double y = 1; y < 3; y += 0.05) {
    withNiche.emplace_back(10, y);
    withNiche.emplace_back(11, y);
  }
  EXPECT_TRUE(isAlone(withNiche, 3.5)) << "what no other place has";
}
