// Whatever is done with a map in a folder of tiles gives, bit for bit, what is done with the same
// map in memory.
#include <gtest/gtest.h>
#include <map_correction/KeyframeMap.h>
#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>
#include <map_streams/MapStream.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/MapFollower.h>

#include <functional>
#include <tuple>

#include "FolderDrive.h"
#include "FollowedTree.h"

using namespace folder_drive;

namespace {

/** How a map comes to be. */
struct Making {
  const char* name;
  bool upkeep = false, halfLives = false, corrections = false;
  double tileSize = 6.4;
};

const Making kMakings[] = {
    {"scans"}, {"corrections", false, false, true}, {"allTogether", true, true, true, 3.2}};

SemanticOcTree emptyMapOf(const Making& making) {
  semantic_types::ClassTable classes = numberedClasses(5);
  for (const semantic_types::ClassId id : {0, 1, 2, 4})
    if (making.halfLives) classes.setHalfLife(id, 0.6 + 0.7 * id);
  return SemanticOcTree(0.4, classes);
}

/** Scans lie 0.3 s apart if the map is aged. */
double secondsSince(const Making& making) { return making.halfLives ? 0.3 : 0; }

void insert(SemanticOcTree& map, const Making& making, const std::vector<PosedCloud>& scans) {
  for (const PosedCloud& scan : scans)
    map.insert(scan.cloud, scan.T_map_sensor, {}, secondsSince(making));
}

/** Each scan a keyframe; of these some move together, one alone, and one goes. */
void insertAndCorrect(SemanticOcTree& map, const Making& making,
                      const std::vector<PosedCloud>& scans, const std::function<void()>& look) {
  KeyframeMap keyframes(map);
  for (const PosedCloud& scan : scans) {
    keyframes.begin(scan.T_map_sensor);
    keyframes.insert(scan.cloud, Eigen::Isometry3d::Identity(), {}, secondsSince(making));
  }
  look();
  std::mt19937 random(9);
  std::vector<KeyframePose> poses;
  for (const KeyframeId id : {0u, 3u, 5u})
    poses.push_back({id, keyframes.pose(id) * randomPose(random, 0.7)});
  keyframes.move(poses);
  look();
  keyframes.move({{1, keyframes.pose(1) * Eigen::Translation3d(9, 2, 0)}});
  keyframes.remove({2});
}

void make(SemanticOcTree& map, const Making& making, const std::function<void()>& look) {
  const auto scans = someScans(31, 6);
  if (making.upkeep) setAbstraction(map, someAbstraction());
  making.corrections ? insertAndCorrect(map, making, scans, look) : insert(map, making, scans);
  look();
  map.age(secondsSince(making));
}

SemanticOcTree loadedAnew(const SemanticOcTree& tree) {
  std::istringstream in(bytesOf(tree));
  return readTree(in);
}

/** One map is in memory, its twin in a folder of which hardly anything is loaded. */
class Composition : public testing::TestWithParam<Making> {
 protected:
  Composition() : whole(emptyMapOf(GetParam())), map(whole) {
    open(MapFolder::Access::Write);
    make(whole, GetParam(), [] {});
    make(map, GetParam(), [] {});
  }
  void open(MapFolder::Access access) {
    tiles = nullptr;
    map = emptyMapOf(GetParam());
    tiles = std::make_unique<MapFolder>(map, folder / "map", access, tight(GetParam().tileSize));
  }
  void expectSame() {
    EXPECT_TRUE(map == whole);
    EXPECT_EQ(map.size(), whole.size());
    EXPECT_EQ(map.getNumLeafNodes(), whole.getNumLeafNodes());
    EXPECT_EQ(map.clock(), whole.clock());
    EXPECT_TRUE(bytesOf(map) == bytesOf(whole));
    if (GetParam().upkeep) {
      EXPECT_EQ(Abstraction(map).objective(), Abstraction(whole).objective());
      EXPECT_EQ(Abstraction(map).leaves(), Abstraction(whole).leaves());
    }
  }
  /** The folder, as whoever opens it finds it. */
  void expectSaved() {
    tiles->save();
    EXPECT_TRUE(loadMap(folder / "map") == whole);
    EXPECT_EQ(loadMap(folder / "map").memoryUsage(), loadedAnew(whole).memoryUsage());
  }
  void insertIntoBoth(unsigned seed) {
    insert(whole, GetParam(), someScans(seed, 3));
    insert(map, GetParam(), someScans(seed, 3));
  }

  const TemporaryFolder folder;
  SemanticOcTree whole, map;
  std::unique_ptr<MapFolder> tiles;
};

}  // namespace

TEST_P(Composition, whileItIsMadeIsThatInMemory) {
  EXPECT_GT(tiles->contents().broughtIn, 10u);
  EXPECT_LT(tiles->contents().tilesInMemory, tiles->contents().tiles / 2);
  expectSame();
}

TEST_P(Composition, withCopies) {
  SemanticOcTree copy(map), expected(whole);
  EXPECT_TRUE(copy == expected);
  EXPECT_EQ(copy.memoryUsage(), expected.memoryUsage());
  insert(copy, GetParam(), someScans(32, 3));
  insert(expected, GetParam(), someScans(32, 3));
  EXPECT_TRUE(copy == expected);
  EXPECT_FALSE(copy == map);
  expectSame();
  expectSaved();
}

TEST_P(Composition, withOperations) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-7, -6, -2), Eigen::Vector3d(9, 5, 4));
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.5, Eigen::Vector3d(0, 0.6, 0.8));
  EXPECT_TRUE(cropped(map, box) == cropped(whole, box));
  EXPECT_TRUE(coarsened(map, 2) == coarsened(whole, 2));
  EXPECT_TRUE(moved(map, pose) == moved(whole, pose));
  EXPECT_EQ(contentsOf(map).voxelsOfClass, contentsOf(whole).voxelsOfClass);
  EXPECT_TRUE(contentsOf(map).box.isApprox(contentsOf(whole).box));
  expectSame();
}

TEST_P(Composition, withSums) {
  SemanticOcTree other = emptyMapOf(GetParam());
  insert(other, GetParam(), someScans(33, 3));
  EXPECT_TRUE(merged({&map, &other}) == merged({&whole, &other}));
  StoredMap sum(emptyLike(merged({&whole, &other})), folder / "sum", tight());
  mergeTo(sum.tree(), {&map, &other});
  EXPECT_TRUE(sum.tree() == merged({&whole, &other}));
  expectSame();
}

TEST_P(Composition, withStreams) {
  const auto packetsOf = [](SemanticOcTree& of) {
    if (!hasAbstraction(of)) setAbstraction(of, someAbstraction());
    MapSender sender(1);
    sender.setMap(of);
    std::string packets;
    while (const auto packet = sender.next()) packets += packet->bytes();
    return packets;
  };
  const std::string packets = packetsOf(whole);
  EXPECT_GT(packets.size(), 1000u);
  EXPECT_TRUE(packetsOf(map) == packets);
  expectSame();
}

TEST_P(Composition, withSavingAndGoingOn) {
  expectSaved();
  open(MapFolder::Access::Write);
  if (GetParam().upkeep) setAbstraction(map, someAbstraction());
  expectSame();
  insertIntoBoth(34);
  whole.age(secondsSince(GetParam()));
  map.age(secondsSince(GetParam()));
  expectSame();
  expectSaved();
}

TEST_P(Composition, withADraft) {
  expectSaved();
  const std::string saved = bytesOf(whole);
  tiles = nullptr;
  map = emptyMapOf(GetParam());
  MapFolderOptions options = tight();
  options.draft = folder / "draft";
  tiles = std::make_unique<MapFolder>(map, folder / "map", kRead, options);
  if (GetParam().upkeep) setAbstraction(map, someAbstraction());
  insertIntoBoth(35);
  whole.age(5);
  map.age(5);
  expectSame();
  EXPECT_THROW(tiles->save(), std::logic_error);
  EXPECT_TRUE(bytesOf(loadMap(folder / "map")) == saved);
  tiles = nullptr;
  EXPECT_FALSE(std::filesystem::exists(folder / "draft"));
}

TEST_P(Composition, withClearing) {
  tiles->save();
  const std::string saved = bytesOf(whole);
  whole.clear();
  map.clear();
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(tiles->contents().tiles, 0u);
  expectSame();
  make(whole, GetParam(), [] {});
  make(map, GetParam(), [] {});
  insertIntoBoth(36);
  expectSame();
  EXPECT_TRUE(bytesOf(loadMap(folder / "map")) == saved);  // until it is saved anew
  expectSaved();
  whole.clear();
  map.clear();
  expectSaved();
  tiles = nullptr;
  open(MapFolder::Access::Write);  // removes what no map needs
  EXPECT_TRUE(tileFiles(folder / "map").empty());
}

TEST_P(Composition, tellsItsReadersWhatTheyAreToldInMemory) {
  SemanticOcTree plain = emptyMapOf(GetParam()), inTiles = plain;
  const MapFolder folderOfTiles(inTiles, folder / "followed", kWrite, tight());
  MapFollower ofPlain = plain.follow(), ofTiles = inTiles.follow();
  std::vector<std::vector<octomap::OcTreeKey>> told, toldOfTiles;
  make(plain, GetParam(), [&] { told.push_back(ofPlain.tiles().tiles); });
  make(inTiles, GetParam(), [&] { toldOfTiles.push_back(ofTiles.tiles().tiles); });
  EXPECT_TRUE(told == toldOfTiles);
  EXPECT_TRUE(ofPlain.tiles().tiles == ofTiles.tiles().tiles);
}

INSTANTIATE_TEST_SUITE_P(OfTiles, Composition, testing::ValuesIn(kMakings),
                         [](const auto& making) { return making.param.name; });

TEST(CompositionOfTiles, compressedTreesAreFollowedThroughAgingAndCorrections) {
  Making making{"", true, true};
  const TemporaryFolder folder;
  SemanticOcTree map = emptyMapOf(making);
  const MapFolder tiles(map, folder / "map", kWrite, tight(3.2));
  setAbstraction(map, someAbstraction());
  FollowedTree told(map);
  making.upkeep = false;
  insertAndCorrect(map, making, someScans(37, 8), [&] { told.follow(); });
  told.follow();
  for (int i = 0; i < 4; ++i) {
    map.age(0.7);
    told.follow();
  }
}

TEST(CompositionOfTiles, halfLivesMayBeGivenAndTaken) {
  const Making plain{""}, ages{"", false, true};
  const TemporaryFolder folder;
  SemanticOcTree whole = emptyMapOf(plain);
  const auto change = [&](SemanticOcTree& map, int step) {
    map.setHalfLives(emptyMapOf(step % 2 ? plain : ages).classes());
    insert(map, ages, someScans(40 + unsigned(step), 2));
    map.age(0.9);
  };
  for (int step = 0; step < 4; ++step) {
    SemanticOcTree map = emptyMapOf(step % 2 ? plain : ages);  // these hold from now on
    MapFolder tiles(map, folder / "map", kWrite, tight());
    change(whole, step);
    change(map, step);
    EXPECT_TRUE(map == whole) << step;
    tiles.save();
    whole = loadedAnew(whole);  // files of maps without half-lives have no clock
    EXPECT_TRUE(loadMap(folder / "map") == whole) << step;
  }
}

TEST(CompositionOfTiles, ifATileCannotBeReadMeanwhileTheFolderIsWhatWasSaved) {
  const Making making{"", false, true};
  const TemporaryFolder folder;
  SemanticOcTree map = emptyMapOf(making);
  MapFolder tiles(map, folder / "map", kWrite, tight());
  insert(map, making, someScans(38, 6));
  tiles.save();
  const auto before = loadMap(folder / "map");
  const auto file = tileFiles(folder / "map")[5];
  const std::string content = contentOf(file);
  write(file, content.substr(0, content.size() / 2));
  EXPECT_TRUE(contains(errorOf([&] { SemanticOcTree copy(map); }), file.string()));
  EXPECT_FALSE(map.isBroken());
  EXPECT_TRUE(contains(errorOf([&] { map.age(3); }), file.string()));
  EXPECT_TRUE(map.isBroken());
  EXPECT_THROW(tiles.save(), std::logic_error);
  write(file, content);
  EXPECT_TRUE(loadMap(folder / "map") == before);
}
