#include <semantic_driving/Focus.h>

#include <cmath>

namespace semantic_driving {

using semantic_octree::Region;

namespace {

/** In the middle of the meter that it is in: it moves rarely. */
Eigen::Vector3d onMeters(const Eigen::Vector3d& place) { return place.array().floor() + 0.5; }

Eigen::Vector3d placeAt(const DrivePath& path, double s) {
  const semantic_planning::PathPoint p = path.at(s);
  return {p.x, p.y, p.z};
}

}  // namespace

void FocusOptions::describe(strict_files::OptionList& list) {
  list.add("corridor", corridor, "m", strict_files::atLeast(0),
           "on both sides of the path ahead, where the compressed tree has detail; 0: everywhere");
}

void FocusOptions::validate() const { strict_files::checkOptions(*this, "FocusOptions"); }

std::vector<Region> regionsAhead(const DrivePath& path, double progress,
                                 const Eigen::Vector3d& vehicle, const FocusOptions& options) {
  constexpr double kFar = 1e6, kStretch = 3;  // m
  constexpr double kAhead = 15;               // m of the path
  if (!options.isOn()) return {};
  const Eigen::Vector3d far = Eigen::Vector3d::Constant(kFar);
  std::vector<Region> regions = {
      {Region::Shape::Box, -far, far, 0, 0},
      {Region::Shape::Sphere, onMeters(vehicle), far, options.around + std::sqrt(0.75), 1}};
  const double end = path.empty() ? 0 : std::min(path.length(), progress + kAhead);
  for (double s = kStretch * std::floor(progress / kStretch); s < end; s += kStretch)
    regions.push_back({Region::Shape::Corridor, placeAt(path, s), placeAt(path, s + kStretch),
                       options.corridor, 1});
  return regions;
}

}  // namespace semantic_driving
