#include "PictureSheet.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "CellColors.h"

namespace semantic_map {

using semantic_types::ClassId;

namespace {

constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;
constexpr double kTextSize = 0.55;
constexpr int kMargin = 20, kRow = 28, kSwatch = 18;

int textWidth(const std::string& text) {
  int baseline = 0;
  return cv::getTextSize(text, kFont, kTextSize, 1, &baseline).width;
}

/** \param left, middle of the text's height, pixels */
void write(cv::Mat& picture, const std::string& text, cv::Point leftMiddle) {
  cv::putText(picture, text, leftMiddle + cv::Point(0, 6), kFont, kTextSize, kInk, 1, cv::LINE_AA);
}

/** Upper left corner of a place of that size in the corner of the picture with least in it. */
cv::Point emptiestCorner(const cv::Mat& picture, cv::Size size) {
  const int right = picture.cols - size.width, bottom = picture.rows - size.height;
  cv::Point best(0, bottom);
  int least = size.area() + 1;
  for (const cv::Point corner : {cv::Point(0, bottom), {right, bottom}, {right, 0}, {0, 0}}) {
    const cv::Rect place = cv::Rect(corner, size) & cv::Rect({0, 0}, picture.size());
    cv::Mat empty;
    cv::inRange(picture(place), kPaper, kPaper, empty);
    const int filled = place.area() - cv::countNonZero(empty);
    if (filled < least) best = corner, least = filled;
  }
  return best;
}

/** Text and lines stay readable on any class's color. */
void brighten(cv::Mat& picture, cv::Rect area) {
  area &= cv::Rect({0, 0}, picture.size());
  cv::Mat part = picture(area);
  cv::addWeighted(part, 0.25, cv::Mat(part.size(), part.type(), kPaper), 0.75, 0, part);
}

std::string lengthName(double meters) {
  if (meters >= 1000) return cv::format("%g km", meters / 1000);
  return meters >= 1 ? cv::format("%g m", meters) : cv::format("%g cm", meters * 100);
}

/** The largest 1, 2 or 5 times a power of ten that is not above. */
double roundLength(double meters) {
  const double power = std::pow(10.0, std::floor(std::log10(meters)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= meters) return factor * power;
  return power;
}

void shortenLegend(std::vector<LegendEntry>& entries, std::size_t rows) {
  if (entries.size() <= rows) return;
  const std::size_t more = entries.size() - rows + 1;
  entries.resize(rows - 1);
  entries.push_back({"and " + std::to_string(more) + " more", kPaper});
}

}  // namespace

std::vector<LegendEntry> legendOf(const semantic_types::ClassTable& classes,
                                  const std::vector<std::size_t>& counts) {
  std::vector<std::size_t> order(counts.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin() + 1, order.end(),
                   [&counts](std::size_t a, std::size_t b) { return counts[a] > counts[b]; });
  std::rotate(order.begin(), order.begin() + 1, order.end());
  std::vector<LegendEntry> entries;
  for (const std::size_t i : order) {
    if (counts[i] == 0) continue;
    const auto id = static_cast<ClassId>(i);
    const auto color = classColor(classes, id);
    entries.push_back({i == 0 ? "no class" : classes.name(id),
                       {double(color.b), double(color.g), double(color.r)}});
  }
  return entries;
}

cv::Mat withLegend(const cv::Mat& picture, const std::string& title,
                   const std::vector<LegendEntry>& all) {
  const int top = title.empty() ? kMargin : kMargin + kRow;
  std::vector<LegendEntry> entries = all;
  shortenLegend(entries, std::max(2, (picture.rows - top - kMargin) / kRow));
  int width = textWidth(title);
  for (const auto& entry : entries)
    width = std::max(width, kSwatch + kMargin / 2 + textWidth(entry.name));

  const int left = picture.cols + kMargin;
  const int rows = std::max(picture.rows, top + int(entries.size()) * kRow + kMargin);
  cv::Mat sheet(rows, left + width + kMargin, CV_8UC3, kPaper);
  picture.copyTo(sheet(cv::Rect({0, 0}, picture.size())));
  if (!title.empty()) write(sheet, title, {left, kMargin + kRow / 4});
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const int y = top + int(i) * kRow;
    const cv::Rect swatch(left, y, kSwatch, kSwatch);
    cv::rectangle(sheet, swatch, entries[i].color, cv::FILLED);
    if (entries[i].color != kPaper) cv::rectangle(sheet, swatch, kInk, 1, cv::LINE_AA);
    write(sheet, entries[i].name, {left + kSwatch + kMargin / 2, y + kSwatch / 2});
  }
  return sheet;
}

void drawScaleBar(cv::Mat& picture, double pixelsPerMeter) {
  const double meters = roundLength(picture.cols / pixelsPerMeter / 5);
  const int length = std::max(1, int(std::lround(meters * pixelsPerMeter)));
  const std::string text = lengthName(meters);
  const int width = std::max(length, textWidth(text));
  const cv::Size size(width + 2 * kMargin, 2 * kRow + 4);
  const cv::Point corner = emptiestCorner(picture, size);
  brighten(picture, {corner, size});
  const cv::Point left = corner + cv::Point(kMargin + (width - length) / 2, size.height - kMargin);
  cv::rectangle(picture, {left.x, left.y - 4, length, 4}, kInk, cv::FILLED);
  for (const int x : {left.x, left.x + length - 2})
    cv::rectangle(picture, {x, left.y - 9, 2, 9}, kInk, cv::FILLED);
  write(picture, text, {left.x + (length - textWidth(text)) / 2, left.y - 20});
}

void drawAxes(cv::Mat& picture, const std::array<cv::Point2d, 3>& directions) {
  constexpr double kLength = 46;
  constexpr int kSize = 132;
  const cv::Point corner = emptiestCorner(picture, {kSize, kSize});
  brighten(picture, {corner, cv::Size(kSize, kSize)});
  const cv::Point2d origin = cv::Point2d(corner) + cv::Point2d(kSize / 2.0, kSize / 2.0);
  const std::array<cv::Scalar, 3> colors = {cv::Scalar(40, 40, 200), cv::Scalar(40, 140, 40),
                                            cv::Scalar(200, 80, 30)};
  for (int axis = 0; axis < 3; ++axis) {
    if (cv::norm(directions[axis]) < 0.1) continue;
    const cv::Point2d tip = origin + kLength * directions[axis];
    const cv::Point2d letter = origin + (kLength + 11) * directions[axis];
    cv::arrowedLine(picture, origin, tip, colors[axis], 2, cv::LINE_AA, 0, 0.2);
    write(picture, std::string(1, char('x' + axis)), cv::Point(letter) - cv::Point(5, 0));
  }
}

}  // namespace semantic_map
