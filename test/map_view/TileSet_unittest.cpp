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
    const std::vector<Tile> tiles = tilesSeen(map, view, false);
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

TEST(TilesSeen, AreCoarserFarAway) {
  const SemanticOcTree map = randomMap(42);
  EXPECT_EQ(finest(tilesSeen(map, viewFrom(5), false)), kFinestTiles);
  const int far = finest(tilesSeen(map, viewFrom(1000), false));
  EXPECT_LT(far, kFinestTiles);
  EXPECT_LT(finest(tilesSeen(map, viewFrom(9000), false)), far);
  View coarse = viewFrom(1000);
  coarse.pixelsPerCell *= 4;
  EXPECT_LT(finest(tilesSeen(map, coarse, false)), far);
}

TEST(TilesSeen, OfNothingAreNone) {
  const SemanticOcTree empty(0.2, threeClasses());
  EXPECT_TRUE(tilesSeen(empty, viewFrom(20), true).empty());
  View away = viewFrom(5);
  away.camera.target.x() = 500;  // and the map behind the camera
  away.camera.azimuth = 180;
  EXPECT_TRUE(tilesSeen(randomMap(43), away, true).empty());
}

TEST(FreshTiles, AreThoseWhoseCellsAndTheirNeighborsStayedAsTheyWere) {
  FreshTiles fresh;
  const int edge = Tile{kFinestTiles, {}}.edge();
  const auto tileAt = [&](int x) { return Tile{kFinestTiles, {x * edge, 0, 0}}; };
  const Tile around = {kFinestTiles - 2, {0, 0, 0}};
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
