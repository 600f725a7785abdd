#include "LatticeSearch.h"

#include <semantic_planning/planner/Slices.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace semantic_planning {

using colored_graph::Length;
using colored_graph::lengthDown;

LatticeSearch::LatticeSearch(const std::vector<Station>& stations, const CollisionChecker& checker,
                             const ClassPrices& prices, std::size_t span)
    : m_checker(checker),
      m_cost(checker.motionCost()),
      m_prices(prices),
      m_span(span),
      m_gearChange(lengthDown(m_cost.gearChange())),
      m_budget{prices.perMeter()} {
  for (const Station& station : stations) {
    m_places.emplace_back();
    const bool isEnd = m_places.size() == 1 || m_places.size() == stations.size();
    for (const GroundPose& pose : station) {
      const mrpt::math::TPoint2D heading(std::cos(pose.pose.phi), std::sin(pose.pose.phi));
      const bool isFree = isEnd || m_places.back().empty();
      m_places.back().push_back({pose, heading, isFree, checker.classAt(pose), {}});
    }
  }
}

const LatticeSearch::Label* LatticeSearch::Place::best() const {
  const auto& [forward, backward] = labels;
  if (!backward.reached) return forward.reached ? &forward : nullptr;
  return forward.reached && forward.cost < backward.cost ? &forward : &backward;
}

std::optional<std::vector<Leg>> LatticeSearch::run() {
  for (Place& start : m_places.front()) start.labels[0].reached = true;
  for (std::size_t i = 1; i < m_places.size(); ++i)
    for (Place& to : m_places[i]) arriveAt(to, i);
  const Label* label = nullptr;
  for (const Place& goal : m_places.back()) label = goal.best();
  if (!label) return std::nullopt;
  std::vector<Leg> legs;
  for (; label->before; label = label->before) legs.push_back(*label->last);
  std::reverse(legs.begin(), legs.end());
  return legs;
}

void LatticeSearch::arriveAt(Place& to, std::size_t station) {
  m_origins.clear();
  for (std::size_t i = station - std::min(station, m_span); i < station; ++i)
    for (const Place& from : m_places[i]) addOrigin(from, to);
  std::make_heap(m_origins.begin(), m_origins.end());
  for (; !m_origins.empty(); m_origins.pop_back()) {
    std::pop_heap(m_origins.begin(), m_origins.end());
    const Origin& origin = m_origins.back();
    if (origin.bound >= std::max(limit(to, true), limit(to, false))) return;
    connect(*origin.place, to);
  }
}

void LatticeSearch::addOrigin(const Place& from, const Place& to) {
  const auto &a = from.pose.pose, &b = to.pose.pose;
  const double dx = b.x - a.x, dy = b.y - a.y, distance = std::hypot(dx, dy);
  const Label* label = from.best();
  if (!label || distance > kLongest) return;
  const double fromAhead = from.heading.x * dx + from.heading.y * dy;
  const double toAhead = to.heading.x * dx + to.heading.y * dy;
  constexpr double kLeastAhead = 0.3;  // of the distance
  if (!from.isFree && !to.isFree &&
      (fromAhead * toAhead <= 0 ||
       std::min(std::abs(fromAhead), std::abs(toAhead)) < kLeastAhead * distance))
    return;
  const auto rank = [this](const Place& place) { return m_checker.order().rank(place.classId); };
  const ClassId better = rank(from) < rank(to) ? from.classId : to.classId;
  const Length length = lengthDown(distance);
  m_origins.push_back({label->cost + length + m_prices.of(better, length), &from});
}

Length LatticeSearch::limit(const Place& to, bool forward) const {
  const Label &same = to.labels[forward ? 0 : 1], &other = to.labels[forward ? 1 : 0];
  Length limit = std::numeric_limits<Length>::max();
  if (other.reached) limit = other.cost + m_gearChange;
  return same.reached ? std::min(limit, same.cost) : limit;
}

void LatticeSearch::connect(const Place& from, Place& to) {
  Slices::count(20);
  for (const ReedsSheppCurve& curve : m_cost.curves(from.pose.pose, to.pose.pose))
    if (curve.length() <= kLongest) connect(from, to, curve);
}

void LatticeSearch::connect(const Place& from, Place& to, const ReedsSheppCurve& curve) {
  constexpr double kSlack = 1e-3;  // m: lengths are rounded
  const auto [before, cost] = leastBefore(from, curve);
  const bool forward = endOf(curve).forward;
  const Length limit = this->limit(to, forward);
  if (!before || cost >= limit) return;
  m_budget.left = colored_graph::toMeters(limit - cost) + kSlack;
  auto profile = m_checker.profile(curve, from.pose.z, to.pose.z, &m_budget);
  if (!profile) return;
  const Length whole = cost + m_prices.of(*profile);
  if (whole >= limit) return;
  m_legs.push_back({curve, from.pose.z, to.pose.z, std::move(*profile)});
  to.labels[forward ? 0 : 1] = {whole, &m_legs.back(), before, true};
}

std::pair<const LatticeSearch::Label*, Length> LatticeSearch::leastBefore(
    const Place& from, const ReedsSheppCurve& curve) const {
  std::pair<const Label*, Length> least{nullptr, 0};
  const CurveState begin = beginOf(curve);
  const Length ofCurve = lengthDown(m_cost.of(curve));
  for (const Label& label : from.labels) {
    if (!label.reached) continue;
    const double change = label.last ? m_cost.ofChange(endOf(label.last->curve), begin) : 0;
    const Length cost = label.cost + ofCurve + lengthDown(change);
    if (!least.first || cost < least.second) least = {&label, cost};
  }
  return least;
}

}  // namespace semantic_planning
