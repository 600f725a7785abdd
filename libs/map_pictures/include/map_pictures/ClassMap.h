#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

namespace map_pictures {

/** A picture of the map from above that geographic software places by itself: north (up) is +y.
 *
 * The map is at the left, whole pixels for each column of voxels in the exact color of the
 * likeliest class of its highest occupied leaf; the legend at the right. It may have 10^8 pixels,
 * and is in memory as a compressed picture. */
class ClassMap {
 public:
  /** \param maxHeight leaves with their center above are not drawn, m; without: nothing is cut off,
   * except the ceiling of a map that lies under one
   * \param columnsAtOnce columns of voxels that are looked at together, some 30 bytes each; a row
   * at least. Of a map in a folder, each of these bands brings in its tiles \throw
   * std::runtime_error nothing is occupied, or the map is too wide for a picture. */
  explicit ClassMap(const semantic_octree::SemanticOcTree& tree,
                    const std::optional<double>& maxHeight = {}, int columnsAtOnce = 3000000);

  cv::Size size() const;  ///< pixels
  double metersPerPixel() const { return m_metersPerPixel; }
  /** The six lines of a world file (.pgw). */
  std::string worldFile() const;
  /** Hands the picture (BGR, 8 bits) over in bands from top to bottom. */
  void forEachBand(const std::function<void(const cv::Mat& rows)>& take) const;
  /** All of it. */
  cv::Mat picture() const;

 private:
  int m_scale = 1;                                 ///< pixels along a column's edge
  std::vector<std::vector<std::uint8_t>> m_bands;  ///< of the map, a pixel per column, PNG
  int m_width = 0;                                 ///< of the map, pixels
  cv::Mat m_legend;                                ///< as high as the picture
  double m_metersPerPixel = 0;
  cv::Point2d m_upperLeft;  ///< outer corner of pixel (0, 0), m, map frame
};

}  // namespace map_pictures
