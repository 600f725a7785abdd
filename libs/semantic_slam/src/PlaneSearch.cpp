#include "PlaneSearch.h"
#include "SensorScale.h"

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <set>
#include <unordered_map>

namespace semantic_slam {
namespace {

constexpr double kAngleStep = 1.5 * kDegree;
constexpr int kBest = 255;
/** A point is blurred by a Gaussian of so many cells, and drawn to twice that. */
constexpr double kBlur = 1.2;
constexpr int kReach = 3;
/** Squares in rows take so many times less time. */
constexpr int kRows = 16;
/** Points whose scores 16 bits hold. */
constexpr std::size_t kInSum = 257;
/** Places that are remembered at most, where many around the best fit as well. */
constexpr std::size_t kMostAround = 1'000'000;
/** A column of a cloud reaches from low to high if it is so many cells high. */
constexpr float kUpright = 3;
/** Scores that differ by less than so many standard deviations of their difference are alike. */
const double kAlike = 3 * std::sqrt(2);
/** Levels of a search that found nothing, and of one that gave up. */
constexpr int kNone = -1, kGaveUp = -2;

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
  const auto sizeOf = [&](double length) {  // a multiple of the margin
    return (cellOf(length, cell) + kReach + 1) / kMargin * kMargin + 3 * kMargin;
  };
  m_width = sizeOf(high.x() - m_corner.x());
  m_height = sizeOf(high.y() - m_corner.y());
  m_levels.resize(kLevels);
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
    const int x = cellOf(p.x() - m_corner.x(), m_cell) + kMargin,
              y = cellOf(p.y() - m_corner.y(), m_cell) + kMargin;
    for (int i = -kReach; i <= kReach; ++i)
      for (int j = -kReach; j <= kReach; ++j) {
        std::uint8_t& c = m_levels[0][indexOf(0, x + i, y + j)];
        c = std::max(c, kernel[i + kReach][j + kReach]);
      }
  }
}

void PlaneSearch::pool() {
  for (int level = 1; level < kLevels; ++level) {
    const auto& finer = m_levels[static_cast<std::size_t>(level - 1)];
    auto& pooled = m_levels[static_cast<std::size_t>(level)];
    const int half = 1 << (level - 1), row = m_width >> (level - 1);
    for (int y = 0; y < m_height - half; ++y)
      for (int x = 0; x < m_width - half; ++x) {
        const std::uint8_t* at = &finer[indexOf(level - 1, x, y)];
        pooled[indexOf(level, x, y)] = std::max({at[0], at[1], at[row], at[row + 1]});
      }
  }
}

class PlaneSearch::Search {
 public:
  Search(const PlaneSearch& grid, const PlanePoints& scan, const Eigen::Vector3d& guess,
         const Window& window, std::size_t mostLooks)
      : m_grid(grid),
        m_radius(static_cast<int>(std::ceil(window.radius / grid.m_cell))),
        m_angles(static_cast<int>(std::ceil(window.angle / kAngleStep))),
        m_most(mostLooks / scan.size()),
        m_left(m_most) {
    for (int a = -m_angles; a <= m_angles; ++a) {
      const Eigen::Rotation2Dd turn(guess[2] + a * kAngleStep);
      auto& cells = m_cells.emplace_back();
      for (const Eigen::Vector2d& p : scan) {
        const Eigen::Vector2d q = turn * p + guess.head<2>() - grid.m_corner;
        cells.emplace_back(cellOf(q.x(), grid.m_cell) + kMargin,
                           cellOf(q.y(), grid.m_cell) + kMargin);
      }
    }
  }

  using Places = std::set<std::array<int, 3>>;

  /** \param least a score that has to be exceeded \param known places that do not count; if there
   * are any, another one is as good as the best
   * \return with a level of kNone if there is none, of kGaveUp if that takes too long to find out
   */
  Candidate best(int least, const Places& known = {}) {
    Candidate best{kNone, 0, 0, 0, least};
    if (least < m_coarsestLeast) m_coarsest = coarsest(m_coarsestLeast = least);
    for (std::vector<Candidate> open = m_coarsest; !open.empty();) {
      const Candidate c = open.back();
      open.pop_back();
      if (c.score <= best.score) continue;
      if (c.level == 0) {
        if (known.count({c.angle, c.x, c.y}) == 0) best = c;
        if (!known.empty() && best.level == 0) break;
        continue;
      }
      if (m_left < 4) return {kGaveUp, 0, 0, 0, least};
      m_left -= 4;
      expand(c, best.score, open);
    }
    return best;
  }
  /** Another place is one that paths lead to from the best only through places that fit worse. A
   * corridor without doors is one place. Where that takes too long to find out, there is another.
   */
  bool isAlone(const Candidate& place) {
    const int least = place.score - noiseOf(place) - 1;
    const auto known = around(place, least);
    return known && best(least, *known).level == kNone;
  }
  /** That it took so far, points. */
  std::size_t looks() const { return (m_most - m_left + m_inRows / kRows) * m_cells[0].size(); }
  Eigen::Vector3d offsetOf(const Candidate& c) const {
    return {c.x * m_grid.m_cell, c.y * m_grid.m_cell, (c.angle - m_angles) * kAngleStep};
  }

 private:
  static bool isWorse(const Candidate& a, const Candidate& b) { return a.score < b.score; }

  /** As many of the best as a search gets to before it gives up. */
  std::vector<Candidate> coarsest(int least) {
    const std::size_t most = m_most / 4 + 1;
    std::vector<Candidate> open;
    std::vector<int> scores;
    const int n = (2 * m_radius >> kCoarsest) + 1;  // along each axis
    for (int angle = 0; angle <= 2 * m_angles; ++angle) {
      scoreAll(n, angle, scores);
      m_inRows += scores.size();
      for (int i = 0; i < n * n; ++i)
        if (const int score = scores[static_cast<std::size_t>(i)]; score > least)
          open.push_back({kCoarsest, angle, (i % n << kCoarsest) - m_radius,
                          (i / n << kCoarsest) - m_radius, score});
      if (open.size() / 2 < most) continue;  // large windows have more than memory is for
      keepBest(open, most);
      least = open.front().score - 1;
    }
    keepBest(open, most);
    return open;
  }
  /** Sorts them; of those that are alike it keeps the last. */
  static void keepBest(std::vector<Candidate>& open, std::size_t most) {
    std::stable_sort(open.begin(), open.end(), isWorse);
    open.erase(open.begin(), open.end() - static_cast<std::ptrdiff_t>(std::min(most, open.size())));
  }
  /** Scores the window's coarsest squares, n x n, row by row. */
  void scoreAll(int n, int angle, std::vector<int>& scores) const {
    const int width = m_grid.m_width >> kCoarsest, height = m_grid.m_height >> kCoarsest;
    scores.assign(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), 0);
    std::vector<std::uint16_t> sums(scores.size());
    std::size_t inSums = 0;
    const auto& cells = m_cells[static_cast<std::size_t>(angle)];
    const auto& squares = m_grid.m_levels.back();
    for (const auto& [cx, cy] : cells) {
      const int x = cx - m_radius, y = cy - m_radius, column = x >> kCoarsest, row = y >> kCoarsest;
      const int first = std::max(0, -column), last = std::min(n, width - column);
      for (int j = std::max(0, -row); first < last && j < std::min(n, height - row); ++j) {
        const std::uint8_t* from =
            &squares[m_grid.indexOf(kCoarsest, x + (first << kCoarsest), y + (j << kCoarsest))];
        std::uint16_t* to = &sums[static_cast<std::size_t>(j * n + first)];
        for (int i = 0; i < last - first; ++i) to[i] = static_cast<std::uint16_t>(to[i] + from[i]);
      }
      if (++inSums % kInSum != 0 && inSums < cells.size()) continue;
      for (std::size_t i = 0; i < scores.size(); ++i) scores[i] += sums[i];
      std::fill(sums.begin(), sums.end(), 0);
    }
  }
  void expand(const Candidate& c, int least, std::vector<Candidate>& open) const {
    const int level = c.level - 1, edge = 1 << level;
    const auto scores = scoreFour(level, c.angle, c.x, c.y);
    const std::size_t first = open.size();
    for (int i = 0; i < 4; ++i) {
      const int x = c.x + (i & 1 ? edge : 0), y = c.y + (i & 2 ? edge : 0);
      const int score = scores[static_cast<std::size_t>(i)];
      if (x <= m_radius && y <= m_radius && score > least)
        open.push_back({level, c.angle, x, y, score});
    }
    std::stable_sort(open.begin() + static_cast<std::ptrdiff_t>(first), open.end(), isWorse);
  }
  /** Scores a square, the one beside it, and the two above. */
  std::array<int, 4> scoreFour(int level, int angle, int dx, int dy) const {
    const auto& squares = m_grid.m_levels[static_cast<std::size_t>(level)];
    const int lastX = m_grid.m_width - (2 << level), lastY = m_grid.m_height - (2 << level),
              row = m_grid.m_width >> level;
    std::array<int, 4> scores{};
    for (const auto& [cx, cy] : m_cells[static_cast<std::size_t>(angle)]) {
      const int x = cx + dx, y = cy + dy;
      if (x < 0 || y < 0 || x > lastX || y > lastY) continue;  // all are in the margin
      const std::uint8_t* at = &squares[m_grid.indexOf(level, x, y)];
      scores[0] += at[0];
      scores[1] += at[1];
      scores[2] += at[row];
      scores[3] += at[row + 1];
    }
    return scores;
  }
  /** What two scores differ by though both places fit: each cell of the scan is a sample. */
  int noiseOf(const Candidate& c) const {
    const auto& cells = m_cells[static_cast<std::size_t>(c.angle)];
    double squares = 0;
    for (const auto& [cx, cy] : cells) squares += std::pow(scoreOf(cx + c.x, cy + c.y), 2);
    const auto n = static_cast<double>(cells.size()), mean = c.score / n;
    const auto samples = static_cast<double>(std::set(cells.begin(), cells.end()).size());
    return static_cast<int>(kAlike * n * std::sqrt((squares / n - mean * mean) / samples));
  }
  /** The places that exceed a score, from one of them to its neighbors, and so on.
   * \return nothing if they are too many */
  std::optional<Places> around(const Candidate& place, int least) {
    Places known, seen{{place.angle, place.x, place.y}};
    std::vector<std::array<int, 3>> open(seen.begin(), seen.end());
    const std::size_t most = std::min(m_left, kMostAround);
    while (!open.empty()) {
      const auto from = open.back();
      open.pop_back();
      if (scoreFour(0, from[0], from[1], from[2])[0] <= least) continue;
      known.insert(from);
      for (int i = 0; i < 27; ++i) {
        const std::array<int, 3> to{from[0] + i / 9 - 1, from[1] + i / 3 % 3 - 1,
                                    from[2] + i % 3 - 1};
        if (to[0] < 0 || to[0] > 2 * m_angles || std::abs(to[1]) > m_radius ||
            std::abs(to[2]) > m_radius || !seen.insert(to).second)
          continue;
        if (seen.size() > most) return std::nullopt;
        open.push_back(to);
      }
    }
    m_left -= seen.size();
    return known;
  }
  int scoreOf(int x, int y) const {
    const bool isIn = x >= 0 && y >= 0 && x < m_grid.m_width && y < m_grid.m_height;
    return isIn ? m_grid.m_levels[0][m_grid.indexOf(0, x, y)] : 0;
  }

  const PlaneSearch& m_grid;
  int m_radius, m_angles;
  std::size_t m_most, m_left;                             ///< squares that may be looked at
  std::size_t m_inRows = 0;                               ///< that were, in rows
  std::vector<std::vector<std::pair<int, int>>> m_cells;  ///< of the scan, turned by each angle
  std::vector<Candidate> m_coarsest;
  int m_coarsestLeast = INT_MAX;
};

auto PlaneSearch::find(const PlanePoints& scan, const Eigen::Vector3d& guess, const Window& window,
                       double least, std::size_t& looks) const -> std::optional<Found> {
  if (scan.empty() || m_width == 0) return std::nullopt;
  Search search(*this, scan, guess, window, looks);
  const double highest = kBest * static_cast<double>(scan.size());
  const auto best = search.best(static_cast<int>(least * highest));
  std::optional<Found> found;
  if (best.level >= 0)
    found = {guess + search.offsetOf(best), best.score / highest, search.isAlone(best)};
  looks -= std::min(looks, search.looks());
  return found;
}

}  // namespace semantic_slam
