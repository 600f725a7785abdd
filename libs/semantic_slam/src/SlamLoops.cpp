#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "SlamEngine.h"

namespace semantic_slam {
namespace {

/** Standard deviations of what loops say: less certain than their points, for they may be wrong. */
constexpr double kLoopMeters = 0.03, kLoopAngle = 0.1 * kDegree;
/** Edges of cubes at a loop's other end, as multiples of the finest. */
constexpr double kCoarsest = 8;
/** Looks for loops are so many keyframe distances apart. */
constexpr double kLookEvery = 2;
/** Window of a search, in cells of the grid: at first, per meter since the last loop (m), and at
 * most around where the robot seems to be. Only if it is nowhere there, all of the window is
 * searched, each time that the robot went this share of it. That takes long, and more is alike in
 * it. */
constexpr double kWindow = 10, kWindowDrift = 0.03, kNearWindow = 100, kLookShare = 1.0 / 8;
constexpr double kAngle = 8 * kDegree, kAngleDrift = 0.3 * kDegree, kLargestAngle = 45 * kDegree;
/** Without registration the robot may be off as after so many times the way more. */
constexpr double kLostMore = 9;
constexpr std::size_t kMostPlaces = 3;
/** Cells of the grid: least window of a search at the end, and how far off a find has to be for a
 * warning. */
constexpr double kLeftWindow = 20, kApart = 3;
/** Least share of the highest score where poses are right already, by the first window. Where they
 * would move it is one of the stretch's own score, for people and noise fit nowhere. What goes on
 * into a corridor that nobody saw fits wrong places up to .75 of that. */
constexpr double kLeastScore = 0.5, kMovingScore = 0.8;
/** Two loops agree up to so much, more for each meter between; farther apart they are not compared.
 */
constexpr double kAgree = 0.2, kAgreeWay = 0.03, kAgreeAngle = 2 * kDegree,
                 kAgreeAngleWay = 0.2 * kDegree,
                 kCompared = 20;  // of the latter, keyframe distances
/** An edge that is off by less, m and radians, can wait for the next optimization. */
constexpr double kNear = 0.05, kNearAngle = 0.5 * kDegree;
/** Squared error of a step between keyframes that loops may leave. */
constexpr double kTorn = 100, kTornMore = 1.5;

}  // namespace

void SlamEngine::setReference(const semantic_octree::SemanticOcTree& map) {
  if (!m_keyframes.empty()) throw std::logic_error("Slam: a reference, but scans were added");
  m_reference = Reference(map, m_options.useClasses);
  m_mostOfReference = informationOf(std::max(kLoopMeters, m_reference.deviation()), kLoopAngle);
}

auto SlamEngine::pointsOf(std::size_t first, std::size_t last, std::size_t frame) const -> Seen {
  Seen all{{}, m_keyframes[frame].seen.T_odometry_robot};
  for (std::size_t k = first; k <= last; ++k) {
    const Eigen::Isometry3f T = (m_poses[frame].inverse() * m_poses[k]).cast<float>();
    const LabeledCloud cloud = seenAt(k).cloud;
    for (std::size_t i = 0; i < cloud.size(); ++i) all.cloud.points.push_back(T * cloud.points[i]);
    all.cloud.classes.insert(all.cloud.classes.end(), cloud.classes.begin(), cloud.classes.end());
  }
  return all;
}

std::vector<double> SlamEngine::waysFrom(std::size_t keyframe) const {
  const std::size_t map = m_keyframes.size();
  std::vector<double> ways(map + 1, std::numeric_limits<double>::infinity());
  ways[keyframe] = 0;
  bool isShorter = true;
  const auto relax = [&](const PoseEdge& edge) {
    double &a = ways[std::min(edge.a, map)], &b = ways[edge.b];
    double step = 0;
    if (!edge.isDoubtful) {
      const Keyframe &from = m_keyframes[edge.a], &to = m_keyframes[edge.b];
      step = to.way - from.way + kLostMore * (to.lostWay - from.lostWay);
    }
    isShorter |= a + step < b || b + step < a;
    a = std::min(a, b + step);
    b = std::min(b, a + step);
  };
  while (isShorter) {
    isShorter = false;
    std::for_each(m_edges.rbegin(), m_edges.rend(), relax);
    std::for_each(m_edges.begin(), m_edges.end(), relax);
  }
  return ways;
}

std::vector<std::size_t> SlamEngine::placesOf(
    std::size_t keyframe, const std::function<double(std::size_t)>& farthest) const {
  const double way = m_keyframes[keyframe].way;
  const auto distance = [&](std::size_t k) {
    return (m_poses[k].translation() - m_poses[keyframe].translation()).norm();
  };
  std::vector<std::size_t> places;
  std::size_t previous = 0;
  for (std::size_t k = 0; k < keyframe && way - m_keyframes[k].way >= m_scale.loopLength; ++k) {
    if (distance(k) > farthest(k)) continue;
    if (places.empty() || k - previous > keyframesBeside())
      places.push_back(k);
    else if (distance(k) < distance(places.back()))
      places.back() = k;
    previous = k;
  }
  std::stable_sort(places.begin(), places.end(),
                   [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
  if (places.size() > kMostPlaces) places.resize(kMostPlaces);
  return places;
}

bool SlamEngine::closeLoops() {
  const std::size_t newest = m_keyframes.size() - 1;
  const double way = m_keyframes[newest].way;
  if (way < m_lastLook + kLookEvery * m_scale.keyframeDistance) return false;
  m_lastLook = way;
  const auto ways = waysFrom(newest);
  const auto places =
      placesOf(newest, [&](std::size_t k) { return 1.4 * windowAfter(ways[k]).radius; });
  if (places.empty()) return false;
  const Seen stretch = pointsOf(newest - std::min(newest, keyframesBeside()), newest, newest);
  bool moved = false;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t place = places[i], share = m_looks / (places.size() - i);
    std::size_t looks = share;
    const auto edge = edgeTo(place, stretch, ways[place], looks);
    m_looks -= share - looks;
    if (edge) {
      const std::size_t before = m_edges.size();
      moved |= confirm(m_pendingLoops, *edge);
      if (m_edges.size() == before) continue;
      m_report.loops += m_edges.size() - before;
      m_report.open = 0;
    }
  }
  return moved;
}

double SlamEngine::ownScore() const {
  const std::size_t newest = m_keyframes.size() - 1;
  PlanePoints some, others;
  for (std::size_t k = newest - std::min(newest, keyframesBeside()); k <= newest; ++k)
    for (const Eigen::Vector2d& p : upright(moved(seenAt(k).cloud, m_poses[k])))
      (k % 2 == newest % 2 ? some : others).push_back(p);
  const PlaneSearch::Window here{0, 0};
  const auto own = PlaneSearch(others, m_scale.gridCell).find(some, {0, 0, 0}, here, 0);
  return own ? own->score : 1;
}

PlaneSearch::Window SlamEngine::windowAfter(double way) const {
  return {kWindow * m_scale.gridCell + kWindowDrift * way,
          std::min(kAngle + kAngleDrift * way, kLargestAngle)};
}

auto SlamEngine::lookAround(std::size_t place, std::size_t keyframe, const Seen& stretch,
                            const PlaneSearch::Window& window, std::size_t& looks) const
    -> std::optional<Look> {
  const double wayNow = m_keyframes[keyframe].way;
  const Pose T_guess = m_poses[place].inverse() * m_poses[keyframe];
  // Seen from above, height and tilt aside.
  const Eigen::Vector3d guess = flatOf(T_guess);
  const Pose T_turn(Eigen::AngleAxisd(guess[2], Eigen::Vector3d::UnitZ()));
  Seen level = stretch;
  const Eigen::Matrix3f T_level = (T_turn.linear().transpose() * T_guess.linear()).cast<float>();
  for (Eigen::Vector3f& p : level.cloud.points) p = T_level * p;
  // Wherever the robot is in the window, all that it sees was seen from these keyframes.
  const auto reach = static_cast<std::size_t>(m_scale.submapKeyframes / 2 +
                                              window.radius / m_scale.keyframeDistance);
  const bool isBefore = !m_tears.empty() && place < m_tears.back();
  const std::size_t end = isBefore ? std::min(m_tears.back(), keyframe) : keyframe;
  const std::size_t first = place - std::min(place, reach);
  std::size_t last = place;
  while (last < place + reach && last + 1 < end &&
         wayNow - m_keyframes[last + 1].way > m_scale.loopLength / 2)
    ++last;
  const auto found = PlaneSearch(upright(pointsOf(first, last, place).cloud), m_scale.gridCell)
                         .find(upright(level.cloud), guess, window, kLeastScore, looks);
  if (!found) return std::nullopt;
  Pose T_found = poseOfFlat(found->pose, T_guess(2, 3));
  T_found.rotate(T_turn.linear().transpose() * T_guess.linear());
  return Look{m_poses[place] * T_found,
              (found->pose - guess).head<2>().norm(),
              found->score,
              found->isAlone,
              first,
              last};
}

std::optional<PoseEdge> SlamEngine::edgeTo(std::size_t place, const Seen& stretch, double way,
                                           std::size_t& looks) {
  const std::size_t newest = m_keyframes.size() - 1;
  const double wayNow = m_keyframes[newest].way;
  const PlaneSearch::Window whole = windowAfter(way);
  const double near = kNearWindow * m_scale.gridCell;
  auto found =
      lookAround(place, newest, stretch, {std::min(whole.radius, near), whole.angle}, looks);
  if (!found && whole.radius > near &&
      (wayNow == m_lastWholeLook || wayNow > m_lastWholeLook + kLookShare * whole.radius)) {
    m_lastWholeLook = wayNow;
    found = lookAround(place, newest, stretch, whole, looks);
  }
  if (!found) return std::nullopt;
  if (found->off > kWindow * m_scale.gridCell && found->score < kMovingScore * ownScore())
    return std::nullopt;
  if (!found->isAlone) {
    m_report.open += way > m_scale.loopLength;  // no loop leads there yet
    return std::nullopt;
  }
  return edgeOf(*found, stretch, newest);
}

std::optional<PoseEdge> SlamEngine::edgeOf(const Look& look, const Seen& stretch,
                                           std::size_t keyframe) const {
  return edgeNear(look.T_map, look.first, look.last, keyframesBeside(), stretch, keyframe,
                  m_scale.leastMatched);
}

bool SlamEngine::closeLeftLoops() {
  const double least = kLeftWindow * m_scale.gridCell, most = kNearWindow * m_scale.gridCell;
  std::vector<PoseEdge> looks;
  bool moved = false;
  m_pendingLoops.clear();
  m_lastLook = 0;
  for (std::size_t k = m_looked; k < m_keyframes.size(); ++k) {
    if (m_keyframes[k].way < m_lastLook + kLookEvery * m_scale.keyframeDistance) continue;
    m_lastLook = m_keyframes[k].way;
    const auto ways = waysFrom(k);
    const auto windowOf = [&](std::size_t place) {
      return std::clamp(windowAfter(ways[place]).radius, least, most);
    };
    for (const std::size_t place :
         placesOf(k, [&](std::size_t at) { return 1.4 * windowOf(at); })) {
      if (isClosed(place, k)) continue;
      const Seen stretch = pointsOf(k - std::min(k, keyframesBeside() / 2),
                                    std::min(k + keyframesBeside() / 2, m_keyframes.size() - 1), k);
      std::size_t budget = kLiveLooks / kMostPlaces;
      const auto edgeWithin = [&](double radius) {
        const auto look = lookAround(place, k, stretch, {radius, kAngle}, budget);
        return look && look->isAlone ? edgeOf(*look, stretch, k) : std::nullopt;
      };
      auto edge = edgeWithin(least);
      if (!edge && windowOf(place) > least) edge = edgeWithin(windowOf(place));
      if (!edge) continue;
      looks.push_back(*edge);
      const std::size_t before = m_edges.size();
      moved |= confirm(m_pendingLoops, *edge);
      m_report.loops += m_edges.size() - before;
    }
  }
  m_report.apart = apartBy(looks);
  return moved;
}

bool SlamEngine::isClosed(std::size_t place, std::size_t keyframe) const {
  const auto areBeside = [this](std::size_t a, std::size_t b) {
    return std::max(a, b) - std::min(a, b) <= keyframesBeside();
  };
  return std::any_of(m_edges.begin(), m_edges.end(), [&](const PoseEdge& e) {
    return e.isDoubtful && areBeside(e.a, place) && areBeside(e.b, keyframe);
  });
}

double SlamEngine::apartBy(const std::vector<PoseEdge>& looks) const {
  double most = 0, second = 0;  // one alone may be wrong
  for (const PoseEdge& look : looks) {
    const double off = (T_map_b(look).inverse() * m_poses[look.b]).translation().norm();
    second = std::max(second, std::min(off, most));
    most = std::max(most, off);
  }
  return second > kApart * m_scale.gridCell ? second : 0;
}

std::optional<PoseEdge> SlamEngine::edgeNear(const Pose& T_map_guess, std::size_t first,
                                             std::size_t last, std::size_t beside,
                                             const Seen& stretch, std::size_t keyframe,
                                             double leastMatched) const {
  const auto distance = [&](std::size_t k) {
    return (m_poses[k].translation() - T_map_guess.translation()).norm();
  };
  std::size_t place = first;
  for (std::size_t k = first; k <= last; ++k)
    if (distance(k) < distance(place)) place = k;
  const Seen then = pointsOf(std::max(first, place - std::min(place, beside)),
                             std::min(last, place + beside), place);
  std::vector<double> cells;
  const double finest = m_scale.cells.back();
  for (double size = (m_scale.isPlanar ? m_scale.cells.front() / finest : kCoarsest) * finest;
       size >= finest; size /= 2)
    cells.push_back(size);
  const Registration r = match(submapsOf(then.cloud, cells), stretch,
                               m_poses[place].inverse() * T_map_guess, Matrix6::Zero());
  if (r.coveredShare < kCovered || r.matchedShare < leastMatched) return std::nullopt;
  return PoseEdge{place, keyframe, r.T_submap_scan,
                  bothErrors(informationOf(kLoopMeters, kLoopAngle), r, keyframe), true};
}

Eigen::Isometry3d SlamEngine::T_map_b(const PoseEdge& edge) const {
  return edge.a == PoseEdge::kMap ? edge.T_a_b : m_poses[edge.a] * edge.T_a_b;
}

bool SlamEngine::agree(const PoseEdge& before, const PoseEdge& edge) const {
  if (before.b == edge.b) return false;
  const double way = std::abs(m_keyframes[edge.b].way - m_keyframes[before.b].way);
  const Pose T_step = m_poses[before.b].inverse() * m_poses[edge.b];
  const Pose T_map_by_before = T_map_b(before) * T_step;
  const Vector6 off = vectorOf(T_map_by_before.inverse() * T_map_b(edge));
  return off.head<3>().norm() < kAgree + kAgreeWay * way &&
         off.tail<3>().norm() < kAgreeAngle + kAgreeAngleWay * way;
}

bool SlamEngine::confirm(std::vector<PoseEdge>& pending, const PoseEdge& edge) {
  const double oldest = m_keyframes[edge.b].way - kCompared * m_scale.keyframeDistance;
  const std::size_t numEdges = m_edges.size();
  std::vector<PoseEdge> left;
  for (const PoseEdge& before : pending)
    if (m_keyframes[before.b].way >= oldest)
      (agree(before, edge) ? m_edges : left).push_back(before);
  const bool isConfirmed = m_edges.size() > numEdges;
  (isConfirmed ? m_edges : left).push_back(edge);
  pending = std::move(left);
  return isConfirmed && optimizeWith(m_edges.size() - numEdges);
}

double SlamEngine::worstStep() const {
  double worst = 0;
  for (const PoseEdge& edge : m_edges)
    if (!edge.isDoubtful) worst = std::max(worst, squaredError(edge, m_poses));
  return worst;
}

bool SlamEngine::optimizeWith(std::size_t added) {
  bool areNear = true;
  for (std::size_t e = m_edges.size() - added; e < m_edges.size(); ++e) {
    const PoseEdge& edge = m_edges[e];
    const Vector6 off = vectorOf(T_map_b(edge).inverse() * m_poses[edge.b]);
    areNear &= off.head<3>().norm() < kNear && off.tail<3>().norm() < kNearAngle;
  }
  m_isOptimized = false;
  if (areNear) return false;
  const auto before = m_poses;
  const double worst = worstStep();
  optimizePoses();
  if (worstStep() <= std::max(kTorn, kTornMore * worst)) return true;
  m_poses = before;
  m_edges.resize(m_edges.size() - added);
  m_report.undone += added;
  return false;
}

void SlamEngine::optimizePoses() {
  optimize(m_poses, m_edges);
  for (std::size_t k = 0; k < m_poses.size(); ++k)
    m_poses[k] = levelled(m_poses[k], m_keyframes[k].seen.T_odometry_robot);
  m_isOptimized = true;
}

bool SlamEngine::finish() {
  settleDoubt(1);
  bool moved = joinParts() || !m_isOptimized;
  if (!m_isOptimized) optimizePoses();
  moved |= closeLeftLoops() || !m_isOptimized;
  if (!m_isOptimized) optimizePoses();
  return moved;
}

std::optional<Registration> SlamEngine::findInReference(const Seen& seen, const Pose& T_map_guess) {
  if (!m_reference.exists()) return std::nullopt;
  const auto& submaps = m_reference.submapsFor(seen.cloud, T_map_guess, m_scale.isPlanar);
  const Registration r = match(submaps, seen, T_map_guess, Matrix6::Zero());
  const bool isFound = r.coveredShare >= kCovered && r.matchedShare >= 0.6;
  return isFound ? std::make_optional(r) : std::nullopt;
}

PoseEdge SlamEngine::lookOf(std::size_t keyframe, const Registration& found) const {
  return {PoseEdge::kMap, keyframe, found.T_submap_scan,
          bothErrors(m_mostOfReference, found, keyframe), true};
}

Matrix6 SlamEngine::bothErrors(const Matrix6& most, const Registration& found,
                               std::size_t keyframe) const {
  const Matrix6 own =
      0.5 * found.information + levelOf(m_keyframes[keyframe].seen.T_odometry_robot);
  return most * (most + own).inverse() * own;
}

bool SlamEngine::followReference() {
  const std::size_t newest = m_keyframes.size() - 1;
  constexpr double kEvery = 3;  // m
  if (m_keyframes[newest].way < m_lastReferenced + kEvery) return false;
  m_lastReferenced = m_keyframes[newest].way;
  const auto found = findInReference(seenAt(newest), m_poses[newest]);
  if (!found) return false;
  const std::size_t before = m_edges.size();
  const bool moved = confirm(m_pendingReferences, lookOf(newest, *found));
  m_report.referenced += m_edges.size() - before;
  return moved;
}

}  // namespace semantic_slam
