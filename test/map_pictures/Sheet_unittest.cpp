#include <gtest/gtest.h>
#include <map_pictures/MapCanvas.h>

#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "PaintedField.h"

using map_pictures::bgr;
using map_pictures::Color;
using map_pictures::LegendEntry;

namespace {

const cv::Mat kPicture(400, 500, CV_8UC3, cv::Scalar(40, 90, 140));

/** Colors that are found again. */
std::vector<LegendEntry> entries(int number) {
  std::vector<LegendEntry> all;
  for (int i = 0; i < number; ++i)
    all.push_back({"class " + std::to_string(i), Color{std::uint8_t(i), 200, 100}});
  return all;
}

int widthOf(const std::string& text) {
  return map_pictures::textWidth(text, map_pictures::fontFor(text));
}

cv::Mat written(const std::string& text) {
  cv::Mat picture(40, 300, CV_8UC3, bgr(map_pictures::kPaper));
  map_pictures::writeText(picture, text, {10, 20}, map_pictures::fontFor(text));
  return picture;
}

}  // namespace

TEST(Sheet, aLegendLeavesThePictureAsItIs) {
  const cv::Mat sheet = map_pictures::withLegend(kPicture, "title", entries(3));
  EXPECT_EQ(cv::norm(sheet(cv::Rect({0, 0}, kPicture.size())), kPicture, cv::NORM_INF), 0);
  const cv::Mat gap = sheet.colRange(kPicture.cols, kPicture.cols + 15);
  EXPECT_EQ(count(gap, map_pictures::kPaper), gap.size().area());
}

TEST(Sheet, aLegendIsCompleteHoweverLongItIs) {
  for (const int number : {1, 12, 13, 40, 254}) {
    const cv::Mat sheet = map_pictures::withLegend(kPicture, "", entries(number));
    EXPECT_EQ(sheet.rows, kPicture.rows) << number;
    for (const LegendEntry& entry : entries(number))
      EXPECT_GE(count(sheet, std::get<Color>(entry.look)), 14 * 14) << number << entry.name;
  }
}

TEST(Sheet, theLegendShowsLinesAndPosesAsTheyAreDrawn) {
  const Color purple{130, 0, 130}, orange{250, 120, 0};
  const cv::Mat sheet = map_pictures::withLegend(
      kPicture, "",
      {{"path", map_pictures::Stroke{purple, 3, 2}}, {"goal", map_pictures::Arrow{orange, 26, 2}}});
  EXPECT_GT(count(sheet, purple), 3 * 18);
  EXPECT_LT(count(sheet, purple), 8 * 18);
  EXPECT_GT(count(sheet, orange), 30);
}

TEST(Sheet, aTitleStandsAboveThePicture) {
  const cv::Mat sheet = map_pictures::withTitle(kPicture, "12 s");
  const int strip = sheet.rows - kPicture.rows;
  EXPECT_GT(strip, 20);
  EXPECT_EQ(cv::norm(sheet.rowRange(strip, sheet.rows), kPicture, cv::NORM_INF), 0);
  EXPECT_LT(count(sheet.rowRange(0, strip), map_pictures::kPaper), strip * sheet.cols);
}

TEST(Sheet, axesAndScaleBarKeepClearOfEachOther) {
  // Something everywhere but in the upper left corner, where both would like to be.
  cv::Mat picture(500, 600, CV_8UC3, cv::Scalar(40, 90, 140));
  picture(cv::Rect(0, 0, 200, 200)).setTo(bgr(map_pictures::kPaper));
  const cv::Rect axes =
      map_pictures::drawAxes(picture, {cv::Point2d(1, 0), cv::Point2d(0, -1), {}});
  EXPECT_EQ(axes.tl(), cv::Point(0, 0));
  const cv::Mat before = picture(axes).clone();
  map_pictures::drawScaleBar(picture, 10, axes);
  EXPECT_EQ(cv::norm(picture(axes), before, cv::NORM_INF), 0);
}

TEST(Text, hasTheWidthThatItSays) {
  for (const char* text : {"road", "Straße", "дорога", "道"}) {
    const cv::Mat picture = written(text);
    cv::Mat ink;
    cv::inRange(picture, bgr(map_pictures::kPaper), bgr(map_pictures::kPaper), ink);
    const cv::Rect place = cv::boundingRect(ink == 0);
    EXPECT_NEAR(place.width, widthOf(text), 5) << text;
    EXPECT_NEAR(place.x, 10, 3) << text;
    EXPECT_NEAR(place.y + place.height / 2.0, 20, 4) << text;
  }
}

TEST(Text, lettersBeyondAsciiAreLettersWhereTheFontIsInstalled) {
  if (!std::filesystem::exists("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"))
    GTEST_SKIP() << "needs fonts-dejavu-core";
  EXPECT_GT(cv::norm(written("Straße"), written("Stra??e"), cv::NORM_L1), 1000);
  EXPECT_GT(cv::norm(written("лес"), written("лед"), cv::NORM_L1), 1000);
  EXPECT_LT(widthOf("Straße"), widthOf("Stra??e") + 10);
}

TEST(Text, aLegendHasOneFont) {
  if (!std::filesystem::exists("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"))
    GTEST_SKIP() << "needs fonts-dejavu-core";
  const auto nextTo = [](const std::string& other) {
    const cv::Mat sheet =
        map_pictures::withLegend(kPicture, "", {{"road", Color{}}, {other, Color{}}});
    return sheet(cv::Rect(kPicture.cols + 45, 20, 35, 20)).clone();
  };
  EXPECT_EQ(cv::norm(nextTo("wall"), nextTo("tree"), cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(nextTo("wall"), nextTo("bäume"), cv::NORM_INF), 100);
}

TEST(Text, brokenUtf8IsWrittenWithoutHarm) {
  for (const char* text : {"a\xff", "\xe2\x82", "\xc3", "\x80\x80z", "\xf0\x9f\x9a"})
    EXPECT_GT(widthOf(text), 0);
}
