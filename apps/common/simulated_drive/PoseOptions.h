#pragma once
#include <strict_files/OptionList.h>

namespace simulated_drive {

/** How the robot knows its pose. Without noise it knows it exactly. */
struct PoseOptions {
  /** Standard deviation of the way that odometry reports, meters after one meter; it grows with the
   * square root of the way. */
  double odometryNoise = 0;
  double turnNoise = 0;  ///< of the heading, degrees after one meter; grows alike
  bool correct = true;   ///< by SLAM

  void describe(strict_files::OptionList& list);
  bool isExact() const { return odometryNoise == 0 && turnNoise == 0; }
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

}  // namespace simulated_drive
