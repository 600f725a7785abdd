#pragma once
#include <strict_files/OptionList.h>

namespace semantic_slam {

/** What a user knows about his sensor and his robot. Lengths (of keyframes, submaps, cubes) follow
 * from the first scan, odometry's noise is measured while the robot drives. */
struct SlamOptions {
  bool useClasses = true;  // a point fits only what is of its class
  bool level = false;      // odometry knows height, roll and pitch; so if beams are horizontal

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

}  // namespace semantic_slam
