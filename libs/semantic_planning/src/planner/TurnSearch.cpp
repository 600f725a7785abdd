#include "TurnSearch.h"

#include <algorithm>
#include <cmath>

#include "PathTracing.h"

namespace semantic_planning {

using colored_graph::kForbidden;
using colored_graph::Length;
using colored_graph::lengthDown;
using colored_graph::Rank;
using mrpt::math::TPose2D;

namespace {

constexpr double kTurns[] = {0, 1, -1, 0.5, -0.5};  // of the tightest curvature
constexpr int kHeadings = 36;                       // that are not the same
constexpr int kShareOfTargets = 6;                  // one of so many is looked at from each pose

double radiusFor(const EdgeChecker& checker) {
  constexpr double kLeast = 8, kInTurningRadii = 2.5;
  return std::max(kLeast, kInTurningRadii * checker.reedsShepp().turningRadius());
}

/** How far along the path places lie that a way may lead to. */
double reachFor(double radius) { return 1.5 * radius; }

double stepFor(const EdgeChecker& checker) {
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
                       const EdgeChecker& checker, const WayPricing& pricing)
    : m_path(path),
      m_isReversed(isReversed),
      m_checker(checker),
      m_pricing(pricing),
      m_radius(radiusFor(checker)),
      m_step(stepFor(checker)),
      m_field(poseAt(0), m_radius, checker, pricing) {
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
  return lengthDown(m_checker.price().ofWay(length, forward != m_isReversed));
}

Length TurnSearch::ofChange(const Node& from, const CurveState& to) const {
  return from.before < 0 ? 0 : lengthDown(m_checker.price().ofChange(from.state(), to));
}

/** Between places that were looked at the path may touch what is forbidden: that is left out. */
void TurnSearch::sumUp() {
  m_toGo.resize(m_path.size());
  for (std::size_t i = m_path.size() - 1; i > 0; --i) {
    const PathPoint& p = m_path[i];
    const double length = p.arcLength - m_path[i - 1].arcLength;
    Length cost = m_toGo[i] + ofWay(length, p.forward);
    if (i + 1 < m_path.size())
      cost += lengthDown(m_checker.price().ofChange(stateAt(i), stateAt(i + 1)));
    if (m_checker.order().rank(p.classId) != kForbidden)
      cost += m_pricing.of(p.classId, lengthDown(length));
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
  if (excess() <= gain) return std::nullopt;
  m_gain = gain;
  m_budget.prices = m_pricing.perMeter();
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
      if (forward != m_isReversed || m_checker.price().canReverse()) step(from, turn, forward);
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
  cost += m_pricing.of(*profile);
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
  const DrivePrice& price = m_checker.price();
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
  if (!m_isReversed) return m_checker.price().curves(from.pose, to.pose);
  std::vector<ReedsSheppCurve> curves = m_checker.price().curves(to.pose, from.pose);
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

constexpr double kSlack = 0.05;  // m, beyond the tolerance

/** Where one rank counts, and others by whether they are better or worse. */
WayPricing pricingFor(Rank rank, Length ofBetter, Length ofRank, Length ofWorse,
                      const colored_graph::ClassOrder& order) {
  std::vector<Length> weights{0};
  for (Rank r = 1; r < order.ranks(); ++r)
    weights.push_back(r < rank ? ofBetter : r == rank ? ofRank : ofWorse);
  return {order, weights};
}

/** Meters of a rank and of those that are worse, as far as they may be avoided. */
double metersOf(Rank rank, const std::vector<PathPoint>& path, const EdgeChecker& checker) {
  double meters = 0;
  const double reach = reachFor(radiusFor(checker));
  for (std::size_t i = 1; i < path.size() && path[i].arcLength < reach; ++i) {
    const Rank own = checker.order().rank(path[i].classId);
    if (own >= rank && own != kForbidden) meters += path[i].arcLength - path[i - 1].arcLength;
  }
  return meters;
}

/** Whether a path has more of a rank, together with those that are worse, than it might, by more
 * than a tolerance. */
bool hasTooMuch(Rank rank, const std::vector<PathPoint>& path, bool isReversed,
                const EdgeChecker& checker, double tolerance) {
  constexpr Length kMuch = 1 << 20;  // beside the price of driving
  const double most = tolerance + 2 * kSlack;
  if (metersOf(rank, path, checker) <= most) return false;
  const WayPricing pricing = pricingFor(rank, 0, kMuch, kMuch, checker.order());
  return TurnSearch(path, isReversed, checker, pricing).excess() > kMuch * lengthDown(most);
}

/** The worst of the ranks of which the path has too much is the one that it should have less of. */
std::optional<std::vector<PathPoint>> better(const std::vector<PathPoint>& path, bool isReversed,
                                             const EdgeChecker& checker, double tolerance) {
  constexpr Length kWeight = 36, kOfWorse = 36 * kWeight, kOfBetter = 6;
  Rank rank = checker.order().ranks() - 1;
  while (rank > 0 && !hasTooMuch(rank, path, isReversed, checker, tolerance)) --rank;
  if (rank == 0) return std::nullopt;
  const WayPricing pricing = pricingFor(rank, kOfBetter, kWeight, kOfWorse, checker.order());
  return TurnSearch(path, isReversed, checker, pricing)
      .run(kWeight * lengthDown(tolerance + kSlack));
}

}  // namespace

std::optional<std::vector<PathPoint>> withBetterBegin(const std::vector<PathPoint>& path,
                                                      const EdgeChecker& checker,
                                                      double tolerance) {
  return better(path, false, checker, tolerance);
}

std::optional<std::vector<PathPoint>> withBetterEnd(const std::vector<PathPoint>& path,
                                                    const EdgeChecker& checker, double tolerance) {
  auto found = better(reversed(path), true, checker, tolerance);
  if (found) *found = reversed(*found);
  return found;
}

}  // namespace semantic_planning
