// Says what is in a semantic octree map, as a whole or at points.
#include <semantic_octree/TreeFile.h>

#include <filesystem>
#include <iostream>
#include <sstream>

#include "Application.h"
#include "Description.h"
#include "JsonFile.h"
#include "PointQuery.h"

namespace semantic_map_info {
namespace {

struct Cli {
  std::filesystem::path map, query;
  bool json = false;

  void addTo(CLI::App& app) {
    app.add_option("MAP", map, "A map's own file (.semantic)")->required();
    CLI::Option* asJson = app.add_flag("--json", json, "As JSON");
    app.add_option("--query", query, "File of lines `x y z`, m: what the map knows there")
        ->excludes(asJson);
  }
};

int run(const Cli& cli) {
  const auto map = semantic_octree::loadTree(cli.map.string());
  if (!cli.query.empty()) {
    std::ostringstream answers;  // all of them, or none
    answerPoints(map, strict_files::readLines(cli.query), answers);
    std::cout << answers.str();
  } else if (cli.json) {
    std::cout << textOf(describe(map));
  } else {
    printText(cli.map.string(), describe(map), std::cout);
  }
  return 0;
}

}  // namespace
}  // namespace semantic_map_info

int main(int argc, char** argv) {
  CLI::App app("Says what is in a semantic octree map");
  semantic_map_info::Cli cli;
  cli.addTo(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_info::run(cli); });
}
