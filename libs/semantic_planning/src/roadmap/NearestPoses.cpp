#include "NearestPoses.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace semantic_planning {

using mrpt::math::TPose2D;

namespace {

/** A lower bound may exceed a distance by what rounding makes of it. */
constexpr double kInexact = 1e-9;

}  // namespace

NearestPoses::NearestPoses(const ReedsShepp& reedsShepp, int neighbors, double radius)
    : m_reedsShepp(reedsShepp), m_count(static_cast<std::size_t>(neighbors)), m_radius(radius) {}

Column NearestPoses::cellOf(const TPose2D& pose) const {
  const double size = m_radius / 8;
  return {static_cast<int>(std::floor(pose.x / size)), static_cast<int>(std::floor(pose.y / size))};
}

template <class F>
void NearestPoses::forNear(const TPose2D& pose, double radius, F f) const {
  const Column low = cellOf({pose.x - radius, pose.y - radius, 0});
  const Column high = cellOf({pose.x + radius, pose.y + radius, 0});
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x)
      if (const std::vector<VertexId>* cell = m_cells.find({x, y}))
        for (const VertexId id : *cell) f(id);
}

bool NearestPoses::mayTake(const Entry& entry, const GroundPose& pose) const {
  const double farthest =
      entry.nearest.size() == m_count ? entry.nearest.back().distance : m_radius;
  return m_reedsShepp.lowerBound(entry.pose.pose, pose.pose) <= farthest + kInexact;
}

void NearestPoses::replace(const std::vector<VertexId>& removed, const std::vector<VertexId>& ids,
                           const std::vector<GroundPose>& poses) {
  for (const VertexId id : removed) {
    std::vector<VertexId>& cell = m_cells.at(cellOf(m_entries[id].pose.pose));
    cell.erase(std::find(cell.begin(), cell.end(), id));
    m_entries[id] = {};
  }
  std::vector<bool> isOutdated;
  for (const Entry& e : m_entries)
    isOutdated.push_back(std::any_of(e.nearest.begin(), e.nearest.end(),
                                     [&](const Neighbor& n) { return !contains(n.id); }));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] >= m_entries.size()) m_entries.resize(ids[i] + 1), isOutdated.resize(ids[i] + 1);
    m_entries[ids[i]] = {true, poses[i], {}};
    isOutdated[ids[i]] = true;
    m_cells.at(cellOf(poses[i].pose)).push_back(ids[i]);
  }
  for (const GroundPose& pose : poses)
    forNear(pose.pose, m_radius, [&](VertexId id) {
      if (!isOutdated[id]) isOutdated[id] = mayTake(m_entries[id], pose);
    });
  for (VertexId id = 0; id < m_entries.size(); ++id)
    if (isOutdated[id]) m_entries[id].nearest = nearestTo(m_entries[id].pose, m_count, id);
}

/** Farther and farther: where poses are dense there is no need to look at all within the radius. */
std::vector<NearestPoses::Neighbor> NearestPoses::nearestTo(const GroundPose& pose,
                                                            std::size_t count, VertexId but) const {
  std::vector<Neighbor> nearest;
  const auto farthest = [&] {
    return nearest.size() == count ? nearest.back().distance : m_radius;
  };
  double looked = -1;
  for (double reach = m_radius / 16; looked < farthest(); reach = std::min(m_radius, 2 * reach)) {
    std::vector<std::pair<double, VertexId>> bounds;
    forNear(pose.pose, reach + kInexact, [&](VertexId id) {
      const double bound = m_reedsShepp.lowerBound(pose.pose, m_entries[id].pose.pose) - kInexact;
      if (id != but && bound > looked && bound <= reach) bounds.emplace_back(bound, id);
    });
    std::sort(bounds.begin(), bounds.end());
    for (const auto& [bound, id] : bounds) {
      if (bound > farthest()) break;
      const GroundPose& other = m_entries[id].pose;
      const Neighbor n{id, PosePair(pose, other).distance(m_reedsShepp), other};
      if (n.distance > m_radius) continue;
      nearest.insert(std::upper_bound(nearest.begin(), nearest.end(), n), n);
      if (nearest.size() > count) nearest.pop_back();
    }
    looked = reach;
  }
  return nearest;
}

}  // namespace semantic_planning
