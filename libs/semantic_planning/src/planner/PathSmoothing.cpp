#include "PathSmoothing.h"

#include <semantic_planning/planner/Slices.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

#include "PathImprovement.h"

namespace semantic_planning {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

constexpr double kLeastCurvature = 1e-7;  // 1/m: less is none

TPoint2D leftOf(double heading) { return {-std::sin(heading), std::cos(heading)}; }
double dot(const TPoint2D& a, const TPoint2D& b) { return a.x * b.x + a.y * b.y; }
double wrapped(double angle) { return std::remainder(angle, 2 * M_PI); }

TPoint2D centerOf(const TPose2D& pose, double curvature) {
  return TPoint2D(pose.x, pose.y) + leftOf(pose.phi) * (1 / curvature);
}

/** Oriented circles touch if their centers are as far apart as their signed radii differ. A circle
 * touches a line if its center is its signed radius to the left. Both are linear in the curvature.
 */
std::optional<double> curvatureInto(const TPose2D& from, const Arc& into) {
  const TPoint2D left = leftOf(from.phi), point(from.x, from.y);
  double above = 0, below = 0;
  if (into.curvature == 0) {
    const TPoint2D side = leftOf(into.begin.phi);
    above = 1 - dot(left, side);
    below = dot(point - TPoint2D(into.begin.x, into.begin.y), side);
  } else {
    const TPoint2D offset = point - centerOf(into.begin, into.curvature);
    const double radius = 1 / into.curvature;
    above = 2 * (dot(left, offset) + radius);
    below = radius * radius - dot(offset, offset);
  }
  if (std::abs(below) < 1e-9) return std::nullopt;
  const double curvature = above / below;
  return std::abs(curvature) < kLeastCurvature ? 0 : curvature;
}

double headingWhereTheyMeet(const TPose2D& from, double curvature, const Arc& into) {
  if (into.curvature == 0) return into.begin.phi;
  if (curvature == 0) return from.phi;
  const TPoint2D apart = centerOf(from, curvature) - centerOf(into.begin, into.curvature);
  const double sign = 1 / curvature < 1 / into.curvature ? -1 : 1;
  return std::atan2(-sign * apart.x, sign * apart.y);
}

double along(const TPose2D& from, const TPose2D& to) {
  return std::cos(from.phi) * (to.x - from.x) + std::sin(from.phi) * (to.y - from.y);
}

}  // namespace

TPose2D Arc::at(double s) const {
  const double phi = begin.phi + curvature * s;
  if (curvature == 0) return {begin.x + s * std::cos(phi), begin.y + s * std::sin(phi), begin.phi};
  return {begin.x + (std::sin(phi) - std::sin(begin.phi)) / curvature,
          begin.y - (std::cos(phi) - std::cos(begin.phi)) / curvature, wrapped(phi)};
}

std::optional<TangentArc> tangentArc(const TPose2D& from, const Arc& into) {
  constexpr double kMostTurn = 1.5 * M_PI, kGap = 1e-5;  // radians, m
  const auto curvature = curvatureInto(from, into);
  if (!curvature) return std::nullopt;
  const double heading = headingWhereTheyMeet(from, *curvature, into);
  TangentArc found{{from, *curvature, 0}, 0};
  if (into.curvature != 0) found.meets = wrapped(heading - into.begin.phi) / into.curvature;
  if (*curvature == 0) {
    found.arc.length = along(from, into.at(found.meets));
  } else {
    double turn = wrapped(heading - from.phi);
    if (turn * *curvature < 0) turn += std::copysign(2 * M_PI, *curvature);
    if (std::abs(turn) > kMostTurn) return std::nullopt;
    found.arc.length = turn / *curvature;
  }
  const TPose2D end = found.arc.at(found.arc.length);
  if (into.curvature == 0) found.meets = along(into.begin, end);
  const TPose2D met = into.at(found.meets);
  if (found.arc.length <= 0 || std::hypot(end.x - met.x, end.y - met.y) > kGap) return std::nullopt;
  return found;
}

namespace {

/** Where a new arc leaves a part: meters after the part's end. */
constexpr std::array<double, 11> kLeaves = {0, -0.3, -0.6, -1.2, -2.4, -4.8, -9.6, 0.5, 1, 2, 4};
constexpr std::size_t kMostReplaced = 12;  // parts by one

/** A part of the path whose curvature and gear are constant. */
struct Part {
  Arc arc;  ///< backwards: its length is negative
  int z;    ///< key of the surface where it begins
  int number = 0;
  double ofClasses = 0;  ///< what it costs for its classes, meters

  CurveState state() const { return {arc.length > 0, arc.curvature}; }
};

/** A new arc instead of what is between two parts, which become shorter or longer. */
struct Replacement {
  double gain;  ///< of the price
  std::size_t before, after;
  std::size_t leave;  ///< which one
  double leaves;
  TangentArc tangent;

  bool operator<(const Replacement& o) const {
    return std::tie(o.gain, before, after, leave) < std::tie(gain, o.before, o.after, o.leave);
  }
};

class Smoothing {
 public:
  Smoothing(const std::vector<PathPoint>& path, const CollisionChecker& checker,
            const ClassPrices& prices)
      : m_checker(checker),
        m_perMeter(prices.perMeter()),
        m_budget{m_perMeter, std::numeric_limits<double>::max()} {
    for (std::size_t i = 0; i + 1 < path.size();) i = addPart(path, i);
    m_end = checker.ground().keyOf(path.back().z);
  }

  std::vector<Leg> run() {
    while (m_looks > 0 && improve()) {
    }
    std::vector<Leg> legs;
    for (const Part& part : m_parts) legs.push_back({curveOf(part.arc), part.z});
    return legs;
  }

 private:
  static constexpr double kLeastGain = 0.02;  // m

  /** From a point of the path to where curvature or gear change. \return that point */
  std::size_t addPart(const std::vector<PathPoint>& path, std::size_t from) {
    const PathPoint &begin = path[from], &first = path[from + 1];
    std::size_t to = from + 1;
    while (to + 1 < path.size() && path[to + 1].forward == first.forward &&
           std::abs(path[to + 1].curvature - first.curvature) < 1e-9)
      ++to;
    const double length = path[to].arcLength - begin.arcLength;
    const TPose2D pose(begin.x, begin.y, begin.heading);
    m_parts.push_back({{pose, first.curvature, first.forward ? length : -length},
                       m_checker.ground().keyOf(begin.z),
                       m_numbers++,
                       ofClasses(path, from, to)});
    return to;
  }

  /** As setLengths(), but without what is forbidden. */
  double ofClasses(const std::vector<PathPoint>& path, std::size_t from, std::size_t to) const {
    double price = 0;
    for (std::size_t i = from + 1; i <= to; ++i)
      for (const std::size_t at : {i - 1, i})
        if (const double rate = m_perMeter[path[at].classId]; std::isfinite(rate))
          price += rate * (path[i].arcLength - path[i - 1].arcLength) / 2;
    return price;
  }

  ReedsSheppCurve curveOf(const Arc& arc) const {
    const int turn = arc.curvature > 0 ? 1 : arc.curvature < 0 ? -1 : 0;
    const double radius =
        turn == 0 ? m_checker.reedsShepp().turningRadius() : 1 / std::abs(arc.curvature);
    return {arc.begin, radius, {{{arc.length, turn}}}};
  }

  /** \param end key of the surface at its end */
  bool evaluate(Part& part, int end) {
    const auto profile = m_checker.profile(curveOf(part.arc), part.z, end, &m_budget);
    if (!profile) return false;
    for (const auto& stretch : *profile)
      part.ofClasses += m_perMeter[stretch.classId] * colored_graph::toMeters(stretch.length);
    return true;
  }

  bool improve() {
    m_replacements.clear();
    for (std::size_t a = 0; a < m_parts.size(); ++a)
      for (std::size_t b = a + 1; b < m_parts.size() && b <= a + 1 + kMostReplaced; ++b) {
        if (m_parts[b - 1].arc.length < 0 || m_parts[b].arc.length < 0) break;
        if (b > a + 1) propose(a, b);
      }
    std::sort(m_replacements.begin(), m_replacements.end());
    return std::any_of(m_replacements.begin(), m_replacements.end(),
                       [this](const Replacement& r) { return apply(r); });
  }

  void propose(std::size_t a, std::size_t b) {
    const Arc &before = m_parts[a].arc, &after = m_parts[b].arc;
    const double most = 1 / m_checker.reedsShepp().turningRadius();
    for (std::size_t i = 0; i < kLeaves.size(); ++i) {
      const double leaves = before.length + kLeaves[i];
      if (leaves < 0) continue;
      const auto tangent = tangentArc(before.at(leaves), after);
      if (!tangent || std::abs(tangent->arc.curvature) > most || tangent->meets > after.length)
        continue;
      Replacement r{0, a, b, i, leaves, *tangent};
      r.gain = gainOf(r);
      if (r.gain > kLeastGain) m_replacements.push_back(r);
    }
  }

  /** What is there instead of the parts from `before` to `after`, not evaluated yet. */
  std::vector<Part> partsOf(const Replacement& r) const {
    std::vector<Part> parts;
    const auto add = [&](const Arc& arc) {
      constexpr double kNothing = 1e-6;
      if (arc.length > kNothing) parts.push_back({arc, 0});
    };
    Arc before = m_parts[r.before].arc;
    const Arc after = m_parts[r.after].arc;
    before.length = r.leaves;
    add(before);
    add(r.tangent.arc);
    add({after.at(r.tangent.meets), after.curvature, after.length - r.tangent.meets});
    return parts;
  }

  template <class Iterator>
  double priceOf(const Replacement& r, Iterator begin, Iterator end) const {
    const MotionCost& price = m_checker.motionCost();
    double sum = 0;
    std::optional<CurveState> last;
    const auto go = [&](const CurveState& state) {
      if (last) sum += price.ofChange(*last, state);
      last = state;
    };
    if (r.before > 0) go(m_parts[r.before - 1].state());
    for (; begin != end; ++begin) {
      go(begin->state());
      sum += price.ofWay(begin->arc.length, true);
    }
    if (r.after + 1 < m_parts.size()) go(m_parts[r.after + 1].state());
    return sum;
  }

  double gainOf(const Replacement& r) const {
    const std::vector<Part> parts = partsOf(r);
    return priceOf(r, m_parts.begin() + static_cast<std::ptrdiff_t>(r.before),
                   m_parts.begin() + static_cast<std::ptrdiff_t>(r.after) + 1) -
           priceOf(r, parts.begin(), parts.end());
  }

  /** If the vehicle can drive it and classes do not cost more than it gains. */
  bool apply(const Replacement& r) {
    constexpr double kSlack = 1e-3;  // m: lengths are rounded
    if (m_looks == 0 ||
        !m_seen.insert({m_parts[r.before].number, m_parts[r.after].number, r.leave}).second)
      return false;
    --m_looks;
    Slices::count(20);
    std::vector<Part> parts = partsOf(r);
    const auto begin = m_parts.begin() + static_cast<std::ptrdiff_t>(r.before),
               end = m_parts.begin() + static_cast<std::ptrdiff_t>(r.after) + 1;
    const double most = r.gain + ofClasses({begin, end});
    m_budget.left = most + kSlack;
    if (!evaluate(r, parts) || most - ofClasses(parts) < kLeastGain) return false;
    for (Part& part : parts) part.number = m_numbers++;
    m_parts.insert(m_parts.erase(begin, end), parts.begin(), parts.end());
    return true;
  }

  int zAfter(const Replacement& r) const {
    return r.after + 1 < m_parts.size() ? m_parts[r.after + 1].z : m_end;
  }

  static double ofClasses(const std::vector<Part>& parts) {
    return std::accumulate(parts.begin(), parts.end(), 0.0,
                           [](double sum, const Part& part) { return sum + part.ofClasses; });
  }

  bool evaluate(const Replacement& r, std::vector<Part>& parts) {
    double z = m_checker.ground().centerOf(m_parts[r.before].z);
    for (Part& part : parts) {
      const auto begin = m_checker.place(part.arc.begin, z);
      if (!begin) return false;
      part.z = begin->z;
      z = m_checker.ground().centerOf(part.z);
    }
    // The new arc first: it is what may not fit.
    for (const std::size_t i : {1, 0, 2}) {
      if (i >= parts.size()) continue;
      const int end = i + 1 < parts.size() ? parts[i + 1].z : zAfter(r);
      if (!evaluate(parts[i], end)) return false;
    }
    return true;
  }

  const CollisionChecker& m_checker;
  const std::vector<double> m_perMeter;
  ClassBudget m_budget;
  std::vector<Part> m_parts;
  std::vector<Replacement> m_replacements;
  std::set<std::tuple<int, int, std::size_t>> m_seen;
  int m_end = 0;  ///< key of the surface where the path ends
  int m_numbers = 0, m_looks = 2000;
};

}  // namespace

std::vector<Leg> smoothed(const std::vector<PathPoint>& path, const CollisionChecker& checker,
                          const ClassPrices& prices) {
  return Smoothing(path, checker, prices).run();
}

}  // namespace semantic_planning
