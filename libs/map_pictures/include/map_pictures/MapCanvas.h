#pragma once
#include <map_pictures/MapPictures.h>
#include <map_pictures/Sheet.h>
#include <mrpt/math/TPose2D.h>

#include <Eigen/Geometry>
#include <functional>

namespace map_pictures {

struct MapCells;

/** A picture of a part of the ground from above, +x to the right and +y up, on which a map and what
 * lies on it is drawn. Places are in the map's frame, m; what lies outside is cut off. */
class MapCanvas {
 public:
  /** Empty paper, as large as fits. \param region m \param most pixels, the border included
   * \param border pixels around the region
   * \throw std::invalid_argument the region has no area, or `most` none within the border. */
  MapCanvas(const Eigen::AlignedBox2d& region, const cv::Size& most, int border = 0);
  /** Nearly all of a map, with a border. An empty map is empty paper of the style's size.
   * \throw std::invalid_argument as PictureStyle::validate(). */
  static MapCanvas ofMap(const semantic_octree::SemanticOcTree& tree, const PictureStyle& style);

  /** Empty paper of the same place, size and scale. */
  MapCanvas blank() const;

  MapCanvas(const MapCanvas&) = delete;
  MapCanvas& operator=(const MapCanvas&) = delete;
  MapCanvas(MapCanvas&&) = default;
  MapCanvas& operator=(MapCanvas&&) = default;

  double pixelsPerMeter() const { return m_pixelsPerMeter; }
  /** Where a place is, pixels: (0, 0) is the upper left corner of the picture. */
  cv::Point2d at(double x, double y) const {
    return {m_origin.x + x * m_pixelsPerMeter, m_origin.y - y * m_pixelsPerMeter};
  }

  /** The map from above: per column the highest occupied cell in the color of its likeliest class
   * (gray: none), shaded by the relief; cells much coarser than the finest are hatched, for they
   * are not full of that class. Its classes are the first entries of the legend. \param style its
   * heights and occupancy \throw std::invalid_argument as PictureStyle::validate(). */
  void drawMap(const semantic_octree::SemanticOcTree& tree, const PictureStyle& style);
  /** The same, of what lies on the canvas or up to 5 m beside it: as fine as that can be drawn, and
   * cut off as if there were no more. The rest of a large map is not looked at. */
  void drawMapAround(const semantic_octree::SemanticOcTree& tree, const PictureStyle& style);
  /** A square with sides along the axes. \param edge m */
  void fillSquare(const Eigen::Vector2d& center, double edge, const Color& color);
  void drawLine(const std::vector<Eigen::Vector2d>& points, const Stroke& stroke);
  void drawPose(const mrpt::math::TPose2D& pose, const Arrow& arrow);
  /** A closed outline, such as a vehicle's footprint, filled. */
  void fillOutline(const std::vector<Eigen::Vector2d>& corners, const Color& color);
  /** What `draw` draws on this canvas covers only that share (0 to 1) of what was there. */
  void drawThrough(double share, const std::function<void()>& draw);
  /** Adds to the legend. */
  void explain(const LegendEntry& entry) { m_legend.push_back(entry); }

  const std::vector<LegendEntry>& legend() const { return m_legend; }

  /** BGR: what was drawn so far, and nothing else. */
  const cv::Mat& picture() const { return m_picture; }
  /** With the axes and a scale bar in its emptiest corners; empty paper stays as it is. */
  cv::Mat withScale() const;
  /** With these, and with the legend beside it. */
  cv::Mat sheet(const std::string& title = {}) const {
    return withLegend(withScale(), title, m_legend);
  }

 private:
  MapCanvas() = default;
  void drawCells(const MapCells& map, const semantic_octree::SemanticOcTree& tree);

  Eigen::AlignedBox2d m_region;
  double m_pixelsPerMeter = 0;
  cv::Point2d m_origin;  ///< of the map's point (0, 0), pixels
  cv::Mat m_picture;
  std::vector<LegendEntry> m_legend;
};

}  // namespace map_pictures
