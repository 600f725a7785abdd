#include <semantic_driving/DrivePath.h>

#include <mrpt/math/wrap2pi.h>
#include <semantic_driving/PathCheck.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace semantic_driving {

using mrpt::math::TPose2D;
using namespace semantic_planning;

namespace {

constexpr double kSame = 1e-6;  // m

double distance(const PathPoint& a, const PathPoint& b) { return std::hypot(b.x - a.x, b.y - a.y); }

bool isForward(const PathPoint& a, const PathPoint& b) {
  const double heading = a.heading + mrpt::math::wrapToPi(b.heading - a.heading) / 2;
  return (b.x - a.x) * std::cos(heading) + (b.y - a.y) * std::sin(heading) >= 0;
}

PathPoint between(const PathPoint& a, const PathPoint& b, double share) {
  PathPoint p = share < 0.5 ? a : b;
  const auto mix = [share](double from, double to) { return from + share * (to - from); };
  p.x = mix(a.x, b.x);
  p.y = mix(a.y, b.y);
  p.z = mix(a.z, b.z);
  p.heading = a.heading + share * mrpt::math::wrapToPi(b.heading - a.heading);
  p.arcLength = mix(a.arcLength, b.arcLength);
  p.forward = a.forward;
  return p;
}

}  // namespace

DrivePath::DrivePath(std::vector<PathPoint> points) {
  for (const PathPoint& p : points) {
    if (!m_points.empty() && distance(m_points.back(), p) < kSame) continue;
    m_points.push_back(p);
    PathPoint& added = m_points.back();
    added.arcLength = 0;
    if (m_points.size() == 1) continue;
    PathPoint& before = m_points[m_points.size() - 2];
    added.arcLength = before.arcLength + distance(before, added);
    before.forward = added.forward = isForward(before, added);
  }
  for (std::size_t i = 1; i + 1 < m_points.size(); ++i)
    if (m_points[i].forward != m_points[i - 1].forward) m_ends.push_back(m_points[i].arcLength);
  m_ends.push_back(length());
}

std::size_t DrivePath::segmentOf(double s) const {
  const auto after =
      std::upper_bound(m_points.begin(), m_points.end(), s,
                       [](double value, const PathPoint& p) { return value < p.arcLength; });
  const auto i = static_cast<std::size_t>(after - m_points.begin());
  return std::clamp<std::size_t>(i, 1, m_points.size() - 1) - 1;
}

PathPoint DrivePath::at(double s) const {
  const std::size_t i = segmentOf(s);
  const PathPoint &a = m_points[i], &b = m_points[i + 1];
  const double share = (s - a.arcLength) / (b.arcLength - a.arcLength);
  return between(a, b, std::clamp(share, 0.0, 1.0));
}

double DrivePath::nearest(const mrpt::math::TPose2D& pose, double from, double to) const {
  constexpr double kStep = 0.02;          // m
  constexpr double kHeadingWeight = 0.2;  // m/rad
  double best = std::numeric_limits<double>::infinity(), found = from;
  for (double s = from; s <= to + kStep / 2; s += kStep) {
    const PathPoint p = at(s);
    const double d = std::hypot(p.x - pose.x, p.y - pose.y) +
                     kHeadingWeight * std::abs(mrpt::math::wrapToPi(p.heading - pose.phi));
    if (d < best) best = d, found = s;
  }
  return std::min(found, to);
}

double DrivePath::stretchEnd(double s) const {
  for (const double end : m_ends)
    if (end > s + kSame) return end;
  return length();
}

double DrivePath::stretchBegin(double s) const {
  double begin = 0;
  for (const double end : m_ends)
    if (end < s - kSame) begin = end;
  return begin;
}

double DrivePath::longestBackwards(double s) const {
  double longest = 0;
  while (s < length() - kSame) {
    const double end = stretchEnd(s);
    if (!at((s + end) / 2).forward) longest = std::max(longest, end - s);
    s = end;
  }
  return longest;
}

DrivePath DrivePath::part(double from, double to, const DrivePath& then) const {
  std::vector<PathPoint> joined{at(from)};
  for (const PathPoint& p : m_points)
    if (p.arcLength > from + kSame && p.arcLength < to - kSame) joined.push_back(p);
  joined.push_back(at(to));
  joined.insert(joined.end(), then.m_points.begin(), then.m_points.end());
  return DrivePath(std::move(joined));
}

std::vector<PathPoint> DrivePath::waypoints(double s, double spacing) const {
  const double end = stretchEnd(s);
  const int pieces = std::max(1, static_cast<int>(std::ceil((end - s) / spacing)));
  std::vector<PathPoint> result;
  for (int i = 1; i <= pieces; ++i) result.push_back(at(s + (end - s) * i / pieces));
  return result;
}

namespace {

constexpr double kSpacing = 0.1;      // m
constexpr double kSameHeading = 0.2;  // rad

double apart(const TPose2D& a, const TPose2D& b) { return std::hypot(a.x - b.x, a.y - b.y); }

bool isSame(const TPose2D& a, const TPose2D& b) {
  return apart(a, b) < kSpacing && std::abs(mrpt::math::wrapToPi(a.phi - b.phi)) < kSameHeading;
}

}  // namespace

void DrivenTrack::add(const TPose2D& pose) {
  while (m_poses.size() > 1 && isSame(pose, m_poses[m_poses.size() - 2])) m_poses.pop_back();
  if (m_poses.empty() || apart(pose, m_poses.back()) >= kSpacing) m_poses.push_back(pose);
  const auto most = static_cast<std::size_t>(m_length / kSpacing);
  while (m_poses.size() > most) m_poses.pop_front();
}

std::vector<PathPoint> DrivenTrack::back() const {
  std::vector<PathPoint> points;
  for (auto pose = m_poses.rbegin(); pose != m_poses.rend(); ++pose) {
    PathPoint p;
    p.x = pose->x, p.y = pose->y, p.heading = pose->phi;
    points.push_back(p);
  }
  return points;
}

bool PathJudgment::isClearlyBetterThan(const PathJudgment& other) const {
  const bool backsUp = longestBackwards > kLongestBackwards;
  const bool otherBacksUp = other.longestBackwards > kLongestBackwards;
  if (backsUp != otherBacksUp) return otherBacksUp;
  return price < other.price - std::max(kSameLength, kSameShare * other.price);
}

PathCheck::PathCheck(const SemanticPlanner& planner)
    : m_planner(planner), m_checker(planner.ground(), planner.options().vehicle, planner.order()) {}

PathJudgment PathCheck::judge(const DrivePath& path, double from) const {
  PathJudgment judgment;
  judgment.longestBackwards = path.longestBackwards(from);
  if (!path.empty())
    judgment.price = m_checker.motionCost().of(path.part(from, path.length()).points());
  const colored_graph::ClassOrder& order = m_planner.order();
  const double step = m_planner.ground().voxelSize();
  for (double s = from; s < path.length(); s += step) {
    const PathPoint p = path.at(s);
    const auto pose = m_checker.place(poseOf(p), p.z);
    const bool fits = pose && m_checker.fit(*pose) == Fit::Free;
    const colored_graph::Rank rank =
        fits ? order.rank(m_checker.classAt(*pose)) : colored_graph::kForbidden;
    if (rank == colored_graph::kForbidden) {
      judgment.freeFor = std::min(judgment.freeFor, s - from);
      continue;
    }
    const double piece = std::min(step, path.length() - s);
    judgment.price += piece * std::min(order.rate(rank), std::pow(order.kHighestRate, rank));
  }
  return judgment;
}

}  // namespace semantic_driving
