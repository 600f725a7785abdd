#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "Outputs.h"
#include "Study.h"

namespace planning_study {

/** What the command line says. */
struct Cli {
  std::vector<std::filesystem::path> maps;
  std::filesystem::path classes, vehicle, output;
  StudyOptions study;
  bool join = false;  ///< maps are folders of results

  Outputs outputs;

  explicit Cli(CLI::App& app);

 private:
  void addTo(CLI::App& app);
};

/** A short name for each map: the file's, or its folder's if the file is called "map".
 * \throw std::runtime_error two have the same. */
std::vector<std::string> namesOf(const std::vector<std::filesystem::path>& maps);

}  // namespace planning_study
