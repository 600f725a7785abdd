#include <semantic_driving/Explorer.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "ViewPlaces.h"

namespace semantic_driving {

using mrpt::math::TPose2D;
using namespace semantic_planning;
using namespace view_information;

namespace {

constexpr double kSetOut = 2;         // m that each view costs beside its way
constexpr double kClustersApart = 8;  // m
constexpr std::size_t kMostClusters = 8;
constexpr int kTile = 8;  // voxels, of the map's changes

/** The sweeps that were made, as long as nothing changed in their reach. */
class SweepMemory {
 public:
  /** \param reach voxels */
  explicit SweepMemory(int reach) : m_reach(reach + kTile) {}
  void changed(const semantic_octree::TileChange& change) {
    std::set<Column> middles;
    for (const auto& tile : change.tiles)
      middles.insert({tile[0] + kTile / 2, tile[1] + kTile / 2});
    for (auto sweep = m_sweeps.begin(); sweep != m_sweeps.end();) {
      const bool isStale = std::any_of(middles.begin(), middles.end(), [&](Column c) {
        const int x = c.x - sweep->first.x, y = c.y - sweep->first.y;
        return x * x + y * y < m_reach * m_reach;
      });
      sweep = isStale ? m_sweeps.erase(sweep) : std::next(sweep);
    }
  }
  /** \param sweep makes it anew */
  template <class Sweep>
  const SectorGains& of(Column c, Sweep sweep) {
    const auto found = m_sweeps.find(c);
    return found != m_sweeps.end() ? found->second : m_sweeps.emplace(c, sweep()).first->second;
  }

 private:
  int m_reach;
  std::map<Column, SectorGains> m_sweeps;
};

class RelevantViews : public ViewStrategy {
 public:
  RelevantViews(const SemanticPlanner& planner, semantic_octree::SemanticOcTree& map,
                const tree_abstraction::AbstractionWeights& weights, const ExploreOptions& options,
                bool learned)
      : m_planner(planner),
        m_ground(planner.ground()),
        m_options(options),
        m_question(weights, map.numClasses()),
        m_field(map, m_question),
        m_view(options.sensor, map.getResolution()),
        m_sweeps(m_view.reach() + static_cast<int>(kPriorsReach / map.getResolution())) {
    m_options.validate();
    if (learned)
      m_prior.reset(m_learned = new LearnedPrior(map, m_question));
    else
      m_prior = std::make_unique<UniformPrior>(m_question,
                                               BeamModel(map.numClasses(), map.filterParameters()));
  }

  std::optional<View> next(const TPose2D& from, double z) override;
  void done(const View& view) override;
  std::string conclusion() const override;
  Bounds growth() const override;
  double promise(const TPose2D& pose, double z) override;
  double left(Column c) override;

 private:
  static constexpr double kPriorsReach = 5;  // m: what changes there changes what is predicted

  struct Candidate {
    View view;
    Column column;
  };
  void follow(const TPose2D& from, double z);
  void learnTile(Column first, const GroundPoint& here);
  void learnThing(Column c, const GroundPoint& here);
  const Surface* surfaceOf(Column c) const;
  const Surface* groundOf(Column c, const GroundPoint& here) const;
  ClassId risingFrom(int ground, Column c) const;
  octomap::OcTreeKey sensorAt(Column column, double z) const;
  std::vector<Candidate> candidates(const GroundFlood& flood, double heading);
  void addBest(const ViewPlace& place, double heading, std::vector<Candidate>& candidates);
  std::vector<Candidate> centers(std::vector<Candidate> candidates) const;
  struct Account {
    double meters, promised, known;  ///< nats
  };
  void takeAccount(const TPose2D& from);
  Account lately() const;
  double shareLeft() const;
  const View& firstOf(const std::vector<Candidate>& stops, const GroundFlood& flood) const;

  const SemanticPlanner& m_planner;
  const Ground& m_ground;
  const ExploreOptions m_options;
  const Question m_question;
  GainField m_field;
  const ViewTemplate m_view;
  std::unique_ptr<UnknownPrior> m_prior;
  LearnedPrior* m_learned = nullptr;  ///< the prior, if it is one
  SweepMemory m_sweeps;
  DoneViews m_done;
  std::set<Column> m_toLearn;  ///< first columns of tiles whose ground may not be connected yet
  std::optional<Candidate> m_most;  ///< that promises most
  std::optional<View> m_chosen;
  TPose2D m_from;  ///< where it was chosen
  /** What the last choices promised, what the map told then, and the way to there. */
  std::deque<Account> m_accounts{{0, 0, 0}};
  double m_left = 0;  ///< nats that are promised within reach
};

double distanceOf(const View& a, const View& b) {
  return std::hypot(a.pose.x - b.pose.x, a.pose.y - b.pose.y);
}

double scoreOf(const View& view) { return view.promise / (view.way + kSetOut); }

/** Along whose middle one looks nearly. */
int sectorOf(double heading) {
  const double turned = (heading + M_PI) / (2 * M_PI) * ViewTemplate::kHeadings;
  return static_cast<int>(std::lround(turned - 0.5));
}

/** Field and prior follow the map. */
void RelevantViews::follow(const TPose2D& from, double z) {
  const semantic_octree::TileChange change = m_field.update();
  m_sweeps.changed(change);
  if (!m_learned) return;
  for (const auto& tile : change.tiles) m_toLearn.insert({tile[0], tile[1]});
  const auto here = m_ground.find(from.x, from.y, z);
  if (!here) return;
  for (const Column& first : std::exchange(m_toLearn, {})) learnTile(first, *here);
}

/** The lowest one that was seen; null: there is none. */
const Surface* RelevantViews::surfaceOf(Column c) const {
  for (const Surface& surface : m_ground.surfaces(c))
    if (!surface.filled && surface.drivable) return &surface;
  return nullptr;
}

/** Ground is what the vehicle's own ground goes on to, whether it may be driven on or not. */
const Surface* RelevantViews::groundOf(Column c, const GroundPoint& here) const {
  const Surface* surface = surfaceOf(c);
  return surface && m_ground.connected(here, {c, *surface}) ? surface : nullptr;
}

/** Learns a tile, and the columns around it: what stands there may rise from the tile's ground. */
void RelevantViews::learnTile(Column first, const GroundPoint& here) {
  for (int x = first.x - 1; x <= first.x + kTile; ++x)
    for (int y = first.y - 1; y <= first.y + kTile; ++y) {
      if (const Surface* ground = groundOf({x, y}, here)) {
        m_learned->learn(x, y, ground->z, ground->classId);
        continue;
      }
      if (surfaceOf({x, y})) m_toLearn.insert({x - x % kTile, y - y % kTile});
      learnThing({x, y}, here);
    }
}

/** Nobody sees the ground below a car or a wall: it counts as ground of its class, where it rises
 * from ground beside it. Roofs, and ground that is not connected yet, do not. */
void RelevantViews::learnThing(Column c, const GroundPoint& here) {
  if (!m_ground.isOccupied(c, 0, semantic_octree::kNumKeys)) return;
  for (const Column& d : kNeighbors) {
    const Surface* ground = groundOf({c.x + d.x, c.y + d.y}, here);
    const ClassId id = ground ? risingFrom(ground->z, c) : semantic_types::kNoClass;
    if (id != semantic_types::kNoClass) return m_learned->learn(c.x, c.y, ground->z, id);
  }
}

/** The class of what is higher than a step above ground of this height, and begins at most a step
 * above that. */
ClassId RelevantViews::risingFrom(int ground, Column c) const {
  constexpr double kTall = 2.6;  // m
  const int foot = ground + m_ground.step() + 1;
  const int top = ground + static_cast<int>(kTall / m_ground.voxelSize());
  if (!m_ground.isOccupied(c, foot, top)) return semantic_types::kNoClass;
  for (int z = foot; z >= ground - m_ground.step(); --z) {
    const auto voxel = m_ground.map().search(semantic_octree::octomapKey(c.x, c.y, z));
    if (voxel && m_ground.map().isNodeOccupied(voxel) && voxel.hasClassRecord())
      return m_ground.map().belief(voxel).ids[0];
  }
  return semantic_types::kNoClass;
}

/** \param z of the ground, m */
octomap::OcTreeKey RelevantViews::sensorAt(Column column, double z) const {
  return semantic_octree::octomapKey(column.x, column.y,
                                     m_ground.keyOf(z + m_options.sensorHeight));
}

/** The best of a place's headings, unless all were done. \param heading of the vehicle */
void RelevantViews::addBest(const ViewPlace& place, double heading,
                            std::vector<Candidate>& candidates) {
  const double width = m_view.shape().width, z = m_ground.centerOf(place.z);
  const bool isAllAround = width >= 360;
  const SectorGains& gains = m_sweeps.of(
      place.column, [&] { return m_field.sweep(m_view, *m_prior, sensorAt(place.column, z)); });
  std::optional<View> best;
  for (int s = 0; s < (isAllAround ? 1 : ViewTemplate::kHeadings); ++s) {
    const TPose2D pose{m_ground.centerOf(place.column.x), m_ground.centerOf(place.column.y),
                       isAllAround ? place.arrival.value_or(heading) : headingOf(s)};
    const double radius = m_planner.options().vehicle.turningRadius;
    const View view{pose, z, wayTo(place, heading, pose.phi, radius),
                    gainOfHeading(gains, s, width)};
    if (view.promise > 0 && (!best || scoreOf(view) > scoreOf(*best)) &&
        !m_done.has(pose, width * M_PI / 180) &&
        m_planner.check(pose, z) == semantic_planning::PlanStatus::Found)
      best = view;
  }
  if (best) candidates.push_back({*best, place.column});
}

std::vector<RelevantViews::Candidate> RelevantViews::candidates(const GroundFlood& flood,
                                                                double heading) {
  std::vector<Candidate> all;
  for (const ViewPlace& place : placesOf(flood, m_ground, m_options.area))
    if (headingToUnknown(m_ground, place)) addBest(place, heading, all);
  return all;
}

/** All best views that are apart from each other, best first. */
std::vector<RelevantViews::Candidate> RelevantViews::centers(
    std::vector<Candidate> candidates) const {
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.view.promise > b.view.promise; });
  std::vector<Candidate> centers;
  for (const Candidate& c : candidates) {
    const auto isNear = [&](const Candidate& o) {
      return distanceOf(o.view, c.view) < kClustersApart;
    };
    if (std::none_of(centers.begin(), centers.end(), isNear)) centers.push_back(c);
  }
  return centers;
}

/** Where the tour over the stops goes first. */
const View& RelevantViews::firstOf(const std::vector<Candidate>& stops,
                                   const GroundFlood& flood) const {
  std::vector<double> worth;
  std::vector<std::vector<double>> ways(stops.size() + 1, std::vector<double>(stops.size()));
  for (std::size_t i = 0; i < stops.size(); ++i) {
    worth.push_back(stops[i].view.promise);
    ways.back()[i] = stops[i].view.way + kSetOut;
    for (std::size_t j = 0; j < stops.size(); ++j)
      ways[i][j] =
          wayBetween(flood, m_ground.voxelSize(), stops[i].column, stops[j].column) + kSetOut;
  }
  return stops[firstStop(ways, worth)].view;
}

/** What the way since the last choice promised and brought, and the way that promised as much as is
 * left (m_left says how far back). */
void RelevantViews::takeAccount(const TPose2D& from) {
  Account now = m_accounts.back();
  if (m_chosen) {
    const double driven = std::hypot(from.x - m_from.x, from.y - m_from.y);
    now.meters += driven, now.promised += scoreOf(*m_chosen) * driven;
  }
  now.known = m_field.known();
  m_accounts.push_back(now);
  while (m_accounts.size() > 2 && now.promised - m_accounts[1].promised >= m_left)
    m_accounts.pop_front();
}

/** What is left is expected to bring as much as the same promise brought last, whatever a promise
 * is worth. */
RelevantViews::Account RelevantViews::lately() const {
  const Account &then = m_accounts.front(), &now = m_accounts.back();
  return {now.meters - then.meters, now.promised - then.promised, now.known - then.known};
}

double RelevantViews::shareLeft() const {
  const Account last = lately();
  const double left = std::max(0.0, last.known) * m_left / std::max(1e-9, last.promised);
  return left / std::max(1e-9, left + m_accounts.back().known);
}

std::optional<View> RelevantViews::next(const TPose2D& from, double z) {
  follow(from, z);
  const GroundFlood flood(m_planner, from, m_ground.keyOf(z), kFrontierRadius);
  const std::vector<Candidate> all = candidates(flood, from.phi);
  std::vector<Candidate> stops = centers(all);
  m_most = stops.empty() ? std::nullopt : std::optional(stops.front());
  m_left = 0;
  for (const Candidate& stop : stops) m_left += stop.view.promise;
  takeAccount(from);
  if (stops.empty() || (lately().promised >= m_left && shareLeft() < m_options.leftShare))
    return {};
  stops.resize(std::min(stops.size(), kMostClusters));
  const View& stop = firstOf(stops, flood);
  const View* best = &stop;
  for (const Candidate& c : all)
    if (distanceOf(c.view, stop) < kClustersApart && scoreOf(c.view) > scoreOf(*best))
      best = &c.view;
  m_chosen = *best, m_from = from;
  return m_chosen;
}

void RelevantViews::done(const View& view) { m_done.add(view.pose); }

Bounds RelevantViews::growth() const {
  if (!m_most) return {};
  return m_field.growth(m_view, *m_prior, sensorAt(m_most->column, m_most->view.z),
                        sectorOf(m_most->view.pose.phi));
}

double RelevantViews::promise(const TPose2D& pose, double z) {
  const auto from = sensorAt(m_ground.columnAt(pose.x, pose.y), z);
  return gainOfHeading(m_field.sweep(m_view, *m_prior, from), sectorOf(pose.phi),
                       m_view.shape().width);
}

std::string RelevantViews::conclusion() const {
  const Account last = lately();
  const Bounds tree = growth();
  char text[400];
  std::snprintf(
      text, sizeof text,
      "what is left within reach promises %.1f nat; the last %.0f m promised %.1f nat and "
      "brought %.1f: %.0f %% of the relevant information within reach is known; the best look that "
      "is left is expected to add %.1f to %.1f nat to the compressed tree's objective; places "
      "looked from: "
      "%zu",
      m_left, last.meters, last.promised, last.known, 100 * (1 - shareLeft()), tree.lower,
      tree.upper, m_done.size());
  return text;
}

/** What is left to see of a column: what may stand there and the first ground from above, if
 * unknown; what another look tells of known surfaces. */
double RelevantViews::left(Column c) {
  constexpr int kBelow = 10;  // voxels
  constexpr int kEdge = UnknownPatch::kEdge;
  if (!m_learned) return 0;
  const UnknownPatch patch = m_learned->lookAt(c.x / kEdge, c.y / kEdge);
  double sum = 0;
  bool isBelowFree = false;
  for (int z = patch.top; z >= patch.ground - kBelow; --z) {
    const auto known = m_field.at(semantic_octree::octomapKey(c.x, c.y, z));
    const Gain gain = known         ? *known
                      : isBelowFree ? patch.belowFree(c.x, c.y, z)
                                    : patch.at(c.x, c.y, z);
    const bool isFree = gain.pass >= 0.5F;
    if (!known || !isFree) sum += gain.gain;
    if (!isFree && z <= patch.ground) break;
    isBelowFree = known && isFree;
  }
  return sum;
}

}  // namespace

std::unique_ptr<ViewStrategy> relevantViews(const SemanticPlanner& planner,
                                            semantic_octree::SemanticOcTree& map,
                                            const tree_abstraction::AbstractionWeights& weights,
                                            const ExploreOptions& options, bool learned) {
  return std::make_unique<RelevantViews>(planner, map, weights, options, learned);
}

void ExploreOptions::describe(strict_files::OptionList& list) {
  list.add("budget", budget, "m", strict_files::above(0).orInfinite(),
           "way that it drives at most while it looks around; inf: no limit");
}

void ExploreOptions::validate() const { strict_files::checkOptions(*this, "ExploreOptions"); }

}  // namespace semantic_driving
