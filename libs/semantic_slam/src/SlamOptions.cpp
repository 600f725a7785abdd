#include <semantic_slam/SlamOptions.h>

namespace semantic_slam {

void SlamOptions::describe(strict_files::OptionList& list) {
  list.add("use_classes", useClasses, "", "a point fits only points of its class");
  list.add("level", level, "",
           "odometry knows height, roll and pitch, as with an IMU; always so of horizontal beams");
  list.add("max_range", maxRange, "m", strict_files::above(0),
           "points beyond it are not registered");
}

void SlamOptions::validate() const { strict_files::checkOptions(*this, "SlamOptions"); }

}  // namespace semantic_slam
