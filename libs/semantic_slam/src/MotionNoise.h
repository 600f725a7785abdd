#pragma once
#include <semantic_slam/PoseGraph.h>

namespace semantic_slam {

/** How far off predictions of the robot's motion are (odometry's, or those of constant velocity),
 * measured while it drives: two factors, of the way and of the heading, on standard deviations that
 * are wide at first. */
class MotionNoise {
 public:
  /** \param isConstantVelocity predictions are the last step again: their errors are accelerations,
   * and do not depend on the step \param factor of the deviations, at first */
  explicit MotionNoise(bool isConstantVelocity = false, double factor = 1)
      : m_isConstantVelocity(isConstantVelocity), m_way(factor * factor), m_turn(factor * factor) {}
  /** Information of a predicted step, frame of its end. */
  Matrix6 information(const Eigen::Isometry3d& T_step) const;
  /** A scan was registered elsewhere than predicted. What the registration leaves uncertain counts
   * as if it were off, too (expectation maximization): else a narrow prediction would confirm
   * itself. \param T_off from the predicted end of the step to the registered one \param
   * information of the registered end, with that of the prediction, frame of the end */
  void note(const Eigen::Isometry3d& T_step, const Eigen::Isometry3d& T_off,
            const Matrix6& information);

  double wayFactor() const { return std::sqrt(m_way); }
  double turnFactor() const { return std::sqrt(m_turn); }

 private:
  struct Deviations {
    double way, turn;  ///< m, radians
  };
  /** At first. */
  Deviations deviationsOf(const Eigen::Isometry3d& T_step) const;

  bool m_isConstantVelocity;
  double m_way, m_turn;  ///< squared factors
};

}  // namespace semantic_slam
