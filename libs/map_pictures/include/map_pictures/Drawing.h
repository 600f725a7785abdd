#pragma once
#include <semantic_types/ClassTable.h>

#include <opencv2/core.hpp>
#include <string>
#include <vector>

/** Drawing on pictures (BGR, 8 bits). Places are in pixels from the upper left corner, x right and
 * y down: pixel (0, 0) reaches from 0 to 1. */
namespace map_pictures {

using semantic_types::Color;

/** Where a picture shows nothing: unknown and free space. */
constexpr Color kPaper{250, 250, 250};
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

/** OpenCV's own letters, made of strokes, are those of ASCII; others need DejaVu Sans. */
enum class Font { Strokes, DejaVu };

/** The one that has all letters of a UTF-8 text. Texts that stand together should share it. */
Font fontFor(const std::string& text);

/** Pixels. */
int textWidth(const std::string& text, Font font);

/** \param leftMiddle of the text. Where DejaVu Sans is not installed, "?" stands for its letters.
 */
void writeText(cv::Mat& picture, const std::string& text, const cv::Point& leftMiddle, Font font);

}  // namespace map_pictures
