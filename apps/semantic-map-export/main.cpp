// Writes a semantic octree map into files that other programs read.
#include <map_operations/MapOperations.h>
#include <map_pictures/MapPictures.h>
#include <mrpt_compat/Drawing.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_map/MapFiles.h>
#include <semantic_planning/planner/OrderFile.h>
#include <strict_files/OutputFiles.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <list>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>

#include "Application.h"
#include "CostGrid.h"
#include "inputs/Inputs.h"

namespace semantic_map_export {
namespace {

namespace fs = std::filesystem;
using semantic_types::ClassTable;

/** Makes .yaml files costs of driving, not occupancy. */
struct CostOptions {
  std::filesystem::path order,
      vehicle;  ///< an empty order: occupancy; an empty vehicle: a small robot
  CostMode mode = CostMode::Trinary;
};

struct ExportOptions {
  bool colors = true;  ///< in .ot files
  semantic_map::PointOptions points;
  semantic_map::GridOptions grid;
  std::optional<double> maxHeight;  ///< of pictures, m
  CostOptions costs;
};

/** Writes a map into files of other formats. They take their names together, in commit(): what was
 * there stays if any of them fails. */
class Exporter {
 public:
  /** The map must outlive the exporter. */
  Exporter(const semantic_octree::SemanticOcTree& map, ExportOptions options)
      : m_map(map), m_options(std::move(options)) {}

  /** What can be written: endings with a few words. */
  static std::string formats() {
    std::string text;
    for (const Format& format : allFormats())
      text += std::string(text.empty() ? "" : "; ") + format.ending + ": " + format.description;
    return text;
  }

  /** The file and what is written beside it.
   * \throw std::runtime_error naming the file: no format has its ending. */
  static std::vector<fs::path> filesOf(const fs::path& file, const ExportOptions& options) {
    std::vector<fs::path> files = {file};
    const char* beside = formatOf(file).beside;
    if (file.extension() == ".yaml" && !options.costs.order.empty())
      beside = endingOf(options.costs.mode);
    if (beside) files.push_back(fs::path(file).replace_extension(beside));
    return files;
  }

  /** Writes a file, and what belongs beside it, in the format that its ending says.
   * \throw std::exception naming the file. */
  void write(const fs::path& file) {
    try {
      (this->*formatOf(file).write)(file);
    } catch (const std::exception& e) {
      const std::string message = e.what();
      const bool named = message.find(file.stem().string() + ".") != std::string::npos;
      throw std::runtime_error(named ? message : file.string() + ": " + message);
    }
  }

  /** \return the files. \throw std::runtime_error naming a file. */
  std::vector<fs::path> commit() {
    std::vector<fs::path> files;
    for (Staged& staged : m_staged) {
      staged.file.commit();
      files.push_back(staged.target);
    }
    m_staged.clear();
    return files;
  }

 private:
  struct Format {
    const char* ending;
    const char* description;
    void (Exporter::*write)(const fs::path& file);
    const char* beside = nullptr;  ///< ending of a second file
  };
  struct Staged {
    explicit Staged(const fs::path& path) : target(path), file(path) {}
    fs::path target;
    strict_files::StagedFile file;
  };

  static const std::vector<Format>& allFormats() {
    static const std::vector<Format> formats = {
        {".ot", "OctoMap's tree, in colors of classes", &Exporter::writeOctree},
        {".bt", "OctoMap's binary tree", &Exporter::writeBinaryOctree},
        {".ply", "points with class, probability and color", &Exporter::writePoints},
        {".csv", "the same as a table", &Exporter::writeTable},
        {".gridmap", "MRPT's 2D occupancy grid", &Exporter::writeGrid},
        {".yaml", "the same for ROS's map_server, with a .png", &Exporter::writeMapServer, ".png"},
        {".png", "classes from above, with a world file (.pgw)", &Exporter::writeClassMap, ".pgw"},
        {".3Dscene", "MRPT's scene", &Exporter::writeScene}};
    return formats;
  }

  static const Format& formatOf(const fs::path& file) {
    std::string endings;
    for (const Format& format : allFormats()) {
      if (file.extension() == format.ending) return format;
      endings += std::string(" ") + format.ending;
    }
    throw std::runtime_error(file.string() + ": the ending says no format, expected one of" +
                             endings);
  }

  /** Where to write what becomes this file. */
  fs::path staged(const fs::path& file) {
    return m_staged.emplace_back(file.lexically_normal()).file.path();
  }

  template <class Writer>
  void stage(const fs::path& file, const Writer& write) {
    const fs::path place = staged(file);
    errno = 0;
    std::ofstream out(place, std::ios::binary);
    try {
      write(out);
      out.close();
    } catch (const std::exception&) {
      if (out) throw;
    }
    if (!out)
      throw std::runtime_error(file.string() + ": cannot be written: " + std::strerror(errno));
  }

  /** A floor at a wrong height makes obstacles of nearly everything: that is said. */
  mrpt::maps::COccupancyGridMap2D grid() const {
    auto grid = semantic_map::gridOf(m_map, m_options.grid);
    constexpr double kFew = 0.1;
    double free = 0, occupied = 0;
    for (int y = 0; y < int(grid.getSizeY()); ++y)
      for (int x = 0; x < int(grid.getSizeX()); ++x) {
        const float p = grid.getCell(x, y);
        (p > 0.5f ? free : occupied) += p == 0.5f ? 0 : 1;
      }
    if (m_options.grid.floor && free < kFew * occupied)
      notes() << "Warning: " << std::lround(100 * occupied / (free + occupied))
              << " % of the grid's known cells are obstacles. Is the ground at "
              << *m_options.grid.floor << " m? Without --floor it is found in the map."
              << std::endl;
    return grid;
  }

  void writeOctree(const fs::path& file) {
    stage(file, [this](std::ostream& out) {
      m_options.colors ? writeColorOcTree(out, m_map) : writeOcTree(out, m_map);
    });
  }
  void writeBinaryOctree(const fs::path& file) {
    stage(file, [this](std::ostream& out) { writeBinaryOcTree(out, m_map); });
  }
  void writePoints(const fs::path& file) {
    stage(file,
          [this](std::ostream& out) { semantic_map::writePly(out, m_map, m_options.points); });
  }
  void writeTable(const fs::path& file) {
    stage(file,
          [this](std::ostream& out) { semantic_map::writeCsv(out, m_map, m_options.points); });
  }
  void writeGrid(const fs::path& file) {
    stage(file, [this](std::ostream& out) { semantic_map::writeGridMap(out, grid()); });
  }

  void writeClassMap(const fs::path& file) {
    const auto drawn = map_pictures::drawClassMap(m_map, m_options.maxHeight);
    map_pictures::savePicture(drawn.picture, staged(file));
    stage(fs::path(file).replace_extension(".pgw"),
          [&drawn](std::ostream& out) { out << drawn.worldFile; });
  }

  void writeCosts(const fs::path& file) {
    const CostOptions& costs = m_options.costs;
    const auto order = semantic_planning::loadClassOrder(costs.order, m_map.classes());
    const auto vehicle = costs.vehicle.empty() ? semantic_planning::VehicleOptions()
                                               : semantic_planning::loadVehicle(costs.vehicle);
    const fs::path picture = fs::path(file).replace_extension(endingOf(costs.mode));
    const CostFiles files =
        semantic_map_export::filesOf(costGridOf(m_map, order, vehicle, m_options.grid.floor),
                                     costs.mode, picture.filename().string());
    stage(file, [&files](std::ostream& out) { out << files.yaml; });
    stage(picture, [&files](std::ostream& out) { out << files.picture; });
  }

  void writeMapServer(const fs::path& file) {
    if (!m_options.costs.order.empty()) return writeCosts(file);
    const fs::path picture = fs::path(file).replace_extension(".png");
    const auto files = semantic_map::mapServerFiles(grid(), picture.filename().string());
    stage(file, [&files](std::ostream& out) { out << files.yaml; });
    stage(picture, [&files](std::ostream& out) { out << files.png; });
  }

  void writeScene(const fs::path& file) {
    semantic_octree::SemanticOcTree copy = semantic_octree::emptyLike(m_map);
    copyTo(copy, m_map);
    semantic_map::CSemanticOctoMap map(std::move(copy));
    if (m_options.maxHeight) map.renderingOptions.maxHeight = *m_options.maxHeight;
    const auto objects = mrpt_compat::drawing::CSetOfObjects::Create();
    map.getVisualizationInto(*objects);
    mrpt_compat::Scene scene;
    scene.insert(objects);
    semantic_map::writeScene(scene, staged(file));
  }

  const semantic_octree::SemanticOcTree& m_map;
  ExportOptions m_options;
  std::list<Staged> m_staged;
};

struct Cli {
  fs::path map;
  std::vector<fs::path> files;
  std::vector<std::string> ground;
  ExportOptions options;
  double memory = semantic_octree::MapFolderOptions().memory;
  Outputs outputs;

  explicit Cli(CLI::App& app) : outputs(app) {
    inputs::addMap(app, map);
    addMemoryOption(app, memory);
    outputs
        .add(app, files, "FILE",
             "File to write, may be given several times: " + Exporter::formats())
        ->required();
    app.add_flag("!--no-colors", options.colors, ".ot: an OcTree without colors");
    app.add_flag("--free", options.points.free, ".ply, .csv: free leaves, too");
    app.add_option("--max-height", options.maxHeight,
                   ".png, .3Dscene: nothing above this height, m");
    addOptions(app, strict_files::OptionList::of(options.points.smoothing),
               "Classes that neighbors tell (.ply, .csv)");
    const std::string kGrids = "2D grids (.gridmap, .yaml)";
    addOptions(app, strict_files::OptionList::of(options.grid), kGrids);
    app.add_option(
           "--ground", ground,
           "Class of the ground, may be given several times; without: the lowest voxel of each "
           "column is ground")
        ->type_name("CLASS")
        ->allow_extra_args(false)
        ->group(kGrids);
    addCosts(app);
  }

 private:
  void addCosts(CLI::App& app) {
    auto* costs = app.add_option_group("Costs (.yaml, for nav2 and map_server)", "");
    auto* order = costs->add_option(
        "--costs", options.costs.order,
        "Classes from best to worst (YAML): write costs of driving, not occupancy");
    costs
        ->add_option("--vehicle", options.costs.vehicle,
                     "The vehicle (YAML); without: a small robot")
        ->needs(order);
    addChoice<CostMode>(
        costs->add_option("--mode", options.costs.mode,
                          "Mode in which map_server reads the picture"),
        {{"trinary", CostMode::Trinary}, {"scale", CostMode::Scale}, {"raw", CostMode::Raw}})
        ->needs(order);
  }
};

std::vector<semantic_types::ClassId> classesNamed(const std::vector<std::string>& names,
                                                  const ClassTable& classes) {
  std::vector<semantic_types::ClassId> ids;
  for (const std::string& name : names) {
    const auto id = classes.find(name);
    if (!id) throw std::runtime_error("--ground: the map has no class '" + name + "'");
    ids.push_back(*id);
  }
  return ids;
}

std::vector<fs::path> allFiles(const std::vector<fs::path>& files, const ExportOptions& options) {
  std::vector<fs::path> all;
  for (const fs::path& file : files)
    for (const fs::path& each : Exporter::filesOf(file, options)) all.push_back(each);
  return all;
}

bool hasScene(const std::vector<fs::path>& files) {
  return std::any_of(files.begin(), files.end(),
                     [](const fs::path& file) { return file.extension() == ".3Dscene"; });
}

/** A scene is made of a copy of the map; neighbors may lie in other tiles than what is gone
 * through. */
void prepare(semantic_octree::StoredMap& map, const Cli& cli) {
  const inputs::TileProgress progress({&map}, "Reading");
  if (hasScene(cli.files)) map.folder()->checkFits();
  if (cli.options.points.smoothing.neighborWeight > 0) map.folder()->bringAll();
}

void writeAll(const Cli& cli, semantic_octree::StoredMap& map, Exporter& exporter) {
  if (map.folder()) prepare(map, cli);
  for (const fs::path& file : cli.files) {
    const inputs::TileProgress progress({&map}, "Writing " + file.filename().string());
    exporter.write(file);
  }
}

int run(const Cli& cli) {
  cli.outputs.check(allFiles(cli.files, cli.options));
  const auto map = inputs::openMap(cli.map, cli.memory);
  ExportOptions options = cli.options;
  options.grid.ground = classesNamed(cli.ground, map->tree().classes());
  Exporter exporter(map->tree(), options);
  writeAll(cli, *map, exporter);
  for (const fs::path& file : exporter.commit()) notes() << file.string() << '\n';
  return 0;
}

}  // namespace

}  // namespace semantic_map_export

int main(int argc, char** argv) {
  CLI::App app("Writes a semantic octree map into files that other programs read");
  const semantic_map_export::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_export::run(cli); });
}
