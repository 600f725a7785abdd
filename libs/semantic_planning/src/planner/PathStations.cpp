#include "PathStations.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace semantic_planning {

using mrpt::math::TPose2D;

namespace {

constexpr double kSpacing = 2.0;  // m along the path
/** Poses head towards others so many stations farther on: straight ways join them. */
constexpr std::array<std::size_t, 2> kStraightSteps = {2, 6};

/** Where along the path its stations are: at its ends, and not too far apart between. */
std::vector<std::size_t> pointsOf(const std::vector<PathPoint>& path, double spacing,
                                  bool withGearChanges) {
  std::vector<std::size_t> points{0};
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const bool changes = withGearChanges && path[i].forward != path[i + 1].forward;
    if (changes || path[i].arcLength >= path[points.back()].arcLength + spacing)
      points.push_back(i);
  }
  points.push_back(path.size() - 1);
  return points;
}

std::optional<GroundPose> poseAt(const PathPoint& p, const CollisionChecker& checker) {
  const auto pose = checker.place({p.x, p.y, p.heading}, p.z);
  return pose && checker.fit(*pose) == Fit::Free ? pose : std::nullopt;
}

/** The direction in which a path goes on, from its points up to so far before and after one. */
double directionAt(const std::vector<PathPoint>& path, std::size_t i, double reach) {
  constexpr double kLeast = 0.4;  // m
  std::size_t a = i, b = i;
  while (a > 0 && path[i].arcLength - path[a].arcLength < reach) --a;
  while (b + 1 < path.size() && path[b].arcLength - path[i].arcLength < reach) ++b;
  const double dx = path[b].x - path[a].x, dy = path[b].y - path[a].y;
  if (std::hypot(dx, dy) > kLeast) return std::atan2(dy, dx);
  return path[i].heading + (path[i].forward ? 0 : M_PI);
}

/** Arc lengths. */
std::vector<double> gearChangesOf(const std::vector<PathPoint>& path) {
  std::vector<double> changes;
  for (std::size_t i = 1; i < path.size(); ++i)
    if (path[i].forward != path[i - 1].forward) changes.push_back(path[i - 1].arcLength);
  return changes;
}

bool isNear(double arcLength, const std::vector<double>& places) {
  constexpr double kNear = 8;  // m
  return std::any_of(places.begin(), places.end(),
                     [&](double place) { return std::abs(place - arcLength) < kNear; });
}

/** Poses of a station. */
class StationPoses {
 public:
  StationPoses(const PathPoint& p, const CollisionChecker& checker)
      : m_point(p), m_checker(checker) {
    if (const auto own = poseAt(p, checker)) m_poses.push_back(*own);
  }

  /** \param sideways from the path's point, to the left of a direction, in which the pose heads but
   * for a turn */
  void add(double direction, double sideways, double turn) {
    const TPose2D pose(m_point.x - sideways * std::sin(direction),
                       m_point.y + sideways * std::cos(direction),
                       std::remainder(direction + turn, 2 * M_PI));
    const auto placed = m_checker.place(pose, m_point.z);
    if (!placed || m_checker.fit(*placed) != Fit::Free) return;
    if (m_checker.order().rank(m_checker.classAt(*placed)) == colored_graph::kForbidden) return;
    m_poses.push_back(*placed);
  }

  Station take() { return std::move(m_poses); }

 private:
  const PathPoint& m_point;
  const CollisionChecker& m_checker;
  Station m_poses;
};

/** The path's ends by themselves, and what f(poses, station) adds between. */
template <class F>
std::vector<Station> stationsAt(const std::vector<PathPoint>& path,
                                const std::vector<std::size_t>& points,
                                const CollisionChecker& checker, F f) {
  std::vector<Station> stations;
  for (std::size_t i = 0; i < points.size(); ++i) {
    StationPoses poses(path[points[i]], checker);
    if (i > 0 && i + 1 < points.size()) f(poses, i);
    stations.push_back(poses.take());
  }
  return stations;
}

}  // namespace

std::vector<Station> stationsOn(const std::vector<PathPoint>& path,
                                const CollisionChecker& checker) {
  const std::vector<std::size_t> points = pointsOf(path, kSpacing, true);
  const auto direction = [&](std::size_t from, std::size_t to) {
    const PathPoint &a = path[points[from]], &b = path[points[to]];
    return std::atan2(b.y - a.y, b.x - a.x);
  };
  return stationsAt(path, points, checker, [&](StationPoses& poses, std::size_t i) {
    const std::size_t last = points.size() - 1;
    for (const std::size_t steps : kStraightSteps) {
      poses.add(direction(i - std::min(i, steps), i), 0, 0);
      poses.add(direction(i, std::min(last, i + steps)), 0, 0);
    }
  });
}

std::vector<Station> stationsBeside(const std::vector<PathPoint>& path,
                                    const CollisionChecker& checker, const BesideOptions& options) {
  constexpr double kReach = 1.5;  // m
  const std::vector<std::size_t> points = pointsOf(path, kSpacing, false);
  const std::vector<double> changes = gearChangesOf(path);
  return stationsAt(path, points, checker, [&](StationPoses& poses, std::size_t i) {
    if (options.atGearChangesOnly && !isNear(path[points[i]].arcLength, changes)) return;
    const double direction = directionAt(path, points[i], kReach);
    for (const int side : {0, -1, 1})
      for (const int heading : {0, -1, 1})
        poses.add(direction, side * options.sideways, heading * options.turn);
    poses.add(direction, 0, M_PI);
  });
}

}  // namespace semantic_planning
