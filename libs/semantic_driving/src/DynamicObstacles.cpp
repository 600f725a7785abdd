#include <semantic_driving/DynamicObstacles.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>
#include <tuple>

namespace semantic_driving {

using Eigen::Vector2d;
using semantic_types::ClassId;

namespace {

constexpr double kApart = 0.4;  // m; points of one are no farther apart
constexpr std::size_t kLeastPoints = 3;
constexpr double kBody = 0.35;         // m: radius about the middle
constexpr double kPlaceNoise = 0.1;    // m: standard deviation of a middle that is seen
constexpr double kFirstSpeed = 1;      // m/s: likewise, of one who is seen for the first time
constexpr double kWalking = 0.6;       // m/s^2: likewise, the acceleration of one who walks
constexpr double kFastest = 2.5;       // m/s; a middle that is seen farther off is somebody else's
constexpr double kStandsBelow = 0.25;  // m/s
constexpr double kStays = 2;           // s at rest until one counts as one who stands
constexpr double kGone = 0.8;          // m from where one stood
constexpr double kForget = 1.5;        // s until one who is not seen any more is forgotten

/** By class id. */
std::vector<bool> classesIn(const std::string& names, const semantic_types::ClassTable& table) {
  std::vector<bool> chosen(static_cast<std::size_t>(table.size()) + 1);
  std::istringstream list(names);
  for (std::string name; std::getline(list, name, ',');) {
    name.erase(0, name.find_first_not_of(' '));
    name.erase(name.find_last_not_of(' ') + 1);
    const auto id = table.find(name);
    if (!id)
      throw std::invalid_argument("DynamicObstacleOptions: '" + name +
                                  "' is no class of the table");
    chosen[*id] = true;
  }
  return chosen;
}

}  // namespace

void DynamicObstacleOptions::describe(strict_files::OptionList& list) {
  list.add("classes", classes, "", "classes that move, with commas between; empty: none");
}

void DynamicObstacleOptions::validate() const {
  strict_files::checkOptions(*this, "DynamicObstacleOptions");
}

DynamicObstacleTracker::DynamicObstacleTracker(const DynamicObstacleOptions& options,
                                               const semantic_types::ClassTable& classes)
    : m_options(options), m_isMover(classesIn(options.classes, classes)) {
  m_options.validate();
}

void DynamicObstacleTracker::see(const semantic_types::LabeledCloud& cloud,
                                 const Eigen::Isometry3d& T_map_sensor) {
  if (cloud.classes.empty()) return;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (isOfMover(cloud, i))
      m_seen.push_back((T_map_sensor * cloud.points[i].cast<double>()).head<2>());
}

bool DynamicObstacleTracker::isOfMover(const semantic_types::LabeledCloud& cloud,
                                       std::size_t i) const {
  const ClassId id = cloud.classes[i];
  return id < m_isMover.size() && m_isMover[id] &&
         cloud.points[i].cast<double>().norm() <= m_options.radius;
}

semantic_types::LabeledCloud DynamicObstacleTracker::withoutPassing(
    const semantic_types::LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor) const {
  const auto isPassing = [&](std::size_t i) {
    if (!isOfMover(cloud, i)) return false;
    const Vector2d at = (T_map_sensor * cloud.points[i].cast<double>()).head<2>();
    return std::any_of(m_tracks.begin(), m_tracks.end(), [&](const Track& track) {
      return !track.stands && (track.place - at).norm() < kBody + kApart;
    });
  };
  if (cloud.classes.empty()) return cloud;
  const std::size_t row = cloud.probabilities.size() / std::max<std::size_t>(1, cloud.size());
  semantic_types::LabeledCloud rest;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (isPassing(i)) continue;
    rest.points.push_back(cloud.points[i]);
    rest.classes.push_back(cloud.classes[i]);
    const auto soft = cloud.probabilities.begin() + static_cast<std::ptrdiff_t>(i * row);
    rest.probabilities.insert(rest.probabilities.end(), soft,
                              soft + static_cast<std::ptrdiff_t>(row));
  }
  return rest;
}

void DynamicObstacleTracker::noteStanding(Track& track, double seconds) {
  if (track.velocity.norm() >= kStandsBelow) track.walkedAt = seconds;
  if (!track.stands && seconds - track.walkedAt >= kStays) track.stands = track.place;
  if (!track.stands || (track.place - *track.stands).norm() < kGone) return;
  m_left.push_back(*track.stands);
  track.stands.reset();
}

/** Middles of clusters: points that are near one another, seen from above. */
std::vector<Vector2d> DynamicObstacleTracker::middles() const {
  using Cell = std::pair<long, long>;
  const auto cellOf = [](const Vector2d& p) {
    return Cell(std::lround(p.x() / kApart), std::lround(p.y() / kApart));
  };
  std::map<Cell, std::vector<std::size_t>> left;
  for (std::size_t i = 0; i < m_seen.size(); ++i) left[cellOf(m_seen[i])].push_back(i);
  std::vector<Vector2d> middles;
  while (!left.empty()) {
    std::vector<std::size_t>& any = left.begin()->second;
    std::vector<std::size_t> cluster{any.back()};
    any.pop_back();
    const auto takeNear = [&](const Vector2d& p, std::vector<std::size_t>& cell) {
      const auto far = std::partition(cell.begin(), cell.end(), [&](std::size_t i) {
        return (m_seen[i] - p).norm() <= kApart;
      });
      cluster.insert(cluster.end(), cell.begin(), far);
      cell.erase(cell.begin(), far);
    };
    for (std::size_t next = 0; next < cluster.size(); ++next) {
      const Vector2d p = m_seen[cluster[next]];
      const auto [x, y] = cellOf(p);
      for (long dx = -1; dx <= 1; ++dx)
        for (long dy = -1; dy <= 1; ++dy)
          if (const auto cell = left.find({x + dx, y + dy}); cell != left.end())
            takeNear(p, cell->second);
    }
    while (!left.empty() && left.begin()->second.empty()) left.erase(left.begin());
    if (cluster.size() < kLeastPoints) continue;
    Vector2d sum = Vector2d::Zero();
    for (const std::size_t i : cluster) sum += m_seen[i];
    middles.push_back(sum / static_cast<double>(cluster.size()));
  }
  return middles;
}

void DynamicObstacleTracker::predict(Track& track, double seconds) {
  const double a = kWalking * seconds;
  track.place += seconds * track.velocity;
  track.pp += seconds * (2 * track.pv + seconds * track.vv) + a * a * seconds * seconds / 4;
  track.pv += seconds * track.vv + a * a * seconds / 2;
  track.vv += a * a;
}

void DynamicObstacleTracker::correct(Track& track, const Vector2d& middle) {
  const double sum = track.pp + kPlaceNoise * kPlaceNoise;
  const double gain = track.pp / sum, speedGain = track.pv / sum;
  const Vector2d off = middle - track.place;
  track.place += gain * off;
  track.velocity += speedGain * off;
  track.vv -= speedGain * track.pv;
  track.pp *= 1 - gain;
  track.pv *= 1 - gain;
}

void DynamicObstacleTracker::update(double seconds) {
  const std::vector<Vector2d> seen = middles();
  m_seen.clear();
  const double since = seconds - m_updatedAt;
  m_updatedAt = seconds;
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;  // distance, track, seen
  for (std::size_t t = 0; t < m_tracks.size(); ++t) {
    const double most = kApart + kFastest * (seconds - m_tracks[t].seenAt);
    predict(m_tracks[t], since);
    for (std::size_t i = 0; i < seen.size(); ++i)
      if (const double far = (seen[i] - m_tracks[t].place).norm(); far <= most)
        pairs.emplace_back(far, t, i);
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<bool> taken(seen.size());
  for (const auto& [far, t, i] : pairs) {
    if (taken[i] || m_tracks[t].seenAt == seconds) continue;
    taken[i] = true;
    m_tracks[t].seenAt = seconds;
    correct(m_tracks[t], seen[i]);
  }
  m_tracks.erase(
      std::remove_if(m_tracks.begin(), m_tracks.end(),
                     [&](const Track& t) { return std::abs(seconds - t.seenAt) > kForget; }),
      m_tracks.end());
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (!taken[i])
      m_tracks.push_back({seen[i],
                          Vector2d::Zero(),
                          kPlaceNoise * kPlaceNoise,
                          0,
                          kFirstSpeed * kFirstSpeed,
                          seconds,
                          seconds,
                          {}});
  for (Track& track : m_tracks) noteStanding(track, seconds);
}

DynamicObstacles DynamicObstacleTracker::at(double seconds) const {
  DynamicObstacles movers;
  for (Track track : m_tracks) {
    predict(track, std::max(0.0, seconds - m_updatedAt));
    const bool stands = track.velocity.norm() < kStandsBelow;
    const Vector2d velocity = stands ? Vector2d::Zero() : track.velocity;
    movers.push_back({track.place, velocity, kBody, std::sqrt(track.vv)});
  }
  return movers;
}

}  // namespace semantic_driving
