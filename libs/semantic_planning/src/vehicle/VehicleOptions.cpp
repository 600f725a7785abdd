#include <semantic_planning/vehicle/VehicleOptions.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <strict_files/OptionChecks.h>

namespace semantic_planning {
namespace {

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

void addSide(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double xLow, double xHigh,
             Extent& extent) {
  if (std::max(a.x(), b.x()) < xLow || std::min(a.x(), b.x()) > xHigh) return;
  const auto at = [&](double x) {
    const double t = a.x() == b.x() ? 0 : std::clamp((x - a.x()) / (b.x() - a.x()), 0.0, 1.0);
    return a.y() + t * (b.y() - a.y());
  };
  for (const double x : {xLow, xHigh}) extent.add(at(x));
  if (a.x() == b.x()) extent.add(b.y());
  for (const Eigen::Vector2d& corner : {a, b})
    if (corner.x() >= xLow && corner.x() <= xHigh) extent.add(corner.y());
}

Extent extentBetween(const std::vector<Eigen::Vector2d>& polygon, double xLow, double xHigh) {
  Extent extent;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    addSide(polygon[i], polygon[(i + 1) % polygon.size()], xLow, xHigh, extent);
  return extent;
}

double area(const std::vector<Eigen::Vector2d>& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(sum) / 2;
}

}  // namespace

std::vector<Eigen::Vector2d> VehicleOptions::rectangle(double back, double front, double width) {
  return {{back, -width / 2}, {front, -width / 2}, {front, width / 2}, {back, width / 2}};
}

void VehicleOptions::validate() const {
  const strict_files::OptionChecks check("VehicleOptions");
  for (const Eigen::Vector2d& corner : footprint)
    if (!corner.allFinite()) check.fail("footprint", "a corner is not finite");
  if (footprint.size() < 3 || !(area(footprint) > 0))
    check.fail("footprint", "is no polygon of an area above 0");
  check.positive("height", height);
  check.positive("turningRadius", turningRadius);
  check.notNegative("clearance", clearance);
  check.notNegative("stepHeight", stepHeight);
  check.within("maxSlope", maxSlope, 0, 89);
  check.notNegative("wheelTrack", wheelTrack);
}

std::vector<Disc> coveringDiscs(const std::vector<Eigen::Vector2d>& footprint) {
  const auto [back, front] =
      std::minmax_element(footprint.begin(), footprint.end(),
                          [](const auto& l, const auto& r) { return l.x() < r.x(); });
  const double low = back->x(), length = front->x() - low;
  const Extent whole = extentBetween(footprint, low, front->x());
  // Slices half as long as wide: the discs stick out by 12 % of half the width.
  const int slices =
      std::max(1, std::min(20, static_cast<int>(std::ceil(2 * length / (whole.high - whole.low)))));
  std::vector<Disc> discs;
  for (int i = 0; i < slices; ++i) {
    const double from = low + i * length / slices, to = low + (i + 1) * length / slices;
    const Extent extent = extentBetween(footprint, from, to);
    const double width = extent.high - extent.low;
    discs.push_back(
        {(from + to) / 2, (extent.low + extent.high) / 2, std::hypot(to - from, width) / 2});
  }
  return discs;
}

}  // namespace semantic_planning
