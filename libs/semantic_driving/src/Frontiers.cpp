#include <semantic_driving/Explorer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "GoalRegion.h"
#include "GroundFlood.h"
#include "WayLeft.h"

namespace semantic_driving {

using mrpt::math::TPose2D;
using semantic_planning::Column;
using semantic_planning::Ground;
using semantic_planning::PlanStatus;
using semantic_planning::SemanticPlanner;
using semantic_planning::Surface;

namespace {

constexpr double kUnknownFactor = 2;   // what a meter through the unknown counts, of one on rank 0
constexpr double kFrontiersApart = 3;  // m
constexpr std::size_t kMostFrontiers = 6;

class FrontierSearch {
 public:
  FrontierSearch(const SemanticPlanner& planner, const GroundFlood& flood, const GoalRegion& region,
                 const TPose2D& from, const TPose2D& goal)
      : m_planner(planner),
        m_ground(planner.ground()),
        m_flood(flood),
        m_region(region),
        m_from(from),
        m_goal(goal) {
    flood.forEach([&](Column c, const GroundFlood::Place& place) {
      if ((c.x + c.y) % 2 == 0) lookAround(c, place.z);
    });
  }

  /** The best ones that the vehicle can stand at, apart from each other and from those to avoid.
   * \param unknown what a meter through it counts */
  std::vector<Frontier> chosen(const WayLeft& wayLeft, double unknown,
                               const std::vector<TPose2D>& avoid) const {
    std::vector<Frontier> chosen;
    for (const auto& [cost, straight, c] : best(wayLeft, unknown)) {
      const double x = m_ground.centerOf(c.x), y = m_ground.centerOf(c.y);
      const auto isNear = [&](const TPose2D& p) {
        return std::hypot(p.x - x, p.y - y) < kFrontiersApart;
      };
      if (chosen.size() == kMostFrontiers) break;
      if (std::any_of(avoid.begin(), avoid.end(), isNear)) continue;
      if (std::any_of(chosen.begin(), chosen.end(),
                      [&](const Frontier& other) { return isNear(other.pose); }))
        continue;
      const Frontier f{{x, y, headingAt(c)}, m_ground.centerOf(m_flood.at(c).z), cost};
      if (m_planner.check(f.pose, f.z) == PlanStatus::Found) chosen.push_back(f);
    }
    return chosen;
  }

 private:
  /** Unknown ground that is seen from a place. */
  struct View {
    Column from, unknown;
    double distance;  ///< meters
  };

  struct Place {
    double cost;
    double straight;  ///< meters from the vehicle by way of it to the goal, whatever is in the way
    Column column;
  };

  /** The least cost first. Ways over columns are as long anywhere between two diagonals: of such
   * places that which leads straight on comes first. */
  std::vector<Place> best(const WayLeft& wayLeft, double unknown) const {
    constexpr double kSame = 1e-3;  // m
    std::vector<Place> places;
    for (const View& view : m_views) {
      const double cost =
          m_flood.at(view.from).cost + unknown * view.distance + wayLeft.from(view.unknown);
      if (!std::isfinite(cost)) continue;
      if (places.empty() || !(places.back().column == view.from))
        places.push_back({cost, straightOver(view.from), view.from});
      places.back().cost = std::min(places.back().cost, cost);
    }
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
      const double costOfA = std::round(a.cost / kSame), costOfB = std::round(b.cost / kSame);
      return costOfA != costOfB ? costOfA < costOfB : a.straight < b.straight;
    });
    return places;
  }

  double straightOver(Column c) const {
    const double x = m_ground.centerOf(c.x), y = m_ground.centerOf(c.y);
    return std::hypot(x - m_from.x, y - m_from.y) + std::hypot(x - m_goal.x, y - m_goal.y);
  }

  bool isUnknown(Column c, int z) const {
    if (!m_ground.surfaces(c).empty()) return false;
    for (int k = z - 1; k <= z; ++k)
      if (m_ground.map().search(octomap::OcTreeKey(static_cast<octomap::key_type>(c.x),
                                                   static_cast<octomap::key_type>(c.y),
                                                   static_cast<octomap::key_type>(k))))
        return false;
    return true;
  }

  /** For the unknown of the goal's region, in each of eight directions. */
  void lookAround(Column c, int z) {
    const int far = static_cast<int>(std::lround(WayLeft::kSight / m_ground.voxelSize()));
    for (const Column& d : kNeighbors)
      for (int i = 1; i <= far; ++i) {
        const Column there{c.x + i * d.x, c.y + i * d.y};
        const double step = m_ground.voxelSize() * lengthOf(d);
        if (!m_flood.columns().contains(there)) {
          m_views.push_back({c, {there.x - d.x, there.y - d.y}, (i - 1) * step});
          break;
        }
        if (m_region.isObstacle(there)) break;
        if (i == 1 || !m_region.contains(there) || !isUnknown(there, z)) continue;
        m_views.push_back({c, there, i * step});
        break;
      }
  }

  double headingAt(Column c) const {
    constexpr double kOver = 2;  // m, the last part of the way
    const auto columns = std::lround(kOver / m_ground.voxelSize());
    Column before = c;
    for (long i = 0; i < columns; ++i) before = m_flood.at(before).from;
    return before == c ? 0 : std::atan2(c.y - before.y, c.x - before.x);
  }

  const SemanticPlanner& m_planner;
  const Ground& m_ground;
  const GroundFlood& m_flood;
  const GoalRegion& m_region;
  const TPose2D m_from, m_goal;
  std::vector<View> m_views;
};

}  // namespace

double Effort::doubt(double left) const {
  return expected > 0 ? std::sqrt(std::max(1.0, (spent + left) / expected)) : 1;
}

Exploration findFrontiers(const SemanticPlanner& planner, const TPose2D& from, double z,
                          const TPose2D& goal, const std::vector<TPose2D>& avoid,
                          const Effort& effort) {
  const double voxel = planner.ground().voxelSize();
  const int key = planner.ground().keyOf(z);
  const GroundFlood flood(planner, from, key, kFrontierRadius);
  const GoalRegion region(planner, flood.columns(), flood.reached(), from, z, goal);
  Exploration found;
  found.enclosed = region.isEnclosed();
  found.goalReached = region.isGoalReached();
  if (!region.isOpen()) found.goalArea = region.columns() * voxel * voxel;
  if (found.enclosed) return found;
  const FrontierSearch places(planner, flood, region, from, goal);
  const auto search = [&](double unknown) {
    const WayLeft wayLeft(planner.ground(), flood, region, goal, unknown);
    return places.chosen(wayLeft, unknown, avoid);
  };
  found.frontiers = search(kUnknownFactor);
  if (found.frontiers.empty()) return found;
  found.hoped = found.frontiers.front().cost;
  const double doubt = effort.doubt(found.hoped);
  if (doubt != 1) found.frontiers = search(kUnknownFactor * doubt);
  return found;
}

}  // namespace semantic_driving
