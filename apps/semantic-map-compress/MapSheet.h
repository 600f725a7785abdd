#pragma once
#include <map_pictures/MapCanvas.h>
#include <semantic_octree/SemanticOcTree.h>

#include <optional>
#include <string>
#include <vector>

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

}  // namespace semantic_map_compress
