#include <semantic_driving/Explorer.h>

#include <algorithm>
#include <cmath>
#include <limits>

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
                 const WayLeft& wayLeft, double unknownFactor)
      : m_planner(planner),
        m_ground(planner.ground()),
        m_flood(flood),
        m_region(region),
        m_wayLeft(wayLeft),
        m_unknownFactor(unknownFactor) {}

  /** The best ones that the vehicle can stand at, apart from each other and from those to avoid. */
  std::vector<Frontier> chosen(const std::vector<TPose2D>& avoid) const {
    std::vector<Frontier> chosen;
    for (const Frontier& f : all()) {
      const auto isNear = [&](const TPose2D& p) {
        return std::hypot(p.x - f.pose.x, p.y - f.pose.y) < kFrontiersApart;
      };
      if (chosen.size() == kMostFrontiers) break;
      if (std::any_of(avoid.begin(), avoid.end(), isNear)) continue;
      if (std::any_of(chosen.begin(), chosen.end(),
                      [&](const Frontier& c) { return isNear(c.pose); }))
        continue;
      if (m_planner.check(f.pose, f.z) == PlanStatus::Found) chosen.push_back(f);
    }
    return chosen;
  }

 private:
  std::vector<Frontier> all() const {
    std::vector<Frontier> found;
    m_flood.forEach([&](Column c, const GroundFlood::Place& place) {
      if ((c.x + c.y) % 2 != 0) return;
      const double left = leftFrom(c, place.z);
      if (!std::isfinite(left)) return;
      found.push_back({{m_ground.centerOf(c.x), m_ground.centerOf(c.y), headingAt(c)},
                       m_ground.centerOf(place.z),
                       place.cost + left});
    });
    std::sort(found.begin(), found.end(),
              [](const Frontier& a, const Frontier& b) { return a.cost < b.cost; });
    return found;
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

  /** The least way on to the goal by the unknown of its region that is seen from there, in one of
   * eight directions; infinite: there is none. */
  double leftFrom(Column c, int z) const {
    double least = std::numeric_limits<double>::infinity();
    const int far = static_cast<int>(std::lround(WayLeft::kSight / m_ground.voxelSize()));
    for (const Column& d : kNeighbors)
      for (int i = 1; i <= far; ++i) {
        const Column there{c.x + i * d.x, c.y + i * d.y};
        const double step = m_unknownFactor * m_ground.voxelSize() * std::hypot(d.x, d.y);
        if (!m_flood.square().contains(there)) {
          least = std::min(least, (i - 1) * step + m_wayLeft.from({there.x - d.x, there.y - d.y}));
          break;
        }
        if (m_region.isObstacle(there)) break;
        if (i == 1 || !m_region.contains(there) || !isUnknown(there, z)) continue;
        least = std::min(least, i * step + m_wayLeft.from(there));
        break;
      }
    return least;
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
  const WayLeft& m_wayLeft;
  double m_unknownFactor;
};

}  // namespace

double Effort::doubt(double left) const {
  return expected > 0 ? std::sqrt(std::max(1.0, (spent + left) / expected)) : 1;
}

Exploration findFrontiers(const SemanticPlanner& planner, const TPose2D& from, double z,
                          const TPose2D& goal, const std::vector<TPose2D>& avoid,
                          const Effort& effort, double radius) {
  const double voxel = planner.ground().voxelSize();
  const int key = planner.ground().keyOf(z);
  const GroundFlood flood(planner, from, key, radius);
  const GoalRegion region(planner, flood.square(), flood.reached(), from, z, goal);
  Exploration found;
  found.enclosed = region.isEnclosed();
  found.goalReached = region.isGoalReached();
  if (!region.isOpen()) found.goalArea = region.columns() * voxel * voxel;
  if (found.enclosed) return found;
  const auto search = [&](double unknownFactor) {
    const WayLeft wayLeft(planner, flood, region, goal, unknownFactor);
    return FrontierSearch(planner, flood, region, wayLeft, unknownFactor).chosen(avoid);
  };
  found.frontiers = search(kUnknownFactor);
  if (found.frontiers.empty()) return found;
  found.hoped = found.frontiers.front().cost;
  const double doubt = effort.doubt(found.hoped);
  if (doubt != 1) found.frontiers = search(kUnknownFactor * doubt);
  return found;
}

}  // namespace semantic_driving
