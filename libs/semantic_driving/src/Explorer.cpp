#include <semantic_driving/Explorer.h>

#include <semantic_planning/planner/Slices.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "GoalRegion.h"
#include "GroundFlood.h"

namespace semantic_driving {

using mrpt::math::TPose2D;
using namespace semantic_planning;

void Explorer::moveTo(const TPose2D& pose, double z) {
  const TPose2D before = std::exchange(m_pose, pose).value_or(pose);
  const auto ground = m_planner.ground().find(pose.x, pose.y, z);
  const auto rank =
      ground ? m_planner.order().rank(ground->surface.classId) : colored_graph::kForbidden;
  const int worse = rank == colored_graph::kForbidden ? 0 : rank;
  m_effort.spent += std::hypot(pose.x - before.x, pose.y - before.y) * (worse + 1);
}

Exploration Explorer::places(const TPose2D& from, double z, const TPose2D& goal) {
  constexpr double kAround = 8;  // m
  const auto isThere = [&](const TPose2D& pose) {
    return std::hypot(pose.x - goal.x, pose.y - goal.y) < kAround;
  };
  Exploration found = findFrontiers(m_planner, from, z, goal, m_seen, m_effort);
  std::vector<Frontier>& frontiers = found.frontiers;
  m_wasThere = m_wasThere || isThere(from);
  if (m_wasThere && found.goalReached)
    frontiers.erase(std::remove_if(frontiers.begin(), frontiers.end(),
                                   [&](const Frontier& f) { return !isThere(f.pose); }),
                    frontiers.end());
  m_exhausted = m_wasThere && found.goalReached && frontiers.empty();
  if (m_effort.expected == 0 && !found.frontiers.empty())
    m_effort.expected = m_effort.spent + found.hoped;
  return found;
}

void Explorer::begin(const TPose2D& from, double z, const TPose2D& goal) {
  m_choice = {};
  m_choice.from = from;
  m_choice.z = z;
  m_choice.search = std::make_unique<Slices>([=] { m_choice.exploration = places(from, z, goal); });
}

bool Explorer::goOn(const std::function<DrivePath(DrivePath)>& joined, std::size_t& work) {
  Choice& c = m_choice;
  if (!c.search->goOn(work)) return false;
  for (; c.next < c.exploration.frontiers.size(); ++c.next) {
    const Frontier& f = c.exploration.frontiers[c.next];
    if (c.best && f.cost >= c.best->cost) break;
    if (!std::exchange(c.isPlanning, true)) m_planner.begin(c.from, f.pose, c.z, f.z);
    std::optional<PlanResult> plan = m_planner.goOn(work);
    if (!plan) return false;
    c.isPlanning = false;
    consider(f, std::move(*plan), joined);
  }
  return true;
}

void Explorer::consider(Frontier f, PlanResult plan,
                        const std::function<DrivePath(DrivePath)>& joined) {
  constexpr double kShortestWay = 0.5;  // m; nearer frontiers are seen from here
  if (!plan.found() || plan.length < kShortestWay) {
    m_choice.useless.push_back(f.pose);
    return;
  }
  DrivePath path = joined(DrivePath(plan.path));
  f.cost +=
      semantic_planning::MotionCost(m_planner.options().vehicle).of(path.points()) - path.length();
  if (m_choice.best && f.cost >= m_choice.best->cost) return;
  m_choice.best = f;
  m_choice.way = Way{std::move(plan), std::move(path)};
}

std::optional<Explorer::Way> Explorer::chosen(bool last) {
  Choice choice = std::exchange(m_choice, {});
  if (choice.best) choice.useless.push_back(choice.best->pose);
  // If there is no way to any, it may be for where the vehicle stands.
  if (choice.way)
    m_tried = std::move(choice.useless);
  else if (last)
    m_seen.insert(m_seen.end(), choice.useless.begin(), choice.useless.end());
  return std::move(choice.way);
}

void Explorer::end(bool drives) {
  if (drives) m_seen.insert(m_seen.end(), m_tried.begin(), m_tried.end());
  m_tried.clear();
}

namespace {

constexpr double kUnknownFactor = 2;   // what a meter through the unknown counts, of one on rank 0
constexpr double kFrontiersApart = 3;  // m
constexpr std::size_t kMostFrontiers = 6;
constexpr double kSight = 1.4;  // m, from a place to the unknown next to known ground

class FrontierSearch {
 public:
  FrontierSearch(const SemanticPlanner& planner, const GroundFlood& flood, const GoalRegion& region,
                 const TPose2D& from, const TPose2D& goal)
      : m_planner(planner), m_ground(planner.ground()), m_flood(flood), m_region(region) {
    flood.forEach([&](Column c, const GroundFlood::Place& place) {
      if ((c.x + c.y) % 2 != 0) return;
      const double x = m_ground.centerOf(c.x), y = m_ground.centerOf(c.y);
      const double onward = onwardFrom(c, place.z);
      if (std::isfinite(onward))
        m_places.push_back(
            {c, onward, std::hypot(x - from.x, y - from.y) + std::hypot(x - goal.x, y - goal.y)});
    });
  }

  /** The best ones that the vehicle can stand at, apart from each other and from those to avoid.
   * \param unknown what a meter through it counts */
  std::vector<Frontier> chosen(double unknown, const std::vector<TPose2D>& avoid) const {
    std::vector<Frontier> chosen;
    for (const auto& [c, onward, straight, cost] : best(unknown)) {
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
  struct Place {
    Column column;
    double onward;    ///< least meters through the unknown that is seen from there to the goal
    double straight;  ///< meters from the vehicle by way of it to the goal, whatever is in the way
    double cost = 0;
  };

  /** The least cost first. Ways over columns are as long anywhere between two diagonals: of such
   * places that which leads straight on comes first. */
  std::vector<Place> best(double unknown) const {
    constexpr double kSameCost = 1e-3;  // m
    std::vector<Place> places = m_places;
    for (Place& p : places) p.cost = m_flood.at(p.column).cost + unknown * p.onward;
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
      const double costOfA = std::round(a.cost / kSameCost),
                   costOfB = std::round(b.cost / kSameCost);
      return costOfA != costOfB ? costOfA < costOfB : a.straight < b.straight;
    });
    return places;
  }

  bool isUnknown(Column c, int z) const {
    if (!m_ground.surfaces(c).empty()) return false;
    for (int k = z - 1; k <= z; ++k)
      if (m_ground.map().search(semantic_octree::octomapKey(c.x, c.y, k))) return false;
    return true;
  }

  /** For the unknown of the goal's region, in each of eight directions; infinite: none is seen. */
  double onwardFrom(Column c, int z) const {
    Slices::count(1);
    const int far = static_cast<int>(std::lround(kSight / m_ground.voxelSize()));
    double least = std::numeric_limits<double>::infinity();
    for (const Column& d : kNeighbors)
      for (int i = 1; i <= far; ++i) {
        const Column there{c.x + i * d.x, c.y + i * d.y}, before{there.x - d.x, there.y - d.y};
        const double step = m_ground.voxelSize() * lengthOf(d);
        const bool isOutside = !m_flood.columns().contains(there);
        if (!isOutside && m_region.isObstacle(there)) break;
        if (!isOutside && (i == 1 || !m_region.contains(there) || !isUnknown(there, z))) continue;
        least = std::min(least, isOutside ? (i - 1) * step + m_region.way(before)
                                          : i * step + m_region.way(there));
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
  std::vector<Place> m_places;
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
  found.frontiers = places.chosen(kUnknownFactor, avoid);
  if (found.frontiers.empty()) return found;
  found.hoped = found.frontiers.front().cost;
  const double doubt = effort.doubt(found.hoped);
  if (doubt != 1) found.frontiers = places.chosen(kUnknownFactor * doubt, avoid);
  return found;
}

}  // namespace semantic_driving
