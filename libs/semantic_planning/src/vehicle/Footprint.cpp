#include <semantic_planning/vehicle/Footprint.h>
#include <strict_files/TextFile.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace semantic_planning {
namespace {

using Eigen::Vector2d;

[[noreturn]] void refuse(const std::string& problem, const Vector2d& corner) {
  std::ostringstream text;
  const strict_files::ClassicNumbers classic(text);
  text << "footprint " << problem << " (" << corner.x() << ", " << corner.y() << ")";
  throw std::invalid_argument(text.str());
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double doubleArea(const std::vector<Vector2d>& corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += cross(corners[i], corners[(i + 1) % corners.size()]);
  return sum;
}

/** The normal of a counterclockwise polygon's side, to the right, of length 1. */
Vector2d outwards(const Vector2d& side) { return Vector2d(side.y(), -side.x()) / side.norm(); }

/** Extent of the footprint in y between two values of x: of a polygon's corners in between and of
 * its sides' crossings with both. */
struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;

  void add(double y) {
    low = std::min(low, y);
    high = std::max(high, y);
  }
};

void addSide(const Vector2d& a, const Vector2d& b, double xLow, double xHigh, Extent& extent) {
  if (std::max(a.x(), b.x()) < xLow || std::min(a.x(), b.x()) > xHigh) return;
  const auto at = [&](double x) {
    const double t = a.x() == b.x() ? 0 : std::clamp((x - a.x()) / (b.x() - a.x()), 0.0, 1.0);
    return a.y() + t * (b.y() - a.y());
  };
  for (const double x : {xLow, xHigh}) extent.add(at(x));
  if (a.x() == b.x()) extent.add(b.y());
  for (const Vector2d& corner : {a, b})
    if (corner.x() >= xLow && corner.x() <= xHigh) extent.add(corner.y());
}

Extent extentBetween(const std::vector<Vector2d>& polygon, double xLow, double xHigh) {
  Extent extent;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    addSide(polygon[i], polygon[(i + 1) % polygon.size()], xLow, xHigh, extent);
  return extent;
}

}  // namespace

Footprint::Footprint(std::vector<Vector2d> corners) : m_corners(std::move(corners)) {
  if (doubleArea(m_corners) < 0) std::reverse(m_corners.begin(), m_corners.end());
  check();
}

Footprint Footprint::rectangle(double back, double front, double width) {
  return Footprint(
      {{back, -width / 2}, {front, -width / 2}, {front, width / 2}, {back, width / 2}});
}

/** Counterclockwise and convex: all turns to the left, and once around. */
void Footprint::check() const {
  constexpr double kSamePlace = 1e-9, kStraight = 1e-9, kBack = M_PI - 1e-6;  // m, radians
  if (size() < 3)
    throw std::invalid_argument("footprint has " + std::to_string(size()) +
                                " corners, expected at least three");
  for (const Vector2d& corner : m_corners)
    if (!corner.allFinite()) refuse("has a corner that is not finite:", corner);
  for (std::size_t i = 0; i < size(); ++i)
    if (!(side(i).norm() > kSamePlace)) refuse("has two corners at one place,", m_corners[i]);
  double turned = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    const Vector2d before = side((i + size() - 1) % size()), after = side(i);
    const double turn = std::atan2(cross(before, after), before.dot(after));
    if (std::abs(turn) > kBack) refuse("turns back on itself at", m_corners[i]);
    if (turn < -kStraight) refuse("is not convex at", m_corners[i]);
    turned += turn;
  }
  if (turned > 3 * M_PI) refuse("has sides that cross, after", m_corners[0]);
}

Footprint Footprint::inflated(double margin) const {
  if (!(margin >= 0) || !std::isfinite(margin))
    throw std::invalid_argument("footprint: margin is " + std::to_string(margin) +
                                ", expected 0 or more");
  std::vector<Vector2d> corners;
  for (std::size_t i = 0; i < size(); ++i) {
    const Vector2d n = outwards(side((i + size() - 1) % size())), m = outwards(side(i));
    corners.push_back(m_corners[i] + margin * ((n + m) / (1 + n.dot(m))));  // where the sides meet
  }
  return Footprint(corners);
}

double Footprint::distance(const Vector2d& point) const {
  bool within = true;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < size(); ++i) {
    const Vector2d a = m_corners[i], d = side(i);
    within = within && d.x() * (point - a).y() - d.y() * (point - a).x() >= 0;
    const double share = std::clamp(d.dot(point - a) / d.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (point - a - share * d).norm());
  }
  return within ? 0 : least;
}

double Footprint::inscribedRadius() const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < size(); ++i)
    least = std::min(least, outwards(side(i)).dot(m_corners[i]));
  return std::max(0.0, least);
}

std::vector<Disc> Footprint::coveringDiscs(double most) const {
  const auto [back, front] = std::minmax_element(
      begin(), end(), [](const auto& l, const auto& r) { return l.x() < r.x(); });
  const double low = back->x(), length = front->x() - low;
  const Extent whole = extentBetween(m_corners, low, front->x());
  const double width = whole.high - whole.low;
  // Slices half as long as wide: the discs stick out by 12 % of half the width.
  int slices = std::max(1, std::min(20, static_cast<int>(std::ceil(2 * length / width))));
  std::vector<Disc> discs;
  const auto cover = [&](double from, double to, int across) {
    const Extent extent = extentBetween(m_corners, low + from, low + to);
    const double share = (extent.high - extent.low) / across;
    for (int i = 0; i < across; ++i)
      discs.push_back({low + (from + to) / 2, extent.low + (i + 0.5) * share,
                       std::hypot(to - from, share) / 2});
  };
  double ends = 0;
  if (std::hypot(length / slices, width) - length / slices > 2 * most) {
    ends = std::min(0.3 * width, length / 2);  // pairs stick out by 14 % of the width
    cover(0, ends, 2);
    cover(length - ends, length, 2);
    --slices;
  }
  const double slice = (length - 2 * ends) / slices;
  for (int i = 0; i < slices; ++i) cover(ends + i * slice, ends + (i + 1) * slice, 1);
  return discs;
}

}  // namespace semantic_planning
