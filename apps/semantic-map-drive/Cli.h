#pragma once
#include <mrpt/math/TPose2D.h>

#include <map_folders/MapFolder.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "Outputs.h"
#include "simulated_drive/Events.h"

namespace semantic_map_drive {

using namespace simulated_drive;

/** What the command line says. */
struct Cli {
  std::filesystem::path map, config, output;
  std::filesystem::path weights;  ///< of what is explored for; empty: for whatever is unknown
  std::string solution;
  std::vector<std::filesystem::path> order;
  std::string scene = "village";
  std::uint64_t seed = 1;
  double hills = 1, pictureEvery = 0;
  double memory = semantic_octree::MapFolderOptions().memory;
  mrpt::math::TPose2D start, goal;
  bool rawlog = true, pictures = true, navlog = false, live = false, compressed = false;
  bool explore = false;
  Events events;
  Outputs outputs;

  explicit Cli(CLI::App& app);

 private:
  void addEvents(CLI::App& app);
};

}  // namespace semantic_map_drive
