#pragma once
#include <semantic_slam/PoseGraph.h>

namespace semantic_slam {

/** How far off predictions of the robot's motion are (odometry's, or those of constant velocity),
 * measured while it drives. Two factors, of the way and of the heading, on standard deviations that
 * are wide at first. And what wheels do wrong at each step: they say too much way, too much of
 * turns, and turn the robot that goes straight. */
class MotionNoise {
 public:
  /** \param isConstantVelocity predictions are the last step again: their errors are accelerations,
   * and do not depend on the step \param factor of the deviations, at first */
  explicit MotionNoise(bool isConstantVelocity = false, double factor = 1);
  /** A step of odometry without what is wrong at each step. */
  Eigen::Isometry3d calibrated(const Eigen::Isometry3d& T_odometry_step) const;
  /** What is wrong at each step is learnt from a registered one (recursive least squares of what
   * the scans alone say). \param T_off, information as note() \param T_step as predicted */
  void calibrate(const Eigen::Isometry3d& T_odometry_step, const Eigen::Isometry3d& T_step,
                 const Eigen::Isometry3d& T_off, const Matrix6& information);
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

  /** Some steps together, so that what is wrong at each stands out of the noise. */
  struct Stretch {
    double way = 0, turn = 0;  ///< as odometry says
    Eigen::Array2d off = {0, 0}, variance = {0, 0},
                   share = {0, 0};  ///< of way and turn: registered less predicted; of the latter;
                                    ///< of what is registered, the scans' part times the variance
  };
  /** Factors on what odometry says, and how certain they are. */
  template <int kSize>
  struct Factors {
    Eigen::Matrix<double, kSize, 1> values;
    Eigen::Matrix<double, kSize, kSize> information;
    void learn(const Eigen::Matrix<double, kSize, 1>& said, const Stretch& stretch, int of);
  };
  bool m_isConstantVelocity;
  Stretch m_stretch;
  Factors<1> m_wayFactors;   ///< of the way
  Factors<2> m_turnFactors;  ///< of the turn, and radians for each meter of the way
  double m_way, m_turn;      ///< squared factors
  /** Steps that the latter, and by what scans told the former, are from; those of long ago do not
   * count. */
  double m_numSteps = 0, m_toldSteps = 0;
};

}  // namespace semantic_slam
