#include "GroundGrid.h"

#include <algorithm>

namespace semantic_map_ros2 {

using semantic_planning::Column;
using semantic_planning::GroundPoint;
using semantic_planning::kTileEdge;

namespace {
constexpr int kUnknown = -1, kBlocked = 100;
}

GroundGrid::GroundGrid(ros2::Node& node, semantic_octree::SemanticOcTree& map,
                       const colored_graph::ClassOrder& order,
                       const semantic_planning::PlannerOptions& options, std::vector<int> costs,
                       std::string frame)
    : m_order(order),
      m_follower(map.follow()),
      m_ground(map, options.vehicle, options.ground, order),
      m_costs(std::move(costs)),
      m_frame(std::move(frame)),
      m_writes(node, "map", {true, true, 1}) {
  m_follower.skipTiles();
}

int GroundGrid::costAt(Column column, const std::optional<GroundPoint>& robot) const {
  const auto surfaces = m_ground.surfaces(column);
  if (surfaces.empty()) return kUnknown;
  for (const auto& surface : surfaces) {
    if (robot && !m_ground.connected(*robot, {column, surface})) continue;
    const colored_graph::Rank rank = m_order.rank(surface.classId);
    return !surface.drivable || rank == colored_graph::kForbidden ? kBlocked
                                                                  : m_costs[std::size_t(rank)];
  }
  return kBlocked;
}

void GroundGrid::publish(ros2::Stamp stamp, const Eigen::Isometry3d& T_map_robot) {
  if (!m_writes.isRead()) return;
  m_ground.update(m_follower.tiles());
  const std::vector<Column> tiles = m_ground.tiles();
  if (tiles.empty()) return;
  Column low = tiles.front(), high = tiles.front();
  for (const Column tile : tiles) {
    low = {std::min(low.x, tile.x), std::min(low.y, tile.y)};
    high = {std::max(high.x, tile.x), std::max(high.y, tile.y)};
  }
  const auto& p = T_map_robot.translation();
  const auto robot = m_ground.find(p.x(), p.y(), p.z());
  const int width = (high.x - low.x + 1) * kTileEdge, height = (high.y - low.y + 1) * kTileEdge;
  const Column first = firstColumnOf(low);
  std::vector<std::uint8_t> cells(std::size_t(width) * height, std::uint8_t(kUnknown));
  for (const Column tile : tiles) {
    const Column begin = firstColumnOf(tile), end = lastColumnOf(tile);
    for (int y = begin.y; y <= end.y; ++y)
      for (int x = begin.x; x <= end.x; ++x)
        cells[std::size_t(y - first.y) * width + (x - first.x)] =
            std::uint8_t(costAt({x, y}, robot));
  }
  const double voxel = m_ground.voxelSize();
  ros2::OccupancyGrid message{};
  message.header = ros2::headerOf(stamp, m_frame);
  message.info.map_load_time = message.header.stamp;
  message.info.resolution = static_cast<float>(voxel);
  message.info.width = std::uint32_t(width), message.info.height = std::uint32_t(height);
  message.info.origin.position.x = m_ground.centerOf(first.x) - voxel / 2;
  message.info.origin.position.y = m_ground.centerOf(first.y) - voxel / 2;
  message.info.origin.orientation.w = 1;
  ros2::refer(message.data, cells);
  m_writes.write(message);
}

}  // namespace semantic_map_ros2
