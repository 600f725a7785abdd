// Says what is in a semantic octree map, as a whole or at points.
#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>
#include <strict_files/Words.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <ostream>
#include <string>

#include "Application.h"
#include "PointQuery.h"
#include "inputs/Inputs.h"

namespace semantic_map_info {
namespace {
using nlohmann::ordered_json;
using semantic_octree::FilterParameters;
using semantic_octree::MapContents;
using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;

ordered_json parametersJson(const FilterParameters& p) {
  return {{"accuracy", p.accuracy},
          {"labelCorrelation", p.labelCorrelation},
          {"hitProbability", p.hitProbability},
          {"falseAlarmProbability", p.falseAlarmProbability},
          {"minOccupancy", p.minOccupancy},
          {"maxProbability", p.maxProbability},
          {"softLabelFloor", p.softLabelFloor},
          {"calibration",
           {{"power", p.calibration.power},
            {"shared", p.calibration.shared},
            {"factors", p.calibration.factors}}}};
}

void addHalfLife(const SemanticOcTree& map, ClassId id, ordered_json& description) {
  const double seconds = map.classes().halfLife(id);
  if (seconds != semantic_types::kForever) description["halfLife"] = seconds;
}

ordered_json boxJson(const MapContents& contents) {
  if (contents.box.isEmpty()) return nullptr;
  const Eigen::Vector3d low = contents.box.min(), high = contents.box.max();
  return {{"min", {low.x(), low.y(), low.z()}}, {"max", {high.x(), high.y(), high.z()}}};
}

ordered_json classesJson(const SemanticOcTree& map, const MapContents& contents) {
  ordered_json classes = ordered_json::array();
  for (int id = 1; id <= map.numClasses(); ++id) {
    const auto& table = map.classes();
    const auto& color = table.color(static_cast<ClassId>(id));
    classes.push_back({{"id", id},
                       {"name", table.name(static_cast<ClassId>(id))},
                       {"color", {color.r, color.g, color.b}},
                       {"voxels", contents.voxelsOfClass[id]}});
    addHalfLife(map, static_cast<ClassId>(id), classes.back());
  }
  return classes;
}

ordered_json folderJson(const semantic_octree::MapFolder::Contents& folder,
                        const semantic_octree::MapFolder::Others& others) {
  return {{"tiles", folder.tiles},           {"tileSize", folder.tileSize},
          {"generation", folder.generation}, {"bytes", folder.bytesOnDisk},
          {"otherFiles", others.files},      {"otherBytes", others.bytes}};
}

void printBox(const ordered_json& box, std::ostream& out) {
  if (box.is_null()) {
    out << "nothing is known yet\n";
    return;
  }
  for (int axis = 0; axis < 3; ++axis)
    out << (axis ? ", " : "") << "xyz"[axis] << " " << box["min"][axis].get<double>() << " to "
        << box["max"][axis].get<double>();
  out << " m\n";
}

void printFolder(const ordered_json& folder, std::ostream& out) {
  out << "\n  folder        " << folder["tiles"] << " tiles of " << folder["tileSize"] << " m, "
      << strict_files::sizeText(folder["bytes"]) << ", saved " << folder["generation"]
      << (folder["generation"] == 1 ? " time" : " times");
  if (folder["otherFiles"] > 0)
    out << "\n  not of it     " << folder["otherFiles"] << " files, "
        << strict_files::sizeText(folder["otherBytes"])
        << ", that index.yaml does not name: of a process that writes, was killed, or others";
}

void printTime(const ordered_json& d, std::ostream& out) {
  const char* before = "";
  const auto say = [&](const std::string& name, const ordered_json& of) {
    if (!of.contains("halfLife")) return;
    out << before << name << " " << of["halfLife"] << " s";
    before = ", ";
  };
  out << "\n  clock         " << d["clock"] << " s\n  half-lives    ";
  for (const auto& c : d["classes"]) say(c["name"], c);
  say("free space", d["freeSpace"]);
}

/** All there is to say about a map but its voxels. \param path where it is */
ordered_json describe(semantic_octree::StoredMap& stored, const std::filesystem::path& path) {
  const SemanticOcTree& map = stored.tree();
  const MapContents contents = contentsOf(map);
  ordered_json description = {{"resolution", map.getResolution()},
                              {"nodes", map.size()},
                              {"leaves", contents.leaves},
                              {"innerNodes", contents.innerNodes},
                              {"bytes", contents.bytes},
                              {"boundingBox", boxJson(contents)},
                              {"freeVoxels", contents.freeVoxels},
                              {"occupiedVoxels", contents.occupiedVoxels},
                              {"occupiedWithoutClass", contents.voxelsOfClass[0]},
                              {"filter", parametersJson(map.filterParameters())},
                              {"classes", classesJson(map, contents)}};
  if (map.classes().hasHalfLives()) {
    description["clock"] = map.clock();
    description["freeSpace"] = ordered_json::object();
    addHalfLife(map, semantic_types::kNoClass, description["freeSpace"]);
  }
  if (stored.folder())
    description["folder"] =
        folderJson(stored.folder()->contents(), semantic_octree::MapFolder::othersAt(path));
  return description;
}

/** "hit_probability" of "hitProbability". */
std::string nameInFiles(const std::string& camelCase) {
  std::string name;
  for (const unsigned char c : camelCase)
    name += std::isupper(c) ? std::string("_") + static_cast<char>(std::tolower(c))
                            : std::string(1, static_cast<char>(c));
  return name;
}

/** Prints a description for people. \param d what describe() returned */
void printText(const std::string& name, const ordered_json& d, std::ostream& out) {
  out << name << "\n"
      << "  resolution    " << d["resolution"] << " m\n"
      << "  known space   ";
  printBox(d["boundingBox"], out);
  out << "  nodes         " << d["nodes"] << " (" << d["leaves"] << " leaves, " << d["innerNodes"]
      << " inner nodes)\n"
      << "  memory        " << strict_files::sizeText(d["bytes"]) << "\n"
      << "  voxels        " << d["occupiedVoxels"] << " occupied, " << d["freeVoxels"] << " free\n"
      << "  filter       ";
  for (const auto& [key, value] : d["filter"].items())
    if (!value.is_object())
      out << " " << nameInFiles(key) << " "
          << (value.is_string() ? value.get<std::string>() : value.dump());
  const ordered_json& calibration = d["filter"]["calibration"];
  const bool isCalibrated = calibration["power"] != 1.0 || calibration["shared"] != 0.0 ||
                            !calibration["factors"].empty();
  if (!isCalibrated)
    out << "\n  calibration   none";
  else
    out << std::setprecision(3)
        << "\n  calibration   the filter's class probabilities to the power of "
        << calibration["power"].get<double>() << "; " << 100 * calibration["shared"].get<double>()
        << " % spread evenly over the classes named in the voxel";
  if (const auto& factors = calibration["factors"]; !factors.empty())
    out << "; times factors of " << std::min_element(factors.begin(), factors.end())->get<double>()
        << " to " << std::max_element(factors.begin(), factors.end())->get<double>() << " by class";
  out << std::setprecision(6);
  if (d.contains("folder")) printFolder(d["folder"], out);
  if (d.contains("clock")) printTime(d, out);
  out << "\n  occupied voxels by likeliest class (the table has " << d["classes"].size() << ")\n";
  const auto line = [&out](const std::string& id, const ordered_json& voxels,
                           const std::string& label) {
    out << std::setw(7) << id << " " << std::setw(10) << voxels << "  " << label << "\n";
  };
  for (const auto& c : d["classes"])
    if (c["voxels"] > 0) line(c["id"].dump(), c["voxels"], c["name"]);
  if (d["occupiedWithoutClass"] > 0) line("-", d["occupiedWithoutClass"], "(no class was seen)");
}

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
    inputs::addMap(app, map);
    app.add_flag("--json", json, "Print JSON");
    app.add_option("--at", at, "What the map knows at this point, m; may be given several times")
        ->type_name("X,Y,Z")
        ->allow_extra_args(false)
        ->each([this](const std::string& text) { points.push_back(pointOf(text)); });
    app.add_option("--query", query,
                   "What it knows at each point of a file (lines: x y z), or of - (standard input)")
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

/** Names the tiles that cannot be read. \throw std::runtime_error there are some. */
void checkTiles(semantic_octree::MapFolder& folder) {
  const std::vector<std::string> problems = folder.problems();
  if (problems.empty()) return;
  for (const std::string& problem : problems)
    std::cerr << "  " << strict_files::printable(problem) << '\n';
  throw std::runtime_error("tiles that cannot be read (the others can, as by --at): " +
                           std::to_string(problems.size()));
}

int run(const Cli& cli) {
  if (cli.distribution && !cli.asksForPoints())
    throw CLI::RequiredError("--at or --query (with --distribution)");
  const auto map = inputs::openMap(cli.map, cli.memory);
  if (cli.asksForPoints()) {
    const auto answers = answersAt(map->tree(), pointsOf(cli), cli.distribution);
    std::cout << (cli.json ? textOf(answers) : textOfAnswers(answers));
    return 0;
  }
  const auto description = [&] {
    std::optional<inputs::TileProgress> progress;
    if (!cli.json) progress.emplace(std::vector{map.get()}, "Reading");
    if (map->folder()) checkTiles(*map->folder());
    return describe(*map, cli.map);
  }();
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
