#include <semantic_planning/planner/Corridor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <queue>

#include "CoarseGround.h"
#include "PlannerCore.h"
#include "RelaxedField.h"
#include "RelaxedSearch.h"
#include "ground/GroundTiles.h"

namespace semantic_planning {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

using Id = CoarseGround::Id;
using Cost = RelaxedField::Cost;

/** A* from part to part. */
class CorridorSearch {
 public:
  CorridorSearch(CoarseGround& ground, const colored_graph::ClassOrder& order)
      : m_ground(ground), m_weights(weightsOfRanks(order)) {}

  /** The tiles on the way; none: there is no way. */
  std::vector<Column> run(const Id& start, const Id& goal) {
    m_goal = goal.tile;
    reach(start, {0, start, false});
    while (!m_queue.empty()) {
      const Id id = m_queue.top().second;
      m_queue.pop();
      if (id == goal) return tilesTo(goal);
      Label& label = m_labels.at(id);
      if (std::exchange(label.done, true)) continue;
      for (const Id& next : m_ground.at(id).next) take(id, label.cost, next);
    }
    return {};
  }

 private:
  struct Label {
    Cost cost;
    Id before;  ///< the start's is itself
    bool done;
  };
  using Entry = std::pair<Cost, Id>;

  void take(const Id& from, Cost cost, const Id& to) {
    cost += stepsBetween(from.tile, to.tile) *
            m_weights[static_cast<std::size_t>(m_ground.at(to).rank)];
    const auto known = m_labels.find(to);
    if (known == m_labels.end() || cost < known->second.cost) reach(to, {cost, from, false});
  }

  void reach(const Id& id, const Label& label) {
    m_labels[id] = label;
    m_queue.push({label.cost + kWeightOfLength * stepsBetween(id.tile, m_goal), id});
  }

  std::vector<Column> tilesTo(Id id) const {
    std::vector<Column> tiles{id.tile};
    while (!(m_labels.at(id).before == id)) {
      id = m_labels.at(id).before;
      tiles.push_back(id.tile);
    }
    std::reverse(tiles.begin(), tiles.end());
    return tiles;
  }

  CoarseGround& m_ground;
  const std::vector<Cost> m_weights;  ///< of a length, by rank
  std::map<Id, Label> m_labels;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> m_queue;
  Column m_goal;
};

std::vector<Column> tilesOnTheWay(const semantic_octree::SemanticOcTree& map,
                                  const colored_graph::ClassOrder& order,
                                  const PlannerOptions& options, const CorridorTask& task) {
  CoarseGround ground(map, order, options);
  const auto start = ground.near(task.start, task.startZ),
             goal = ground.near(task.goal, task.goalZ);
  if (!start || !goal) return {};
  return CorridorSearch(ground, order).run(*start, *goal);
}

}  // namespace

std::vector<Column> Corridor::tiles(double voxelSize) const {
  const double edge = kTileEdge * voxelSize;
  const auto tileAt = [&](double x, double y) {
    return tileOf({semantic_octree::keyOf(x, voxelSize), semantic_octree::keyOf(y, voxelSize)});
  };
  std::vector<Column> tiles;
  for (const TPoint2D& p : way) {
    const Column low = tileAt(p.x - width, p.y - width), high = tileAt(p.x + width, p.y + width);
    for (int x = low.x; x <= high.x; ++x)
      for (int y = low.y; y <= high.y; ++y) {
        const Column first = firstColumnOf({x, y});
        const double dx = semantic_octree::lowerBorderOf(first.x, voxelSize) + edge / 2 - p.x;
        const double dy = semantic_octree::lowerBorderOf(first.y, voxelSize) + edge / 2 - p.y;
        if (std::hypot(dx, dy) <= width + edge) tiles.push_back({x, y});
      }
  }
  sortOut(tiles);
  return tiles;
}

bool Corridor::mayNeed(const TPoint2D& low, const TPoint2D& high) const {
  const auto distance = [](double at, double from, double to) {
    return std::max({0.0, from - at, at - to});
  };
  return std::any_of(way.begin(), way.end(), [&](const TPoint2D& p) {
    return std::hypot(distance(p.x, low.x, high.x), distance(p.y, low.y, high.y)) <= width + reach;
  });
}

Corridor findCorridor(const semantic_octree::SemanticOcTree& map,
                      const colored_graph::ClassOrder& order, const PlannerOptions& options,
                      const CorridorTask& task) {
  options.validate();
  PlannerCore::checkFinite("start", {task.start, task.startZ});
  PlannerCore::checkFinite("goal", {task.goal, task.goalZ});
  const double voxel = map.getResolution(), edge = kTileEdge * voxel;
  const GroundShape shape(options.vehicle, options.ground, order, voxel);
  Corridor corridor{
      {{task.start.x, task.start.y}}, task.width, voxel * reachOfGround(shape) + 4 * edge};
  for (const Column& tile : tilesOnTheWay(map, order, options, task)) {
    const Column first = firstColumnOf(tile);
    corridor.way.emplace_back(semantic_octree::lowerBorderOf(first.x, voxel) + edge / 2,
                              semantic_octree::lowerBorderOf(first.y, voxel) + edge / 2);
  }
  corridor.way.emplace_back(task.goal.x, task.goal.y);
  return corridor;
}

}  // namespace semantic_planning
