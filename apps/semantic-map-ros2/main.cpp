// Makes a semantic octree map in a live ROS 2 system, without ROS.
#include <semantic_octree/TreeFile.h>

#include <chrono>
#include <ostream>
#include <stdexcept>
#include <thread>
#include <utility>

#include "Application.h"
#include "MapMessages.h"
#include "MappingNode.h"
#include "inputs/Inputs.h"

namespace semantic_map_ros2 {
namespace {

namespace fs = std::filesystem;
using semantic_octree::SemanticOcTree;

struct Cli {
  fs::path output, map;
  std::string copy;
  Outputs outputs;

  explicit Cli(CLI::App& app) : outputs(app) {
    outputs
        .add(app, output, "FILE",
             "The map (.semantic), written after Ctrl-C, and when somebody publishes to ~/save")
        ->required();
    app.add_option("--map", map, "Map to go on with; its frame is the frame of all poses");
    app.add_option(
           "--copy", copy,
           "Instead of mapping, mirror the compressed tree of this node, such as /semantic_map")
        ->type_name("NAME");
    app.add_flag_callback("-v,--verbose", beVerbose, "Tell of each scan");
    app.footer("ROS arguments: --ros-args -r FROM:=TO -p NAME:=VALUE --params-file FILE (YAML)");
  }
};

int keepCopy(const Cli& cli, const ros2::Arguments& arguments, const StopRequest& stop) {
  constexpr std::chrono::milliseconds kLook(50);
  ros2::Node node("semantic_map_copy", arguments);
  TreeReader reader(node, cli.copy);
  Complaints complaints;
  notes() << "Waiting for a tree; Ctrl-C ends and saves" << std::endl;
  for (bool isThere = false; !stop.pending(); std::this_thread::sleep_for(kLook)) {
    for (const std::string& problem : node.look()) complaints.say(problem);
    if (const auto problem = reader.look(); !problem.empty())
      complaints.say(cli.copy + ": " + problem);
    if (!std::exchange(isThere, isThere || reader.isCurrent()) && reader.isCurrent())
      notes() << "The tree has come" << std::endl;
  }
  complaints.sum();
  const auto map = reader.map();
  if (!map)
    throw std::runtime_error(cli.copy + ": no compressed tree came: there is no map to save");
  if (!reader.isCurrent()) notes() << "The last changes did not come" << std::endl;
  saveTree(*map, cli.output.string());
  return 0;
}

int run(const Cli& cli, const ros2::Arguments& arguments) {
  if (!arguments.problem.empty()) throw CLI::ValidationError(arguments.problem);
  const StopRequest stop("after the scans that wait");
  const std::vector<fs::path> files(arguments.files.begin(), arguments.files.end());
  const Parameters parameters = readParameters(files, arguments.parameters);
  cli.outputs.check({cli.output}, files);
  if (!cli.copy.empty()) return keepCopy(cli, arguments, stop);
  SemanticOcTree map = cli.map.empty() ? parameters.newMap() : inputs::loadMap(cli.map);
  if (!cli.map.empty()) parameters.abstract(map);
  MappingNode node(parameters, arguments, map, [&] {
    saveTree(map, cli.output.string());
    notes() << cli.output.string() << ": saved" << std::endl;
  });
  node.run(stop);
  node.saySummary();
  if (node.scans() == 0) throw std::runtime_error("no scan came: there is no map to save");
  saveTree(map, cli.output.string());
  return 0;
}

}  // namespace
}  // namespace semantic_map_ros2

int main(int argc, char** argv) {
  CLI::App app("Makes a semantic octree map in a live ROS 2 system; needs no ROS of its own");
  const semantic_map_ros2::Cli cli(app);
  ros2::Arguments arguments = ros2::argumentsOf(argc, argv);
  return runApplication(app, static_cast<int>(arguments.others.size()), arguments.others.data(),
                        [&] { return semantic_map_ros2::run(cli, arguments); });
}
