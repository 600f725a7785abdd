#include "ground_costs/GroundCosts.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>

namespace ground_costs {

namespace {

template <class F>
void forEachColumn(semantic_planning::Column tile, const F& use) {
  const auto begin = firstColumnOf(tile), end = lastColumnOf(tile);
  for (int y = begin.y; y <= end.y; ++y)
    for (int x = begin.x; x <= end.x; ++x) use(semantic_planning::Column{x, y});
}

}  // namespace

std::vector<int> evenCosts(int ranks) {
  std::vector<int> costs;
  for (int rank = 0; rank < ranks; ++rank) costs.push_back(ranks > 1 ? 90 * rank / (ranks - 1) : 0);
  return costs;
}

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
      m_costs(costs.empty() ? evenCosts(order.ranks()) : std::move(costs)) {
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
  m_height.look(m_ground, m_vehicle, T_map_robot);
  return compute(std::move(tiles), below(T_map_robot));
}

void GroundCosts::takeLargestPart(std::optional<double> floor) {
  m_isInscribed = true;
  m_storeyHeight = static_cast<int>(m_vehicle.height / voxelSize());
  if (floor) m_floor = m_ground.keyOf(*floor - voxelSize() / 2);  // of the voxel with this top
  compute({}, inLargestPart());
}

/** A place in it. */
auto GroundCosts::inLargestPart() const -> GroundPoint {
  using Counted = std::pair<GroundPoint, std::size_t>;
  std::vector<Counted> parts;
  const auto add = [&](const GroundPoint& place) {
    auto part = std::find_if(parts.begin(), parts.end(), [&](const Counted& known) {
      return m_ground.connected(known.first, place);
    });
    if (part == parts.end()) part = parts.insert(part, {place, 0});
    ++part->second;
    if (part != parts.begin() && part->second > std::prev(part)->second)
      std::iter_swap(part, std::prev(part));  // large ones are asked first
  };
  for (const Column tile : m_ground.tiles())
    forEachColumn(tile, [&](Column column) {
      for (const Surface& surface : m_ground.surfaces(column))
        if (surface.drivable && isInStorey(surface)) add({column, surface});
    });
  if (parts.empty()) throw std::runtime_error("the map has no drivable ground");
  const auto smaller = [](const Counted& a, const Counted& b) { return a.second < b.second; };
  return std::max_element(parts.begin(), parts.end(), smaller)->first;
}

auto GroundCosts::compute(std::vector<Column> tiles, const std::optional<GroundPoint>& from)
    -> std::optional<Box> {
  const bool hadPlace = std::exchange(m_from, from).has_value();
  if (!m_box || grow(tiles) || m_from.has_value() != hadPlace) {
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
    for (const Column tile : tiles) computeTile(tile, changed);
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
  constexpr std::size_t kMostCells = std::size_t{1} << 28;
  const std::size_t cells = std::size_t(box.width()) * std::size_t(box.height());
  if (cells > kMostCells)
    throw std::runtime_error("a grid of " + std::to_string(box.width()) + " x " +
                             std::to_string(box.height()) +
                             " cells is too wide: crop the map first");
  m_box = box;
  m_cells.assign(cells, std::uint8_t(kUnknown));
  return true;
}

void GroundCosts::computeTile(Column tile, std::optional<Box>& changed) {
  std::vector<Part> parts;
  forEachColumn(tile, [&](Column column) {
    const auto cost = std::uint8_t(costAt(column, parts));
    if (std::exchange(m_cells[placeOf(column)], cost) == cost) return;
    if (!changed) changed = Box{column, column};
    changed->add(column);
  });
  if (!parts.empty()) m_parts[tile] = std::move(parts);
}

/** \param parts of its tile that were met already; gets those that were not */
bool GroundCosts::counts(Column column, const Surface& surface, std::vector<Part>& parts) const {
  auto part = std::find_if(parts.begin(), parts.end(), [&](const Part& p) {
    return p.point.surface.component == surface.component;
  });
  if (part == parts.end() && surface.drivable) {
    const GroundPoint point{column, surface};
    part = parts.insert(parts.end(), {point, isReached(point)});
  }
  return !m_from || (surface.drivable && part->isReached);
}

int GroundCosts::costAt(Column column, std::vector<Part>& parts) const {
  bool isKnown = m_floor && m_ground.isOccupied(column, *m_floor + 1, *m_floor + m_storeyHeight);
  const Surface* nearest = nullptr;
  for (const Surface& surface : m_ground.surfaces(column)) {
    if (!isInStorey(surface)) continue;
    isKnown = true;
    const bool isNearer =
        !nearest || std::abs(aboveFloor(surface)) < std::abs(aboveFloor(*nearest));
    if (counts(column, surface, parts) && isNearer) nearest = &surface;
  }
  if (!nearest) return isKnown ? kBlocked : kUnknown;
  const colored_graph::Rank rank = m_order.rank(nearest->classId);
  if (!nearest->drivable || rank == colored_graph::kForbidden) return kBlocked;
  const bool fits =
      !m_isInscribed || m_ground.hasClearance(*nearest, m_vehicle.footprint.inscribedRadius());
  return fits ? m_costs[std::size_t(rank)] : kInscribed;
}

}  // namespace ground_costs
