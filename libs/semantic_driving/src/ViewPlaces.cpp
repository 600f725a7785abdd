#include "ViewPlaces.h"

#include <semantic_driving/Explorer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace semantic_driving {

using mrpt::math::TPose2D;
using namespace semantic_planning;

namespace {

constexpr double kPlacesApart = 1.6;  // m
constexpr double kViewSight = 2;      // m

double directionOf(Column from, Column to) { return std::atan2(to.y - from.y, to.x - from.x); }

double turnBetween(double a, double b) { return std::abs(std::remainder(a - b, 2 * M_PI)); }

/** No surface is known there, and nothing stands there: downhill, what beams passed at the height
 * of the ground before is free. */
bool isUnknownColumn(const Ground& ground, Column c, int z) {
  return ground.surfaces(c).empty() && !ground.isOccupied(c, z - 1, z + 1);
}

}  // namespace

/** The way to a column, from its end to where the vehicle is. */
ViewPlace placeAt(const GroundFlood& flood, double voxelSize, Column c) {
  const auto far = static_cast<std::size_t>(std::lround(kViewSight / voxelSize));
  std::vector<Column> way{c};
  double columns = 0;
  for (Column before = flood.at(c).from; !(before == way.back()); before = flood.at(before).from) {
    columns += std::hypot(way.back().x - before.x, way.back().y - before.y);
    way.push_back(before);
  }
  ViewPlace place{c, flood.at(c).z, columns * voxelSize, {}, {}};
  if (way.size() == 1) return place;
  const std::size_t near = std::min(far, way.size() - 1);
  place.arrival = directionOf(way[near], way.front());
  place.departure = directionOf(way.back(), way[way.size() - 1 - near]);
  return place;
}

std::vector<ViewPlace> placesOf(const GroundFlood& flood, const Ground& ground,
                                const Eigen::AlignedBox2d& area) {
  const int apart = std::max(1, static_cast<int>(std::lround(kPlacesApart / ground.voxelSize())));
  std::vector<ViewPlace> places;
  flood.forEach([&](Column c, const GroundFlood::Place&) {
    if (c.x % apart != 0 || c.y % apart != 0) return;
    const Eigen::Vector2d at(ground.centerOf(c.x), ground.centerOf(c.y));
    if (area.isEmpty() || area.contains(at))
      places.push_back(placeAt(flood, ground.voxelSize(), c));
  });
  std::sort(places.begin(), places.end(), [](const ViewPlace& a, const ViewPlace& b) {
    return std::tie(a.length, a.column) < std::tie(b.length, b.column);
  });
  return places;
}

double wayTo(const ViewPlace& place, double from, double to, double turningRadius) {
  const double turn = place.arrival && place.departure
                          ? turnBetween(from, *place.departure) + turnBetween(*place.arrival, to)
                          : turnBetween(from, to);
  return place.length + turningRadius * turn;
}

std::optional<double> headingToUnknown(const Ground& ground, const ViewPlace& place) {
  const int far = static_cast<int>(std::lround(kViewSight / ground.voxelSize()));
  double x = 0, y = 0;
  bool isAny = false;
  for (const Column& d : kNeighbors) {
    int z = place.z;
    for (int i = 1; i <= far; ++i) {
      const Column there{place.column.x + i * d.x, place.column.y + i * d.y};
      if (const auto* surface = ground.near(there, z, ground.step())) {
        z = surface->z;
        continue;
      }
      const double length = std::hypot(d.x, d.y);
      if (isUnknownColumn(ground, there, z)) isAny = true, x += d.x / length, y += d.y / length;
      break;
    }
  }
  if (!isAny) return {};
  return std::hypot(x, y) > 0.1 ? std::atan2(y, x) : place.arrival.value_or(0);
}

bool DoneViews::has(const TPose2D& pose, double width) const {
  constexpr double kLike = 2.5;  // m
  return std::any_of(m_done.begin(), m_done.end(), [&](const TPose2D& done) {
    return std::hypot(done.x - pose.x, done.y - pose.y) < kLike &&
           std::cos(done.phi - pose.phi) >= std::cos(std::min(M_PI, width / 2));
  });
}

double wayBetween(const GroundFlood& flood, double voxelSize, Column a, Column b) {
  double columns = 0;
  while (!(a == b)) {
    Column& farther = flood.at(a).cost >= flood.at(b).cost ? a : b;
    const Column before = flood.at(farther).from;
    if (before == farther) break;
    columns += std::hypot(farther.x - before.x, farther.y - before.y);
    farther = before;
  }
  return columns * voxelSize;
}

std::size_t firstStop(const std::vector<std::vector<double>>& ways,
                      const std::vector<double>& worth) {
  const std::size_t n = worth.size(), all = std::size_t{1} << n;
  std::vector<double> left(all, 0);  // worth of the stops that are not in the set
  for (std::size_t set = 0; set < all; ++set)
    for (std::size_t i = 0; i < n; ++i)
      if (!(set >> i & 1)) left[set] += worth[i];
  // Least sum from here on, by what was visited and where the vehicle is.
  std::vector<std::vector<double>> least(all, std::vector<double>(n, 0));
  const auto next = [&](std::size_t set, std::size_t at) {
    std::pair<double, std::size_t> best{std::numeric_limits<double>::infinity(), 0};
    for (std::size_t j = 0; j < n; ++j)
      if (!(set >> j & 1))
        best = std::min(best, {ways[at][j] * left[set] + least[set | std::size_t{1} << j][j], j});
    return best;
  };
  for (std::size_t set = all - 1; set-- > 1;)
    for (std::size_t i = 0; i < n; ++i)
      if (set >> i & 1) least[set][i] = next(set, i).first;
  return next(0, n).second;
}

namespace {

class NearestFrontier : public ViewStrategy {
 public:
  NearestFrontier(const SemanticPlanner& planner, const ExploreOptions& options)
      : m_planner(planner), m_options(options) {
    m_options.validate();
  }

  std::optional<View> next(const TPose2D& from, double z) override {
    const Ground& ground = m_planner.ground();
    const GroundFlood flood(m_planner, from, ground.keyOf(z), kFrontierRadius);
    std::optional<View> nearest;
    for (const ViewPlace& place : placesOf(flood, ground, m_options.area)) {
      if (nearest && place.length >= nearest->way) break;
      const auto heading = headingToUnknown(ground, place);
      if (!heading || place.length < kSeenFromHere) continue;
      const TPose2D pose{ground.centerOf(place.column.x), ground.centerOf(place.column.y),
                         *heading};
      const double way =
          wayTo(place, from.phi, *heading, m_planner.options().vehicle.turningRadius);
      const double height = ground.centerOf(place.z);
      if ((!nearest || way < nearest->way) && !m_done.has(pose, 2 * M_PI) &&
          m_planner.check(pose, height) == semantic_planning::PlanStatus::Found)
        nearest = View{pose, height, way, 0};
    }
    m_isOver = !nearest;
    return nearest;
  }
  void done(const View& view) override { m_done.add(view.pose); }
  std::string conclusion() const override {
    return (m_isOver ? "no border of what is known is left within reach; places looked from: "
                     : "places looked from: ") +
           std::to_string(m_done.size());
  }

 private:
  static constexpr double kSeenFromHere = 0.8;  // m

  const SemanticPlanner& m_planner;
  const ExploreOptions m_options;
  DoneViews m_done;
  bool m_isOver = false;
};

}  // namespace

std::unique_ptr<ViewStrategy> nearestFrontier(const SemanticPlanner& planner,
                                              const ExploreOptions& options) {
  return std::make_unique<NearestFrontier>(planner, options);
}

}  // namespace semantic_driving
