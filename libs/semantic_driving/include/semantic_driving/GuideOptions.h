#pragma once
#include <semantic_driving/Frontiers.h>
#include <semantic_driving/Motion.h>
#include <semantic_driving/PathCheck.h>
#include <semantic_driving/Recovery.h>

namespace semantic_driving {

/** When a guide looks for paths, and where. */
struct GuideOptions {
  double period = 1.0;       ///< seconds between looks for a better path
  double patience = 2.0;     ///< seconds for what stands in the way to go away, or to be passed
  double stuckAfter = 4.0;   ///< seconds without getting on, until another path is looked for
  double giveUpAfter = 4.0;  ///< seconds at rest without any path
  /** Seconds for what stands in the goal's place to go away, until it is said that the goal does
   * not fit: people move, walls do not. */
  double goalPatience = 10.0;
  double nearestWithin = 5.0;   ///< meters around such a goal, where a pose that fits is looked for
  bool driveToNearest = false;  ///< that pose becomes the goal, or else the drive ends
  double atGoal = 0.3;          ///< so near (meters) to the goal's place is there
  double atRest = 0.05;         ///< m/s; a slower vehicle stands

  /** A vehicle that is faster (m/s) comes to rest before it leaves its path for another one, which
   * may begin backwards. */
  double slow = 0.2;
  /** Of DriveOptions::braking(), below 1: so gently that the tracker keeps to it. */
  double restBraking = 0.9375;
  double restMargin = 0.1;  ///< meters more than that takes
  /** A better path leaves the present one where the vehicle is after so many seconds, or at least
   * so many meters ahead. */
  double leadTime = 1, leadDistance = 0.5;
  PathTolerance same;  ///< paths that differ by less are equally good
  /** A shorter last stretch to the goal (meters) is not worth a change of gear, and left out; less
   * than atGoal. */
  double shortestShunt = 0.15;

  double nearFrontier = 3;   ///< meters before a frontier the next one is looked for
  double shortestWay = 0.5;  ///< meters; nearer frontiers are seen from here
  double backBeyond = 1;     ///< meters back beyond where planning is possible again
  int mostTimesBack = 3;     ///< without a plan between, then there is no path

  FrontierOptions frontiers;
  RecoveryOptions recovery;

  /** Its own; frontiers and recovery describe theirs. */
  void describe(strict_files::OptionList& list);
  /** Meters that a vehicle takes to come to rest, without restMargin, also if it gets faster yet.
   * \param speed m/s */
  double restingWay(double speed, const DriveOptions& drive) const {
    return speed * speed / (2 * (restBraking * drive.braking())) +
           speed * delayOfStop(drive.maxAcceleration / 2, drive);
  }
  /** Who is there is at the goal, though not to the last centimeter. */
  bool isAsGood(const mrpt::math::TPose2D& pose, const mrpt::math::TPose2D& goal) const;
  /** Of all. \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

}  // namespace semantic_driving
