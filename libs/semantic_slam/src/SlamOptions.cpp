#include <semantic_slam/SlamOptions.h>

namespace semantic_slam {

using strict_files::above;
using strict_files::atLeast;
using strict_files::between;

void SlamOptions::describe(strict_files::OptionList& list) {
  list.add("keyframe_distance", keyframeDistance, "m", above(0),
           "a keyframe begins where the robot is this far from the last one's beginning");
  list.add("keyframe_angle", keyframeAngle, "degrees", above(0).upTo(180),
           "the same, if it has turned so far");
  list.add("submap_keyframes", submapKeyframes, "", between(1, 1000),
           "to so many, the last or those around a loop's other end, a keyframe is registered");
  list.add("use_classes", useClasses, "", "points fit only what is of their class");
  list.add("register_all", registerAll, "",
           "scans between keyframes are registered, too; else they are where odometry has them");
  list.add("level", level, "",
           "odometry knows height, roll and pitch, as with an IMU; so it is if all beams are "
           "horizontal");
  list.add("max_range", maxRange, "m", above(0), "points beyond it are not registered");
  list.add("cube_size", cubeSize, "m", above(0), "of the points in such a cube one is used");
  list.add("odometry_share", odometryShare, "m", atLeast(0),
           "standard deviation of odometry after a meter; grows with the square root of the way");
  list.add("odometry_angle", odometryAngle, "degrees", atLeast(0), "of its headings; grows alike");
  list.add("odometry_turn", odometryTurn, "", atLeast(0),
           "so much more of its headings, of the angle turned since");
  list.add("registration_share", registrationShare, "", between(0, 1),
           "of a keyframe's points that have to fit those before it; else odometry has to do");
  list.add("loop_length", loopLength, "m", above(0), "of the way between a loop's ends, at least");
  list.add("loop_radius", loopRadius, "m", above(0),
           "places that seem to be this near may be a loop's other end");
  list.add("loop_drift", loopDrift, "", atLeast(0),
           "so much more for each meter of the way between");
  list.add("loop_share", loopShare, "", between(0, 1),
           "of a keyframe's points that have to fit those at the loop's other end");
  list.add("loop_every", loopEvery, "m", atLeast(0), "of the way between two looks for loops");
}

void SlamOptions::validate() const { strict_files::checkOptions(*this, "SlamOptions"); }

}  // namespace semantic_slam
