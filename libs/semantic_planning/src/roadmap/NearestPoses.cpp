#include "NearestPoses.h"

#include <algorithm>
#include <cmath>

namespace semantic_planning {

using mrpt::math::TPose2D;

namespace {

/** A lower bound, or a distance on the plane, may exceed a distance by what rounding makes of it.
 */
constexpr double kInexact = 1e-9;

double squared(double x) { return x * x; }

/** Squared distance on the plane. */
double onPlane2(const TPose2D& a, const TPose2D& b) {
  return squared(b.x - a.x) + squared(b.y - a.y);
}

NearestPoses::Pair ordered(colored_graph::VertexId a, colored_graph::VertexId b) {
  return std::minmax(a, b);
}

bool holds(const std::vector<NearestPoses::Neighbor>& nearest, colored_graph::VertexId id) {
  return std::any_of(nearest.begin(), nearest.end(), [&](const auto& n) { return n.id == id; });
}

}  // namespace

NearestPoses::NearestPoses(const ReedsShepp& reedsShepp, int neighbors, double radius)
    : m_reedsShepp(reedsShepp),
      m_count(static_cast<std::size_t>(neighbors)),
      m_radius(radius),
      m_cellSize(radius / 4) {}

Column NearestPoses::cellOf(const TPose2D& pose) const {
  return {static_cast<int>(std::floor(pose.x / m_cellSize)),
          static_cast<int>(std::floor(pose.y / m_cellSize))};
}

template <class F>
void NearestPoses::forWithin(const TPose2D& pose, double radius, F f) const {
  const Column low = cellOf({pose.x - radius, pose.y - radius, 0});
  const Column high = cellOf({pose.x + radius, pose.y + radius, 0});
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      const std::vector<VertexId>* cell = m_cells.find({x, y});
      if (!cell) continue;
      for (const VertexId id : *cell) {
        const double distance2 = onPlane2(pose, m_entries[id].pose.pose);
        if (distance2 <= squared(radius)) f(id, distance2);
      }
    }
}

double NearestPoses::farthest(const Entry& entry) const {
  return isFull(entry) ? entry.nearest.back().distance : m_radius;
}

void NearestPoses::place(VertexId id, const GroundPose& pose) {
  if (id >= m_entries.size()) m_entries.resize(id + 1);
  m_entries[id] = {true, pose, {}};
  m_cells.at(cellOf(pose.pose)).push_back(id);
  ++m_present;
}

void NearestPoses::forget(VertexId id) {
  std::vector<VertexId>& cell = m_cells.at(cellOf(m_entries[id].pose.pose));
  --m_present;
  cell.erase(std::find(cell.begin(), cell.end(), id));
  for (const Neighbor& n : m_entries[id].nearest) m_changed.push_back(ordered(id, n.id));
  m_entries[id] = Entry();
}

void NearestPoses::offer(VertexId to, const Neighbor& neighbor) {
  std::vector<Neighbor>& nearest = m_entries[to].nearest;
  if (neighbor.distance > m_radius || holds(nearest, neighbor.id)) return;
  if (isFull(m_entries[to])) {
    if (!(neighbor < nearest.back())) return;
    m_changed.push_back(ordered(to, nearest.back().id));
    nearest.pop_back();
  }
  nearest.insert(std::upper_bound(nearest.begin(), nearest.end(), neighbor), neighbor);
  m_changed.push_back(ordered(to, neighbor.id));
}

bool NearestPoses::mayCount(const PairBound& p) const {
  const double bound = p.bound - kInexact;
  return bound <= farthest(m_entries[p.a]) || bound <= farthest(m_entries[p.b]);
}

void NearestPoses::relax(std::vector<PairBound>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  for (const PairBound& p : pairs) {
    if (!mayCount(p)) continue;
    const Entry &a = m_entries[p.a], &b = m_entries[p.b];
    const double distance = PosePair(a.pose, b.pose).distance(m_reedsShepp);
    offer(p.a, {p.b, distance, b.pose});
    offer(p.b, {p.a, distance, a.pose});
  }
}

std::vector<NearestPoses::PairBound> NearestPoses::pairsOf(const std::vector<VertexId>& open,
                                                           double beyond, double radius) const {
  std::vector<bool> isOpen(m_entries.size());
  for (const VertexId id : open) isOpen[id] = true;
  const double beyond2 = beyond < 0 ? -1 : squared(beyond);
  std::vector<PairBound> pairs;
  for (const VertexId a : open)
    forWithin(m_entries[a].pose.pose, radius, [&](VertexId b, double distance2) {
      if (a == b || distance2 <= beyond2 || (isOpen[b] && b < a)) return;
      PairBound pair{std::sqrt(distance2), a, b};
      if (!mayCount(pair)) return;
      pair.bound = m_reedsShepp.lowerBound(m_entries[a].pose.pose, m_entries[b].pose.pose);
      if (pair.bound <= m_radius && mayCount(pair)) pairs.push_back(pair);
    });
  return pairs;
}

/** Where poses are dense there is no need to look at all within the radius: a disc that holds some
 * times the neighbors wanted, if they were spread evenly. */
double NearestPoses::firstRadius() const {
  std::size_t cells = 0;
  m_cells.forEach([&](Column, const std::vector<VertexId>& cell) { cells += !cell.empty(); });
  const double area = static_cast<double>(cells) * m_cellSize * m_cellSize;
  const double wanted = 3.0 * static_cast<double>(m_count);
  return std::min(m_radius, std::sqrt(wanted * area / (M_PI * static_cast<double>(m_present + 1))));
}

void NearestPoses::complete(std::vector<VertexId> open, double radius) {
  for (double beyond = -1; !open.empty() && beyond < m_radius;) {
    std::vector<PairBound> pairs = pairsOf(open, beyond, radius);
    relax(pairs);
    beyond = radius;
    radius = std::min(m_radius, 2 * radius);
    open.erase(
        std::remove_if(open.begin(), open.end(),
                       [&](VertexId id) { return farthest(m_entries[id]) <= beyond - kInexact; }),
        open.end());
  }
}

std::vector<NearestPoses::VertexId> NearestPoses::dropForgotten() {
  std::vector<VertexId> lacking;
  for (VertexId id = 0; id < m_entries.size(); ++id) {
    std::vector<Neighbor>& nearest = m_entries[id].nearest;
    const auto lost = std::stable_partition(nearest.begin(), nearest.end(),
                                            [&](const Neighbor& n) { return contains(n.id); });
    if (lost == nearest.end()) continue;
    if (isFull(m_entries[id])) lacking.push_back(id);
    for (auto n = lost; n != nearest.end(); ++n) m_changed.push_back(ordered(id, n->id));
    nearest.erase(lost, nearest.end());
  }
  return lacking;
}

std::vector<NearestPoses::Pair> NearestPoses::replace(const std::vector<VertexId>& removed,
                                                      const std::vector<VertexId>& ids,
                                                      const std::vector<GroundPose>& poses) {
  for (const VertexId id : removed) forget(id);
  std::vector<VertexId> open = dropForgotten();
  const bool first = m_present == 0;
  for (std::size_t i = 0; i < ids.size(); ++i) place(ids[i], poses[i]);
  open.insert(open.end(), ids.begin(), ids.end());
  complete(std::move(open), firstRadius());
  if (first) return takeChanged();
  // New poses may be neighbors of what is farther from them than their own neighbors.
  std::vector<PairBound> pairs = pairsOf(ids, -1, m_radius);
  relax(pairs);
  return takeChanged();
}

std::vector<NearestPoses::Pair> NearestPoses::takeChanged() {
  std::sort(m_changed.begin(), m_changed.end());
  m_changed.erase(std::unique(m_changed.begin(), m_changed.end()), m_changed.end());
  return std::exchange(m_changed, {});
}

bool NearestPoses::linked(VertexId a, VertexId b) const {
  return contains(a) && contains(b) && (holds(of(a), b) || holds(of(b), a));
}

std::vector<NearestPoses::Neighbor> NearestPoses::nearestTo(const GroundPose& pose,
                                                            std::size_t count) const {
  std::vector<std::pair<double, VertexId>> bounds;
  forWithin(pose.pose, m_radius, [&](VertexId id, double) {
    bounds.emplace_back(m_reedsShepp.lowerBound(pose.pose, m_entries[id].pose.pose), id);
  });
  std::sort(bounds.begin(), bounds.end());
  std::vector<Neighbor> nearest;
  for (const auto& [bound, id] : bounds) {
    if (nearest.size() == count && bound - kInexact > nearest.back().distance) break;
    const GroundPose& other = m_entries[id].pose;
    const Neighbor n{id, PosePair(pose, other).distance(m_reedsShepp), other};
    if (n.distance > m_radius) continue;
    nearest.insert(std::upper_bound(nearest.begin(), nearest.end(), n), n);
    if (nearest.size() > count) nearest.pop_back();
  }
  return nearest;
}

}  // namespace semantic_planning
