#include <ft2build.h>
#include <map_pictures/MapCanvas.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <optional>

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

/** Draws what OpenCV's own font has no letters for. */
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

Font fontFor(const std::string& text) {
  const auto isAscii = [](unsigned char c) { return c < 0x80; };
  return std::all_of(text.begin(), text.end(), isAscii) ? Font::Strokes : Font::DejaVu;
}

int textWidth(const std::string& text, Font font) {
  if (font == Font::DejaVu)
    if (const auto letters = DejaVu::load()) return letters->write(nullptr, text, {});
  int baseline = 0;
  return cv::getTextSize(text, kFont, kTextSize, 1, &baseline).width;
}

void writeText(cv::Mat& picture, const std::string& text, const cv::Point& leftMiddle, Font font) {
  const cv::Point baseline = leftMiddle + cv::Point(0, 6);
  if (font == Font::DejaVu)
    if (const auto letters = DejaVu::load()) {
      letters->write(&picture, text, baseline);
      return;
    }
  cv::putText(picture, text, baseline, kFont, kTextSize, bgr(kInk), 1, cv::LINE_AA);
}

}  // namespace map_pictures
