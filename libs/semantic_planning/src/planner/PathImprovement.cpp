#include "PathImprovement.h"

#include <semantic_planning/vehicle/PathPoint.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "LatticeSearch.h"
#include "PathSmoothing.h"
#include "PathTracing.h"
#include "PoseSearch.h"

namespace semantic_planning {
namespace {
using mrpt::math::TPose2D;

struct BesideOptions {
  double sideways, turn;   ///< to both sides of the path and of the direction of travel; m, radians
  bool atGearChangesOnly;  ///< and near them
};

constexpr double kSpacing = 2.0;  // m along the path
/** Poses head towards others so many stations farther on: straight ways join them. */
constexpr std::array<std::size_t, 2> kStraightSteps = {2, 6};

/** Where along the path its stations are: at its ends, and not too far apart between. */
std::vector<std::size_t> pointsOf(const std::vector<PathPoint>& path, double spacing,
                                  bool withGearChanges) {
  std::vector<std::size_t> points{0};
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const bool changes = withGearChanges && path[i].forward != path[i + 1].forward;
    if (changes || path[i].arcLength >= path[points.back()].arcLength + spacing)
      points.push_back(i);
  }
  points.push_back(path.size() - 1);
  return points;
}

std::optional<GroundPose> poseAt(const PathPoint& p, const CollisionChecker& checker) {
  const auto pose = checker.place({p.x, p.y, p.heading}, p.z);
  return pose && checker.fit(*pose) == Fit::Free ? pose : std::nullopt;
}

/** The direction in which a path goes on, from its points up to so far before and after one. */
double directionAt(const std::vector<PathPoint>& path, std::size_t i, double reach) {
  constexpr double kLeast = 0.4;  // m
  std::size_t a = i, b = i;
  while (a > 0 && path[i].arcLength - path[a].arcLength < reach) --a;
  while (b + 1 < path.size() && path[b].arcLength - path[i].arcLength < reach) ++b;
  const double dx = path[b].x - path[a].x, dy = path[b].y - path[a].y;
  if (std::hypot(dx, dy) > kLeast) return std::atan2(dy, dx);
  return path[i].heading + (path[i].forward ? 0 : M_PI);
}

/** Arc lengths. */
std::vector<double> gearChangesOf(const std::vector<PathPoint>& path) {
  std::vector<double> changes;
  for (std::size_t i = 1; i < path.size(); ++i)
    if (path[i].forward != path[i - 1].forward) changes.push_back(path[i - 1].arcLength);
  return changes;
}

bool isNear(double arcLength, const std::vector<double>& places) {
  constexpr double kNear = 8;  // m
  return std::any_of(places.begin(), places.end(),
                     [&](double place) { return std::abs(place - arcLength) < kNear; });
}

/** Poses of a station. */
class StationPoses {
 public:
  StationPoses(const PathPoint& p, const CollisionChecker& checker)
      : m_point(p), m_checker(checker) {
    if (const auto own = poseAt(p, checker)) m_poses.push_back(*own);
  }

  /** \param sideways from the path's point, to the left of a direction, in which the pose heads but
   * for a turn */
  void add(double direction, double sideways, double turn) {
    const TPose2D pose(m_point.x - sideways * std::sin(direction),
                       m_point.y + sideways * std::cos(direction),
                       std::remainder(direction + turn, 2 * M_PI));
    const auto placed = m_checker.place(pose, m_point.z);
    if (!placed || m_checker.fit(*placed) != Fit::Free) return;
    if (m_checker.order().rank(m_checker.classAt(*placed)) == colored_graph::kForbidden) return;
    m_poses.push_back(*placed);
  }

  Station take() { return std::move(m_poses); }

 private:
  const PathPoint& m_point;
  const CollisionChecker& m_checker;
  Station m_poses;
};

/** The path's ends by themselves, and what f(poses, station) adds between. */
template <class F>
std::vector<Station> stationsAt(const std::vector<PathPoint>& path,
                                const std::vector<std::size_t>& points,
                                const CollisionChecker& checker, F f) {
  std::vector<Station> stations;
  for (std::size_t i = 0; i < points.size(); ++i) {
    StationPoses poses(path[points[i]], checker);
    if (i > 0 && i + 1 < points.size()) f(poses, i);
    stations.push_back(poses.take());
  }
  return stations;
}

/** Poses at the places of a path: its ends, where the gear changes, and between; with its own
 * headings and those towards places farther along it. */
std::vector<Station> stationsOn(const std::vector<PathPoint>& path,
                                const CollisionChecker& checker) {
  const std::vector<std::size_t> points = pointsOf(path, kSpacing, true);
  const auto direction = [&](std::size_t from, std::size_t to) {
    const PathPoint &a = path[points[from]], &b = path[points[to]];
    return std::atan2(b.y - a.y, b.x - a.x);
  };
  return stationsAt(path, points, checker, [&](StationPoses& poses, std::size_t i) {
    const std::size_t last = points.size() - 1;
    for (const std::size_t steps : kStraightSteps) {
      poses.add(direction(i - std::min(i, steps), i), 0, 0);
      poses.add(direction(i, std::min(last, i + steps)), 0, 0);
    }
  });
}

/** The poses of a path and others beside them that the vehicle fits at; its ends stay as they are.
 */
std::vector<Station> stationsBeside(const std::vector<PathPoint>& path,
                                    const CollisionChecker& checker, const BesideOptions& options) {
  constexpr double kReach = 1.5;  // m
  const std::vector<std::size_t> points = pointsOf(path, kSpacing, false);
  const std::vector<double> changes = gearChangesOf(path);
  return stationsAt(path, points, checker, [&](StationPoses& poses, std::size_t i) {
    if (options.atGearChangesOnly && !isNear(path[points[i]].arcLength, changes)) return;
    const double direction = directionAt(path, points[i], kReach);
    for (const int side : {0, -1, 1})
      for (const int heading : {0, -1, 1})
        poses.add(direction, side * options.sideways, heading * options.turn);
    poses.add(direction, 0, M_PI);
  });
}

/** By rank, worst first, without the best; then motion cost and length. */
std::vector<std::int64_t> costOf(const PlanResult& plan, const CollisionChecker& checker) {
  const colored_graph::ClassOrder& order = checker.order();
  const auto units = [](double meters) {
    return std::llround(meters * colored_graph::kLengthUnitsPerMeter);
  };
  std::vector<std::int64_t> cost(static_cast<std::size_t>(order.ranks()) - 1);
  for (std::size_t id = 0; id < plan.lengthPerClass.size(); ++id) {
    const auto rank = static_cast<std::size_t>(order.rank(static_cast<ClassId>(id)));
    if (plan.lengthPerClass[id] > 0 && rank > 0)
      cost[cost.size() - rank] += units(plan.lengthPerClass[id]);
  }
  cost.push_back(colored_graph::lengthDown(checker.motionCost().of(plan.path)));
  cost.push_back(units(plan.length));
  return cost;
}

bool changesGear(const std::vector<PathPoint>& path) {
  return std::adjacent_find(path.begin() + 1, path.end(),
                            [](const PathPoint& a, const PathPoint& b) {
                              return a.forward != b.forward;
                            }) != path.end();
}

/** Makes one path cheaper, step by step. */
class Improvement {
 public:
  Improvement(const CollisionChecker& checker, const ClassPrices& prices)
      : m_checker(checker), m_prices(prices) {}

  PlanResult run(const std::vector<PathPoint>& way, bool isDrivable) {
    if (isDrivable) offer(legsAlong(way, m_checker, m_prices));
    improve(way);
    return m_result;
  }

 private:
  static constexpr double kTurn = 20 * M_PI / 180;
  static constexpr std::size_t kSpanBeside = 2, kSpanOn = 8;  // stations that a curve goes on by

  void improve(const std::vector<PathPoint>& way) {
    offer(search(stationsBeside(way, m_checker, {0.6, kTurn, false}), kSpanBeside));
    if (!m_result.found()) return;
    changeGearLess();
    smooth();
    if (!turnBetter()) return;
    changeGearLess();
    smooth();
  }

  std::vector<Leg> search(const std::vector<Station>& stations, std::size_t span) const {
    return LatticeSearch(stations, m_checker, m_prices, span).run().value_or(std::vector<Leg>());
  }

  void changeGearLess() {
    if (!changesGear(m_result.path)) return;
    offer(search(stationsOn(m_result.path, m_checker), kSpanOn));
    if (offer(
            search(stationsBeside(m_result.path, m_checker, {0.3, kTurn / 2, true}), kSpanBeside)))
      offer(search(stationsOn(m_result.path, m_checker), kSpanOn));
  }

  /** Where the path begins and ends: there the vehicle may have to turn around, by a way that is
   * far from all poses beside it. */
  bool turnBetter() {
    bool isBetter = false;
    for (const auto better : {withBetterBegin, withBetterEnd})
      if (const auto path = better(m_result.path, m_checker, m_prices))
        isBetter |= offer(legsAlong(*path, m_checker, m_prices));
    return isBetter;
  }

  void smooth() { offer(smoothed(m_result.path, m_checker, m_prices)); }

  /** \return whether that costs less than what there is. */
  bool offer(const std::vector<Leg>& legs) {
    if (legs.empty()) return false;
    PlanResult offered = withLegs(legs);
    if (m_result.found() && m_result.price <= offered.price) return false;
    m_result = std::move(offered);
    return true;
  }

  PlanResult withLegs(const std::vector<Leg>& legs) const {
    PlanResult after;
    after.status = PlanStatus::Found;
    after.vertices = {legs.front().curve.from()};
    colored_graph::PathResult lengths;
    lengths.lengthPerClass.resize(static_cast<std::size_t>(m_checker.order().classes()));
    for (const Leg& leg : legs) {
      appendCurve(m_checker.trace(leg.curve, leg.from), after.path);
      after.vertices.push_back(leg.curve.at(leg.curve.length()).pose);
      for (const auto& stretch : leg.profile)
        lengths.lengthPerClass[stretch.classId] += stretch.length;
    }
    setLengths(lengths, after);
    after.cost = costOf(after, m_checker);
    after.price = priceOf(after, m_checker, m_prices);
    return after;
  }

  const CollisionChecker& m_checker;
  const ClassPrices& m_prices;
  PlanResult m_result;
};

}  // namespace

double priceOf(const PlanResult& plan, const CollisionChecker& checker, const ClassPrices& prices) {
  double price = checker.motionCost().of(plan.path);
  for (std::size_t id = 0; id < plan.lengthPerClass.size(); ++id)
    if (plan.lengthPerClass[id] > 0)
      price +=
          prices.rate(checker.order().rank(static_cast<ClassId>(id))) * plan.lengthPerClass[id];
  return price;
}

void setLengths(PlanResult& plan, const CollisionChecker& checker, const ClassPrices& prices) {
  std::vector<PathPoint>& path = plan.path;
  plan.lengthPerClass.assign(static_cast<std::size_t>(checker.order().classes()), 0);
  plan.vertices = {{path.front().x, path.front().y, path.front().heading}};
  path.front().arcLength = 0;
  ClassId id = path.front().classId;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const PathPoint& before = path[i - 1];
    PathPoint& p = path[i];
    const double length = std::hypot(p.x - before.x, p.y - before.y);
    p.arcLength = before.arcLength + length;
    if (checker.order().rank(p.classId) != colored_graph::kForbidden) id = p.classId;
    plan.lengthPerClass[id] += length;
    const bool goesOn = i + 1 < path.size() && path[i + 1].forward == p.forward &&
                        !MotionCost::steers(p.curvature, path[i + 1].curvature);
    if (!goesOn) plan.vertices.emplace_back(p.x, p.y, p.heading);
  }
  plan.length = path.back().arcLength;
  plan.cost = costOf(plan, checker);
  plan.price = priceOf(plan, checker, prices);
}

PlanResult pathBeside(const std::vector<PathPoint>& way, bool isDrivable,
                      const CollisionChecker& checker, const ClassPrices& prices) {
  if (way.size() > 2) return Improvement(checker, prices).run(way, isDrivable);
  PlanResult result;
  if (!isDrivable || way.empty()) return result;
  result.status = PlanStatus::Found;
  result.path = way;
  setLengths(result, checker, prices);
  return result;
}

}  // namespace semantic_planning
