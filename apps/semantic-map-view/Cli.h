#pragma once
#include <filesystem>
#include <vector>

#include "Outputs.h"
#include "map_window/Viewer.h"

namespace semantic_map_view {

using namespace map_window;

struct Cli {
  std::vector<std::filesystem::path> files;
  std::filesystem::path picture, animation, weights, classes;
  double memory = semantic_octree::MapFolderOptions().memory;
  int width = 1280, height = 720;
  Beginning view;
  bool panels = true, compress = false;
  Outputs outputs;

  explicit Cli(CLI::App& app);
  WantedTiles wantedTiles() const { return {memory, view.style.clip}; }
};

}  // namespace semantic_map_view
