#pragma once
#include <semantic_map/MapPictures.h>

#include <array>
#include <string>
#include <vector>

namespace semantic_map {

const cv::Scalar kPaper(250, 250, 250);
const cv::Scalar kInk(50, 45, 40);

struct LegendEntry {
  std::string name;
  cv::Scalar color;
};

/** The classes that are there, the most frequent first, and "no class" at the end. \param counts
 * see MapCells::countClasses() */
std::vector<LegendEntry> legendOf(const semantic_types::ClassTable& classes,
                                  const std::vector<std::size_t>& counts);

/** The picture with a legend to its right; as many entries as fit. */
cv::Mat withLegend(const cv::Mat& picture, const std::string& title,
                   const std::vector<LegendEntry>& entries);

/** A bar of 1, 2 or 5 times a power of ten meters in the emptiest corner. */
void drawScaleBar(cv::Mat& picture, double pixelsPerMeter);

/** The map's axes in the emptiest corner. \param directions of x, y, z in the picture (x right, y
 * down), at most of length 1; those that point at the viewer are left out */
void drawAxes(cv::Mat& picture, const std::array<cv::Point2d, 3>& directions);

}  // namespace semantic_map
