#pragma once
#include <map_view/CellLook.h>
#include <map_view/OrbitCamera.h>

#include <filesystem>
#include <optional>
#include <vector>

#include "Outputs.h"

namespace semantic_map_view {

struct Cli {
  std::vector<std::filesystem::path> maps;
  std::filesystem::path picture, weights, classes;
  int width = 1280, height = 720;
  std::optional<map_view::OrbitCamera> camera;
  bool top = false, panels = true, measure = false, compress = false;
  map_view::ViewStyle style;
  Outputs outputs;

  explicit Cli(CLI::App& app);
};

}  // namespace semantic_map_view
