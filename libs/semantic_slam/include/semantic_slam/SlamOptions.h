#pragma once
#include <strict_files/OptionList.h>

namespace semantic_slam {

/** How keyframes are chosen, registered, and loops found. */
struct SlamOptions {
  double keyframeDistance = 1;  // m
  double keyframeAngle = 15;    // degrees
  int submapKeyframes = 10;     // that a scan is registered to
  bool useClasses = true;       // a point fits what is of its class only
  bool registerAll = false;     // scans between keyframes, too; else odometry has them
  bool level = false;           // odometry knows height, roll and pitch; so if beams are horizontal
  double maxRange = 30;         // m; points beyond it are not used
  double cubeSize = 0.25;       // m; one point per cube is used

  double odometryShare = 0.01;     // standard deviation of odometry after a meter, m
  double odometryAngle = 0.1;      // the same of its headings, degrees
  double odometryTurn = 0.05;      // more of its headings, of the angle turned
  double registrationShare = 0.5;  // of the points that fit, at least; else odometry holds alone

  double loopLength = 30;   // m of the way, at least, between the ends of a loop
  double loopRadius = 5;    // m; ends that seem to be this near are looked at
  double loopDrift = 0.02;  // m of radius more per m of the way between
  double loopShare = 0.6;   // of the points that fit, at least
  double loopEvery = 3;     // m of the way between two looks

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

}  // namespace semantic_slam
