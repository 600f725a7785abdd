#include <ft2build.h>
#include <map_pictures/MapCanvas.h>
#include <semantic_types/ClassTable.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include FT_FREETYPE_H
#include <memory>
#include <numeric>
#include <optional>

#include "MapCells.h"

namespace map_pictures {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;
constexpr double kTextSize = 0.55;

/** OpenCV draws at whole numbers of a sixteenth of a pixel, counted from the first one's middle. */
constexpr int kShift = 4;
cv::Point fixedPoint(const cv::Point2d& p) {
  constexpr double kScale = 1 << kShift;
  return {int(std::lround((p.x - 0.5) * kScale)), int(std::lround((p.y - 0.5) * kScale))};
}

void drawDot(cv::Mat& picture, const cv::Point2d& place, double radius, const Color& color) {
  cv::circle(picture, fixedPoint(place), int(std::lround(radius * (1 << kShift))), bgr(color),
             cv::FILLED, cv::LINE_AA, kShift);
}

/** The characters of UTF-8; U+FFFD for bytes that are none. */
std::vector<char32_t> charactersOf(const std::string& text) {
  std::vector<char32_t> characters;
  int missing = 0;
  for (const unsigned char byte : text) {
    if (missing > 0 && (byte & 0xc0) == 0x80) {
      characters.back() = characters.back() << 6 | (byte & 0x3f);
      --missing;
      continue;
    }
    if (missing > 0) characters.back() = 0xfffd;
    missing = byte < 0xc0 ? 0 : byte < 0xe0 ? 1 : byte < 0xf0 ? 2 : 3;
    characters.push_back(byte < 0x80 ? byte : missing > 0 ? byte & (0x3f >> missing) : 0xfffd);
  }
  if (missing > 0) characters.back() = 0xfffd;
  return characters;
}

/** Writes in DejaVu Sans. */
class DejaVu {
 public:
  /** Nothing if the font is not installed. */
  static std::optional<DejaVu> load() {
    FT_Library library = nullptr;
    if (FT_Init_FreeType(&library)) return {};
    DejaVu font;
    font.m_library = {library, FT_Done_FreeType};
    FT_Face face = nullptr;
    if (FT_New_Face(library, "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", 0, &face))
      return {};
    font.m_face = {face, FT_Done_Face};
    constexpr int kHeight = 16;  // pixels: as large as OpenCV's letters of kTextSize
    if (FT_Set_Pixel_Sizes(face, 0, kHeight)) return {};
    return font;
  }

  /** Writes into the picture, if there is one. \return the width, pixels */
  int write(cv::Mat* picture, const std::string& text, const cv::Point& baseline) const {
    int x = 0;
    for (const char32_t c : charactersOf(text)) {
      if (FT_Load_Char(m_face.get(), c, FT_LOAD_RENDER)) continue;
      const FT_GlyphSlot glyph = m_face->glyph;
      if (picture)
        blend(*picture, glyph->bitmap,
              baseline + cv::Point(x + glyph->bitmap_left, -glyph->bitmap_top));
      x += int(glyph->advance.x >> 6);
    }
    return x;
  }

 private:
  DejaVu() : m_library(nullptr, FT_Done_FreeType), m_face(nullptr, FT_Done_Face) {}

  static void blend(cv::Mat& picture, const FT_Bitmap& glyph, const cv::Point& corner) {
    const cv::Vec3d ink(kInk.b, kInk.g, kInk.r);
    for (int row = 0; row < int(glyph.rows); ++row)
      for (int col = 0; col < int(glyph.width); ++col) {
        const cv::Point at = corner + cv::Point(col, row);
        if (!cv::Rect({0, 0}, picture.size()).contains(at)) continue;
        auto& pixel = picture.at<cv::Vec3b>(at);
        const double share = glyph.buffer[row * glyph.pitch + col] / 255.0;
        pixel = cv::Vec3d(pixel) * (1 - share) + ink * share;
      }
  }

  std::unique_ptr<FT_LibraryRec_, decltype(&FT_Done_FreeType)> m_library;
  std::unique_ptr<FT_FaceRec_, decltype(&FT_Done_Face)> m_face;  // goes first
};

}  // namespace

void drawLine(cv::Mat& picture, const std::vector<cv::Point2d>& points, const Stroke& stroke) {
  std::vector<cv::Point> line;
  std::transform(points.begin(), points.end(), std::back_inserter(line), fixedPoint);
  const auto draw = [&](const Color& color, int width) {
    cv::polylines(picture, line, false, bgr(color), width, cv::LINE_AA, kShift);
  };
  if (stroke.halo > 0) draw(kHalo, stroke.width + 2 * stroke.halo);
  draw(stroke.color, stroke.width);
}

void drawArrow(cv::Mat& picture, const cv::Point2d& place, double heading, const Arrow& arrow) {
  const cv::Point2d forward(std::cos(heading), -std::sin(heading)), left(forward.y, -forward.x);
  const cv::Point2d tip = place + arrow.length * forward;
  constexpr double kShortestWithHead = 12;
  const int width = std::max(1, int(std::lround(arrow.length / 7)));
  const double barb = 0.35 * arrow.length, radius = 0.27 * arrow.length;
  const auto draw = [&](const Color& color, int halo) {
    const Stroke stroke{color, width + 2 * halo, 0};
    drawLine(picture, {place, tip}, stroke);
    if (arrow.length >= kShortestWithHead)
      drawLine(picture, {tip - barb * (forward - left), tip, tip - barb * (forward + left)},
               stroke);
    drawDot(picture, place, radius + halo, color);
  };
  if (arrow.halo > 0) draw(kHalo, arrow.halo);
  draw(arrow.color, 0);
}

int textWidth(const std::string& text) {
  if (const auto letters = DejaVu::load()) return letters->write(nullptr, text, {});
  int baseline = 0;
  return cv::getTextSize(text, kFont, kTextSize, 1, &baseline).width;
}

void writeText(cv::Mat& picture, const std::string& text, const cv::Point& leftMiddle) {
  const cv::Point baseline = leftMiddle + cv::Point(0, 6);
  if (const auto letters = DejaVu::load())
    letters->write(&picture, text, baseline);
  else
    cv::putText(picture, text, baseline, kFont, kTextSize, bgr(kInk), 1, cv::LINE_AA);
}

using semantic_types::ClassId;

namespace {

constexpr int kMargin = 20, kRow = 28, kSwatch = 18;

/** Upper left corner of a place of that size in the corner of the picture with least in it.
 * \param taken keeps clear of that, if there is another corner */
cv::Point emptiestCorner(const cv::Mat& picture, cv::Size size, const cv::Rect& taken) {
  const int right = picture.cols - size.width, bottom = picture.rows - size.height;
  cv::Point best(0, bottom);
  int least = size.area() + 1;
  for (const cv::Point corner : {cv::Point(0, bottom), {right, bottom}, {right, 0}, {0, 0}}) {
    const cv::Rect place = cv::Rect(corner, size) & cv::Rect({0, 0}, picture.size());
    if (!(place & taken).empty()) continue;
    cv::Mat empty;
    cv::inRange(picture(place), bgr(kPaper), bgr(kPaper), empty);
    const int filled = place.area() - cv::countNonZero(empty);
    if (filled < least) best = corner, least = filled;
  }
  return best;
}

/** Text and lines stay readable on any class's color. */
void brighten(cv::Mat& picture, cv::Rect area) {
  area &= cv::Rect({0, 0}, picture.size());
  cv::Mat part = picture(area);
  cv::addWeighted(part, 0.25, cv::Mat(part.size(), part.type(), bgr(kPaper)), 0.75, 0, part);
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

/** Draws an entry's sample. \param place of it */
struct Sample {
  cv::Mat& sheet;
  cv::Rect place;

  void operator()(const Color& color) const {
    cv::rectangle(sheet, place, bgr(color), cv::FILLED);
    cv::rectangle(sheet, place, bgr(kInk), 1, cv::LINE_AA);
  }
  void operator()(const Hatch& hatch) const {
    constexpr int kStripes = 8;
    const cv::Vec3b color(hatch.color.b, hatch.color.g, hatch.color.r);
    for (int y = 0; y < place.height; ++y)
      for (int x = 0; x < place.width; ++x)
        sheet.at<cv::Vec3b>(place.tl() + cv::Point(x, y)) = hatched(color, x, y, kStripes);
    cv::rectangle(sheet, place, bgr(kInk), 1, cv::LINE_AA);
  }
  void operator()(const Stroke& stroke) const {
    const double middle = place.y + place.height / 2.0;
    drawLine(sheet, {{double(place.x), middle}, {double(place.br().x), middle}}, stroke);
  }
  void operator()(const Arrow& arrow) const {
    Arrow fitting = arrow;
    fitting.length = std::min(arrow.length, 0.75 * place.width);
    const double radius = 0.27 * fitting.length;
    drawArrow(sheet, {place.x + radius, place.y + place.height / 2.0}, 0, fitting);
  }
};

}  // namespace

std::vector<LegendEntry> classLegend(const semantic_types::ClassTable& classes,
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
    entries.push_back({i == 0 ? "no class" : classes.name(id), colorOf(id, classes)});
  }
  return entries;
}

LegendEntry coarseCellEntry() {
  return {"coarse cell with some of it", Hatch{semantic_types::kColorWithoutClass}};
}

int legendHeight(std::size_t entries) { return int(entries) * kRow + 2 * kMargin; }

cv::Mat withLegend(const cv::Mat& picture, const std::string& title,
                   const std::vector<LegendEntry>& entries) {
  constexpr int kFewestRows = 8, kTextLeft = kSwatch + kMargin / 2;
  const int top = title.empty() ? kMargin : kMargin + kRow, numEntries = int(entries.size());
  const int rows = std::max(kFewestRows, (picture.rows - top - kMargin) / kRow);
  const int columns = std::max(1, (numEntries + rows - 1) / rows);
  int width = 0;
  for (const auto& entry : entries) width = std::max(width, kTextLeft + textWidth(entry.name));

  const int left = picture.cols + kMargin;
  const int inside = std::max(textWidth(title), columns * (width + kMargin) - kMargin);
  const int height = std::max(picture.rows, top + std::min(rows, numEntries) * kRow + kMargin);
  cv::Mat sheet(height, left + inside + kMargin, CV_8UC3, bgr(kPaper));
  picture.copyTo(sheet(cv::Rect({0, 0}, picture.size())));
  if (!title.empty()) writeText(sheet, title, {left, kMargin + kRow / 4});
  for (int i = 0; i < numEntries; ++i) {
    const cv::Point at(left + i / rows * (width + kMargin), top + i % rows * kRow);
    std::visit(Sample{sheet, {at, cv::Size(kSwatch, kSwatch)}}, entries[i].look);
    writeText(sheet, entries[i].name, at + cv::Point(kTextLeft, kSwatch / 2));
  }
  return sheet;
}

cv::Mat withTitle(const cv::Mat& picture, const std::string& title) {
  constexpr int kHeight = 34;
  cv::Mat sheet;
  cv::copyMakeBorder(picture, sheet, kHeight, 0, 0, 0, cv::BORDER_CONSTANT, bgr(kPaper));
  writeText(sheet, title, {kMargin, kHeight / 2});
  return sheet;
}

void drawScaleBar(cv::Mat& picture, double pixelsPerMeter, const cv::Rect& taken) {
  const double meters = roundLength(picture.cols / pixelsPerMeter / 5);
  const int length = std::max(1, int(std::lround(meters * pixelsPerMeter)));
  const std::string text = lengthName(meters);
  const int width = std::max(length, textWidth(text));
  const cv::Size size(width + 2 * kMargin, 2 * kRow + 4);
  const cv::Point corner = emptiestCorner(picture, size, taken);
  brighten(picture, {corner, size});
  const cv::Point left = corner + cv::Point(kMargin + (width - length) / 2, size.height - kMargin);
  cv::rectangle(picture, {left.x, left.y - 4, length, 4}, bgr(kInk), cv::FILLED);
  for (const int x : {left.x, left.x + length - 2})
    cv::rectangle(picture, {x, left.y - 9, 2, 9}, bgr(kInk), cv::FILLED);
  writeText(picture, text, {left.x + (length - textWidth(text)) / 2, left.y - 20});
}

cv::Rect drawAxes(cv::Mat& picture, const std::array<cv::Point2d, 3>& directions) {
  constexpr double kLength = 46;
  constexpr int kSize = 132;
  const cv::Point corner = emptiestCorner(picture, {kSize, kSize}, {});
  const cv::Rect place(corner, cv::Size(kSize, kSize));
  brighten(picture, place);
  const cv::Point2d origin = cv::Point2d(corner) + cv::Point2d(kSize / 2.0, kSize / 2.0);
  const std::array<cv::Scalar, 3> colors = {cv::Scalar(40, 40, 200), cv::Scalar(40, 140, 40),
                                            cv::Scalar(200, 80, 30)};
  for (int axis = 0; axis < 3; ++axis) {
    if (cv::norm(directions[axis]) < 0.1) continue;
    const cv::Point2d tip = origin + kLength * directions[axis];
    const cv::Point2d letter = origin + (kLength + 11) * directions[axis];
    cv::arrowedLine(picture, origin, tip, colors[axis], 2, cv::LINE_AA, 0, 0.2);
    writeText(picture, std::string(1, char('x' + axis)), cv::Point(letter) - cv::Point(5, 0));
  }
  return place;
}

}  // namespace map_pictures
