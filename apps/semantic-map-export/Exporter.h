#pragma once
#include <semantic_map/MapFiles.h>
#include <strict_files/OutputFiles.h>

#include <filesystem>
#include <functional>
#include <list>
#include <optional>
#include <ostream>
#include <string>

#include "CostGrid.h"

namespace semantic_map_export {

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
  static std::string formats();
  /** The file and what is written beside it.
   * \throw std::runtime_error naming the file: no format has its ending. */
  static std::vector<std::filesystem::path> filesOf(const std::filesystem::path& file,
                                                    const ExportOptions& options);

  /** Writes a file, and what belongs beside it, in the format that its ending says.
   * \throw std::exception naming the file. */
  void write(const std::filesystem::path& file);
  /** \return the files. \throw std::runtime_error naming a file. */
  std::vector<std::filesystem::path> commit();

 private:
  using Writer = std::function<void(std::ostream&)>;
  using Filler = std::function<void(const std::filesystem::path&)>;
  struct Format;
  static const std::vector<Format>& allFormats();
  static const Format& formatOf(const std::filesystem::path& file);

  void stage(const std::filesystem::path& file, const Writer& writer);
  void stageFile(const std::filesystem::path& file, const Filler& fill);
  void writeOctree(const std::filesystem::path& file);
  void writeClassMap(const std::filesystem::path& file);
  void writeMapServer(const std::filesystem::path& file);
  void writeCosts(const std::filesystem::path& file);
  void writeScene(const std::filesystem::path& file);

  struct Staged {
    explicit Staged(const std::filesystem::path& path) : target(path), file(path) {}
    std::filesystem::path target;
    strict_files::StagedFile file;
  };

  const semantic_octree::SemanticOcTree& m_map;
  ExportOptions m_options;
  std::list<Staged> m_staged;
};

}  // namespace semantic_map_export
