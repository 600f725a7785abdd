#include <gtest/gtest.h>
#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>
#include <map_pictures/MapCanvas.h>
#include <rapidcheck/gtest.h>
#include <semantic_abstraction/Abstraction.h>

#include <opencv2/imgproc.hpp>

#include "PaintedField.h"
#include "TemporaryFolder.h"

using map_pictures::Color;
using map_pictures::MapCanvas;
using map_pictures::Stroke;

namespace {

constexpr Color kPurple{130, 0, 130};

Eigen::AlignedBox2d region(double left, double bottom, double right, double top) {
  return {Eigen::Vector2d(left, bottom), Eigen::Vector2d(right, top)};
}

/** 40 pixels a meter, from (-10, -8) to (10, 7). */
MapCanvas canvas() { return {region(-10, -8, 10, 7), {800, 800}}; }

cv::Vec3b pixelAt(const MapCanvas& canvas, double x, double y) {
  const cv::Point2d p = canvas.at(x, y);
  return canvas.picture().at<cv::Vec3b>(int(std::floor(p.y)), int(std::floor(p.x)));
}

/** Longest run of a color in a row of the picture. */
int longestRun(const cv::Mat& picture, const Color& color) {
  int longest = 0;
  for (int row = 0; row < picture.rows; ++row)
    for (int col = 0, run = 0; col < picture.cols; ++col) {
      run = picture.at<cv::Vec3b>(row, col) == pixelOf(color) ? run + 1 : 0;
      longest = std::max(longest, run);
    }
  return longest;
}

}  // namespace

TEST(MapCanvas, aRegionFillsThePictureWithinItsBorder) {
  const MapCanvas canvas(region(-10, -8, 10, 7), {848, 2000}, 24);
  EXPECT_EQ(canvas.picture().size(), cv::Size(848, 15 * 40 + 48));
  EXPECT_DOUBLE_EQ(canvas.pixelsPerMeter(), 40);
  EXPECT_EQ(canvas.at(-10, 7), cv::Point2d(24, 24));
  EXPECT_EQ(canvas.at(10, -8), cv::Point2d(824, 624));
}

TEST(MapCanvas, aPoseIsWhereItIsAndLooksWhereItLooks) {
  for (const double x : {-7.3, -0.01, 0.0, 4.2})
    for (const double heading : {0.0, M_PI / 2, -2.5}) {
      MapCanvas c = canvas();
      c.drawPose({x, -2.5, heading}, {kPurple, 20, 0});
      EXPECT_EQ(pixelAt(c, x, -2.5), pixelOf(kPurple));
      const double meters = 0.4;  // on the shaft
      EXPECT_EQ(pixelAt(c, x + meters * std::cos(heading), -2.5 + meters * std::sin(heading)),
                pixelOf(kPurple));
      EXPECT_EQ(pixelAt(c, x - meters * std::cos(heading), -2.5 - meters * std::sin(heading)),
                pixelOf(map_pictures::kPaper));
    }
}

TEST(MapCanvas, aMapInThePlaneShowsWhatIsFreeOccupiedAndUnknown) {
  for (const bool isInPlane : {true, false}) {
    semantic_types::LabeledCloud cloud;
    for (int i = 0; i < 400; ++i) {
      const double angle = M_PI * i / 400;
      cloud.points.emplace_back(float(4 * std::cos(angle)), float(4 * std::sin(angle)),
                                isInPlane || i < 390 ? 0 : 0.2f);
      cloud.classes.push_back(3);
    }
    semantic_octree::SemanticOcTree tree(0.1, paintedClasses());
    tree.insert(cloud, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.05)));
    MapCanvas c = canvas();
    c.drawMap(tree, {});
    EXPECT_EQ(pixelAt(c, 0.05, 4.0), pixelOf(kWall));
    EXPECT_EQ(pixelAt(c, 0.05, 2.0), pixelOf(map_pictures::kPaper));
    const Color& unknown = isInPlane ? map_pictures::kUnknown : map_pictures::kPaper;
    for (const double y : {5.0, -2.0}) EXPECT_EQ(pixelAt(c, 0.05, y), pixelOf(unknown));
    EXPECT_EQ(c.legend().back().name, isInPlane ? "not known" : "wall");
  }
}

RC_GTEST_PROP(MapCanvas, aDotsMiddleIsItsPlace, ()) {
  MapCanvas c = canvas();
  const double x = *rc::gen::inRange(-9000, 9000) / 1000.0;
  const double y = *rc::gen::inRange(-7000, 6000) / 1000.0;
  c.drawLine({{x, y}, {x, y}}, {kPurple, 9, 0});
  cv::Mat ink;
  cv::extractChannel(c.picture(), ink, 1);  // green: 250 on paper, 0 on the dot
  const cv::Moments m = cv::moments(250 - ink);
  const cv::Point2d place = c.at(x, y);
  RC_ASSERT(std::abs(m.m10 / m.m00 + 0.5 - place.x) < 0.1);
  RC_ASSERT(std::abs(m.m01 / m.m00 + 0.5 - place.y) < 0.1);
}

TEST(MapCanvas, aLineHasAHaloOnBothSides) {
  MapCanvas c = canvas();
  c.fillSquare({0, 0}, 6, {30, 30, 30});
  c.drawLine({{-2, 0.0125}, {2, 0.0125}}, {kPurple, 3, 4});
  const double pixel = 1 / c.pixelsPerMeter();
  EXPECT_EQ(pixelAt(c, 0, 0.0125), pixelOf(kPurple));
  for (const double side : {-4 * pixel, 4 * pixel})
    EXPECT_EQ(pixelAt(c, 0, 0.0125 + side), pixelOf(map_pictures::kHalo)) << side;
  for (const double side : {-8 * pixel, 8 * pixel})
    EXPECT_EQ(pixelAt(c, 0, 0.0125 + side), cv::Vec3b(30, 30, 30)) << side;
}

TEST(MapCanvas, squaresAndOutlinesCoverTheirPlaceOnly) {
  MapCanvas c = canvas();
  c.fillSquare({-3, -2}, 1, kPurple);
  EXPECT_EQ(count(c.picture(), kPurple), 40 * 40);
  EXPECT_EQ(pixelAt(c, -3.49, -1.51), pixelOf(kPurple));
  EXPECT_EQ(pixelAt(c, -3.51, -1.51), pixelOf(map_pictures::kPaper));
  MapCanvas outlined = canvas();
  outlined.fillOutline({{2, 2}, {4, 2}, {4, 3}, {2, 3}}, kPurple);
  EXPECT_EQ(pixelAt(outlined, 3, 2.5), pixelOf(kPurple));
  EXPECT_NEAR(count(outlined.picture(), kPurple), 80 * 40, 400);
}

TEST(MapCanvas, whatLiesOutsideIsCutOff) {
  MapCanvas c = canvas();
  c.fillSquare({-10, 7}, 2, kPurple);
  c.fillSquare({50, 50}, 2, kPurple);
  EXPECT_EQ(count(c.picture(), kPurple), 40 * 40);
  c.drawLine({{-500, 0}, {500, 0}}, {kPurple, 1, 0});
  c.drawPose({90, 90, 0}, {kPurple, 20, 2});
  EXPECT_EQ(c.picture().size(), cv::Size(800, 600));
}

TEST(MapCanvas, drawingThroughMixesWithWhatIsThere) {
  MapCanvas c = canvas();
  c.fillSquare({0, 0}, 4, {0, 0, 0});
  c.drawThrough(0.25, [&] { c.fillSquare({0, 0}, 2, {200, 100, 40}); });
  EXPECT_EQ(pixelAt(c, 0, 0), cv::Vec3b(10, 25, 50));
  EXPECT_EQ(pixelAt(c, 1.5, 1.5), cv::Vec3b(0, 0, 0));
  c.fillSquare({1.5, 1.5}, 0.5, {200, 100, 40}, 0.5);
  EXPECT_EQ(pixelAt(c, 1.5, 1.5), cv::Vec3b(20, 50, 100));
}

TEST(MapCanvas, aMapLiesWhereItIsOnAnyRegion) {
  const auto tree = paintedField({-4.2, -1});  // road for x < 0.8, trees beyond it
  for (const auto& part : {region(-10, -8, 10, 7), region(-1.234, -0.77, 3.1, 2.9)}) {
    MapCanvas c(part, {900, 900});
    c.drawMap(tree, {});
    EXPECT_EQ(pixelAt(c, 0.75, 1), pixelOf(kRoad));
    EXPECT_EQ(pixelAt(c, 0.85, 1), pixelOf(kTree));
    EXPECT_EQ(pixelAt(c, 0.75, -0.7), pixelOf(kRoad));
  }
  MapCanvas c(region(-10, -8, 10, 7), {800, 800});
  c.drawMap(tree, {});
  EXPECT_EQ(pixelAt(c, -4.25, 1), pixelOf(map_pictures::kPaper));
  EXPECT_EQ(pixelAt(c, -4.15, 1), pixelOf(kRoad));
  EXPECT_EQ(pixelAt(c, 1, -1.05), pixelOf(map_pictures::kPaper));
  EXPECT_EQ(pixelAt(c, 1, -0.95), pixelOf(kTree));
}

TEST(MapCanvas, aMapAroundTheCanvasIsDrawnAsIfThereWereNoMore) {
  using namespace semantic_octree;
  const TemporaryFolder folder;
  const auto near = paintedField({-5, -3}, 4), far = paintedField({-125, 60}),
             all = merged({&near, &far});
  MapFolderOptions options;
  options.tileSize = 12.8;
  StoredMap tiles(emptyLike(all), folder / "tiles", options);
  copyTo(tiles.tree(), all);
  tiles.folder()->save();
  StoredMap stored(folder / "tiles", 0.0);
  map_pictures::PictureStyle style;
  style.maxHeight = 50;  // it is no ceiling
  for (const bool cut : {false, true}) {
    if (cut) style.maxAboveGround = 2.5;
    MapCanvas expected = canvas(), whole = canvas(), ofTiles = canvas();
    expected.drawMap(near, style);
    whole.drawMapAround(all, style);
    ofTiles.drawMapAround(stored.tree(), style);
    EXPECT_EQ(count(expected.picture(), kWall) > 0, !cut);
    EXPECT_EQ(cv::norm(expected.picture(), whole.picture(), cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(expected.picture(), ofTiles.picture(), cv::NORM_INF), 0);
    EXPECT_EQ(whole.legend().size(), expected.legend().size());
  }
  MapCanvas expected(region(-4, -2, 4, 2), {800, 400}), around = expected.blank();
  expected.drawMap(near, {});
  around.drawMapAround(near, {});
  EXPECT_EQ(cv::norm(expected.picture(), around.picture(), cv::NORM_INF), 0) << "to its border";
  const auto contents = stored.folder()->contents();
  EXPECT_GT(contents.tiles, 8u);
  EXPECT_LE(contents.broughtIn, 2 * 2 * 8u);  // two drawings, two passes, two by two by two
}

TEST(MapCanvas, aPartThatIsPastedAfterAChangeMakesTheWholePicture) {
  map_pictures::PictureStyle style;
  style.maxHeight = 50, style.maxAboveGround = 2.5;
  auto tree = paintedField({-5, -3});
  MapCanvas kept = canvas();
  kept.drawMapAround(tree, style);
  semantic_types::LabeledCloud cloud;
  for (float y = -0.5f; y < 0.6f; y += 0.1f)
    for (float z = 0.1f; z < 4; z += 0.1f)
      cloud.points.emplace_back(1.1f, y, z), cloud.classes.push_back(3);
  tree.insert(cloud, Eigen::Isometry3d::Identity());
  MapCanvas whole = canvas(), pasted = canvas(), part(region(-8, -8, 10, 7), {720, 600});
  whole.drawMapAround(tree, style);
  part.drawMapAround(tree, style);
  EXPECT_GT(cv::norm(kept.picture(), whole.picture(), cv::NORM_INF), 50);
  pasted.paste(kept, region(-10, -8, 10, 7));
  EXPECT_EQ(cv::norm(kept.picture(), pasted.picture(), cv::NORM_INF), 0);
  pasted.paste(part, region(-5, -7, 7, 7));
  EXPECT_LE(cv::norm(whole.picture(), pasted.picture(), cv::NORM_INF), 1);
}

TEST(MapCanvas, theLegendStandsBesideThePictureAndNamesTheMapsClassesFirst) {
  MapCanvas c = canvas();
  c.explain({"path", Stroke{kPurple, 3, 2}});
  c.drawMap(paintedField(), {});
  ASSERT_EQ(c.legend().size(), 3u);
  EXPECT_EQ(c.legend()[0].name, "road");
  EXPECT_EQ(c.legend()[2].name, "path");
  const cv::Mat sheet = c.sheet("plan"), picture = c.withScale();
  EXPECT_EQ(cv::norm(sheet(cv::Rect({0, 0}, picture.size())), picture, cv::NORM_INF), 0);
  EXPECT_GT(count(sheet.colRange(picture.cols, sheet.cols), kPurple), 10);
}

TEST(MapCanvas, coarseCellsAreHatchedAndTheLegendSaysSo) {
  auto tree = paintedField();
  semantic_octree::AbstractionOptions options;
  options.weights = {{tree_abstraction::relevant("wall", 1, {3})}, 1};
  options.blockSize = 1.6;
  setAbstraction(tree, options);
  MapCanvas fine = canvas(), coarse = canvas();
  fine.drawMap(tree, {});
  coarse.drawMap(semantic_octree::Abstraction(tree).compressedMap(), {});
  EXPECT_EQ(coarse.legend().size(), fine.legend().size() + 1);
  EXPECT_EQ(coarse.legend().back().name, map_pictures::coarseCellEntry().name);

  // In the middle of a block nothing is shaded, and columns of 0.2 m are 8 pixels wide.
  const cv::Vec3b road = pixelOf(kRoad), pale(173, 173, 232);  // 0.35 and 0.65 of the paper
  int ofEach[2] = {0, 0};
  for (double x = 1.7; x < 3; x += 0.2)
    for (double y = 1.7; y < 3; y += 0.2) {
      EXPECT_EQ(pixelAt(fine, x, y), road);
      ++ofEach[pixelAt(coarse, x, y) == pale];
      EXPECT_TRUE(pixelAt(coarse, x, y) == pale || pixelAt(coarse, x, y) == road) << x << ' ' << y;
      EXPECT_EQ(pixelAt(coarse, x, y), pixelAt(coarse, x + 0.2, y + 0.2)) << "along a stripe";
    }
  EXPECT_NEAR(ofEach[0], ofEach[1], 7);
}

TEST(MapCanvas, theScaleBarIsAsLongAsItSays) {
  for (const double meters : {3.0, 20.0, 470.0}) {
    MapCanvas c(region(-meters, -meters, meters, meters), {700, 700});
    c.fillSquare({0, 0}, meters, {200, 200, 200});
    // The largest of 1, 2, 5, 10, ... m that is no more than a fifth of the picture.
    const double bar = meters == 3 ? 1 : meters == 20 ? 5 : 100;
    EXPECT_NEAR(longestRun(c.withScale(), map_pictures::kInk), bar * c.pixelsPerMeter(), 1);
  }
}

TEST(MapCanvas, regionsWithoutAnAreaAreRefused) {
  EXPECT_TRUE(contains(errorOf([] { MapCanvas(region(1, 1, 1, 5), {100, 100}); }), "0 m x 4 m"));
  EXPECT_TRUE(contains(errorOf([] { MapCanvas({}, {100, 100}); }), "0 m x 0 m"));
  EXPECT_TRUE(contains(errorOf([] { MapCanvas(region(0, 0, 1, 1), {40, 40}, 20); }), "border"));
}
