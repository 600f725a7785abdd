#include <semantic_driving/PathCheck.h>

#include <algorithm>

namespace semantic_driving {

using colored_graph::Rank;
using namespace semantic_planning;

namespace {

constexpr double kBetween = 0.5;  // m, between places that a curve connects
constexpr double kReach = 16;     // m, of the path that it replaces
constexpr double kInside = 1e-3;  // m

}  // namespace

ForwardTurns::ForwardTurns(const SemanticPlanner& planner, double longest)
    : m_planner(planner),
      m_checker(planner.ground(), planner.options().vehicle, planner.order()),
      m_longest(longest) {}

double ForwardTurns::priceOf(const DrivePath& path, double from, double to) const {
  return to > from ? m_checker.motionCost().of(path.part(from, to).points()) : 0;
}

/** Where the path goes forward, and its ends. */
std::vector<double> ForwardTurns::places(const DrivePath& path, double from) const {
  std::vector<double> places{from};
  for (double s = from + kBetween; s < path.length() - kInside; s += kBetween)
    if (path.at(s).forward) places.push_back(s);
  places.push_back(path.length());
  return places;
}

/** Cheapest first. \param most price */
std::vector<ForwardTurns::Curve> ForwardTurns::curves(const DrivePath& path, double from,
                                                      double most) const {
  std::vector<Curve> curves;
  const std::vector<double> all = places(path, from);
  for (const double a : all) {
    const double before = priceOf(path, 0, a);
    for (const double b : all) {
      if (b > a + kReach || path.stretchEnd(a + kInside) > b - kInside) continue;
      const ReedsSheppCurve curve =
          m_checker.reedsShepp().connectForward(poseOf(path.at(a)), poseOf(path.at(b)));
      const double price =
          before + m_checker.motionCost().of(curve) + priceOf(path, b, path.length());
      if (price < most) curves.push_back({a, b, price, curve});
    }
  }
  std::sort(curves.begin(), curves.end(),
            [](const Curve& a, const Curve& b) { return a.price < b.price; });
  return curves;
}

Rank ForwardTurns::worstOf(const DrivePath& path) const {
  Rank worst = 0;
  for (const PathPoint& p : path.points())
    worst = std::max(worst, m_planner.order().rank(p.classId));
  return worst;
}

/** Whether a curve fits, and meets no worse class than the path that it replaces. */
bool ForwardTurns::isDrivable(const Curve& c, const DrivePath& path) const {
  const semantic_planning::Ground& ground = m_planner.ground();
  const auto profile =
      m_checker.profile(c.curve, ground.keyOf(path.at(c.from).z), ground.keyOf(path.at(c.to).z));
  if (!profile) return false;
  const bool backsUp = path.longestBackwards(c.from) > m_longest;
  const Rank worst = worstOf(backsUp ? path : path.part(c.from, c.to));
  return std::all_of(profile->begin(), profile->end(), [&](const colored_graph::Stretch& s) {
    return m_planner.order().rank(s.classId) <= worst;
  });
}

std::optional<DrivePath> ForwardTurns::find(const DrivePath& path, double from,
                                            double worth) const {
  if (path.empty() || from > path.length() || path.stretchEnd(from) >= path.length()) return {};
  for (const Curve& c : curves(path, from, priceOf(path, 0, path.length()) - worth)) {
    if (!isDrivable(c, path)) continue;
    std::vector<PathPoint> points =
        m_checker.trace(c.curve, m_planner.ground().keyOf(path.at(c.from).z));
    const DrivePath turn(std::move(points));
    const DrivePath end = c.to < path.length() ? path.part(c.to, path.length()) : DrivePath();
    const DrivePath rest = turn.part(0, turn.length(), end);
    return c.from > 0 ? path.part(0, c.from, rest) : rest;
  }
  return {};
}

}  // namespace semantic_driving
