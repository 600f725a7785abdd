#include <gtest/gtest.h>
#include <map_pictures/MapCanvas.h>
#include <map_pictures/MapPictures.h>
#include <semantic_abstraction/Abstraction.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <filesystem>

#include "PaintedField.h"
#include "TemporaryFolder.h"

using map_pictures::PictureStyle;
using map_pictures::renderPerspective;
using map_pictures::renderTopView;
using map_pictures::Viewpoint;
using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;

namespace {

const cv::Vec3b kPaper(250, 250, 250);

PictureStyle plain() {
  PictureStyle style;
  style.width = 800, style.height = 600, style.legend = false;
  return style;
}

int count(const cv::Mat& picture, const cv::Vec3b& color, int tolerance = 0) {
  cv::Mat mask;
  const cv::Scalar c(color), t(tolerance, tolerance, tolerance);
  cv::inRange(picture, c - t, c + t, mask);
  return cv::countNonZero(mask);
}

/** Mean column of the pixels in which that channel dominates. */
double meanColumn(const cv::Mat& picture, int channel) {
  double sum = 0;
  int n = 0;
  for (int row = 0; row < picture.rows; ++row)
    for (int col = 0; col < picture.cols; ++col) {
      const auto& p = picture.at<cv::Vec3b>(row, col);
      if (p[channel] < 60 || p[channel] < 2 * p[(channel + 1) % 3] ||
          p[channel] < 2 * p[(channel + 2) % 3])
        continue;
      sum += col, ++n;
    }
  EXPECT_GT(n, 1000);
  return sum / n;
}

}  // namespace

TEST(TopView, showsEachPlaceInItsClassesColor) {
  const cv::Mat picture = renderTopView(paintedField(), plain());
  ASSERT_EQ(picture.type(), CV_8UC3);
  ASSERT_EQ(picture.cols, 800);
  const double scale = (800 - 2 * 24) / 10.0;  // pixels per meter, within the border
  EXPECT_NEAR(picture.rows, 6 * scale + 2 * 24, 2);
  const auto at = [&](double x, double y) {
    return picture.at<cv::Vec3b>(int(24 + (6 - y) * scale), int(24 + x * scale));
  };
  EXPECT_EQ(at(3, 3), pixelOf(kRoad));
  EXPECT_EQ(at(4.8, 3), pixelOf(kRoad));
  EXPECT_EQ(at(5.2, 3), pixelOf(kTree));
  EXPECT_EQ(at(7, 3), pixelOf(kTree));
  EXPECT_EQ(picture.at<cv::Vec3b>(2, 2), kPaper);
}

TEST(TopView, theHighestCellCoversTheOthersUnlessItIsCutOff) {
  const SemanticOcTree tree = paintedField({0, 0}, 0.8f);
  PictureStyle style = plain();
  EXPECT_GT(count(renderTopView(tree, style), pixelOf(kWall), 3), 100000);
  style.maxHeight = 0.5;
  const cv::Mat below = renderTopView(tree, style);
  EXPECT_EQ(count(below, pixelOf(kWall), 3), 0);
  EXPECT_GT(count(below, pixelOf(kRoad)), 100000);
}

TEST(TopView, cutsOffWhatIsHighAboveTheGroundOnAHillToo) {
  semantic_types::LabeledCloud
      cloud;  // a slope of 20 degrees, 20 m long, with a crown above each part of it
  const double rise = std::tan(20 * M_PI / 180);
  const auto add = [&cloud](double x, double y, double z, ClassId id) {
    cloud.points.push_back(Eigen::Vector3d(x, y, z).cast<float>());
    cloud.classes.push_back(id);
  };
  for (double y = -0.9; y < 1; y += 0.2)
    for (double x = -9.9; x < 10; x += 0.2) {
      add(x, y, rise * x, 1);
      add(x, y, rise * x + 4, 2);
    }
  SemanticOcTree tree(0.2, paintedClasses());
  semantic_octree::InsertionOptions options;
  options.carvingMargin = 1e6;
  tree.insert(cloud, Eigen::Isometry3d::Identity(), options);
  PictureStyle style = plain();
  style.maxAboveGround = 2.5;
  const cv::Mat picture = renderTopView(tree, style);
  EXPECT_GT(count(picture, pixelOf(kRoad), 3), 10 * count(picture, pixelOf(kTree), 3));
  for (const int part : {1, 3, 5}) {  // low, in the middle, high
    const cv::Vec3b pixel = picture.at<cv::Vec3b>(picture.rows / 2, picture.cols * part / 6);
    EXPECT_LT(cv::norm(pixel, pixelOf(kRoad)), 60) << part;
  }
}

TEST(TopView, looksUnderTheCeilingOfAnIndoorMap) {
  const SemanticOcTree tree = paintedField({0, 0}, 2.4f);
  PictureStyle style = plain();
  const cv::Mat inside = renderTopView(tree, style);
  EXPECT_EQ(count(inside, pixelOf(kWall), 3), 0);
  EXPECT_GT(count(inside, pixelOf(kRoad)), 100000);
  style.maxHeight = INFINITY;
  EXPECT_GT(count(renderTopView(tree, style), pixelOf(kWall), 3), 100000);
}

TEST(TopView, theLegendShowsTheClassesThatAreThereOnly) {
  PictureStyle style = plain();
  const int width = renderTopView(paintedField(), style).cols;
  style.legend = true, style.title = "A field";
  const cv::Mat picture = renderTopView(paintedField(), style);
  const cv::Mat legend = picture(cv::Rect(width, 0, picture.cols - width, picture.rows));
  EXPECT_GT(count(legend, pixelOf(kRoad)), 100);
  EXPECT_GT(count(legend, pixelOf(kTree)), 100);
  EXPECT_EQ(count(legend, pixelOf(kWall)), 0);
}

TEST(TopView, anEmptyMapIsAnEmptySheet) {
  const SemanticOcTree empty(0.1, paintedClasses());
  for (const cv::Mat& picture :
       {renderTopView(empty, plain()), renderPerspective(empty, plain())}) {
    EXPECT_EQ(picture.size(), cv::Size(800, 600));
    EXPECT_EQ(count(picture, kPaper), 800 * 600);
  }
}

TEST(TopView, aMapOfOneEnormousCellIsDrawnWithoutEnormousMemory) {
  SemanticOcTree tree = paintedField();
  semantic_octree::AbstractionOptions options;
  options.weights = {{tree_abstraction::relevant("road", 1, {1})}, 1};
  options.blockSize = 0;
  options.frame = semantic_octree::AbstractionOptions::Frame::Charged;
  setAbstraction(tree, options);
  const SemanticOcTree collapsed = semantic_octree::Abstraction(tree).compressedMap();
  ASSERT_EQ(collapsed.getNumLeafNodes(), 1u);
  const cv::Mat picture = renderTopView(collapsed, plain());
  EXPECT_EQ(picture.rows, 600);
  EXPECT_GT(count(picture, kPaper), 0);
  EXPECT_LT(count(picture, kPaper), 100000);
}

TEST(PerspectiveView, showsTheMapFromItsViewpoint) {
  Viewpoint north, south;
  north.heading = 90, south.heading = -90;
  const cv::Mat fromSouth = renderPerspective(paintedField(), plain(), north);
  const cv::Mat fromNorth = renderPerspective(paintedField(), plain(), south);
  ASSERT_EQ(fromSouth.type(), CV_8UC3);
  // Road (red) is in the west, the trees (green) in the east.
  EXPECT_LT(meanColumn(fromSouth, 2), meanColumn(fromSouth, 1));
  EXPECT_GT(meanColumn(fromNorth, 2), meanColumn(fromNorth, 1));
}

TEST(PerspectiveView, straightDownItIsTheTopView) {
  Viewpoint down;
  down.heading = 90, down.tilt = 90;
  const cv::Mat picture = renderPerspective(paintedField(), plain(), down);
  EXPECT_EQ(picture.at<cv::Vec3b>(picture.rows / 2, picture.cols / 4), pixelOf(kRoad));
  EXPECT_EQ(picture.at<cv::Vec3b>(picture.rows / 2, picture.cols * 3 / 4), pixelOf(kTree));
}

TEST(Pictures, badStylesAreNamed) {
  const auto error = [](auto change) {
    PictureStyle style = plain();
    change(style);
    return errorOf([&] { renderTopView(paintedField(), style); });
  };
  EXPECT_TRUE(contains(error([](auto& s) { s.width = 0; }), "width is 0"));
  EXPECT_TRUE(contains(error([](auto& s) { s.height = 100000; }), "height is 100000"));
  EXPECT_TRUE(contains(error([](auto& s) { s.maxHeight = NAN; }), "max_height"));
  const auto viewError = [](auto change) {
    Viewpoint viewpoint;
    change(viewpoint);
    return errorOf([&] { renderPerspective(paintedField(), plain(), viewpoint); });
  };
  EXPECT_TRUE(contains(viewError([](auto& v) { v.tilt = 0; }), "tilt"));
  EXPECT_TRUE(contains(viewError([](auto& v) { v.heading = NAN; }), "heading"));
}

TEST(Pictures, areSavedWholeOrNotAtAll) {
  const TemporaryFolder folder;
  const cv::Mat picture = renderTopView(paintedField(), plain());
  map_pictures::savePicture(picture, folder / "map.png");
  const cv::Mat read = cv::imread((folder / "map.png").string());
  ASSERT_EQ(read.size(), picture.size());
  EXPECT_EQ(cv::norm(read, picture, cv::NORM_INF), 0);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  const std::string error =
      errorOf([&] { map_pictures::savePicture(picture, folder / "no/map.png"); });
  EXPECT_TRUE(contains(error, "no/map.png"));
}

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

cv::Mat written(const std::string& text) {
  cv::Mat picture(40, 300, CV_8UC3, bgr(map_pictures::kPaper));
  map_pictures::writeText(picture, text, {10, 20});
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
    EXPECT_NEAR(place.width, map_pictures::textWidth(text), 5) << text;
    EXPECT_NEAR(place.x, 10, 3) << text;
    EXPECT_NEAR(place.y + place.height / 2.0, 20, 4) << text;
  }
}

TEST(Text, lettersBeyondAsciiAreLettersWhereTheFontIsInstalled) {
  if (!std::filesystem::exists("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"))
    GTEST_SKIP() << "needs fonts-dejavu-core";
  EXPECT_GT(cv::norm(written("Straße"), written("Stra??e"), cv::NORM_L1), 1000);
  EXPECT_GT(cv::norm(written("лес"), written("лед"), cv::NORM_L1), 1000);
  EXPECT_LT(map_pictures::textWidth("Straße"), map_pictures::textWidth("Stra??e") + 10);
}

TEST(Text, brokenUtf8IsWrittenWithoutHarm) {
  for (const char* text : {"a\xff", "\xe2\x82", "\xc3", "\x80\x80z", "\xf0\x9f\x9a"})
    EXPECT_GT(map_pictures::textWidth(text), 0);
}
