#include <gtest/gtest.h>
#include <map_view/TileSet.h>

#include "RandomMap.h"

namespace {

using namespace map_view;

View viewFrom(double distance, double azimuth = -60) {
  View view;
  view.camera.distance = distance;
  view.camera.azimuth = azimuth;
  return view;
}

bool contains(const Tile& tile, const octomap::OcTreeKey& key) {
  const Eigen::Array3i k(key[0], key[1], key[2]);
  return (tile.lowest <= k).all() && (k < tile.lowest + tile.edge()).all();
}

/** Cells of the finest tile. */
int finest(const std::vector<Tile>& tiles) {
  int depth = 0;
  for (const Tile& tile : tiles) depth = std::max(depth, tile.depth);
  return depth;
}

}  // namespace

TEST(TilesSeen, HoldAllThatIsSeenOnce) {
  const SemanticOcTree map = randomMap(41);
  for (const double distance : {5.0, 60.0, 3000.0}) {
    const View view = viewFrom(distance);
    const std::vector<Tile> tiles = tilesSeen(map, view, CellLook(map));
    for (auto it = map.begin_leafs(); it != map.end_leafs(); ++it) {
      if (!map.isNodeOccupied(*it)) continue;
      int holders = 0;
      for (const Tile& tile : tiles) holders += contains(tile, it.getIndexKey());
      const Eigen::Vector3d center(it.getX(), it.getY(), it.getZ());
      EXPECT_LE(holders, 1);
      if (view.camera.maySee(center, 0, view.width, view.height)) {
        EXPECT_EQ(holders, 1);
      }
    }
  }
}

TEST(TilesSeen, HoldUnknownSpaceOnce) {
  // Between the two there are tiles of which nothing is known.
  SemanticOcTree map = randomMap(44);
  semantic_types::LabeledCloud far;
  far.points.emplace_back(1, 0, 0);
  far.classes.push_back(1);
  map.insert(far, Eigen::Isometry3d(Eigen::Translation3d(60, 50, 0)));
  CellLook look(map);
  ViewStyle style;
  style.unknownSpace = true;
  style.clip.max().x() = 50;
  look.setStyle(style);
  std::mt19937 random(45);
  for (const double distance : {20.0, 60.0, 3000.0}) {
    const View view = viewFrom(distance);
    const std::vector<Tile> tiles = tilesSeen(map, view, look);
    int unknown = 0;
    for (int i = 0; i < 30000; ++i) {
      const auto near = [&] { return octomap::key_type(32768 + int(random() % 400) - 80); };
      const octomap::OcTreeKey key(near(), near(), near());
      const ViewCell cell = {{{key[0], key[1], key[2]}, kFinestTiles + kTileLevels}, {}};
      if (map.search(key) || !look.isShown(cell)) continue;
      int holders = 0;
      for (const Tile& tile : tiles) holders += contains(tile, key);
      EXPECT_LE(holders, 1);
      if (view.camera.maySee(cell.center(0.2), 0, view.width, view.height)) {
        EXPECT_EQ(holders, 1);
        ++unknown;
      }
    }
    EXPECT_GT(unknown, 10);
  }
}

TEST(TilesSeen, AreCoarserFarAway) {
  const SemanticOcTree map = randomMap(42);
  EXPECT_EQ(finest(tilesSeen(map, viewFrom(5), CellLook(map))), kFinestTiles);
  const int far = finest(tilesSeen(map, viewFrom(1000), CellLook(map)));
  EXPECT_LT(far, kFinestTiles);
  EXPECT_LT(finest(tilesSeen(map, viewFrom(9000), CellLook(map))), far);
  View coarse = viewFrom(1000);
  coarse.pixelsPerCell *= 4;
  EXPECT_LT(finest(tilesSeen(map, coarse, CellLook(map))), far);
}

TEST(TilesSeen, OfNothingAreNone) {
  const SemanticOcTree empty(0.2, threeClasses());
  const auto withAll = [](const SemanticOcTree& map) {
    CellLook look(map);
    ViewStyle style;
    style.freeSpace = style.unknownSpace = true;
    look.setStyle(style);
    return look;
  };
  EXPECT_TRUE(tilesSeen(empty, viewFrom(20), withAll(empty)).empty());
  View away = viewFrom(5);
  away.camera.target.x() = 500;  // and the map behind the camera
  away.camera.azimuth = 180;
  const SemanticOcTree map = randomMap(43);
  EXPECT_TRUE(tilesSeen(map, away, withAll(map)).empty());
}

TEST(FreshTiles, AreThoseWhoseCellsAndTheirNeighborsStayedAsTheyWere) {
  FreshTiles fresh;
  const int edge = Tile{{{0, 0, 0}, kFinestTiles}}.edge();
  const auto tileAt = [&](int x) { return Tile{{{x * edge, 0, 0}, kFinestTiles}}; };
  const Tile around = {{{0, 0, 0}, kFinestTiles - 2}};
  const auto refill = [&] {
    for (int x = 0; x < 8; ++x) fresh.add(tileAt(x));
    fresh.add(around);
  };
  refill();
  fresh.remove(std::vector<KeyBox>{{{70, 5, 5}, {71, 6, 6}}, {{90, 5, 5}, {91, 6, 6}}});
  EXPECT_TRUE(fresh.contains(tileAt(0)));
  EXPECT_FALSE(fresh.contains(tileAt(1)));
  EXPECT_TRUE(fresh.contains(tileAt(2)));
  EXPECT_FALSE(fresh.contains(around));
  refill();
  fresh.remove(std::vector<KeyBox>{{{64, 5, 5}, {64, 5, 5}}});
  EXPECT_FALSE(fresh.contains(tileAt(0))) << "a side of its last cells may be hidden no longer";
  EXPECT_FALSE(fresh.contains(tileAt(1)));
  EXPECT_TRUE(fresh.contains(tileAt(2)));
  fresh.clear();
  EXPECT_FALSE(fresh.contains(tileAt(2)));
}
