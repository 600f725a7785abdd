// Pictures of maps in folders of tiles are those of the map in one piece.
#include <gtest/gtest.h>
#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>
#include <map_pictures/MapPictures.h>

#include "PaintedField.h"
#include "TemporaryFolder.h"

using namespace map_pictures;
using semantic_octree::MapFolder;
using semantic_octree::SemanticOcTree;
using semantic_octree::StoredMap;

namespace {

/** Saves a map in tiles and opens them so that one alone is in memory. */
class InTiles {
 public:
  InTiles(const SemanticOcTree& map, double tileSize) {
    StoredMap tiles(emptyLike(map), m_folder / "map", {500, tileSize});
    copyTo(tiles.tree(), map);
    tiles.folder()->save();
    m_stored.emplace(m_folder / "map", 0);
  }
  const SemanticOcTree& map() { return m_stored->tree(); }
  MapFolder::Contents contents() { return m_stored->folder()->contents(); }

 private:
  TemporaryFolder m_folder;
  std::optional<StoredMap> m_stored;
};

/** More cells than a picture shows: hills of 904 x 904 columns, classes in squares, each 8 x 8
 * columns seen from 1 m above. */
SemanticOcTree wideField() {
  constexpr int kPatches = 113, kEdge = 8;
  constexpr double kVoxel = 0.2;
  SemanticOcTree tree(kVoxel, paintedClasses());
  for (int patch = 0; patch < kPatches * kPatches; ++patch) {
    const int column = patch / kPatches, row = patch % kPatches;
    Eigen::Isometry3d T(Eigen::Translation3d(kVoxel * kEdge * (column - 56),
                                             kVoxel * kEdge * (row - 56),
                                             3 * std::sin(column / 9.0) * std::cos(row / 7.0)));
    semantic_types::LabeledCloud cloud;
    for (int i = 0; i < kEdge * kEdge; ++i) {
      cloud.points.emplace_back(float(kVoxel * (i / kEdge - 3.5)),
                                float(kVoxel * (i % kEdge - 3.5)), -1.f);
      cloud.classes.push_back(semantic_types::ClassId((column / 5 + row / 5 + i / 40) % 3 + 1));
    }
    tree.insert(cloud, T);
  }
  return tree;
}

void expectSame(const cv::Mat& picture, const cv::Mat& expected) {
  ASSERT_EQ(picture.size(), expected.size());
  EXPECT_EQ(cv::norm(picture, expected, cv::NORM_INF), 0);
}

}  // namespace

TEST(MapsInTiles, haveThePicturesOfTheMapInOnePiece) {
  const SemanticOcTree field = paintedField({-3, -2}, 4);
  for (const double tileSize : {1.6, 6.4}) {
    InTiles tiles(field, tileSize);
    PictureStyle style;
    style.width = style.height = 400;
    expectSame(renderTopView(tiles.map(), style), renderTopView(field, style));
    style.maxAboveGround = 2;
    expectSame(renderTopView(tiles.map(), style), renderTopView(field, style));
    const ClassMap map = drawClassMap(tiles.map()), expected = drawClassMap(field);
    expectSame(map.picture, expected.picture);
    EXPECT_EQ(map.worldFile, expected.worldFile);
  }
}

TEST(MapsInTiles, areReadTwiceAtMostForAPictureHoweverManyCellsThereAre) {
  const SemanticOcTree field = wideField();
  InTiles tiles(field, 12.8);
  PictureStyle style;
  style.width = style.height = 400;
  const cv::Mat picture = renderTopView(tiles.map(), style);
  EXPECT_LE(tiles.contents().broughtIn, 2 * tiles.contents().tiles);
  EXPECT_LT(tiles.contents().tilesInMemory, 3u);
  expectSame(picture, renderTopView(field, style));
}

TEST(MapsInTiles, areReadOnceForEachBandOfAPictureWithAPixelAColumn) {
  const SemanticOcTree field = wideField();
  const ClassMap whole = drawClassMap(field, 100.0);
  EXPECT_EQ(whole.picture.rows, 904);
  for (const int columns : {1, 50000, 100000}) {
    InTiles tiles(field, 12.8);  // 64 voxels: a band of 100000 columns is as high
    const ClassMap map = drawClassMap(tiles.map(), 100.0, columns);
    if (columns == 100000) {
      EXPECT_LE(tiles.contents().broughtIn, 2 * tiles.contents().tiles);
    }
    expectSame(map.picture, whole.picture);
  }
}
