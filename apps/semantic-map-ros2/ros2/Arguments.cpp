#include "ros2/Arguments.h"

namespace ros2 {

namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;

/** Reads "a:=b". */
bool addPair(const std::string& word, Pairs& pairs) {
  const std::size_t at = word.find(":=");
  if (at == std::string::npos || at == 0) return false;
  pairs.emplace_back(word.substr(0, at), word.substr(at + 2));
  return true;
}

/** What is wrong with a flag of ROS's and its value, if anything. */
std::string add(const std::string& flag, const char* value, Arguments& arguments) {
  const bool isRemapping = flag == "-r" || flag == "--remap";
  const bool isParameter = flag == "-p" || flag == "--param";
  if (!isRemapping && !isParameter && flag != "--params-file" && flag != "--log-level")
    return "unknown argument '" + flag + "' behind --ros-args; known: -r, -p, --params-file";
  if (!value) return flag + " lacks its value";
  if (flag == "--params-file") arguments.files.push_back(value);
  if (isRemapping && !addPair(value, arguments.remappings))
    return flag + " " + value + ": expected FROM:=TO";
  if (isParameter && !addPair(value, arguments.parameters))
    return flag + " " + value + ": expected NAME:=VALUE";
  return {};
}

}  // namespace

Arguments argumentsOf(int argc, char** argv) {
  Arguments arguments;
  bool ofRos = false;
  for (int i = 0; i < argc; ++i) {
    const std::string word = argv[i];
    if (!ofRos && word != "--ros-args") arguments.others.push_back(argv[i]);
    const bool isFlag = ofRos && word != "--ros-args" && word != "--";
    if (word == "--ros-args") ofRos = true;
    if (ofRos && word == "--") ofRos = false;
    if (!isFlag) continue;
    const std::string problem = add(word, i + 1 < argc ? argv[i + 1] : nullptr, arguments);
    if (arguments.problem.empty()) arguments.problem = problem;
    ++i;
  }
  return arguments;
}

}  // namespace ros2
