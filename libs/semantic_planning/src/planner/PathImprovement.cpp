#include "PathImprovement.h"

#include <semantic_planning/vehicle/PathPoint.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "LatticeSearch.h"
#include "PathSmoothing.h"
#include "PoseSearch.h"

namespace semantic_planning {

using colored_graph::PathResult;
using colored_graph::SearchStatus;

namespace {

PlanStatus statusOf(SearchStatus status) {
  switch (status) {
    case SearchStatus::Found:
      return PlanStatus::Found;
    case SearchStatus::OnlyForbidden:
      return PlanStatus::OnlyForbidden;
    case SearchStatus::Cancelled:
      return PlanStatus::Cancelled;
    default:
      return PlanStatus::NotConnected;
  }
}

/** The poses along a path of the roadmap, with their arc lengths. */
std::vector<PathPoint> tracePath(const PathResult& path, const Roadmap& roadmap,
                                 const CollisionChecker& checker) {
  std::vector<PathPoint> points;
  for (std::size_t i = 0; i < path.edges.size(); ++i) {
    const auto from = path.vertices[i];
    appendCurve(checker.trace(roadmap.curve(path.edges[i], from), roadmap.pose(from).z), points);
  }
  return points;
}

}  // namespace

void appendCurve(const std::vector<PathPoint>& curve, std::vector<PathPoint>& path) {
  const double begin = path.empty() ? 0 : path.back().arcLength;
  for (std::size_t i = path.empty() ? 0 : 1; i < curve.size(); ++i) {
    path.push_back(curve[i]);
    path.back().arcLength += begin;
  }
}

void describePath(const PathResult& path, const Roadmap& roadmap, const CollisionChecker& checker,
                  PlanResult& result) {
  result.status = statusOf(path.status);
  result.search = path.statistics;
  if (!path.found()) {
    result.reason = describe(path.status);
    return;
  }
  result.cost = path.cost;
  for (const colored_graph::Length length : path.lengthPerClass) {
    result.lengthPerClass.push_back(colored_graph::toMeters(length));
    result.length += result.lengthPerClass.back();
  }
  for (const auto v : path.vertices) result.vertices.push_back(roadmap.pose(v).pose);
  result.path = tracePath(path, roadmap, checker);
}

namespace {
using mrpt::math::TPose2D;

constexpr double kSpacing = 2.0;  ///< of stations, m along the path

/** Where along the path its stations are: at its ends, and not too far apart between. */
std::vector<std::size_t> pointsOf(const std::vector<PathPoint>& path, bool withGearChanges) {
  std::vector<std::size_t> points{0};
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const bool changes = withGearChanges && path[i].forward != path[i + 1].forward;
    if (changes || path[i].arcLength >= path[points.back()].arcLength + kSpacing)
      points.push_back(i);
  }
  points.push_back(path.size() - 1);
  return points;
}

/** The direction in which a path goes on, from its points somewhat before and after one. */
double directionAt(const std::vector<PathPoint>& path, std::size_t i) {
  constexpr double kReach = 1.5, kLeast = 0.4;  // m
  std::size_t a = i, b = i;
  while (a > 0 && path[i].arcLength - path[a].arcLength < kReach) --a;
  while (b + 1 < path.size() && path[b].arcLength - path[i].arcLength < kReach) ++b;
  const double dx = path[b].x - path[a].x, dy = path[b].y - path[a].y;
  if (std::hypot(dx, dy) > kLeast) return std::atan2(dy, dx);
  return path[i].heading + (path[i].forward ? 0 : M_PI);
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

/** Whether a path changes its gear within so many meters of one of its points. */
bool changesGear(const std::vector<PathPoint>& path, double arcLength, double within) {
  for (std::size_t i = 1; i + 1 < path.size(); ++i)
    if (path[i].forward != path[i + 1].forward && std::abs(path[i].arcLength - arcLength) < within)
      return true;
  return false;
}

/** Makes one path cheaper, step by step. */
class Improvement {
 public:
  Improvement(const CollisionChecker& checker, const ClassPrices& prices)
      : m_checker(checker), m_prices(prices) {}

  PlanResult run(const std::vector<PathPoint>& way, bool isDrivable) {
    if (isDrivable && !way.empty()) offer(way);
    if (way.size() > 2) improve(way);
    return m_result;
  }

 private:
  static constexpr double kTurn = 20 * M_PI / 180;
  static constexpr double kNear = 8, kEverywhere = std::numeric_limits<double>::infinity();  // m
  static constexpr std::size_t kSpanBeside = 2, kSpanOn = 8;  // stations that a curve goes on by

  void improve(const std::vector<PathPoint>& way) {
    offer(search(stationsBeside(way, 0.6, kTurn, kEverywhere), kSpanBeside));
    if (!m_result.found()) return;
    changeGearLess();
    if (changesGear(m_result.path, 0, kEverywhere))
      offer(search(stationsBeside(m_result.path, 0.3, kTurn / 2, kNear), kSpanBeside));
    smooth();
    if (!turnBetter()) return;
    changeGearLess();
    smooth();
  }

  std::vector<Leg> search(const std::vector<Station>& stations, std::size_t span) const {
    return cheapestLegs(stations, span, m_checker, m_prices);
  }

  void changeGearLess() {
    if (changesGear(m_result.path, 0, kEverywhere))
      offer(search(stationsOn(m_result.path), kSpanOn));
  }

  /** Adds the pose so far to the left of a point, seen in a direction, if the vehicle can be there.
   * It heads in that direction but for a turn. What leads to the same voxel two stations on is the
   * same pose: along a straight way most are. */
  void add(const PathPoint& p, double direction, double sideways, double turn,
           Station& station) const {
    const TPose2D pose(p.x - sideways * std::sin(direction), p.y + sideways * std::cos(direction),
                       std::remainder(direction + turn, 2 * M_PI));
    const double same = m_checker.ground().voxelSize() / (2 * kSpacing);
    const bool isThere = std::any_of(station.begin(), station.end(), [&](const GroundPose& other) {
      return other.pose.x == pose.x && other.pose.y == pose.y &&
             std::abs(std::remainder(other.pose.phi - pose.phi, 2 * M_PI)) < same;
    });
    const auto placed = isThere ? std::nullopt : m_checker.place(pose, p.z);
    if (placed && m_checker.fit(*placed) == Fit::Free &&
        m_checker.order().rank(m_checker.classAt(*placed)) != colored_graph::kForbidden)
      station.push_back(*placed);
  }

  /** The poses of a path at some of its points, and what f(index, its station) adds between its
   * ends, which stay as they are. */
  template <class F>
  std::vector<Station> stationsAt(const std::vector<PathPoint>& path,
                                  const std::vector<std::size_t>& points, F f) const {
    std::vector<Station> stations;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PathPoint& p = path[points[i]];
      Station& station = stations.emplace_back();
      const auto own = m_checker.place({p.x, p.y, p.heading}, p.z);
      if (own && m_checker.fit(*own) == Fit::Free) station.push_back(*own);
      if (i > 0 && i + 1 < points.size()) f(i, station);
    }
    return stations;
  }

  /** Where the gear changes, and between; with the path's own headings and those towards places
   * farther along it, to which straight ways lead. */
  std::vector<Station> stationsOn(const std::vector<PathPoint>& path) const {
    const std::vector<std::size_t> points = pointsOf(path, true);
    const auto direction = [&](std::size_t from, std::size_t to) {
      const PathPoint &a = path[points[from]], &b = path[points[to]];
      return std::atan2(b.y - a.y, b.x - a.x);
    };
    return stationsAt(path, points, [&](std::size_t i, Station& station) {
      for (const std::size_t farther : {2u, 6u}) {  // stations
        add(path[points[i]], direction(i - std::min(i, farther), i), 0, 0, station);
        add(path[points[i]], direction(i, std::min(points.size() - 1, i + farther)), 0, 0, station);
      }
    });
  }

  /** \param sideways, turn to both sides of the path and of the direction of travel; m, radians
   * \param within m of places where the gear changes */
  std::vector<Station> stationsBeside(const std::vector<PathPoint>& path, double sideways,
                                      double turn, double within) const {
    const std::vector<std::size_t> points = pointsOf(path, false);
    return stationsAt(path, points, [&](std::size_t i, Station& station) {
      const PathPoint& p = path[points[i]];
      if (within < kEverywhere && !changesGear(path, p.arcLength, within)) return;
      const double direction = directionAt(path, points[i]);
      for (const int side : {0, -1, 1})
        for (const int heading : {0, -1, 1})
          add(p, direction, side * sideways, heading * turn, station);
      add(p, direction, 0, M_PI, station);
    });
  }

  /** Where the path begins and ends: there the vehicle may have to turn around, by a way that is
   * far from all poses beside it. */
  bool turnBetter() {
    bool isBetter = false;
    for (const auto better : {withBetterBegin, withBetterEnd})
      if (const auto path = better(m_result.path, m_checker, m_prices)) isBetter |= offer(*path);
    return isBetter;
  }

  void smooth() { offer(smoothed(m_result.path, m_checker, m_prices)); }

  bool offer(const std::vector<Leg>& legs) {
    std::vector<PathPoint> path;
    for (const Leg& leg : legs) appendCurve(m_checker.trace(leg.curve, leg.from), path);
    return !path.empty() && offer(path);
  }

  /** \return whether that costs less than what there is. */
  bool offer(const std::vector<PathPoint>& path) {
    PlanResult offered;
    offered.status = PlanStatus::Found;
    offered.path = path;
    setLengths(offered, m_checker, m_prices);
    if (m_result.found() && m_result.price <= offered.price) return false;
    m_result = std::move(offered);
    return true;
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
  const std::vector<PathPoint>& path = plan.path;
  plan.lengthPerClass.assign(static_cast<std::size_t>(checker.order().classes()), 0);
  plan.vertices = {{path.front().x, path.front().y, path.front().heading}};
  std::optional<ClassId> id;
  const auto count = [&](ClassId at, double length) {
    if (checker.order().rank(at) != colored_graph::kForbidden) id = at;
    if (id) plan.lengthPerClass[*id] += length;
  };
  for (std::size_t i = 1; i < path.size(); ++i) {
    const PathPoint& p = path[i];
    const double half = (p.arcLength - path[i - 1].arcLength) / 2;
    count(path[i - 1].classId, half), count(p.classId, half);
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
  return Improvement(checker, prices).run(way, isDrivable);
}

}  // namespace semantic_planning
