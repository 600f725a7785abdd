#include "StationSearch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace semantic_planning {

using colored_graph::Length;
using colored_graph::lengthDown;

StationSearch::StationSearch(const std::vector<Station>& stations, const EdgeChecker& checker,
                             std::size_t span, double reach)
    : m_checker(checker),
      m_price(checker.price()),
      m_span(span),
      m_reach(reach),
      m_gearChange(lengthDown(m_price.gearChange())) {
  std::size_t number = 0;
  for (const Station& station : stations) {
    m_places.emplace_back();
    const std::size_t at = m_places.size() - 1, from = at - std::min(at, span);
    const std::size_t firstOrigin = m_places[from].empty() ? number : m_places[from][0].number;
    const bool isEnd = at == 0 || at + 1 == stations.size();
    for (const GroundPose& pose : station) {
      const mrpt::math::TPoint2D heading(std::cos(pose.pose.phi), std::sin(pose.pose.phi));
      const bool isFree = isEnd || m_places[at].empty();
      m_places[at].push_back(
          {pose, heading, isFree, checker.classAt(pose), number++, firstOrigin, {}, {}});
    }
  }
}

const StationSearch::Label* StationSearch::Place::best() const {
  const auto& [forward, backward] = labels;
  if (!backward.reached) return forward.reached ? &forward : nullptr;
  return forward.reached && forward.cost < backward.cost ? &forward : &backward;
}

std::optional<std::vector<Leg>> StationSearch::run(const WayPricing& pricing) {
  m_budget.prices = pricing.perMeter();
  for (std::vector<Place>& station : m_places)
    for (Place& place : station) place.labels = {};
  for (Place& start : m_places.front()) start.labels[0].reached = true;
  for (std::size_t i = 1; i < m_places.size(); ++i)
    for (Place& to : m_places[i]) arriveAt(to, i, pricing);
  const Label* label = nullptr;
  for (const Place& goal : m_places.back()) label = goal.best();
  if (!label) return std::nullopt;
  std::vector<Leg> legs;
  for (; label->before; label = label->before)
    legs.push_back({label->last->curve, label->last->from, label->last->to, *label->last->profile});
  std::reverse(legs.begin(), legs.end());
  return legs;
}

void StationSearch::arriveAt(Place& to, std::size_t station, const WayPricing& pricing) {
  m_origins.clear();
  for (std::size_t i = station - std::min(station, m_span); i < station; ++i)
    for (const Place& from : m_places[i]) addOrigin(from, to, pricing);
  std::make_heap(m_origins.begin(), m_origins.end());
  for (; !m_origins.empty(); m_origins.pop_back()) {
    std::pop_heap(m_origins.begin(), m_origins.end());
    const Origin& origin = m_origins.back();
    if (origin.bound >= std::max(limit(to, true), limit(to, false))) return;
    connect(*origin.place, to, pricing);
  }
}

void StationSearch::addOrigin(const Place& from, const Place& to, const WayPricing& pricing) {
  const auto &a = from.pose.pose, &b = to.pose.pose;
  const double dx = b.x - a.x, dy = b.y - a.y, distance = std::hypot(dx, dy);
  const Label* label = from.best();
  if (!label || distance > m_reach) return;
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
  m_origins.push_back({label->cost + length + pricing.of(better, length), &from});
}

Length StationSearch::limit(const Place& to, bool forward) const {
  const Label &same = to.labels[forward ? 0 : 1], &other = to.labels[forward ? 1 : 0];
  Length limit = std::numeric_limits<Length>::max();
  if (other.reached) limit = other.cost + m_gearChange;
  return same.reached ? std::min(limit, same.cost) : limit;
}

void StationSearch::connect(const Place& from, Place& to, const WayPricing& pricing) {
  const Span span = connections(from, to);
  for (std::uint32_t i = 0; i < span.count; ++i) {
    Connection& connection = m_connections[span.first + i];
    auto [before, cost] = leastBefore(from, connection);
    const bool forward = endOf(connection.curve).forward;
    const Length limit = this->limit(to, forward);
    if (!before || cost >= limit) continue;
    evaluate(connection, limit - cost, pricing);
    if (!connection.profile) continue;
    cost += pricing.of(*connection.profile);
    if (cost < limit) to.labels[forward ? 0 : 1] = {cost, &connection, before, true};
  }
}

StationSearch::Span StationSearch::connections(const Place& from, Place& to) {
  if (to.connections.empty()) to.connections.resize(to.number - to.firstOrigin);
  Span& span = to.connections[from.number - to.firstOrigin];
  if (span.isKnown) return span;
  const auto first = static_cast<std::uint32_t>(m_connections.size());
  for (const ReedsSheppCurve& curve : m_price.curves(from.pose.pose, to.pose.pose))
    if (curve.length() <= m_reach)
      m_connections.push_back({curve, from.pose.z, to.pose.z, lengthDown(m_price.of(curve)),
                               Connection::New, std::nullopt});
  span = {first, static_cast<std::uint32_t>(m_connections.size()) - first, true};
  return span;
}

void StationSearch::evaluate(Connection& connection, Length most, const WayPricing& pricing) {
  constexpr Length kSlack = 10;  // lengths are rounded
  if (connection.state == Connection::Known || pricing.of(connection.seen) - kSlack > most) return;
  m_budget.left = colored_graph::toMeters(most) + colored_graph::toMeters(kSlack);
  connection.profile =
      m_checker.profile(connection.curve, connection.from, connection.to, &m_budget);
  const bool isForbidden = std::isinf(m_budget.left);  // in other runs, too
  connection.state = m_budget.isSpent() && !isForbidden ? Connection::Costly : Connection::Known;
  if (connection.state == Connection::Costly) connection.seen.swap(m_budget.seen);
}

std::pair<const StationSearch::Label*, Length> StationSearch::leastBefore(
    const Place& from, const Connection& connection) const {
  std::pair<const Label*, Length> least{nullptr, 0};
  const CurveState begin = beginOf(connection.curve);
  for (const Label& label : from.labels) {
    if (!label.reached) continue;
    const double change = label.last ? m_price.ofChange(endOf(label.last->curve), begin) : 0;
    const Length cost = label.cost + connection.price + lengthDown(change);
    if (!least.first || cost < least.second) least = {&label, cost};
  }
  return least;
}

}  // namespace semantic_planning
