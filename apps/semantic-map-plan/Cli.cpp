#include "Cli.h"

#include "MemoryOption.h"
#include "OptionFlags.h"
#include "inputs/Inputs.h"
#include "poses/Poses.h"

namespace semantic_map_plan {

namespace {

/** CLI::PositiveNumber knows no infinity. */
std::string moreThanZero(const std::string& text) {
  double value = 0;
  const bool isMore = CLI::detail::lexical_cast(text, value) && value > 0;
  return isMore ? "" : "expected more than 0, not '" + text + "'";
}

}  // namespace

Cli::Cli(CLI::App& app) : outputs(app) {
  inputs::addMap(app, map);
  addMemoryOption(app, memory);
  poses::addPose(app, "--start", start, "Where the vehicle is")->required();
  poses::addPose(app, "--goal", goal, "Where the vehicle shall go")->required();
  app.add_option("--start-z", startZ, "Height, where the ground has several levels, m");
  app.add_option("--goal-z", goalZ, "Height of the goal, m");
  app.add_option("--order", order, "Classes from best to worst (YAML)")->required();
  app.add_option("--vehicle", vehicle, "The vehicle (YAML); without: a small robot");
  app.add_option("--weights", weights,
                 "Weights of classes for the compressed tree (YAML, as for semantic-map-compress); "
                 "without: what tells the ranks of --order apart");
  app.add_option("--solution", solution, "Name of one solution in the weights; without: the first")
      ->type_name("NAME")
      ->needs("--weights");
  app.add_option("--corridor", corridor,
                 "Distance from a coarse way within which ground is looked at, m; inf: all ground. "
                 "Without: 30 for folders of tiles, inf for other maps")
      ->check(moreThanZero);
  outputs.add(app, output, "FOLDER", "Folder of the results, created if need be")->required();
  planner.shorten = true;
  strict_files::OptionList options;
  planner.describe(options);
  addOptions(app, options, "Planner");
}

}  // namespace semantic_map_plan
