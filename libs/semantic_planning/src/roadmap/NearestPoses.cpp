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

void NearestPoses::replace(const std::vector<VertexId>& removed, const std::vector<VertexId>& ids,
                           const std::vector<GroundPose>& poses) {
  if (removed.empty() && ids.empty()) return;
  for (const VertexId id : removed) m_entries[id] = {};
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] >= m_entries.size()) m_entries.resize(ids[i] + 1);
    m_entries[ids[i]] = {true, poses[i], {}};
  }
  m_cells = {};
  for (VertexId id = 0; id < m_entries.size(); ++id)
    if (contains(id)) m_cells.at(cellOf(pose(id).pose)).push_back(id);
  for (VertexId id = 0; id < m_entries.size(); ++id)
    if (contains(id)) m_entries[id].nearest = nearestTo(pose(id), m_count, id);
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
