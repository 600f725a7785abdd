#pragma once
#include <mrpt/math/TPose2D.h>
#include <strict_files/OptionList.h>

namespace semantic_driving {

/** When a guide looks for paths, and where. */
struct GuideOptions {
  double period = 1.0;    ///< seconds between looks for a better path
  double patience = 2.0;  ///< seconds for what stands in the way to go away, or to be passed
  /** Seconds for what stands in the goal's place to go away, until it is said that the goal does
   * not fit: people move, walls do not. */
  double goalPatience = 10.0;
  bool driveToNearest = false;  ///< the nearest pose that fits becomes the goal then
  double atGoal = 0.3;          ///< so near (meters) to the goal's place is there
  double longestBackwards =
      4;                       ///< nobody backs up farther at a stretch if it can be helped, meters
  double frontierRadius = 80;  ///< how far frontiers are looked for, see findFrontiers(), meters

  void describe(strict_files::OptionList& list);
  /** Who is there is at the goal, though not to the last centimeter. */
  bool isAsGood(const mrpt::math::TPose2D& pose, const mrpt::math::TPose2D& goal) const;
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

}  // namespace semantic_driving
