#pragma once
#include <map_folders/MapFolder.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "Outputs.h"

namespace semantic_map_plan {

/** What the command line says. */
struct Cli {
  std::filesystem::path map, order, vehicle, weights, output;
  double memory = semantic_octree::MapFolderOptions().memory;
  std::string solution;
  mrpt::math::TPose2D start, goal;
  std::optional<double> startZ, goalZ;
  std::optional<double> corridor;  ///< meters to each side; none: said nothing
  /** All but the vehicle. */
  semantic_planning::PlannerOptions planner;
  Outputs outputs;

  explicit Cli(CLI::App& app);
};

}  // namespace semantic_map_plan
