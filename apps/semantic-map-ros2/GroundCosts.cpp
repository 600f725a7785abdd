#include "GroundCosts.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace semantic_map_ros2 {

using semantic_planning::Surface;

void GroundCosts::Box::add(Column c) {
  low = {std::min(low.x, c.x), std::min(low.y, c.y)};
  high = {std::max(high.x, c.x), std::max(high.y, c.y)};
}

GroundCosts::GroundCosts(semantic_octree::SemanticOcTree& map,
                         const colored_graph::ClassOrder& order,
                         const semantic_planning::PlannerOptions& options, std::vector<int> costs)
    : m_order(order),
      m_vehicle(options.vehicle),
      m_follower(map.follow()),
      m_ground(map, options.vehicle, options.ground, order),
      m_costs(std::move(costs)) {
  m_follower.skipTiles();
}

/** What the robot stands on, if the map knows it. */
auto GroundCosts::below(const Eigen::Isometry3d& T_map_robot) const -> std::optional<GroundPoint> {
  if (!m_height.meters()) return std::nullopt;
  const Eigen::Vector3d p = m_height.onGround(T_map_robot).translation();
  const auto found = m_ground.find(p.x(), p.y(), p.z());
  const bool isThere =
      found && std::abs(found->surface.z - m_ground.keyOf(p.z())) <= 2 * m_ground.step();
  return isThere ? found : std::nullopt;
}

auto GroundCosts::follow(const Eigen::Isometry3d& T_map_robot) -> std::optional<Box> {
  std::vector<Column> tiles = m_ground.update(m_follower.tiles());
  const bool hadRobot = m_robot.has_value();
  m_height.look(m_ground, m_vehicle, T_map_robot);
  m_robot = below(T_map_robot);
  if (!m_box || grow(tiles) || m_robot.has_value() != hadRobot) {
    const std::vector<Column> all = m_ground.tiles();
    tiles.insert(tiles.end(), all.begin(), all.end());
    grow(all);
  }
  for (const Column tile : tiles) m_parts.erase(tile);  // of ground that is another one now
  for (const auto& [tile, parts] : m_parts)
    if (std::any_of(parts.begin(), parts.end(),
                    [&](const Part& part) { return isReached(part.point) != part.isReached; }))
      tiles.push_back(tile);
  std::optional<Box> changed;
  if (m_box)
    for (const Column tile : tiles) compute(tile, changed);
  return changed;
}

/** A side that has to grow takes a quarter more than it needs: a map that becomes larger with each
 * scan is not sent anew each time. \return whether the cells are others, and unknown */
bool GroundCosts::grow(const std::vector<Column>& tiles) {
  if (tiles.empty()) return false;
  Box box = m_box.value_or(Box{firstColumnOf(tiles.front()), lastColumnOf(tiles.front())});
  const Box before = box;
  for (const Column tile : tiles) {
    box.add(firstColumnOf(tile));
    box.add(lastColumnOf(tile));
  }
  const auto more = [&](bool grows, int length) { return m_box && grows ? length / 4 : 0; };
  const int width = box.width(), height = box.height();
  box.low.x -= more(box.low.x < before.low.x, width);
  box.low.y -= more(box.low.y < before.low.y, height);
  box.high.x += more(box.high.x > before.high.x, width);
  box.high.y += more(box.high.y > before.high.y, height);
  if (m_box && *m_box == box) return false;
  m_box = box;
  m_cells.assign(std::size_t(box.width()) * box.height(), std::uint8_t(kUnknown));
  return true;
}

void GroundCosts::compute(Column tile, std::optional<Box>& changed) {
  std::vector<Part> parts;
  const Column begin = firstColumnOf(tile), end = lastColumnOf(tile);
  for (int y = begin.y; y <= end.y; ++y)
    for (int x = begin.x; x <= end.x; ++x) {
      const auto cost = std::uint8_t(costAt({x, y}, parts));
      if (std::exchange(m_cells[placeOf({x, y})], cost) == cost) continue;
      if (!changed) changed = Box{{x, y}, {x, y}};
      changed->add({x, y});
    }
  if (!parts.empty()) m_parts[tile] = std::move(parts);
}

/** \param parts of its tile that were met already; gets those that were not */
int GroundCosts::costAt(Column column, std::vector<Part>& parts) const {
  const auto surfaces = m_ground.surfaces(column);
  if (surfaces.empty()) return kUnknown;
  std::optional<int> cost;
  for (const Surface& surface : surfaces) {
    auto part = std::find_if(parts.begin(), parts.end(), [&](const Part& p) {
      return p.point.surface.component == surface.component;
    });
    if (part == parts.end() && surface.drivable) {
      const GroundPoint point{column, surface};
      part = parts.insert(parts.end(), {point, isReached(point)});
    }
    if (cost || (m_robot && !(surface.drivable && part->isReached))) continue;
    const colored_graph::Rank rank = m_order.rank(surface.classId);
    const bool isFree = surface.drivable && rank != colored_graph::kForbidden;
    cost = isFree ? m_costs[std::size_t(rank)] : kBlocked;
  }
  return cost.value_or(kBlocked);
}

}  // namespace semantic_map_ros2
