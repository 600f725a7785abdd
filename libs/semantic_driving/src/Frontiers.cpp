#include <semantic_driving/Frontiers.h>

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

class FrontierSearch {
 public:
  FrontierSearch(const SemanticPlanner& planner, const GroundFlood& flood, const GoalRegion& region,
                 const WayLeft& wayLeft, const FrontierOptions& options)
      : m_planner(planner),
        m_ground(planner.ground()),
        m_flood(flood),
        m_region(region),
        m_wayLeft(wayLeft),
        m_options(options) {}

  /** The best ones that the vehicle can stand at, apart from each other and from those to avoid. */
  std::vector<Frontier> chosen(const std::vector<TPose2D>& avoid) const {
    std::vector<Frontier> chosen;
    for (const Frontier& f : all()) {
      const auto isNear = [&](const TPose2D& p) {
        return std::hypot(p.x - f.pose.x, p.y - f.pose.y) < m_options.apart;
      };
      if (chosen.size() == m_options.most) break;
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
    const int far = static_cast<int>(std::lround(m_options.sight / m_ground.voxelSize()));
    for (const Column& d : kNeighbors)
      for (int i = 1; i <= far; ++i) {
        const Column there{c.x + i * d.x, c.y + i * d.y};
        const double step = m_options.unknownFactor * m_ground.voxelSize() * std::hypot(d.x, d.y);
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
    const auto columns = std::lround(m_options.headingOver / m_ground.voxelSize());
    Column before = c;
    for (long i = 0; i < columns; ++i) before = m_flood.at(before).from;
    return before == c ? 0 : std::atan2(c.y - before.y, c.x - before.x);
  }

  const SemanticPlanner& m_planner;
  const Ground& m_ground;
  const GroundFlood& m_flood;
  const GoalRegion& m_region;
  const WayLeft& m_wayLeft;
  const FrontierOptions& m_options;
};

}  // namespace

void FrontierOptions::describe(strict_files::OptionList& list) {
  using strict_files::above;
  using strict_files::atLeast;
  list.add("radius", radius, "m", above(0), "how far places are looked for");
  list.add("unknown_factor", unknownFactor, "", atLeast(0),
           "what a meter through the unknown counts against one on the best class");
  list.add("turning", turning, "m", atLeast(0),
           "what turning around at the start counts, on the best class");
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

double Effort::doubt(double left) const {
  return expected > 0 ? std::sqrt(std::max(1.0, (spent + left) / expected)) : 1;
}

Exploration findFrontiers(const SemanticPlanner& planner, const TPose2D& from, double z,
                          const TPose2D& goal, const std::vector<TPose2D>& avoid,
                          const Effort& effort, const FrontierOptions& options) {
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
  const auto search = [&](const FrontierOptions& wanted) {
    const WayLeft wayLeft(planner, flood, region, goal, wanted);
    return FrontierSearch(planner, flood, region, wayLeft, wanted).chosen(avoid);
  };
  found.frontiers = search(options);
  if (found.frontiers.empty()) return found;
  found.hoped = found.frontiers.front().cost;
  const double doubt = effort.doubt(found.hoped);
  if (doubt == 1) return found;
  FrontierOptions wiser = options;
  wiser.unknownFactor *= doubt;
  found.frontiers = search(wiser);
  return found;
}

}  // namespace semantic_driving
