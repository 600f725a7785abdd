#include <mrpt/core/format.h>
#include <mrpt/math/wrap2pi.h>
#include <semantic_driving/Explorer.h>
#include <semantic_driving/PathCheck.h>
#include <semantic_planning/roadmap/CollisionChecker.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "GroundFlood.h"
#include "Surroundings.h"

namespace semantic_driving {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using namespace semantic_planning;

namespace {

/** f(column) for the columns at most `reach` away along x and along y. */
template <class F>
void forSquare(Column center, int reach, F f) {
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) f(Column{center.x + x, center.y + y});
}

/** A column that a vehicle at a goal must have for itself. */
struct Claimed {
  double distance;  ///< from the goal, m
  Column column;
  bool isUnderWheels;
};

/** Nearest first: what CollisionChecker asks for at a pose. */
std::vector<Claimed> claimOf(const SemanticPlanner& planner, const TPose2D& goal) {
  const Ground& ground = planner.ground();
  const CollisionChecker checker(ground, planner.options().vehicle, planner.order());
  std::vector<Claimed> claim;
  const auto at = [&](double x, double y) {
    const TPoint2D p = goal.composePoint({x, y});
    return ground.columnAt(p.x, p.y);
  };
  const auto add = [&](Column c, bool isUnderWheels) {
    const double x = ground.centerOf(c.x) - goal.x, y = ground.centerOf(c.y) - goal.y;
    claim.push_back({std::hypot(x, y), c, isUnderWheels});
  };
  for (const CollisionChecker::CheckedDisc& d : checker.discs()) {
    const Column center = at(d.disc.x, d.disc.y);
    forSquare(center, static_cast<int>(std::ceil(std::sqrt(d.needed2))), [&](Column c) {
      const int x = std::max(0, std::abs(c.x - center.x) - 1),
                y = std::max(0, std::abs(c.y - center.y) - 1);  // as Surface::clearance2
      if (x * x + y * y < d.needed2) add(c, false);
    });
  }
  for (const double y : checker.wheels()) add(at(0, y), true);
  std::stable_sort(claim.begin(), claim.end(),
                   [](const Claimed& a, const Claimed& b) { return a.distance < b.distance; });
  return claim;
}

/** Ground next to it was seen, at the height where it is in the way. */
bool isAtSeenGround(const Ground& ground, const Surroundings& heights, Column c) {
  constexpr double kNext = 0.6;  // m
  bool isAny = false;
  forSquare(c, static_cast<int>(kNext / ground.voxelSize()), [&](Column near) {
    if (isAny || !heights.contains(near)) return;
    const Surface* s = ground.near(near, heights.height(c), ground.step());
    isAny = s && !s->filled;
  });
  return isAny;
}

}  // namespace

std::optional<GoalMisfit> findMisfit(const SemanticPlanner& planner, const TPose2D& from, double z,
                                     const TPose2D& goal) {
  const Ground& ground = planner.ground();
  const std::vector<Claimed> claim = claimOf(planner, goal);
  if (std::all_of(claim.begin(), claim.end(),
                  [&](const Claimed& c) { return ground.surfaces(c.column).empty(); }))
    return {};
  const double far = std::hypot(goal.x - from.x, goal.y - from.y) + claim.back().distance;
  const Column center = ground.columnAt(from.x, from.y);
  const int reach = static_cast<int>(std::ceil(far / ground.voxelSize())) + 1;
  const Surroundings heights(ground, ColumnRectangle::around(center, reach), center,
                             ground.keyOf(z));
  ObstacleOptions all, things;
  things.forbiddenGround = planner.options().ground.keepOff;
  for (const auto& [distance, c, isUnderWheels] : claim) {
    if (!heights.contains(c)) continue;
    const int height = heights.height(c);
    const Surface* s = ground.near(c, height, ground.step());
    if (s && s->filled) continue;  // as steep as it may be, nobody saw it
    if (!isObstacle(planner, isUnderWheels ? all : things, c, height, s)) continue;
    if (!isAtSeenGround(ground, heights, c)) continue;
    const TPoint2D at{ground.centerOf(c.x), ground.centerOf(c.y)};
    const auto top = ground.find(at.x, at.y, ground.centerOf(height));
    return GoalMisfit{at, top ? top->surface.classId : semantic_types::kNoClass};
  }
  return {};
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
