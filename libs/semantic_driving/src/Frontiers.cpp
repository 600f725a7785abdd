#include <semantic_driving/Frontiers.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include "GoalRegion.h"

namespace semantic_driving {

using mrpt::math::TPose2D;
using semantic_planning::Column;
using semantic_planning::Ground;
using semantic_planning::PlanStatus;
using semantic_planning::SemanticPlanner;
using semantic_planning::Surface;

namespace {

constexpr std::array<Column, 8> kNeighbors = {
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

/** Dijkstra's search over the columns around the vehicle. */
class GroundFlood {
 public:
  GroundFlood(const SemanticPlanner& planner, const TPose2D& from, int z,
              const FrontierOptions& options)
      : m_planner(planner),
        m_ground(planner.ground()),
        m_center(m_ground.columnAt(from.x, from.y)),
        m_square(m_center, static_cast<int>(options.radius / m_ground.voxelSize())),
        m_lenient(options.lenient / m_ground.voxelSize()),
        m_places(m_square.size()) {
    for (const Eigen::Vector2d& p : planner.options().vehicle.footprint)
      m_radius = std::min(m_radius, std::abs(p.y()));
    flood(z);
  }

  struct Place {
    double cost = std::numeric_limits<double>::infinity();
    int z = 0;
    Column from;
    bool done = false;
  };

  /** f(column, place) for all columns where the vehicle can get. */
  template <class F>
  void forEach(F f) const {
    for (std::size_t i = 0; i < m_places.size(); ++i)
      if (m_places[i].done) f(m_square.columnOf(i), m_places[i]);
  }
  const Place& at(Column c) const { return m_places[m_square.indexOf(c)]; }

  const ColumnSquare& square() const { return m_square; }
  /** For each column of the square. */
  std::vector<bool> reached() const {
    std::vector<bool> reached(m_places.size());
    for (std::size_t i = 0; i < m_places.size(); ++i) reached[i] = m_places[i].done;
    return reached;
  }

 private:
  using Open = std::pair<double, std::size_t>;

  bool isNear(Column c) const {  // where the vehicle stands there may be less clearance
    return std::hypot(c.x - m_center.x, c.y - m_center.y) < m_lenient;
  }

  void offer(Column c, double cost, int z, Column from) {
    Place& place = m_places[m_square.indexOf(c)];
    if (place.done || cost >= place.cost) return;
    place.cost = cost, place.z = z, place.from = from;
    m_open.emplace(cost, m_square.indexOf(c));
  }

  void flood(int z) {
    const Surface* s = m_ground.near(m_center, z, 2 * m_ground.step());
    if (s) offer(m_center, 0, s->z, m_center);
    while (!m_open.empty()) {
      const std::size_t i = m_open.top().second;
      m_open.pop();
      if (m_places[i].done) continue;
      m_places[i].done = true;
      expand(m_square.columnOf(i), m_places[i]);
    }
  }

  void expand(Column c, const Place& place) {
    for (const Column& d : kNeighbors) {
      const Column next{c.x + d.x, c.y + d.y};
      if (!m_square.contains(next)) continue;
      const Surface* s = m_ground.near(next, place.z, m_ground.step());
      if (!s || !s->drivable || !(m_ground.hasClearance(*s, m_radius) || isNear(next))) continue;
      const colored_graph::Rank rank = m_planner.order().rank(s->classId);
      if (rank == colored_graph::kForbidden) continue;
      const double way = std::hypot(d.x, d.y) * m_ground.voxelSize();
      offer(next, place.cost + way * (rank + 1), s->z, c);
    }
  }

  const SemanticPlanner& m_planner;
  const Ground& m_ground;
  Column m_center;
  ColumnSquare m_square;
  double m_lenient;  // voxels
  double m_radius = 1e3;
  std::vector<Place> m_places;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> m_open;
};

class FrontierSearch {
 public:
  FrontierSearch(const SemanticPlanner& planner, const GroundFlood& flood, const GoalRegion& region,
                 const FrontierOptions& options)
      : m_ground(planner.ground()), m_flood(flood), m_region(region), m_options(options) {}

  std::vector<Frontier> all(const TPose2D& goal) const {
    std::vector<Frontier> found;
    m_flood.forEach([&](Column c, const GroundFlood::Place& place) {
      if ((c.x + c.y) % 2 != 0 || !seesUnknown(c, place.z)) return;
      const double x = m_ground.centerOf(c.x), y = m_ground.centerOf(c.y);
      const double left = std::hypot(goal.x - x, goal.y - y);
      found.push_back({{x, y, headingAt(c)},
                       m_ground.centerOf(place.z),
                       place.cost + m_options.unknownFactor * left});
    });
    std::sort(found.begin(), found.end(),
              [](const Frontier& a, const Frontier& b) { return a.cost < b.cost; });
    return found;
  }

 private:
  bool isUnknown(Column c, int z) const {
    if (!m_ground.surfaces(c).empty()) return false;
    for (int k = z - 1; k <= z + 2; ++k)
      if (m_ground.map().search(octomap::OcTreeKey(static_cast<octomap::key_type>(c.x),
                                                   static_cast<octomap::key_type>(c.y),
                                                   static_cast<octomap::key_type>(k))))
        return false;
    return true;
  }

  /** Of the goal's region, in one of eight directions. */
  bool seesUnknown(Column c, int z) const {
    const int far = static_cast<int>(std::lround(m_options.sight / m_ground.voxelSize()));
    return std::any_of(kNeighbors.begin(), kNeighbors.end(), [&](const Column& d) {
      for (int i = 1; i <= far; ++i) {
        const Column there{c.x + i * d.x, c.y + i * d.y};
        if (!m_flood.square().contains(there)) return true;
        if (m_region.isObstacle(there)) return false;
        if (i > 1 && m_region.contains(there) && isUnknown(there, z)) return true;
      }
      return false;
    });
  }

  double headingAt(Column c) const {
    const auto columns = std::lround(m_options.headingOver / m_ground.voxelSize());
    Column before = c;
    for (long i = 0; i < columns; ++i) before = m_flood.at(before).from;
    return before == c ? 0 : std::atan2(c.y - before.y, c.x - before.x);
  }

  const Ground& m_ground;
  const GroundFlood& m_flood;
  const GoalRegion& m_region;
  const FrontierOptions& m_options;
};

}  // namespace

void FrontierOptions::describe(strict_files::OptionList& list) {
  using strict_files::above;
  using strict_files::atLeast;
  list.add("radius", radius, "m", above(0), "how far places are looked for");
  list.add("unknown_factor", unknownFactor, "", atLeast(0),
           "what a meter through the unknown counts against one on the best class");
  list.add("apart", apart, "m", atLeast(0), "between places");
  list.add("most", most, "", atLeast(1), "places");
  list.add("sight", sight, "m", above(0), "how far from a place the unknown is, at most");
  list.add("lenient", lenient, "m", atLeast(0),
           "so near to the vehicle less than its clearance is enough");
  list.add("heading_over", headingOver, "m", above(0),
           "last part of the way, which a place's heading is taken from");
  list.add("around_goal", aroundGoal, "m", atLeast(0),
           "a goal that seems not to be passable counts as so wide");
}

void FrontierOptions::validate() const { strict_files::checkOptions(*this, "FrontierOptions"); }

Exploration findFrontiers(const SemanticPlanner& planner, const TPose2D& from, double z,
                          const TPose2D& goal, const std::vector<TPose2D>& avoid,
                          const FrontierOptions& options) {
  options.validate();
  const double voxel = planner.ground().voxelSize();
  const int key = planner.ground().keyOf(z);
  const GroundFlood flood(planner, from, key, options);
  const GoalRegion region(planner, flood.square(), flood.reached(), from, z, goal,
                          options.aroundGoal);
  Exploration found;
  found.enclosed = region.isEnclosed();
  if (!region.isOpen()) found.goalArea = region.columns() * voxel * voxel;
  if (found.enclosed) return found;
  std::vector<Frontier>& chosen = found.frontiers;
  for (const Frontier& f : FrontierSearch(planner, flood, region, options).all(goal)) {
    const auto isNear = [&](const TPose2D& p) {
      return std::hypot(p.x - f.pose.x, p.y - f.pose.y) < options.apart;
    };
    if (chosen.size() == options.most) break;
    if (std::any_of(avoid.begin(), avoid.end(), isNear)) continue;
    if (std::any_of(chosen.begin(), chosen.end(),
                    [&](const Frontier& c) { return isNear(c.pose); }))
      continue;
    if (planner.check(f.pose, f.z) == PlanStatus::Found) chosen.push_back(f);
  }
  return found;
}

}  // namespace semantic_driving
