#include "PlaneSearch.h"
#include "SensorScale.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace semantic_slam {
namespace {

constexpr double kAngleStep = 1.5 * kDegree;
constexpr int kBest = 255;
/** A point is blurred by a Gaussian of so many cells, and drawn to twice that. */
constexpr double kBlur = 1.2;
constexpr int kReach = 3;
/** Points that one search looks up at most, beside those at the coarsest level: where much is alike
 * (trees, cars) and nothing fits, bounds exclude next to nothing. */
constexpr std::size_t kMostLooks = 300'000'000;
/** A column of a cloud reaches from low to high if it is so many cells high. */
constexpr float kUpright = 3;

int cellOf(double x, double cell) { return static_cast<int>(std::floor(x / cell)); }

}  // namespace

PlanePoints uprightPoints(const LabeledCloud& cloud, bool isPlanar, double cell) {
  struct Column {
    float low, high;
    std::size_t at;
  };
  PlanePoints points;
  std::unordered_map<std::uint64_t, Column> columns;
  for (const Eigen::Vector3f& p : cloud.points) {
    const Eigen::Vector2d q = p.head<2>().cast<double>();
    const auto x = static_cast<std::uint32_t>(cellOf(q.x(), cell)),
               y = static_cast<std::uint32_t>(cellOf(q.y(), cell));
    Column& column = columns.try_emplace(std::uint64_t{x} << 32 | y, Column{p.z(), p.z(), SIZE_MAX})
                         .first->second;
    column.low = std::min(column.low, p.z());
    column.high = std::max(column.high, p.z());
    const bool isUpright = isPlanar || column.high - column.low > kUpright * cell;
    if (!isUpright || column.at != SIZE_MAX) continue;
    column.at = points.size();
    points.push_back(q);
  }
  return points;
}

PlaneSearch::PlaneSearch(const PlanePoints& points, double cell) : m_cell(cell) {
  if (points.empty()) return;
  Eigen::Vector2d high = points.front();
  m_corner = points.front();
  for (const Eigen::Vector2d& p : points) {
    m_corner = m_corner.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  m_corner.array() -= (kReach + 1) * cell;  // one more, for rounding
  m_width = cellOf(high.x() - m_corner.x(), cell) + kReach + 2;
  m_height = cellOf(high.y() - m_corner.y(), cell) + kReach + 2;
  // Squares of the coarsest level are a 32nd of the grid at least: there each is looked at.
  std::size_t levels = kLevels;
  for (int edge = 1024; edge < std::max(m_width, m_height); edge *= 2) ++levels;
  m_levels.resize(levels);
  for (auto& level : m_levels)
    level.assign(static_cast<std::size_t>(m_width) * static_cast<std::size_t>(m_height), 0);
  drawPoints(points);
  pool();
}

void PlaneSearch::drawPoints(const PlanePoints& points) {
  std::uint8_t kernel[2 * kReach + 1][2 * kReach + 1];
  for (int i = -kReach; i <= kReach; ++i)
    for (int j = -kReach; j <= kReach; ++j)
      kernel[i + kReach][j + kReach] = static_cast<std::uint8_t>(
          std::lround(kBest * std::exp(-0.5 * (i * i + j * j) / (kBlur * kBlur))));
  for (const Eigen::Vector2d& p : points) {
    const int x = cellOf(p.x() - m_corner.x(), m_cell), y = cellOf(p.y() - m_corner.y(), m_cell);
    for (int i = -kReach; i <= kReach; ++i)
      for (int j = -kReach; j <= kReach; ++j) {
        std::uint8_t& c = cell(0, x + i, y + j);
        c = std::max(c, kernel[i + kReach][j + kReach]);
      }
  }
}

void PlaneSearch::pool() {
  for (int level = 1; level < numLevels(); ++level) {
    const int step = 1 << (level - 1);
    for (int y = 0; y < m_height; ++y)
      for (int x = 0; x < m_width; ++x) {
        std::uint8_t& c = cell(level, x, y);
        c = cell(level - 1, x, y);
        if (x + step < m_width) c = std::max(c, cell(level - 1, x + step, y));
        if (y + step >= m_height) continue;
        c = std::max(c, cell(level - 1, x, y + step));
        if (x + step < m_width) c = std::max(c, cell(level - 1, x + step, y + step));
      }
  }
}

int PlaneSearch::at(int level, int x, int y) const {
  const int edge = 1 << level;
  if (x <= -edge || y <= -edge || x >= m_width || y >= m_height) return 0;
  // A square that begins outside is within the one that begins at the border.
  return m_levels[static_cast<std::size_t>(level)]
                 [static_cast<std::size_t>(std::max(0, y)) * m_width +
                  static_cast<std::size_t>(std::max(0, x))];
}

class PlaneSearch::Search {
 public:
  Search(const PlaneSearch& grid, const PlanePoints& scan, const Eigen::Vector3d& guess,
         const Window& window)
      : m_grid(grid),
        m_radius(static_cast<int>(std::ceil(window.radius / grid.m_cell))),
        m_angles(static_cast<int>(std::ceil(window.angle / kAngleStep))) {
    for (int a = -m_angles; a <= m_angles; ++a) {
      const Eigen::Rotation2Dd turn(guess[2] + a * kAngleStep);
      auto& cells = m_cells.emplace_back();
      for (const Eigen::Vector2d& p : scan) {
        const Eigen::Vector2d q = turn * p + guess.head<2>() - grid.m_corner;
        cells.emplace_back(cellOf(q.x(), grid.m_cell), cellOf(q.y(), grid.m_cell));
      }
    }
  }

  /** \param least a score that has to be exceeded \return with a level of -1 if there is none, or
   * if that takes too long to find out */
  Candidate best(int least) {
    Candidate best{-1, 0, 0, 0, least};
    std::size_t left = kMostLooks / (4 * m_cells.front().size());  // of expansions
    for (std::vector<Candidate> open = coarsest(); !open.empty();) {
      const Candidate c = open.back();
      open.pop_back();
      if (c.score <= best.score) continue;
      if (c.level == 0) {
        best = c;
        continue;
      }
      if (left-- == 0) return {-1, 0, 0, 0, least};
      expand(c, best.score, open);
    }
    return best;
  }
  Eigen::Vector3d offsetOf(const Candidate& c) const {
    return {c.x * m_grid.m_cell, c.y * m_grid.m_cell, (c.angle - m_angles) * kAngleStep};
  }

 private:
  static bool isWorse(const Candidate& a, const Candidate& b) { return a.score < b.score; }

  std::vector<Candidate> coarsest() const {
    std::vector<Candidate> open;
    const int top = m_grid.numLevels() - 1, edge = 1 << top;
    for (int a = 0; a <= 2 * m_angles; ++a)
      for (int x = -m_radius; x <= m_radius; x += edge)
        for (int y = -m_radius; y <= m_radius; y += edge)
          open.push_back({top, a, x, y, scoreOf(top, a, x, y)});
    std::stable_sort(open.begin(), open.end(), isWorse);
    return open;
  }
  void expand(const Candidate& c, int least, std::vector<Candidate>& open) const {
    const int edge = 1 << (c.level - 1);
    const std::size_t first = open.size();
    for (int i = 0; i < 4; ++i) {
      const int x = c.x + (i & 1 ? edge : 0), y = c.y + (i & 2 ? edge : 0);
      if (x > m_radius || y > m_radius) continue;
      const int score = scoreOf(c.level - 1, c.angle, x, y);
      if (score > least) open.push_back({c.level - 1, c.angle, x, y, score});
    }
    std::stable_sort(open.begin() + static_cast<std::ptrdiff_t>(first), open.end(), isWorse);
  }
  int scoreOf(int level, int angle, int x, int y) const {
    int score = 0;
    for (const auto& [cx, cy] : m_cells[static_cast<std::size_t>(angle)])
      score += m_grid.at(level, cx + x, cy + y);
    return score;
  }

  const PlaneSearch& m_grid;
  int m_radius, m_angles;
  std::vector<std::vector<std::pair<int, int>>> m_cells;  ///< of the scan, turned by each angle
};

std::optional<Eigen::Vector3d> PlaneSearch::find(const PlanePoints& scan,
                                                 const Eigen::Vector3d& guess, const Window& window,
                                                 double least) const {
  if (scan.empty() || m_width == 0) return std::nullopt;
  Search search(*this, scan, guess, window);
  const auto best = search.best(static_cast<int>(least * kBest * static_cast<double>(scan.size())));
  if (best.level < 0) return std::nullopt;
  return guess + search.offsetOf(best);
}

}  // namespace semantic_slam
