// Writes a semantic octree map into files that other programs read.
#include <map_operations/MapOperations.h>
#include <map_pictures/MapPictures.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt_compat/Drawing.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_map/MapFiles.h>
#include <semantic_planning/planner/OrderFile.h>
#include <strict_files/OutputFiles.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <list>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>

#include "Application.h"
#include "GridFiles.h"
#include "inputs/Inputs.h"

namespace semantic_map_export {
namespace {

namespace fs = std::filesystem;
using semantic_types::ClassTable;

struct ExportOptions {
  bool colors = true;               ///< in .ot files
  bool free = false;                ///< leaves, as points
  std::optional<double> maxHeight;  ///< of pictures, m
  std::optional<double> floor;      ///< of 2D grids, m
  fs::path order;                   ///< makes .yaml files costs of driving; empty: occupancy
  fs::path vehicle;                 ///< empty: a small robot
  CostMode mode = CostMode::Trinary;

  const char* endingOfPicture() const {
    return order.empty() || mode == CostMode::Scale ? ".png" : ".pgm";
  }
};

/** Writes a map into files of other formats. They take their names together, in commit(): what was
 * there stays if any of them fails. */
class Exporter {
 public:
  /** The map must outlive the exporter. */
  Exporter(semantic_octree::SemanticOcTree& map, ExportOptions options)
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
    if (file.extension() == ".yaml") beside = options.endingOfPicture();
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

  Grid grid() const {
    semantic_planning::PlannerOptions options;
    if (!m_options.vehicle.empty())
      options.vehicle = semantic_planning::loadVehicle(m_options.vehicle);
    if (m_options.order.empty()) return gridOf(m_map, options.vehicle, m_options.floor);
    const auto order = semantic_planning::loadClassOrder(m_options.order, m_map.classes());
    ground_costs::GroundCosts costs(m_map, order, options, {});
    costs.takeLargestPart(m_options.floor);
    return gridOf(costs);
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
    stage(file, [this](std::ostream& out) { semantic_map::writePly(out, m_map, m_options.free); });
  }
  void writeTable(const fs::path& file) {
    stage(file, [this](std::ostream& out) { semantic_map::writeCsv(out, m_map, m_options.free); });
  }
  void writeGrid(const fs::path& file) {
    mrpt::io::CMemoryStream bytes;
    mrpt::serialization::archiveFrom(bytes) << occupancyOf(grid());
    stage(file, [&bytes](std::ostream& out) {
      out.write(static_cast<const char*>(bytes.getRawBufferData()),
                std::streamsize(bytes.getTotalBytesCount()));
    });
  }

  void writeClassMap(const fs::path& file) {
    const auto drawn = map_pictures::drawClassMap(m_map, m_options.maxHeight);
    map_pictures::savePicture(drawn.picture, staged(file));
    stage(fs::path(file).replace_extension(".pgw"),
          [&drawn](std::ostream& out) { out << drawn.worldFile; });
  }

  void writeMapServer(const fs::path& file) {
    const Grid made = grid();
    const fs::path picture = fs::path(file).replace_extension(m_options.endingOfPicture());
    const CostMode mode = m_options.mode;
    stage(file, [&](std::ostream& out) { out << yamlOf(made, mode, picture.filename().string()); });
    stage(picture,
          [&](std::ostream& out) { out << pictureOf(made, mode, picture.extension().string()); });
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

  semantic_octree::SemanticOcTree& m_map;
  ExportOptions m_options;
  std::list<Staged> m_staged;
};

struct Cli {
  fs::path map;
  std::vector<fs::path> files;
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
    app.add_flag("--free", options.free, ".ply, .csv: free leaves, too");
    app.add_option("--max-height", options.maxHeight,
                   ".png, .3Dscene: nothing above this height, m");
    const std::string kGrids = "2D grids (.gridmap, .yaml)";
    app.add_option("--vehicle", options.vehicle, "The vehicle (YAML); without: a small robot")
        ->group(kGrids);
    app.add_option("--floor", options.floor,
                   "Height of the ground, if it is flat, or of a storey's (--costs), m")
        ->group(kGrids);
    auto* costs = app.add_option_group("Costs (.yaml, for nav2 and map_server)", "");
    auto* order = costs->add_option(
        "--costs", options.order,
        "Classes from best to worst (YAML): write costs of driving, not occupancy");
    addChoice<CostMode>(
        costs->add_option("--mode", options.mode, "Mode in which map_server reads the picture"),
        {{"trinary", CostMode::Trinary}, {"scale", CostMode::Scale}, {"raw", CostMode::Raw}})
        ->needs(order);
  }
};

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

void writeAll(const Cli& cli, semantic_octree::StoredMap& map, Exporter& exporter) {
  if (map.folder() && hasScene(cli.files)) map.folder()->checkFits();  // it is of a copy
  for (const fs::path& file : cli.files) {
    const inputs::TileProgress progress({&map}, "Writing " + file.filename().string());
    exporter.write(file);
  }
}

int run(const Cli& cli) {
  cli.outputs.check(allFiles(cli.files, cli.options));
  const auto map = inputs::openMap(cli.map, cli.memory);
  Exporter exporter(map->tree(), cli.options);
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
