#include "PoseSearch.h"

#include <semantic_planning/planner/Slices.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>
#include <tuple>
#include <unordered_map>

#include "PathImprovement.h"
#include "RelaxedField.h"

namespace semantic_planning {

using colored_graph::kForbidden;
using colored_graph::Length;
using colored_graph::lengthDown;
using mrpt::math::TPose2D;

namespace {

constexpr double kTurns[] = {0, 1, -1, 0.5, -0.5};  // of the tightest curvature
constexpr int kHeadings = 36;                       // that are not the same

double stepFor(const CollisionChecker& checker) {
  constexpr double kVoxels = 2, kInTurningRadii = 0.2;
  return std::max(kVoxels * checker.ground().voxelSize(),
                  kInTurningRadii * checker.reedsShepp().turningRadius());
}

std::uint64_t bits(double number, double size, int count) {
  const auto whole = static_cast<std::int64_t>(std::floor(number / size));
  return static_cast<std::uint64_t>(whole) & ((std::uint64_t{1} << count) - 1);
}

/** Looks from pose to pose for the cheapest way to one of some targets, in so many poses at most.
 * It goes best first over short arcs and straights in both gears, and from poses to the targets by
 * the vehicle's shortest curves. What a CostField says of the rest of the way tells what is worth
 * going on with. Poses much like earlier ones are dropped (Dolgov et al., "Path Planning for
 * Autonomous Vehicles in Unknown Semi-structured Environments", 2010). */
class PoseSearch {
 public:
  /** A place where the way may end. */
  struct Target {
    GroundPose pose;
    std::optional<CurveState> state;  ///< how it goes on from there; none: not at all
    Length rest;                      ///< what it costs from there on
    std::size_t number;               ///< of the caller
  };
  struct Task {
    GroundPose start;
    double radius;            ///< of the square around the start that is looked at, meters
    double reach;             ///< farthest target that a curve is tried to, meters
    double weight = 1;        ///< of what the field says: more finds a way sooner, and a worse one
    int poses;                ///< to go on from, at most
    int shareOfTargets;       ///< from each pose one of so many is tried
    bool isReversed = false;  ///< the way is one that is driven from its end to its begin
  };
  /** The best way that was found. */
  struct Way {
    std::vector<PathPoint> path;
    std::size_t target;  ///< its number
  };

  PoseSearch(const Task& task, const CollisionChecker& checker, const ClassPrices& prices)
      : m_task(task),
        m_checker(checker),
        m_prices(prices),
        m_step(stepFor(checker)),
        m_field(task.start, task.radius, checker, prices),
        m_budget{prices.perMeter()},
        m_left(task.poses) {}

  void add(const Target& target) { m_targets.push_back(target); }
  /** Tells the field what the rest of a way costs from a place on. */
  void addRest(const GroundPose& pose, Length rest) { m_field.add(pose, rest); }

  /** Nothing if no way costs less than `most`, or none was found. */
  std::optional<Way> run(Length most) {
    m_most = most;
    const Length rest = m_field.at(m_task.start);
    if (rest == CostField::kUnreached) return std::nullopt;
    reach({m_task.start, 0, -1, ReedsSheppCurve({}, 1, {})}, rest);
    for (; !m_queue.empty() && m_left > 0; --m_left) {
      const Entry entry = m_queue.top();
      if (m_task.weight == 1 && entry.estimate >= m_most) break;
      m_queue.pop();
      Slices::count(30);
      join(entry.node);
      goOn(entry.node);
    }
    if (!m_joint) return std::nullopt;
    return Way{joined(), m_targets[m_joint->target].number};
  }

 private:
  /** A pose that was reached. */
  struct Node {
    GroundPose pose;
    Length cost;
    int before;             ///< -1: it is the first
    ReedsSheppCurve curve;  ///< from there
    CurveState state() const { return endOf(curve); }
  };
  struct Entry {
    Length estimate;
    int node;
    bool operator<(const Entry& o) const {  // the least on top
      return estimate != o.estimate ? o.estimate < estimate : o.node < node;
    }
  };
  /** The best way that is known. */
  struct Joint {
    int node;
    ReedsSheppCurve curve;
    std::size_t target;
  };

  const Node& node(int i) const { return m_nodes[static_cast<std::size_t>(i)]; }

  Length ofWay(double length, bool forward) const {
    return lengthDown(m_checker.motionCost().ofWay(length, forward != m_task.isReversed));
  }

  Length ofChange(const Node& from, const CurveState& to) const {
    return from.before < 0 ? 0 : lengthDown(m_checker.motionCost().ofChange(from.state(), to));
  }

  void reach(const Node& node, Length rest) {
    const auto weighted = static_cast<Length>(m_task.weight * static_cast<double>(rest));
    m_queue.push({node.cost + weighted, static_cast<int>(m_nodes.size())});
    m_nodes.push_back(node);
  }

  void goOn(int from) {
    for (const double turn : kTurns)
      for (const bool forward : {true, false})
        if (forward != m_task.isReversed || m_checker.motionCost().canReverse())
          step(from, turn, forward);
  }

  void step(int from, double turn, bool forward) {
    const double tightest = m_checker.reedsShepp().turningRadius();
    const double radius = turn == 0 ? tightest : tightest / std::abs(turn);
    const int side = turn > 0 ? 1 : turn < 0 ? -1 : 0;
    const ReedsSheppCurve curve(node(from).pose.pose, radius,
                                {{{forward ? m_step : -m_step, side}}});
    GroundPose to{curve.at(m_step).pose, node(from).pose.z};
    const Length rest = m_field.at(to);
    Length cost = node(from).cost + ofWay(m_step, forward) + ofChange(node(from), beginOf(curve));
    if (rest == CostField::kUnreached || cost + rest >= m_most) return;
    const std::uint64_t key = (bits(to.pose.x, m_step / 2, 24) << 32) |
                              (bits(to.pose.y, m_step / 2, 24) << 8) |
                              (bits(to.pose.phi + M_PI, 2 * M_PI / kHeadings, 7) << 1) | forward;
    const auto [least, isNew] = m_least.try_emplace(key, CostField::kUnreached);
    if (least->second <= cost) return;
    const Surface* s = m_checker.ground().near(m_checker.ground().columnAt(to.pose.x, to.pose.y),
                                               to.z, 2 * m_checker.ground().step());
    if (!s) return;
    to.z = s->z;
    const auto whole = costOver(curve, node(from).pose.z, to.z, cost, rest);
    if (!whole || *whole >= least->second) return;
    least->second = *whole;
    reach({to, *whole, from, curve}, rest);
  }

  std::optional<Length> costOver(const ReedsSheppCurve& curve, int from, int to, Length cost,
                                 Length rest) {
    if (cost + rest >= m_most) return std::nullopt;
    m_budget.left = colored_graph::toMeters(m_most - cost - rest);
    const auto profile = m_checker.profile(curve, from, to, &m_budget);
    if (!profile) return std::nullopt;
    cost += m_prices.of(*profile);
    return cost + rest < m_most ? std::optional(cost) : std::nullopt;
  }

  /** Each time others of the targets have their turn. */
  void join(int from) {
    for (std::size_t i = m_targets.size(); i-- > 0;) {
      const Target& target = m_targets[i];
      if (from > 0 && (static_cast<int>(i) + m_left) % m_task.shareOfTargets) continue;
      const TPose2D &a = node(from).pose.pose, &b = target.pose.pose;
      const double distance = std::hypot(b.x - a.x, b.y - a.y);
      if (distance < m_task.reach && node(from).cost + lengthDown(distance) + target.rest < m_most)
        join(from, target);
    }
  }

  void join(int from, const Target& target) {
    const MotionCost& price = m_checker.motionCost();
    const ReedsSheppCurve curve = curveBetween(node(from).pose, target.pose);
    Length cost = node(from).cost + ofChange(node(from), beginOf(curve)) +
                  lengthDown(price.of(m_task.isReversed ? curve.reversed() : curve));
    if (target.state) cost += lengthDown(price.ofChange(endOf(curve), *target.state));
    const int z = node(from).pose.z;
    if (cost + target.rest >= m_most) return;
    const auto whole = costOver(curve, z, target.pose.z, cost, target.rest);
    if (!whole) return;
    m_most = *whole + target.rest;
    m_joint = Joint{from, curve, static_cast<std::size_t>(&target - m_targets.data())};
  }

  ReedsSheppCurve curveBetween(const GroundPose& from, const GroundPose& to) const {
    const MotionCost& price = m_checker.motionCost();
    return m_task.isReversed ? price.shortest(to.pose, from.pose).reversed()
                             : price.shortest(from.pose, to.pose);
  }

  std::vector<PathPoint> joined() const {
    std::vector<int> way;
    for (int i = m_joint->node; node(i).before >= 0; i = node(i).before) way.push_back(i);
    std::vector<PathPoint> path;
    for (auto i = way.rbegin(); i != way.rend(); ++i)
      appendCurve(m_checker.trace(node(*i).curve, node(node(*i).before).pose.z), path);
    appendCurve(m_checker.trace(m_joint->curve, node(m_joint->node).pose.z), path);
    return path;
  }

  const Task m_task;
  const CollisionChecker& m_checker;
  const ClassPrices& m_prices;
  const double m_step;
  CostField m_field;
  std::vector<Target> m_targets;
  ClassBudget m_budget;
  Length m_most = 0;
  std::vector<Node> m_nodes;
  std::unordered_map<std::uint64_t, Length> m_least;  ///< by what makes poses the same
  std::priority_queue<Entry> m_queue;
  std::optional<Joint> m_joint;
  int m_left;
};

/** The path as if it were driven from its end to its begin. */
std::vector<PathPoint> reversed(const std::vector<PathPoint>& path) {
  std::vector<PathPoint> back(path.rbegin(), path.rend());
  for (std::size_t i = 0; i < back.size(); ++i) {
    // Gear and curvature are those of the way to a point: here from the one after it.
    const PathPoint& way = path[path.size() - std::max<std::size_t>(1, i)];
    back[i].forward = !way.forward;
    back[i].curvature = way.curvature;
    back[i].arcLength = path.back().arcLength - back[i].arcLength;
  }
  return back;
}

/** \param isReversed looks from the goal on for a way that leads back to the start */
std::vector<PathPoint> wayFromOneEnd(const GroundPose& start, const GroundPose& goal,
                                     bool isReversed, const CollisionChecker& checker,
                                     const ClassPrices& prices) {
  constexpr double kBeside = 20, kReach = 15, kWeight = 2.4;  // m, m
  constexpr int kPoses = 2000, kShare = 3;
  constexpr Length kMost = Length{1} << 62;
  const double turn = checker.reedsShepp().turningRadius(),
               distance = std::hypot(goal.pose.x - start.pose.x, goal.pose.y - start.pose.y);
  const auto [from, to] = isReversed ? std::tie(goal, start) : std::tie(start, goal);
  PoseSearch search(
      {from, distance + kBeside, kReach + 2 * turn, kWeight, kPoses, kShare, isReversed}, checker,
      prices);
  search.addRest(to, 0);
  search.add({to, std::nullopt, 0, 0});
  const auto way = search.run(kMost);
  if (!way) return {};
  return isReversed ? reversed(way->path) : way->path;
}

}  // namespace

std::vector<PathPoint> wayBetween(const GroundPose& start, const GroundPose& goal,
                                  const CollisionChecker& checker, const ClassPrices& prices) {
  const auto way = wayFromOneEnd(start, goal, false, checker, prices);
  return way.empty() ? wayFromOneEnd(start, goal, true, checker, prices) : way;
}

namespace {

GroundPose poseAt(const PathPoint& p, const Ground& ground) {
  return {{p.x, p.y, p.heading}, ground.keyOf(p.z)};
}

/** What the rest of a path costs from each point on. Between places that were looked at the path
 * may touch what is forbidden: that is left out. */
std::vector<Length> costsToGo(const std::vector<PathPoint>& path, bool isReversed,
                              const CollisionChecker& checker, const ClassPrices& prices) {
  const MotionCost& price = checker.motionCost();
  std::vector<Length> toGo(path.size());
  for (std::size_t i = path.size() - 1; i > 0; --i) {
    const PathPoint& p = path[i];
    const double length = p.arcLength - path[i - 1].arcLength;
    Length cost = toGo[i] + lengthDown(price.ofWay(length, p.forward != isReversed));
    if (i + 1 < path.size()) cost += lengthDown(price.ofChange(stateAt(p), stateAt(path[i + 1])));
    if (checker.order().rank(p.classId) != kForbidden)
      cost += prices.of(p.classId, lengthDown(length));
    toGo[i - 1] = cost;
  }
  return toGo;
}

/** A cheaper way to turn around near a path's first point, which leads to the path some meters on.
 */
std::optional<std::vector<PathPoint>> better(const std::vector<PathPoint>& path, bool isReversed,
                                             const CollisionChecker& checker,
                                             const ClassPrices& prices) {
  constexpr double kLeast = 8, kInTurningRadii = 2.5, kSpacing = 0.5, kMargin = 0.3;  // m
  constexpr double kAlong = 1.5, kReach = 0.6;  // of the radius
  constexpr int kPoses = 500, kShare = 6;
  const Ground& ground = checker.ground();
  const double radius = std::max(kLeast, kInTurningRadii * checker.reedsShepp().turningRadius());
  PoseSearch search(
      {poseAt(path.front(), ground), radius, kReach * radius, 1, kPoses, kShare, isReversed},
      checker, prices);
  const std::vector<Length> toGo = costsToGo(path, isReversed, checker, prices);
  double last = 0;
  for (std::size_t i = 1; i < path.size() && path[i].arcLength < kAlong * radius; ++i) {
    const PathPoint& p = path[i];
    if (std::hypot(p.x - path[0].x, p.y - path[0].y) > radius - kMargin) continue;
    search.addRest(poseAt(p, ground), toGo[i]);
    if (p.arcLength < last + kSpacing && i + 1 < path.size()) continue;
    last = p.arcLength;
    search.add({poseAt(p, ground), stateAt(path[std::min(i + 1, path.size() - 1)]), toGo[i], i});
  }
  auto way = search.run(toGo.front());
  if (!way) return std::nullopt;
  const double more = way->path.back().arcLength - path[way->target].arcLength;
  for (std::size_t i = way->target + 1; i < path.size(); ++i) {
    way->path.push_back(path[i]);
    way->path.back().arcLength += more;
  }
  return std::move(way->path);
}

}  // namespace

std::optional<std::vector<PathPoint>> withBetterBegin(const std::vector<PathPoint>& path,
                                                      const CollisionChecker& checker,
                                                      const ClassPrices& prices) {
  return better(path, false, checker, prices);
}

std::optional<std::vector<PathPoint>> withBetterEnd(const std::vector<PathPoint>& path,
                                                    const CollisionChecker& checker,
                                                    const ClassPrices& prices) {
  auto found = better(reversed(path), true, checker, prices);
  if (found) *found = reversed(*found);
  return found;
}

}  // namespace semantic_planning
