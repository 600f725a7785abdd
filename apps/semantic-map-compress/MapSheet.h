#pragma once
#include <semantic_map/MapPictures.h>

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace semantic_map_compress {

/** renderTopView(), but empty for a map whose leaves are too large to draw: of one that was
 * compressed to its root. */
cv::Mat topView(const semantic_octree::SemanticOcTree& map,
                const semantic_map::PictureStyle& style);

/** Maps of the same place from above, side by side, each with its title. */
class MapSheet {
 public:
  /** \param numMaps that will be added: the more, the smaller. */
  explicit MapSheet(std::size_t numMaps);

  void add(const semantic_octree::SemanticOcTree& map, const std::string& title);
  /** All maps in rows, and to their right the first one's legend. BGR. */
  cv::Mat picture() const;

 private:
  int m_columns;
  cv::Size m_tile;
  cv::Mat m_legend;
  std::vector<cv::Mat> m_tiles;
};

}  // namespace semantic_map_compress
