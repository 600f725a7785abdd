#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace semantic_slam {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/** What was measured of two poses: b, seen from a. */
struct PoseEdge {
  /** As a: the frame of the poses. */
  static constexpr std::size_t kMap = SIZE_MAX;
  std::size_t a, b;
  Eigen::Isometry3d T_a_b;
  /** Inverse covariance of (translation, meters; rotation, radians), frame of b. */
  Matrix6 information;
  /** May be wrong altogether, as loops may: it counts less where it contradicts the others. */
  bool isDoubtful = false;
};

/** (1/sigma^2) of translations and rotations. \param meters, radians standard deviations */
Matrix6 informationOf(double meters, double radians);

/** exp of a twist whose translation and rotation are independent: (meters; rotation vector). */
Eigen::Isometry3d poseOf(const Vector6& v);
/** The inverse of poseOf(). */
Vector6 vectorOf(const Eigen::Isometry3d& T);

/** Where a robot is after a time at constant velocity, seen from where it was. \param velocity
 * (m/s; rad/s), frame of the robot */
Eigen::Isometry3d movedFor(double seconds, const Vector6& velocity);
/** The inverse of movedFor(). \param seconds above 0 */
Vector6 velocityOf(const Eigen::Isometry3d& T_before_after, double seconds);

/** Over less time (s) poses' errors would count for more than motion: scans of several sensors come
 * a few milliseconds after each other. */
constexpr double kLeastTimeOfVelocity = 0.05;

/** The nearest pose whose rotation is one to the last bits: products of products drift. */
Eigen::Isometry3d rigid(const Eigen::Isometry3d& T);

/** Information of a step and then that of an edge, frame of its end. */
Matrix6 inSeries(const Matrix6& step, const PoseEdge& then);

/** e^T information e of an edge, e = vectorOf(T_a_b^-1 T_a^-1 T_b). */
double squaredError(const PoseEdge& edge, const std::vector<Eigen::Isometry3d>& poses);

/** Moves poses so that sum_e rho(e^T information e) becomes least, with e = vectorOf(T_a_b^-1
 * T_a^-1 T_b). rho is the square, or for doubtful edges Cauchy's log(1 + x / c^2) c^2. Gauss-Newton
 * with Levenberg's damping (Grisetti et al., "A Tutorial on Graph-Based SLAM"). The first pose
 * stays, but for edges from PoseEdge::kMap. \throw std::invalid_argument an edge of poses that are
 * not there. */
void optimize(std::vector<Eigen::Isometry3d>& poses, const std::vector<PoseEdge>& edges);

}  // namespace semantic_slam
