#pragma once
#include <string>
#include <utility>
#include <vector>

namespace ros2 {

/** What stands behind --ros-args on a command line, as ROS's users type it. */
struct Arguments {
  std::vector<std::pair<std::string, std::string>> remappings;  ///< -r FROM:=TO
  std::vector<std::pair<std::string, std::string>> parameters;  ///< -p NAME:=VALUE
  std::vector<std::string> files;                               ///< --params-file FILE
  std::vector<char*> others;  ///< the program's own arguments, its name first
  std::string problem;        ///< what is wrong, if anything
};

/** Parts a command line. It never throws: the program says what is wrong (Arguments::problem). */
Arguments argumentsOf(int argc, char** argv);

}  // namespace ros2
