#include "TurnSearch.h"

#include <algorithm>
#include <cmath>

#include "PathTracing.h"

namespace semantic_planning {

using colored_graph::kForbidden;
using colored_graph::Length;
using colored_graph::lengthDown;
using mrpt::math::TPose2D;

namespace {

constexpr double kTurns[] = {0, 1, -1, 0.5, -0.5};  // of the tightest curvature
constexpr int kHeadings = 36;                       // that are not the same
constexpr int kShareOfTargets = 6;                  // one of so many is looked at from each pose

double radiusFor(const CollisionChecker& checker) {
  constexpr double kLeast = 8, kInTurningRadii = 2.5;
  return std::max(kLeast, kInTurningRadii * checker.reedsShepp().turningRadius());
}

/** How far along the path places lie that a way may lead to. */
double reachFor(double radius) { return 1.5 * radius; }

double stepFor(const CollisionChecker& checker) {
  constexpr double kVoxels = 2, kInTurningRadii = 0.2;
  return std::max(kVoxels * checker.ground().voxelSize(),
                  kInTurningRadii * checker.reedsShepp().turningRadius());
}

std::uint64_t bits(double number, double size, int count) {
  const auto whole = static_cast<std::int64_t>(std::floor(number / size));
  return static_cast<std::uint64_t>(whole) & ((std::uint64_t{1} << count) - 1);
}

/** As if driven from its end to its begin. */
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

}  // namespace

TurnSearch::TurnSearch(const std::vector<PathPoint>& path, bool isReversed,
                       const CollisionChecker& checker, const ClassPrices& prices)
    : m_path(path),
      m_isReversed(isReversed),
      m_checker(checker),
      m_prices(prices),
      m_radius(radiusFor(checker)),
      m_step(stepFor(checker)),
      m_field(poseAt(0), m_radius, checker, prices) {
  sumUp();
  aim();
}

GroundPose TurnSearch::poseAt(std::size_t point) const {
  const PathPoint& p = m_path[point];
  return {{p.x, p.y, p.heading}, m_checker.ground().keyOf(p.z)};
}

CurveState TurnSearch::stateAt(std::size_t point) const {
  return {m_path[point].forward, m_path[point].curvature};
}

Length TurnSearch::ofWay(double length, bool forward) const {
  return lengthDown(m_checker.motionCost().ofWay(length, forward != m_isReversed));
}

Length TurnSearch::ofChange(const Node& from, const CurveState& to) const {
  return from.before < 0 ? 0 : lengthDown(m_checker.motionCost().ofChange(from.state(), to));
}

/** Between places that were looked at the path may touch what is forbidden: that is left out. */
void TurnSearch::sumUp() {
  m_toGo.resize(m_path.size());
  for (std::size_t i = m_path.size() - 1; i > 0; --i) {
    const PathPoint& p = m_path[i];
    const double length = p.arcLength - m_path[i - 1].arcLength;
    Length cost = m_toGo[i] + ofWay(length, p.forward);
    if (i + 1 < m_path.size())
      cost += lengthDown(m_checker.motionCost().ofChange(stateAt(i), stateAt(i + 1)));
    if (m_checker.order().rank(p.classId) != kForbidden)
      cost += m_prices.of(p.classId, lengthDown(length));
    m_toGo[i - 1] = cost;
  }
  m_best = m_toGo.front();
}

/** At places of the path that are near. */
void TurnSearch::aim() {
  constexpr double kSpacing = 0.5, kMargin = 0.3;  // m
  double last = 0;
  for (std::size_t i = 1; i < m_path.size() && m_path[i].arcLength < reachFor(m_radius); ++i) {
    const PathPoint& p = m_path[i];
    if (std::hypot(p.x - m_path[0].x, p.y - m_path[0].y) > m_radius - kMargin) continue;
    m_field.add(poseAt(i), m_toGo[i]);
    if (p.arcLength < last + kSpacing && i + 1 < m_path.size()) continue;
    last = p.arcLength;
    m_targets.push_back({i, poseAt(i), stateAt(std::min(i + 1, m_path.size() - 1))});
  }
}

Length TurnSearch::excess() {
  const GroundPose start = poseAt(0);
  m_field.spread(m_best, &start);
  return m_best - std::min(m_best, m_field.at(start));
}

std::optional<std::vector<PathPoint>> TurnSearch::run(Length gain) {
  m_gain = gain;
  m_budget.prices = m_prices.perMeter();
  m_field.spread(most(), nullptr);
  const ReedsSheppCurve none({}, 1, {});
  reach({poseAt(0), 0, -1, none}, m_field.at(poseAt(0)));
  for (; !m_queue.empty() && m_left > 0; --m_left) {
    const Entry entry = m_queue.top();
    if (entry.estimate >= most()) break;
    m_queue.pop();
    join(entry.node);
    goOn(entry.node);
  }
  if (!m_joint) return std::nullopt;
  return joined();
}

void TurnSearch::reach(const Node& node, Length rest) {
  m_queue.push({node.cost + rest, static_cast<int>(m_nodes.size())});
  m_nodes.push_back(node);
}

void TurnSearch::goOn(int from) {
  for (const double turn : kTurns)
    for (const bool forward : {true, false})
      if (forward != m_isReversed || m_checker.motionCost().canReverse()) step(from, turn, forward);
}

void TurnSearch::step(int from, double turn, bool forward) {
  const double tightest = m_checker.reedsShepp().turningRadius();
  const double radius = turn == 0 ? tightest : tightest / std::abs(turn);
  const ReedsSheppCurve curve(node(from).pose.pose, radius,
                              {{{forward ? m_step : -m_step, turn > 0   ? 1
                                                             : turn < 0 ? -1
                                                                        : 0}}});
  GroundPose to{curve.at(m_step).pose, node(from).pose.z};
  const Length rest = m_field.at(to);
  Length cost = node(from).cost + ofWay(m_step, forward) + ofChange(node(from), beginOf(curve));
  if (rest == CostField::kUnreached || cost + rest >= most()) return;
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

std::optional<Length> TurnSearch::costOver(const ReedsSheppCurve& curve, int from, int to,
                                           Length cost, Length rest) {
  if (cost + rest >= most()) return std::nullopt;
  m_budget.left = colored_graph::toMeters(most() - cost - rest);
  const auto profile = m_checker.profile(curve, from, to, &m_budget);
  if (!profile) return std::nullopt;
  cost += m_prices.of(*profile);
  return cost + rest < most() ? std::optional(cost) : std::nullopt;
}

/** Each time others of the targets have their turn. */
void TurnSearch::join(int from) {
  const double reach = 0.6 * m_radius;
  for (std::size_t i = m_targets.size(); i-- > 0;) {
    const Target& target = m_targets[i];
    if (from > 0 && (static_cast<int>(i) + m_left) % kShareOfTargets) continue;
    const TPose2D &a = node(from).pose.pose, &b = target.pose.pose;
    const double distance = std::hypot(b.x - a.x, b.y - a.y);
    if (distance < reach && node(from).cost + lengthDown(distance) + m_toGo[target.point] < most())
      join(from, target);
  }
}

void TurnSearch::join(int from, const Target& target) {
  const MotionCost& price = m_checker.motionCost();
  for (const ReedsSheppCurve& curve : curves(node(from).pose, target.pose)) {
    if (curve.length() > 1.25 * m_radius) continue;
    const Length cost = node(from).cost + ofChange(node(from), beginOf(curve)) +
                        lengthDown(price.of(m_isReversed ? curve.reversed() : curve)) +
                        lengthDown(price.ofChange(endOf(curve), target.state));
    const Length rest = m_toGo[target.point];
    const auto whole = costOver(curve, node(from).pose.z, target.pose.z, cost, rest);
    if (!whole) continue;
    m_best = *whole + rest;
    m_joint = Joint{from, curve, target.point};
  }
}

std::vector<ReedsSheppCurve> TurnSearch::curves(const GroundPose& from,
                                                const GroundPose& to) const {
  if (!m_isReversed) return m_checker.motionCost().curves(from.pose, to.pose);
  std::vector<ReedsSheppCurve> curves = m_checker.motionCost().curves(to.pose, from.pose);
  for (ReedsSheppCurve& curve : curves) curve = curve.reversed();
  return curves;
}

std::vector<PathPoint> TurnSearch::joined() const {
  std::vector<int> way;
  for (int i = m_joint->node; node(i).before >= 0; i = node(i).before) way.push_back(i);
  std::vector<PathPoint> path;
  for (auto i = way.rbegin(); i != way.rend(); ++i)
    appendCurve(m_checker.trace(node(*i).curve, node(node(*i).before).pose.z), path);
  appendCurve(m_checker.trace(m_joint->curve, node(m_joint->node).pose.z), path);
  const double more = path.back().arcLength - m_path[m_joint->point].arcLength;
  for (std::size_t i = m_joint->point + 1; i < m_path.size(); ++i) {
    path.push_back(m_path[i]);
    path.back().arcLength += more;
  }
  return path;
}

namespace {

/** To turn around costs as much anywhere: that is no reason to look for another way. */
double costOfTurning(const CollisionChecker& checker) {
  return M_PI * checker.reedsShepp().turningRadius() + checker.motionCost().gearChange();
}

std::optional<std::vector<PathPoint>> better(const std::vector<PathPoint>& path, bool isReversed,
                                             const CollisionChecker& checker,
                                             const ClassPrices& prices) {
  constexpr double kLeastGain = 0.2;  // m
  TurnSearch search(path, isReversed, checker, prices);
  if (search.excess() <= lengthDown(costOfTurning(checker))) return std::nullopt;
  return search.run(lengthDown(kLeastGain));
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
