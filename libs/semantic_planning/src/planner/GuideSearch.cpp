#include "GuideSearch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>

#include "GuideRaster.h"

namespace semantic_planning {

namespace {

using Cost = std::int64_t;
constexpr Cost kUnreached = std::numeric_limits<Cost>::max();
constexpr Cost kStraight = 5, kDiagonal = 7;  // lengths of steps, in fifths of a voxel

/** A step to a neighboring column, and where discs and wheels are when it has been taken. */
struct Step {
  Column by;
  Cost length;
  std::vector<Column> discs, wheels;
};

Column rotated(double x, double y, double angle, double voxel) {
  return {static_cast<int>(std::lround((std::cos(angle) * x - std::sin(angle) * y) / voxel)),
          static_cast<int>(std::lround((std::sin(angle) * x + std::cos(angle) * y) / voxel))};
}

std::array<Step, 8> stepsOf(const EdgeChecker& checker) {
  const double voxel = checker.ground().voxelSize();
  std::array<Step, 8> steps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double angle = static_cast<double>(i) * M_PI / 4;
    steps[i].by = rotated(1.2 * voxel, 0, angle, voxel);
    steps[i].length = i % 2 ? kDiagonal : kStraight;
    for (const auto& d : checker.discs())
      steps[i].discs.push_back(rotated(d.disc.x, d.disc.y, angle, voxel));
    for (const double y : checker.wheels()) steps[i].wheels.push_back(rotated(0, y, angle, voxel));
  }
  return steps;
}

Column operator+(Column a, Column b) { return {a.x + b.x, a.y + b.y}; }

class GuideSearch {
 public:
  GuideSearch(const EdgeChecker& checker, const PlanningRegion& region)
      : m_checker(checker),
        m_raster(checker.ground(), region),
        m_steps(stepsOf(checker)),
        m_weights(weightsOfRanks(checker.order())),
        m_labels(static_cast<std::size_t>(m_raster.size())) {}

  /** From one to the other, if there is a way. */
  void run(const GroundPose& start, const GroundPose& goal, Guide& guide) {
    const int from = cellOf(start);
    m_goal = cellOf(goal);
    if (from == GuideRaster::kNone || m_goal == GuideRaster::kNone) return;
    reach(from, {0, GuideRaster::kNone, 0, false});
    while (!m_queue.empty()) {
      const Entry entry = m_queue.top();
      m_queue.pop();
      if (entry.cell == m_goal) return traceTo(m_goal, guide);
      if (label(entry.cell).done) continue;
      label(entry.cell).done = true;
      for (std::size_t i = 0; i < m_steps.size(); ++i) take(i, entry.cell);
    }
  }

 private:
  struct Label {
    Cost cost = kUnreached;
    int before = GuideRaster::kNone;
    std::int8_t step = 0;  ///< with which it was reached
    bool done = false;
  };
  struct Entry {
    Cost estimate;
    int cell;
    bool operator<(const Entry& o) const {  // the least on top
      return estimate != o.estimate ? estimate > o.estimate : cell > o.cell;
    }
  };

  Label& label(int cell) { return m_labels[static_cast<std::size_t>(cell)]; }

  int cellOf(const GroundPose& p) const {
    return m_raster.near(m_checker.ground().columnAt(p.pose.x, p.pose.y), p.z, 0);
  }

  void take(std::size_t number, int from) {
    const Step& step = m_steps[number];
    const auto& cell = m_raster[from];
    const int to = m_raster.near(cell.column + step.by, cell.z, m_checker.ground().step());
    if (to == GuideRaster::kNone) return;
    const Cost before = label(from).cost, known = label(to).cost;
    if (label(to).done || before + step.length >= known) return;
    const colored_graph::Rank rank = rankAt(step, to);
    if (rank == colored_graph::kForbidden) return;
    const Cost cost = before + step.length * m_weights[static_cast<std::size_t>(rank)];
    if (cost < known && (to == m_goal || fits(step, to)))
      reach(to, {cost, from, static_cast<std::int8_t>(number), false});
  }

  /** The worst under the wheels. */
  colored_graph::Rank rankAt(const Step& step, int at) const {
    const auto& cell = m_raster[at];
    colored_graph::Rank worst = 0;
    for (const Column& wheel : step.wheels) {
      const int below = m_raster.near(cell.column + wheel, cell.z, 2 * m_checker.ground().step());
      if (below == GuideRaster::kNone) return colored_graph::kForbidden;
      worst = std::max(worst, m_checker.order().rank(m_raster[below].classId));
    }
    return worst;
  }

  bool fits(const Step& step, int at) const {
    const auto& cell = m_raster[at];
    for (std::size_t i = 0; i < step.discs.size(); ++i) {
      const auto& disc = m_checker.discs()[i];
      const int below = m_raster.near(cell.column + step.discs[i], cell.z, disc.tolerance);
      if (below == GuideRaster::kNone || m_raster[below].clearance2 < disc.needed2) return false;
    }
    return true;
  }

  void reach(int cell, const Label& reached) {
    label(cell) = reached;
    m_queue.push({reached.cost + bound(m_raster[cell].column), cell});
  }

  Cost bound(Column c) const {
    const Column goal = m_raster[m_goal].column;
    const Cost dx = std::abs(c.x - goal.x), dy = std::abs(c.y - goal.y);
    return kStraight * std::max(dx, dy) + (kDiagonal - kStraight) * std::min(dx, dy);
  }

  PathPoint pointAt(int cell) const {
    const Ground& ground = m_checker.ground();
    PathPoint p;
    p.x = ground.centerOf(m_raster[cell].column.x);
    p.y = ground.centerOf(m_raster[cell].column.y);
    p.z = ground.centerOf(m_raster[cell].z);
    p.classId = m_raster[cell].classId;
    return p;
  }

  void traceTo(int cell, Guide& guide) {
    guide.lengthPerRank.resize(m_weights.size());
    for (; cell != GuideRaster::kNone; cell = label(cell).before) {
      guide.path.push_back(pointAt(cell));
      const Label& at = label(cell);
      if (at.before == GuideRaster::kNone) continue;
      const Cost length = m_steps[static_cast<std::size_t>(at.step)].length;
      const Cost weight = (at.cost - label(at.before).cost) / length;
      const auto rank = std::lower_bound(m_weights.begin(), m_weights.end(), weight);
      guide.lengthPerRank[static_cast<std::size_t>(rank - m_weights.begin())] +=
          static_cast<double>(length) / kStraight * m_checker.ground().voxelSize();
    }
    std::reverse(guide.path.begin(), guide.path.end());
  }

  const EdgeChecker& m_checker;
  const GuideRaster m_raster;
  const std::array<Step, 8> m_steps;
  const std::vector<Cost> m_weights;  ///< of a length, by rank
  std::vector<Label> m_labels;
  std::priority_queue<Entry> m_queue;
  int m_goal = GuideRaster::kNone;
};

}  // namespace

std::vector<std::int64_t> weightsOfRanks(const colored_graph::ClassOrder& order) {
  const Cost factor = std::min<Cost>(256, Cost{1} << (40 / std::max(1, order.ranks() - 1)));
  std::vector<Cost> weights;
  for (int rank = 0; rank < order.ranks(); ++rank)
    weights.push_back(rank == 0 ? 1 : weights.back() * factor);
  return weights;
}

Guide searchGuide(const EdgeChecker& checker, const PlanningRegion& region, const GroundPose& start,
                  const GroundPose& goal) {
  Guide guide{region, {}, {}};
  std::vector<PathPoint>& path = guide.path;
  GuideSearch(checker, region).run(start, goal, guide);
  if (path.size() < 2) path.clear();
  if (path.empty()) return guide;
  for (std::size_t i = 1; i < path.size(); ++i) {
    PathPoint &a = path[i - 1], &b = path[i];
    b.arcLength = a.arcLength + std::hypot(b.x - a.x, b.y - a.y);
    b.heading = std::atan2(b.y - a.y, b.x - a.x);
  }
  const auto putAt = [](PathPoint& p, const mrpt::math::TPose2D& pose) {
    p.x = pose.x, p.y = pose.y, p.heading = pose.phi;
  };
  putAt(path.front(), start.pose);
  putAt(path.back(), goal.pose);
  return guide;
}

}  // namespace semantic_planning
