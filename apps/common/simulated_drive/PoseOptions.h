#pragma once
#include <strict_files/OptionList.h>

namespace simulated_drive {

/** How the robot knows its pose. Without noise it knows it exactly. */
struct PoseOptions {
  /** Standard deviation of the way that odometry reports, meters after one meter; it grows with the
   * square root of the way. */
  double odometryNoise = 0;
  double turnNoise = 0;  ///< of the heading, degrees after one meter; grows alike
  bool correct = true;   ///< by the map's likelihood, before each scan is inserted
  int particles = 100;
  int points = 900;  ///< of all scans of a moment; those count whose places the map tells apart
  /** Of each point's log-likelihood, (0, 1]: neighboring points are not independent, and the map
   * was made at poses that were estimated, too. */
  double pointWeight = 0.2;
  int fewestPoints = 30;  ///< that count, to be worth a correction
  /** What the map itself is uncertain by: standard deviations of x and y (meters), and of the
   * heading (degrees). */
  double mapPlace = 0.01, mapHeading = 0.1;

  void describe(strict_files::OptionList& list);
  bool isExact() const { return odometryNoise == 0 && turnNoise == 0; }
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

}  // namespace simulated_drive
