#pragma once
#include <CLI/CLI.hpp>

#include "NumberChecks.h"

/** --memory, of programs that read maps tile by tile. */
inline void addMemoryOption(CLI::App& app, double& megabytes) {
  app.add_option("--memory", megabytes,
                 "Of a map in a folder of tiles, so many MB are in memory at a time")
      ->check(isNumber(strict_files::atLeast(0)))
      ->capture_default_str();
}
