#pragma once
#include <CLI/CLI.hpp>
#include <optional>

#include "NumberChecks.h"

/** --memory, of programs that read maps tile by tile. */
inline void addMemoryOption(CLI::App& app, double& megabytes) {
  app.add_option("--memory", megabytes, "Memory for the tiles of a map in a folder, MB")
      ->check(isNumber(strict_files::atLeast(0)))
      ->capture_default_str();
}

/** --tiles, of programs that write maps. */
inline void addTilesOption(CLI::App& app, std::optional<double>& edge) {
  app.add_option("--tiles", edge,
                 "Write a folder of tiles, cubes of this edge, m: 8, 16, 32 ... voxels")
      ->check(isNumber(strict_files::above(0)));
}
