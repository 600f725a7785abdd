#pragma once
#include <Eigen/Core>
#include <vector>

namespace semantic_planning {

/** What drives, and where it can. The frame is the vehicle's: x ahead, y to the left, the origin on
 * the ground, at the middle of the axle that does not steer. */
struct VehicleOptions {
  /** Corners of the outline on the ground in order, meters: at least three. */
  std::vector<Eigen::Vector2d> footprint = rectangle(-0.25, 0.55, 0.6);
  /** From the ground to the top, meters. What is lower than this above the ground is in the way. */
  double height = 1.0;
  /** Least radius of the origin's path, meters. */
  double turningRadius = 1.0;
  /** Kept free around the footprint, meters. */
  double clearance = 0.1;
  /** Highest step that the wheels take, meters. A step of one voxel cannot be told from a slope and
   * is always taken. */
  double stepHeight = 0.2;
  /** Steepest ground, degrees. */
  double maxSlope = 25;
  /** Between left and right wheels, meters: whose classes count. 0: one track in the middle. */
  double wheelTrack = 0.5;

  /** Corners of a rectangle from `back` (negative) to `front`, `width` wide; meters. */
  static std::vector<Eigen::Vector2d> rectangle(double back, double front, double width);

  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;
};

/** A disc that covers a part of the footprint. */
struct Disc {
  double x = 0, y = 0;  ///< center in the vehicle's frame, meters
  double radius = 0;    ///< meters
};

/** Discs that together cover the footprint: a vehicle whose discs are free is free. They stick out
 * by at most a tenth of its width on long vehicles, more on short ones. */
std::vector<Disc> coveringDiscs(const std::vector<Eigen::Vector2d>& footprint);

}  // namespace semantic_planning
