#include <gtest/gtest.h>
#include <map_view/TileSet.h>

#include <map>

#include "RandomMap.h"

namespace {

using namespace map_view;
using semantic_octree::kKeyOfOrigin;
using semantic_octree::kTreeDepth;

/** A voxel's side: its key and which of the six. */
using Side = std::array<int, 4>;

const std::array<Eigen::Array3i, 6> kNormals = {
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

/** The sides of occupied voxels next to voxels that are not. */
std::set<Side> sidesOfMap(const SemanticOcTree& map) {
  std::set<Side> sides;
  const auto isOccupied = [&](const Eigen::Array3i& k) {
    const auto node = map.search(semantic_octree::octomapKey(k.x(), k.y(), k.z()));
    return node && map.isNodeOccupied(node);
  };
  for (auto it = map.begin_leafs(); it != map.end_leafs(); ++it) {
    if (!map.isNodeOccupied(*it)) continue;
    const octomap::OcTreeKey low = it.getIndexKey();
    const int edge = semantic_octree::edgeAtDepth(int(it.getDepth()));
    for (int i = 0; i < edge * edge * edge; ++i) {
      const Eigen::Array3i key(low[0] + i % edge, low[1] + i / edge % edge,
                               low[2] + i / edge / edge);
      for (int n = 0; n < 6; ++n)
        if (!isOccupied(key + kNormals[std::size_t(n)]))
          sides.insert({key.x(), key.y(), key.z(), n});
    }
  }
  return sides;
}

/** In all directions. */
std::vector<Face> occupiedOf(const TileMesh& mesh) {
  std::vector<Face> all;
  for (const auto& faces : mesh.occupied) all.insert(all.end(), faces.begin(), faces.end());
  return all;
}

Eigen::Vector3f normalOf(const Face& face) {
  return (face.corners[1] - face.corners[0]).cross(face.corners[2] - face.corners[1]).normalized();
}

/** The sides of voxels that a face of a mesh covers. */
std::vector<Side> sidesOf(const Face& face) {
  const Eigen::Vector3f normal = normalOf(face);
  Eigen::Vector3f low = face.corners[0], high = face.corners[0];
  for (const Eigen::Vector3f& corner : face.corners)
    low = low.cwiseMin(corner), high = high.cwiseMax(corner);
  const auto keyOf = [](float x) { return int(std::lround(x / 0.2f)) + kKeyOfOrigin; };
  int n = 0;
  while (!normal.isApprox(kNormals[std::size_t(n)].cast<float>().matrix(), 1e-3f)) ++n;
  Eigen::Array3i first, end;
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = keyOf(low[axis]), end[axis] = keyOf(high[axis]);
    if (first[axis] == end[axis]) first[axis] -= normal[axis] > 0.5f, end[axis] = first[axis] + 1;
  }
  std::vector<Side> sides;
  for (int x = first.x(); x < end.x(); ++x)
    for (int y = first.y(); y < end.y(); ++y)
      for (int z = first.z(); z < end.z(); ++z) sides.push_back({x, y, z, n});
  return sides;
}

/** All tiles of a depth with something in them. */
std::set<Tile> tilesOf(const SemanticOcTree& map, int depth) {
  std::set<Tile> tiles;
  for (auto it = map.begin_tree(unsigned(depth)); it != map.end_tree(); ++it)
    if (int(it.getDepth()) == depth) {
      const octomap::OcTreeKey key = it.getIndexKey();
      tiles.insert(Tile{{Eigen::Array3i(key[0], key[1], key[2]), depth}});
    }
  return tiles;
}

TEST(TileMesh, HasEachSideThatIsOpenOnceAndNoneThatIsHidden) {
  for (const unsigned seed : {31u, 32u}) {
    const SemanticOcTree map = randomMap(seed);
    const CellSource cells(map);
    const CellLook look(map);
    std::map<Side, int> drawn;
    for (const Tile& tile : tilesOf(map, kFinestTiles))
      for (const Face& face : occupiedOf(meshOf(tile, cells, look))) {
        int open = 0;
        for (const Side& side : sidesOf(face)) ++drawn[side], ++open;
        EXPECT_GT(open, 0);
      }
    const std::set<Side> expected = sidesOfMap(map);
    ASSERT_GT(expected.size(), 5000u);
    for (const Side& side : expected) ASSERT_EQ(drawn[side], 1);
    // A large cell's side is drawn as a whole if a part of it is open.
    EXPECT_LT(drawn.size(), expected.size() * 101 / 100);
  }
}

TEST(TileMesh, OfLargeCellsFitsTogetherFromTileToTile) {
  SemanticOcTree map = randomMap(33);
  semantic_octree::AbstractionOptions options;
  options.weights = {{{"road", 1, {{1}}}}, 0.3};
  options.blockSize = 25.6;  // two tiles
  const LiveCompression compression(map, options);
  const CellSource cells(map, &compression);
  const CellLook look(map);
  double area = 0, expected = 0;
  std::set<Side> sides;
  for (const Tile& tile : tilesOf(map, kFinestTiles))
    for (const Face& face : occupiedOf(meshOf(tile, cells, look)))
      for (const Side& side : sidesOf(face)) EXPECT_TRUE(sides.insert(side).second);
  bool large = false;
  cells.forEachShown({Eigen::Array3i::Zero(), Eigen::Array3i::Constant(65535)}, kTreeDepth, look,
                     [&](const ViewCell& cell) { large = large || cell.edge() > kCellsPerTile; });
  EXPECT_TRUE(large) << "the test needs cells that are larger than tiles";
  for (const Side& side : sides) {
    const Eigen::Array3i key(side[0], side[1], side[2]);
    EXPECT_TRUE(cells.at(key).isOccupied());
    area += !cells.at(key + kNormals[std::size_t(side[3])]).isOccupied();
    expected += 1;
  }
  EXPECT_GT(area, 0.5 * expected);
}

TEST(TileMesh, OfCoarseTilesHasTheSidesOfTheirCells) {
  const SemanticOcTree map = randomMap(34);
  const CellSource cells(map);
  const CellLook look(map);
  const int depth = kFinestTiles - 2;  // cells of 4 voxels
  std::set<std::array<int, 3>> occupied;
  cells.forEachShown({Eigen::Array3i::Zero(), Eigen::Array3i::Constant(65535)}, depth + kTileLevels,
                     look, [&](const ViewCell& cell) {
                       occupied.insert({cell.lowest.x(), cell.lowest.y(), cell.lowest.z()});
                     });
  std::size_t expected = 0, found = 0;
  for (const auto& k : occupied)
    for (const Eigen::Array3i& n : kNormals)
      expected += occupied.count({k[0] + 4 * n.x(), k[1] + 4 * n.y(), k[2] + 4 * n.z()}) == 0;
  for (const Tile& tile : tilesOf(map, depth))
    found += occupiedOf(meshOf(tile, cells, look)).size();
  ASSERT_GT(expected, 500u);
  EXPECT_EQ(found, expected);
}

TEST(TileMesh, ShowsUnknownSpaceWhereItEnds) {
  const SemanticOcTree map = randomMap(38, 1);
  const CellSource cells(map);
  CellLook look(map);
  ViewStyle style;
  style.unknownSpace = true;
  style.clip = {Eigen::Vector3d(-3, -2, -5), Eigen::Vector3d(4, 3, 2)};
  look.setStyle(style);
  const auto isUnknown = [&](const Eigen::Array3i& k) {
    const auto node = map.search(semantic_octree::octomapKey(k.x(), k.y(), k.z()));
    return look.isShown({k, kTreeDepth, node, 0}) && !node;
  };
  const auto isSolid = [&](const Eigen::Array3i& k) {
    const auto node = map.search(semantic_octree::octomapKey(k.x(), k.y(), k.z()));
    return look.isShown({k, kTreeDepth, node, 0}) && node && map.isNodeOccupied(node);
  };
  std::set<Side> expected;
  for (int x = -16; x < 21; ++x)
    for (int y = -11; y < 16; ++y)
      for (int z = -26; z < 11; ++z)
        for (int n = 0; n < 6; ++n) {
          const Eigen::Array3i key = Eigen::Array3i(x, y, z) + kKeyOfOrigin,
                               next = key + kNormals[std::size_t(n)];
          if (isUnknown(key) && !isUnknown(next) && !isSolid(next))
            expected.insert({key.x(), key.y(), key.z(), n});
        }
  ASSERT_GT(expected.size(), 2000u);
  std::map<Side, int> drawn;
  View view;
  view.pixelsPerCell = 0.1;
  for (const Tile& tile : tilesSeen(map, view, look))
    for (const Face& face : meshOf(tile, cells, look).translucent)
      for (const Side& side : sidesOf(face)) ++drawn[side];
  for (const Side& side : expected) ASSERT_EQ(drawn[side], 1);
  for (const auto& [side, times] : drawn) EXPECT_EQ(times, 1);
  // A large cell's side is drawn as a whole if a part of it is open.
  EXPECT_LT(drawn.size(), expected.size() * 5 / 4);
}

TEST(TileMesh, SidesThatLookAwayFromAPlaceAreNotSeenFromThere) {
  const SemanticOcTree map = randomMap(37);
  const CellSource cells(map);
  const CellLook look(map);
  std::mt19937 random(38);
  std::uniform_real_distribution<double> unit(-15, 15);
  int hidden = 0;
  for (const Tile& tile : tilesOf(map, kFinestTiles)) {
    const TileMesh mesh = meshOf(tile, cells, look);
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d place(unit(random), unit(random), unit(random));
      for (std::size_t d = 0; d < kNumDirections; ++d) {
        const bool may = mayFace(tile, d, place, 0.2);
        hidden += !may;
        for (const Face& face : mesh.occupied[d]) {
          EXPECT_TRUE(normalOf(face).isApprox(map_view::normalOf(d).cast<float>(), 1e-3f));
          const bool faces =
              normalOf(face).cast<double>().dot(place - face.corners[0].cast<double>()) > 0;
          EXPECT_TRUE(may || !faces);
        }
      }
    }
  }
  EXPECT_GT(hidden, 50);
}

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
