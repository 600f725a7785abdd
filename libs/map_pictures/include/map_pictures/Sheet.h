#pragma once
#include <map_pictures/Drawing.h>

#include <array>
#include <cstddef>
#include <variant>

namespace map_pictures {

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

}  // namespace map_pictures
