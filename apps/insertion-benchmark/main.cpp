#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "Application.h"
#include "Choice.h"
#include "NumberChecks.h"
#include "Report.h"

namespace {

using namespace insertion_benchmark;
using semantic_octree::InsertionOptions;

const char* const kReference = "semantic_octree with G";
const char* const kTraversal = "bare traversal of all rays";

std::vector<Entry> allEntries() {
  return {{kTraversal, denseTraversal},
          {"semantic_octree", semanticOcTree},
          {kReference, semanticOcTreeWithAbstraction},
          {"octomap::OcTree", octomapOcTree},
          {"octomap::OcTree, discretized", octomapDiscretized},
          {"octomap::ColorOcTree", octomapColorOcTree},
          {"mrpt::maps::COctoMap", mrptOctoMap}};
}

struct Cli {
  CLI::App app{"Measures the insertion of labeled scans, next to other maps, in one run."};
  std::filesystem::path rawlog, classes;
  Settings settings;
  std::size_t scans = 0;
  int repeats = 3;
  std::string only;
  bool json = false;

  Cli() {
    app.add_option("RAWLOG", rawlog, "Rawlog with labels and poses of the robot")->required();
    app.add_option("--classes", classes, "Class table (YAML)")->required();
    app.add_option("--resolution", settings.resolution, "Edge of a voxel, m")
        ->check(isNumber(strict_files::above(0)))
        ->capture_default_str();
    app.add_option("--range", settings.maxRange, "Maximum range, m; 0: none")
        ->check(isNumber(strict_files::atLeast(0)))
        ->capture_default_str();
    app.add_option("--scans", scans, "Number of scans; 0: all")->capture_default_str();
    addChoice(app.add_option("--rays", settings.rays,
                             "Our rays: all, or one for each end voxel (endpoints)"),
              std::map<std::string, InsertionOptions::Rays>{
                  {"all", InsertionOptions::Rays::All},
                  {"endpoints", InsertionOptions::Rays::EndVoxels}});
    app.add_option("--terms", settings.terms, "Information terms to keep up to date")
        ->check(isNumber(strict_files::between(1, 8)))
        ->capture_default_str();
    app.add_option("--threads", settings.threads, "Our threads")
        ->check(isNumber(strict_files::between(1, 256)))
        ->capture_default_str();
    app.add_option("--repeats", repeats, "Measurements of each runner")
        ->check(isNumber(strict_files::between(1, 1000)))
        ->capture_default_str();
    app.add_option("--only", only,
                   "Measure only runners whose names contain this, and the bare traversal");
    app.add_flag("--json", json, "JSON instead of a table");
  }
};

std::vector<Entry> chosenEntries(const std::string& only) {
  std::vector<Entry> entries = allEntries();
  entries.erase(std::remove_if(entries.begin(), entries.end(),
                               [&](const Entry& e) {
                                 return e.name != kTraversal &&
                                        e.name.find(only) == std::string::npos;
                               }),
                entries.end());
  return entries;
}

/** On a terminal, what is said next stands in place of the line that was begun. */
void clearLine() {
  if (isatty(STDERR_FILENO)) std::fputs("\r\033[K", stderr);
}

int run(const Cli& cli) {
  const Scene scene = sceneOf(cli.rawlog, cli.classes, cli.scans);
  if (scene.scans.empty()) throw std::runtime_error(cli.rawlog.string() + ": no scans");

  Conditions conditions{cli.rawlog.filename().string(),
                        scene.scans.size(),
                        scene.numPoints(),
                        cli.settings,
                        cli.repeats,
                        0,
                        0};
  getloadavg(&conditions.loadAverage, 1);
  const std::vector<Result> results =
      compare(chosenEntries(cli.only), scene, cli.settings, cli.repeats, [&](const auto& name) {
        clearLine();
        if (isatty(STDERR_FILENO)) std::cerr << name << std::flush;
      });
  clearLine();
  conditions.touchedVoxels = results.front().touchedVoxels;
  (cli.json ? printJson : printTable)(std::cout, conditions, results, kReference);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Cli cli;
  return runApplication(cli.app, argc, argv, [&] { return run(cli); });
}
