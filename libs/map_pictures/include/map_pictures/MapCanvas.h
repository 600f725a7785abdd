#pragma once
#include <map_pictures/MapPictures.h>
#include <mrpt/math/TPose2D.h>
#include <semantic_types/ClassTable.h>

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <variant>
#include <vector>

namespace map_pictures {

using semantic_types::Color;

// Drawing on pictures (BGR, 8 bits). Places are in pixels from the upper left corner, x right and
// y down: pixel (0, 0) reaches from 0 to 1.

/** Where a picture shows nothing: unknown and free space; of a map in the plane free space only. */
constexpr Color kPaper{250, 250, 250};
/** Unknown space of a map in the plane. */
constexpr Color kUnknown{205, 205, 205};
/** Text, scales and outlines. */
constexpr Color kInk{40, 45, 50};
/** Around lines and poses, so that they show on every class's color. */
constexpr Color kHalo{255, 255, 255};

inline cv::Scalar bgr(const Color& color) {
  return {double(color.b), double(color.g), double(color.r)};
}

struct Stroke {
  Color color = kInk;
  int width = 3;  ///< pixels
  int halo = 2;   ///< pixels on each side
};

/** A pose: a dot where it is, and an arrow where it looks. */
struct Arrow {
  Color color = kInk;
  double length = 22;  ///< pixels
  int halo = 2;        ///< pixels around
};

void drawLine(cv::Mat& picture, const std::vector<cv::Point2d>& points, const Stroke& stroke);

/** \param heading radians, counterclockwise from the right */
void drawArrow(cv::Mat& picture, const cv::Point2d& place, double heading, const Arrow& arrow);

/** Pixels. */
int textWidth(const std::string& text);

/** In DejaVu Sans; where it is not installed in OpenCV's own letters, which are those of ASCII.
 * \param text UTF-8 \param leftMiddle of the text */
void writeText(cv::Mat& picture, const std::string& text, const cv::Point& leftMiddle);

/** How coarse cells are drawn: stripes in a color and a paler one. */
struct Hatch {
  Color color;
};

/** A name, and how that looks in the picture: an area's color, a hatch, a line, or a pose. */
struct LegendEntry {
  std::string name;
  std::variant<Color, Hatch, Stroke, Arrow> look;
};

/** The classes that are there, the most frequent first, and "no class" at the end.
 * \param counts how much of each class, [0] of none */
std::vector<LegendEntry> classLegend(const semantic_types::ClassTable& classes,
                                     const std::vector<std::size_t>& counts);

/** What the hatch of MapCanvas::drawMap() means. */
LegendEntry coarseCellEntry();

/** The picture with all of the legend to its right, in as many columns as that needs. */
cv::Mat withLegend(const cv::Mat& picture, const std::string& title,
                   const std::vector<LegendEntry>& entries);

/** Pixels that one column of so many entries without a title needs. */
int legendHeight(std::size_t entries);

/** The picture with a line of text above. */
cv::Mat withTitle(const cv::Mat& picture, const std::string& title);

/** A bar of 1, 2 or 5 times a power of ten meters in the emptiest corner but that which is taken.
 */
void drawScaleBar(cv::Mat& picture, double pixelsPerMeter, const cv::Rect& taken = {});

/** The map's axes in the emptiest corner. \param directions of x, y, z in the picture (x right, y
 * down), at most of length 1; those that point at the viewer are left out
 * \return their place */
cv::Rect drawAxes(cv::Mat& picture, const std::array<cv::Point2d, 3>& directions);

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
   * (gray: none), shaded by the relief. Cells much coarser than the finest are hatched, for they
   * are not full of that class. Of a map in the plane, which is one layer of voxels, unknown space
   * is gray. Its classes are the first entries of the legend. \param style its heights and
   * occupancy \throw std::invalid_argument as PictureStyle::validate(). */
  void drawMap(const semantic_octree::SemanticOcTree& tree, const PictureStyle& style);
  /** Draws what of a map lies on the canvas or up to 5 m beside it, otherwise as drawMap(). That
   * part is drawn as finely as it can be, and cut off as if there were no more. The rest of a large
   * map is not looked at. */
  void drawMapAround(const semantic_octree::SemanticOcTree& tree, const PictureStyle& style);
  /** Copies what a canvas of the same scale shows of a part, m. The legend stays. */
  void paste(const MapCanvas& from, const Eigen::AlignedBox2d& part);
  /** A square with sides along the axes. \param edge m \param share (0 to 1) of the color; the rest
   * is what was there */
  void fillSquare(const Eigen::Vector2d& center, double edge, const Color& color, double share = 1);
  void drawLine(const std::vector<Eigen::Vector2d>& points, const Stroke& stroke);
  /** \param name in the legend; empty: none */
  void drawPose(const mrpt::math::TPose2D& pose, const Arrow& arrow, const std::string& name = {});
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
  /** The picture with axes and scale bar, and with the legend beside it. */
  cv::Mat sheet(const std::string& title = {}) const {
    return withLegend(withScale(), title, m_legend);
  }

 private:
  MapCanvas() = default;
  void drawCells(const MapCells& map, const semantic_octree::SemanticOcTree& tree);
  cv::Rect pixelsOf(const Eigen::Vector2d& low, const Eigen::Vector2d& high) const;

  Eigen::AlignedBox2d m_region;
  double m_pixelsPerMeter = 0;
  cv::Point2d m_origin;  ///< of the map's point (0, 0), pixels
  cv::Mat m_picture;
  std::vector<LegendEntry> m_legend;
};

}  // namespace map_pictures
