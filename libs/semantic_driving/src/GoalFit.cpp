#include <mrpt/core/format.h>
#include <mrpt/math/wrap2pi.h>
#include <semantic_driving/Explorer.h>
#include <semantic_driving/PathCheck.h>
#include <semantic_planning/roadmap/CollisionChecker.h>

#include <algorithm>
#include <cmath>

#include "GroundFlood.h"
#include "Surroundings.h"

namespace semantic_driving {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using namespace semantic_planning;

namespace {

/** Squared, in columns: from nearest side to nearest side, as Surface::clearance2. */
int clearance2(Column a, Column b) {
  const int dx = std::max(0, std::abs(a.x - b.x) - 1), dy = std::max(0, std::abs(a.y - b.y) - 1);
  return dx * dx + dy * dy;
}

/** f(column) for the columns at most `reach` away along x and along y. */
template <class F>
void forSquare(Column center, int reach, F f) {
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) f(Column{center.x + x, center.y + y});
}

template <class F>
bool anyInSquare(Column center, int reach, F f) {
  bool any = false;
  forSquare(center, reach, [&](Column c) { any = any || f(c); });
  return any;
}

/** The columns that a vehicle at the goal must have for itself. */
class Claim {
 public:
  Claim(const SemanticPlanner& planner, const TPose2D& goal)
      : m_ground(planner.ground()),
        m_checker(m_ground, planner.options().vehicle, planner.order()),
        m_goal(goal) {}

  /** f(column, only wheels) */
  template <class F>
  void forEach(F f) const {
    for (const CollisionChecker::CheckedDisc& d : m_checker.discs()) {
      const Column center = at(d.disc.x, d.disc.y);
      forSquare(center, static_cast<int>(std::ceil(std::sqrt(d.needed2))), [&](Column c) {
        if (clearance2(center, c) < d.needed2) f(c, false);
      });
    }
    for (const double y : m_checker.wheels()) f(at(0, y), true);
  }
  double reach() const {
    double reach = 0;
    forEach([&](Column c, bool) { reach = std::max(reach, distance(c)); });
    return reach;
  }
  /** From the goal's place, meters. */
  double distance(Column c) const {
    return std::hypot(m_ground.centerOf(c.x) - m_goal.x, m_ground.centerOf(c.y) - m_goal.y);
  }
  bool isSeen() const {
    bool any = false;
    forEach([&](Column c, bool) { any = any || !m_ground.surfaces(c).empty(); });
    return any;
  }

 private:
  Column at(double x, double y) const {
    const TPoint2D p = m_goal.composePoint({x, y});
    return m_ground.columnAt(p.x, p.y);
  }

  const Ground& m_ground;
  CollisionChecker m_checker;
  const TPose2D& m_goal;
};

/** Ground next to it was seen, at the height where it is in the way. */
bool isAtSeenGround(const Ground& ground, const Surroundings& heights, Column c) {
  constexpr double kNext = 0.6;  // m
  return anyInSquare(c, static_cast<int>(kNext / ground.voxelSize()), [&](Column near) {
    if (!heights.contains(near)) return false;
    const Surface* s = ground.near(near, heights.height(c), ground.step());
    return s && !s->filled;
  });
}

}  // namespace

std::optional<GoalMisfit> findMisfit(const SemanticPlanner& planner, const TPose2D& from, double z,
                                     const TPose2D& goal) {
  const Ground& ground = planner.ground();
  const Claim claim(planner, goal);
  if (!claim.isSeen()) return {};
  const double far = std::hypot(goal.x - from.x, goal.y - from.y) + claim.reach();
  const Surroundings heights(ground, from, ground.keyOf(z), far + ground.voxelSize());
  ObstacleOptions all, things;
  all.forbiddenGround = true;
  things.forbiddenGround = planner.options().ground.keepOff;
  const ObstacleFinder belowWheels(planner, all), around(planner, things);
  std::optional<GoalMisfit> misfit;
  double nearest = std::numeric_limits<double>::infinity();
  claim.forEach([&](Column c, bool wheels) {
    const double distance = claim.distance(c);
    if (distance >= nearest || !heights.contains(c)) return;
    const int height = heights.height(c);
    const Surface* s = ground.near(c, height, ground.step());
    if (s && s->filled) return;  // as steep as it may be, nobody saw it
    if (!(wheels ? belowWheels : around).isObstacle(c, height, s)) return;
    if (!isAtSeenGround(ground, heights, c)) return;
    nearest = distance;
    const TPoint2D at{ground.centerOf(c.x), ground.centerOf(c.y)};
    const auto top = ground.find(at.x, at.y, ground.centerOf(height));
    misfit = GoalMisfit{at, top ? top->surface.classId : semantic_types::kNoClass};
  });
  return misfit;
}

std::optional<TPose2D> nearestFit(const SemanticPlanner& planner, const TPose2D& from, double z,
                                  const TPose2D& goal, double within) {
  constexpr double kTurn = 1.5 / M_PI;  // m/rad
  constexpr int kHeadings = 16;
  const Ground& ground = planner.ground();
  const double step = ground.voxelSize();
  const GroundFlood flood(planner, from, ground.keyOf(z), kFrontierRadius);
  std::optional<TPose2D> found;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](double r, const TPose2D& pose) {
    const double cost = r + kTurn * std::abs(mrpt::math::wrapToPi(pose.phi - goal.phi));
    const Column c = ground.columnAt(pose.x, pose.y);
    if (cost >= least || !flood.columns().contains(c) || !flood.at(c).done) return;
    if (planner.check(pose, ground.centerOf(flood.at(c).z)) != PlanStatus::Found) return;
    least = cost;
    found = pose;
  };
  for (double r = 0; r <= within && r < least; r += step) {
    const int directions = std::max(1, static_cast<int>(std::ceil(2 * M_PI * r / step)));
    for (int i = 0; i < directions; ++i)
      for (int k = 0; k < kHeadings; ++k) {
        const double to = goal.phi + i * 2 * M_PI / directions;
        consider(r, {goal.x + r * std::cos(to), goal.y + r * std::sin(to),
                     mrpt::math::wrapToPi(goal.phi + k * 2 * M_PI / kHeadings)});
      }
  }
  return found;
}

std::string describe(const GoalMisfit& misfit, const TPose2D& goal,
                     const semantic_types::ClassTable& classes) {
  const std::string what = misfit.classId == semantic_types::kNoClass
                               ? "something of unknown class"
                               : classes.name(misfit.classId);
  return mrpt::format("the goal (%.2f, %.2f) does not fit: %s is at (%.2f, %.2f)", goal.x, goal.y,
                      what.c_str(), misfit.at.x, misfit.at.y);
}

}  // namespace semantic_driving
