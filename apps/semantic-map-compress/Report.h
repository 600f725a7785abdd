#pragma once
#include <map_pictures/MapCanvas.h>
#include <semantic_octree/SemanticOcTree.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "Compressor.h"

namespace semantic_map_compress {

/** Maps of the same place from above, side by side, each with its title: the first one's extent, at
 * one scale. */
class MapSheet {
 public:
  /** \param numMaps that will be added: the more, the smaller. */
  explicit MapSheet(std::size_t numMaps);

  void add(const semantic_octree::SemanticOcTree& map, const std::string& title);
  /** All maps in rows, and to their right the legend of all. BGR. */
  cv::Mat picture() const;

 private:
  void explain(const map_pictures::LegendEntry& entry);

  int m_columns;
  cv::Size m_tile;
  std::optional<map_pictures::MapCanvas> m_first;
  std::vector<map_pictures::LegendEntry> m_legend;
  std::vector<cv::Mat> m_tiles;
};

// Figures about all solutions, drawn with gnuplot into a PNG file.
// All: \throw std::runtime_error as drawWithGnuplot().

/** Share of the information kept, per class and solution; below, the share of leaves. Classes that
 * the map does not show are left out. */
void drawRetained(const FullMap& map, const std::vector<Compression>& compressions,
                  const TermCatalog& catalog, const std::filesystem::path& file);

/** Information kept over the number of leaves, for all alphas; the chosen one is marked. */
void drawCurves(const std::vector<Compression>& compressions, const std::filesystem::path& file);

/** Everything about all solutions, informations in bits. */
nlohmann::ordered_json toJson(const FullMap& map, const TermCatalog& catalog,
                              const std::vector<Compression>& compressions,
                              const StageTimer& times);

/** One line a solution with what its report has, but for lists and weights; the first line names
 * the columns by their places in the report: /tree/knownLeaves. */
std::string toCsv(const nlohmann::ordered_json& report);

}  // namespace semantic_map_compress
