// Says what is in a semantic octree map, as a whole or at points.
#include <map_folders/MapFolder.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>

#include "Application.h"
#include "Description.h"
#include "JsonFile.h"
#include "MemoryOption.h"
#include "PointQuery.h"

namespace semantic_map_info {
namespace {

/** \throw CLI::ValidationError it is no point. */
strict_files::TextLine pointOf(const std::string& text) {
  strict_files::TextLine line{text, "--at"};
  std::replace(line.text.begin(), line.text.end(), ',', ' ');
  try {
    numbersOf(line, 3);
  } catch (const std::runtime_error&) {
    throw CLI::ValidationError("--at", "expected X,Y,Z (meters), found '" + text + "'");
  }
  return line;
}

struct Cli {
  std::filesystem::path map;
  std::string query;
  std::vector<std::string> at;
  std::vector<strict_files::TextLine> points;
  bool json = false, distribution = false;
  double memory = semantic_octree::MapFolderOptions().memory;

  explicit Cli(CLI::App& app) {
    app.add_option("MAP", map, "A map's own file (.semantic), or a folder of tiles")->required();
    app.add_flag("--json", json, "Print JSON");
    app.add_option("--at", at, "What the map knows at this point, m; may be given several times")
        ->type_name("X,Y,Z")
        ->allow_extra_args(false)
        ->each([this](const std::string& text) { points.push_back(pointOf(text)); });
    app.add_option("--query", query,
                   "What it knows at each line `x y z` of a file, or of - (standard input)")
        ->type_name("FILE");
    app.add_flag("--distribution", distribution,
                 "Print the probabilities of all classes at these points, too");
    addMemoryOption(app, memory);
  }
  bool asksForPoints() const { return !at.empty() || !query.empty(); }
};

std::vector<strict_files::TextLine> pointsOf(const Cli& cli) {
  std::vector<strict_files::TextLine> points = cli.points;
  if (cli.query.empty()) return points;
  const auto lines =
      cli.query == "-" ? strict_files::linesOf({std::istreambuf_iterator<char>(std::cin), {}}, "-")
                       : strict_files::readLines(cli.query);
  points.insert(points.end(), lines.begin(), lines.end());
  return points;
}

/** \throw std::runtime_error naming all tiles that cannot be read. */
void checkTiles(semantic_octree::MapFolder& folder) {
  const std::vector<std::string> problems = folder.problems();
  if (problems.empty()) return;
  std::string text =
      "tiles that cannot be read (the others can, as by --at): " + std::to_string(problems.size());
  for (const std::string& problem : problems) text += "\n  " + problem;
  throw std::runtime_error(text);
}

int run(const Cli& cli) {
  if (cli.distribution && !cli.asksForPoints())
    throw CLI::RequiredError("--at or --query (with --distribution)");
  semantic_octree::StoredMap map(cli.map, cli.memory);
  if (cli.asksForPoints()) {
    const auto answers = answersAt(map.tree(), pointsOf(cli), cli.distribution);
    std::cout << (cli.json ? textOf(answers) : textOfAnswers(answers));
    return 0;
  }
  if (map.folder()) checkTiles(*map.folder());
  const auto description = describe(map, cli.map);
  if (cli.json)
    std::cout << textOf(description);
  else
    printText(cli.map.string(), description, std::cout);
  return 0;
}

}  // namespace
}  // namespace semantic_map_info

int main(int argc, char** argv) {
  CLI::App app("Says what is in a semantic octree map");
  const semantic_map_info::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_info::run(cli); });
}
