#pragma once
#include <filesystem>
#include <vector>

#include "Outputs.h"
#include "map_window/Viewer.h"

namespace semantic_map_view {

struct Cli {
  std::vector<std::filesystem::path> maps;
  std::filesystem::path picture, animation, weights, classes;
  int width = 1280, height = 720;
  map_window::Beginning view;
  bool panels = true, measure = false, compress = false;
  Outputs outputs;

  explicit Cli(CLI::App& app);
};

}  // namespace semantic_map_view
