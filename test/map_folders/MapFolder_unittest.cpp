#include <fcntl.h>
#include <gtest/gtest.h>
#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>
#include <semantic_abstraction/AlphaTrees.h>
#include <semantic_octree/MapFollower.h>
#include <semantic_octree/store/MapAccess.h>
#include <sys/resource.h>
#include <unistd.h>

#include <functional>
#include <numeric>

#include "FolderDrive.h"
#include "Voxels.h"

using namespace folder_drive;

namespace {

struct Variant {
  const char* name;
  double tileSize = 3.2;
  bool pruning = true, softLabels = false;
  int threads = 1;
};

const Variant kVariants[] = {{"smallest tiles"},
                             {"larger tiles", 12.8},
                             {"not pruned", 6.4, false},
                             {"soft labels", 6.4, true, true},
                             {"three threads", 6.4, true, false, 3}};

void expectSameAnswers(const SemanticOcTree& map, const SemanticOcTree& expected) {
  std::mt19937 random(5);
  for (int i = 0; i < 500; ++i) {
    const octomap::point3d at(static_cast<float>(between(random, -15, 15)),
                              static_cast<float>(between(random, -15, 15)),
                              static_cast<float>(between(random, -15, 15)));
    const CellState a = map.query(at.x(), at.y(), at.z()),
                    b = expected.query(at.x(), at.y(), at.z());
    EXPECT_EQ(a.status, b.status);
    EXPECT_EQ(a.occupancy, b.occupancy);
    EXPECT_EQ(a.likeliestClass, b.likeliestClass);
    EXPECT_EQ(a.probability, b.probability);
    if (i % 10) continue;
    const auto hit = map.castRay({0, 0, 0}, at), other = expected.castRay({0, 0, 0}, at);
    ASSERT_EQ(hit.has_value(), other.has_value());
    if (hit) {
      EXPECT_EQ(hit->key, other->key);
    }
  }
}

MapFolderOptions draftIn(const std::filesystem::path& place) {
  MapFolderOptions options = tight();
  options.draft = place;
  return options;
}

std::vector<PosedCloud> firstOf(const std::vector<PosedCloud>& scans, std::size_t n) {
  return {scans.begin(), scans.begin() + static_cast<std::ptrdiff_t>(n)};
}

TEST(MapFolder, isTheMapInOnePieceToTheLastBit) {
  for (const Variant& v : kVariants) {
    SCOPED_TRACE(v.name);
    const TemporaryFolder folder;
    const auto scans = someScans(1, 12, v.softLabels);
    SemanticOcTree whole = emptyMap(v.pruning), map = emptyMap(v.pruning);
    MapFolder tiles(map, folder / "map", kWrite, tight(v.tileSize));
    insertAll(whole, scans, v.threads);
    insertAll(map, scans, v.threads);
    EXPECT_GT(tiles.contents().broughtIn, 10u);
    EXPECT_GT(tiles.contents().sentOut, 10u);
    EXPECT_EQ(map.size(), whole.size());
    EXPECT_EQ(map.getNumLeafNodes(), whole.getNumLeafNodes());
    expectSameAnswers(map, whole);
    EXPECT_EQ(voxelsOf(map), voxelsOf(whole));
    EXPECT_TRUE(map == whole);
    EXPECT_EQ(bytesOf(map), bytesOf(whole));
    tiles.save();
    EXPECT_TRUE(loadMap(folder / "map") == whole);
    EXPECT_EQ(loadMap(folder / "map").size(), whole.size());
    EXPECT_EQ(loadMap(folder / "map").memoryUsage(), whole.memoryUsage());
  }
}

TEST(MapFolder, tellsOfEachTileInTheOrderInWhichReadersNeedThem) {
  const TemporaryFolder folder;
  saveScans(folder / "map", someScans(2, 6));
  SemanticOcTree map = emptyMap();
  MapFolder tiles(map, folder / "map", kRead, tight());
  std::vector<std::size_t> told, expected(tiles.contents().tiles);
  std::iota(expected.begin(), expected.end(), std::size_t{0});
  tiles.onTile([&told](std::size_t number) { told.push_back(number); });
  contentsOf(map);
  EXPECT_GT(told.size(), 10u);
  EXPECT_EQ(told, expected);
  tiles.onTile({});
  tiles.problems();
  EXPECT_EQ(told, expected);
  SemanticOcTree all = emptyMap();
  MapFolder inMemory(all, folder / "map", kRead, tight());
  told.clear();
  inMemory.onTile([&told](std::size_t number) { told.push_back(number); });
  inMemory.bringAll();
  EXPECT_EQ(told, expected);
}

TEST(MapFolder, staysWithinItsBudgetButForAScan) {
  const TemporaryFolder folder;
  SemanticOcTree map = emptyMap();
  MapFolderOptions options = tight();
  options.memory = 0.3;
  MapFolder tiles(map, folder / "map", kWrite, options);
  for (const PosedCloud& scan : someScans(3, 60)) {
    SemanticOcTree alone = emptyMap();
    alone.insert(scan.cloud, scan.T_map_sensor);
    map.insert(scan.cloud, scan.T_map_sensor);
    EXPECT_LT(map.memoryUsage(), 300000 + 4 * alone.memoryUsage());
  }
  const std::size_t least = tiles.contents().tilesInMemory;
  EXPECT_GT(least, 0u);
  EXPECT_LT(least, tiles.contents().tiles);
  EXPECT_TRUE(map.query(100, 100, 100).status == CellState::Status::Unknown);
}

/** Sees the most memory that a map has, also while a tile comes in. */
class Watcher final : public NodeObserver, public NodeObserver::Worker {
 public:
  explicit Watcher(std::size_t& most) : m_most(most) {}
  std::size_t stateBytes() const override { return 8; }
  NodeObserver::Worker& worker(int) override { return *this; }
  bool sameState(const NodeStore&, const Slot&, const NodeStore&, const Slot&) const override {
    return true;
  }
  void tellAll() override {}
  std::unique_ptr<NodeObserver> clone() const override { return std::make_unique<Watcher>(m_most); }
  void recompute(NodeStore& store, Slot&, const Cube&, bool) override {
    m_most = std::max(m_most, store.bytes());
  }

 private:
  std::size_t& m_most;
};

}  // namespace

TEST(MapFolder, hasRoomBeforeATileComes) {
  const TemporaryFolder folder;
  saveScans(folder / "map", someScans(4, 6));
  SemanticOcTree map = emptyMap();
  MapFolderOptions options = tight();
  options.memory = 0;
  const MapFolder tiles(map, folder / "map", kRead, options);
  std::size_t most = 0, largest = 0;
  MapAccess::setObserver(map, std::make_unique<Watcher>(most));
  most = 0;
  for (const auto& file : tileFiles(folder / "map")) {
    const Eigen::Vector3d center = 6.4 * (placeOf(file).array() + 0.5);
    map.query(center.x(), center.y(), center.z());
    largest = std::max(largest, map.memoryUsage());
  }
  EXPECT_GT(most, 0u);
  EXPECT_LE(most, largest);
}

TEST(MapFolder, keepsWhatWasUsedLast) {
  const TemporaryFolder folder;
  saveScans(folder / "map", someScans(4, 6));
  SemanticOcTree map = emptyMap();
  MapFolderOptions options = tight();
  options.memory = 1e-6 * static_cast<double>(loadMap(folder / "map").memoryUsage()) / 2;
  MapFolder tiles(map, folder / "map", kRead, options);
  const auto ask = [&](std::size_t i) {
    const Eigen::Vector3d center = 6.4 * (placeOf(tileFiles(folder / "map")[i]).array() + 0.5);
    map.query(center.x(), center.y(), center.z());
    return tiles.contents().broughtIn;
  };
  EXPECT_EQ(ask(0), 1u);
  EXPECT_EQ(ask(1), 2u);
  EXPECT_EQ(ask(0), 2u);
  const std::size_t n = tiles.contents().tiles;
  for (std::size_t i = 2; i < n; ++i) EXPECT_EQ(ask(i), i + 1);
  EXPECT_EQ(ask(n - 1), n);
  EXPECT_EQ(ask(0), n + 1);
}

TEST(MapFolder, aTilesFileIsAMapOfItsCubeAlone) {
  const TemporaryFolder folder;
  const auto scans = someScans(5, 2);
  saveScans(folder / "map", scans);
  SemanticOcTree whole = emptyMap();
  insertAll(whole, scans);
  std::map<VoxelId, std::vector<double>> all;
  for (const auto& file : tileFiles(folder / "map")) {
    const Eigen::Vector3d at = placeOf(file);
    const SemanticOcTree tile = loadMap(file);
    const auto voxels = voxelsOf(tile);
    for (const auto& [voxel, p] : voxels)
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_EQ(std::floor((voxel[axis] - (voxel[axis] > 10000 ? 32768 : 0)) / 16.0), at[axis]);
    all.insert(voxels.begin(), voxels.end());
  }
  for (const auto& file : std::filesystem::directory_iterator(folder / "map"))
    if (file.path().filename().string().rfind("leaves", 0) == 0) {
      const auto voxels = voxelsOf(loadMap(file.path()));
      EXPECT_FALSE(voxels.empty());  // what is free as a whole
      all.insert(voxels.begin(), voxels.end());
    }
  EXPECT_EQ(all, voxelsOf(whole));
}

TEST(MapFolder, abstractionByTileIsThatOfTheWhole) {
  for (const auto frame : {AbstractionOptions::Frame::Free, AbstractionOptions::Frame::Charged})
    for (const bool before : {true, false}) {
      const TemporaryFolder folder;
      const auto scans = someScans(6, 10);
      AbstractionOptions options = someAbstraction();
      options.frame = frame;
      options.regions = {{Region::Shape::Sphere, {1, 2, 0}, {}, 5, 3}};
      SemanticOcTree whole = emptyMap(), map = emptyMap();
      setAbstraction(whole, options);
      MapFolder tiles(map, folder / "map", kWrite, tight(before ? 6.4 : 12.8));
      if (before) setAbstraction(map, options);
      insertAll(whole, scans);
      insertAll(map, scans);
      if (!before) setAbstraction(map, options);
      Abstraction a(map), b(whole);
      const auto expectSame = [&] {
        EXPECT_EQ(a.objective(), b.objective());
        EXPECT_EQ(a.measures().compressed.information, b.measures().compressed.information);
        EXPECT_EQ(a.measures().compressed.numLeaves, b.measures().compressed.numLeaves);
        EXPECT_EQ(AlphaTrees(a).alphaForLeaves(3000), AlphaTrees(b).alphaForLeaves(3000));
        EXPECT_TRUE(a.compressedMap() == b.compressedMap());
        EXPECT_EQ(a.leaves(), b.leaves());
        EXPECT_TRUE(map == whole);  // all G-values and mixtures
      };
      expectSame();
      a.setWeights({2, 1}, 0.003);
      b.setWeights({2, 1}, 0.003);
      expectSame();
      a.setRegions({});
      b.setRegions({});
      expectSame();
      EXPECT_LT(tiles.contents().tilesInMemory, tiles.contents().tiles);
    }
}

TEST(MapFolder, whoFollowedTheMapBeforeIsToldAllThatIsInIt) {
  const TemporaryFolder folder;
  saveScans(folder / "map", someScans(7, 4));
  SemanticOcTree map = emptyMap();
  MapFollower follower = map.follow();
  EXPECT_TRUE(follower.tiles().tiles.empty());
  const MapFolder tiles(map, folder / "map", MapFolder::Access::Read, tight());
  const TileChange change = follower.tiles();
  EXPECT_TRUE(change.all);
  EXPECT_EQ(change.tiles, map.follow().tiles().tiles);
  EXPECT_GT(change.tiles.size(), 100u);
}

TEST(MapFolder, isCroppedWithoutReadingAllTiles) {
  const TemporaryFolder folder;
  saveScans(folder / "map", someScans(8, 8));
  SemanticOcTree map = emptyMap();
  MapFolder tiles(map, folder / "map", kRead, tight());
  EXPECT_FALSE(cropped(map, {Eigen::Vector3d(-5, -6, -2), Eigen::Vector3d(7, 5, 4)}).empty());
  EXPECT_LT(tiles.contents().broughtIn, tiles.contents().tiles);
}

TEST(MapFolder, changesOnlyIfItMay) {
  const TemporaryFolder folder;
  const auto scans = someScans(9, 3);
  saveScans(folder / "map", scans);
  SemanticOcTree map = emptyMap();
  {
    MapFolder tiles(map, folder / "map", kRead, tight());
    const std::string before = bytesOf(map);
    const auto expectRefused = [&](const std::function<void()>& change) {
      EXPECT_TRUE(contains(errorOf(change), "opened to be read"));
      EXPECT_TRUE(bytesOf(map) == before);
    };
    expectRefused([&] { map.clear(); });
    expectRefused([&] { insertAll(map, scans); });
    expectRefused([&] { map.setHalfLives(map.classes()); });
    expectRefused([&] { tiles.save(); });
    EXPECT_THROW(MapFolder(map, folder / "map", kRead), std::invalid_argument);
  }
  EXPECT_THROW(bytesOf(map), std::logic_error);  // its folder was closed
  map.clear();
  insertAll(map, scans);  // it is a map in memory
  EXPECT_TRUE(map == loadMap(folder / "map"));
  SemanticOcTree aging = emptyMap();
  semantic_types::ClassTable halfLives = aging.classes();
  halfLives.setHalfLife(semantic_types::kNoClass, 1);
  aging.setHalfLives(halfLives);
  MapFolder tiles(aging, folder / "map", kRead, tight());
  EXPECT_TRUE(contains(errorOf([&] { aging.age(1); }), "opened to be read"));
  EXPECT_EQ(aging.clock(), 0);
  SemanticOcTree other = emptyMap();
  const MapFolder writer(other, folder / "map", kWrite, tight());
  insertAll(other, {scans[0]});
  other.clear();
  EXPECT_THROW(MapFolder(other, folder / "other", kWrite), std::invalid_argument);
}

TEST(MapFolder, anEmptyMapIsOne) {
  const TemporaryFolder folder;
  saveScans(folder / "map", {});
  EXPECT_TRUE(MapFolder::isAt(folder / "map"));
  EXPECT_TRUE(loadMap(folder / "map") == emptyMap());
}

TEST(MapFolder, withoutTilesThatAreNotWantedTheirCubesAreUnknown) {
  const TemporaryFolder folder;
  saveScans(folder / "map", someScans(3, 8));
  const auto isRight = [](const Eigen::AlignedBox3d& cube) { return cube.min().x() >= 0; };
  StoredMap all(folder / "map"), right(folder / "map", 500, isRight);
  constexpr double kFar = 60;
  const Eigen::AlignedBox3d half(Eigen::Vector3d(0, -kFar, -kFar), Eigen::Vector3d::Constant(kFar));
  EXPECT_TRUE(cropped(right.tree(), half) == cropped(all.tree(), half));
  std::size_t leaves = 0;
  for (auto leaf = right.tree().begin_leafs(); leaf != right.tree().end_leafs(); ++leaf)
    if (const auto cube = leaf.getCoordinate(); cube.x() < 0)
      EXPECT_GE(leaf.getSize(), 6.4);  // those are in no tile
    else
      ++leaves;
  EXPECT_GT(leaves, 1000u);
  EXPECT_LT(right.folder()->contents().tiles, all.folder()->contents().tiles);
}

TEST(MapDrafts, goOnWhileAnotherProcessSavesTheFolder) {
  const TemporaryFolder folder;
  const auto scans = someScans(4, 9);
  saveScans(folder / "map", firstOf(scans, 3));
  SemanticOcTree map = emptyMap(), whole = emptyMap();
  const MapFolder draft(map, folder / "map", kRead, draftIn(folder / "draft"));
  insertAll(map, {scans[3], scans[4]});
  saveScans(folder / "map", {scans.begin() + 5, scans.end()});  // adds to it
  insertAll(map, {scans[3], scans[4]});
  insertAll(whole, firstOf(scans, 5));
  insertAll(whole, {scans[3], scans[4]});
  EXPECT_TRUE(map == whole);
}

TEST(MapDrafts, ofMapsInOneFileAreTheMap) {
  const TemporaryFolder folder;
  SemanticOcTree whole = emptyMap();
  insertAll(whole, someScans(6, 3));
  saveTree(whole, (folder / "map.semantic").string());
  StoredMap stored(folder / "map.semantic", draftIn(folder / "draft"));
  EXPECT_TRUE(stored.tree() == whole);
  EXPECT_EQ(stored.folder(), nullptr);
}

TEST_F(FolderTest, saysThatTooManyFilesAreOpen) {
  saveScans(folder / "map", someScans(5, 2));
  const int next = open("/dev/null", O_RDONLY | O_CLOEXEC);
  close(next);
  rlimit before = {};
  getrlimit(RLIMIT_NOFILE, &before);
  std::string errors;
  for (int more = 0; more < 4; ++more) {
    const rlimit few = {static_cast<rlim_t>(next + more), before.rlim_max};
    setrlimit(RLIMIT_NOFILE, &few);
    SemanticOcTree map = emptyMap();
    errors += errorOf([&] { MapFolder(map, folder / "map", kWrite); }) + "\n";
    setrlimit(RLIMIT_NOFILE, &before);
  }
  EXPECT_TRUE(contains(errors, path("map") + ": Too many open files")) << errors;
  EXPECT_FALSE(contains(errors, "another process")) << errors;
}
