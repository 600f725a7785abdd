// Maps that are made of others, in folders of tiles: what would not fit into memory as a whole.
#include <gtest/gtest.h>
#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>
#include <semantic_abstraction/Abstraction.h>

#include <strict_files/Words.h>

#include "FolderDrive.h"

using namespace folder_drive;

namespace {

using FilledFolders = FolderTest;

/** Maps of different places that overlap, one of them compressed. */
std::vector<SemanticOcTree> someMaps() {
  std::vector<SemanticOcTree> maps;
  for (const unsigned seed : {21u, 22u}) {
    maps.push_back(emptyMap());
    insertAll(maps.back(), someScans(seed, 8));
  }
  SemanticOcTree full = maps.front();
  setAbstraction(full, someAbstraction());
  maps.push_back(Abstraction(full).compressedMap());
  return maps;
}

/** Fills a map in a folder, saves it, and compares it with the expected one, in the folder and read
 * again. */
template <typename F>
void expectFilled(const SemanticOcTree& expected, const F& fill) {
  for (const double tileSize : {3.2, 12.8}) {
    const TemporaryFolder folder;
    StoredMap stored(emptyLike(expected), folder / "map", {0, tileSize});
    fill(stored.tree());
    EXPECT_TRUE(stored.tree() == expected);
    EXPECT_EQ(stored.tree().getNumLeafNodes(), expected.getNumLeafNodes());
    stored.folder()->save();
    EXPECT_TRUE(loadMap(folder / "map") == expected);
    EXPECT_EQ(bytesOf(stored.tree()), bytesOf(expected));
  }
}

}  // namespace

TEST_F(FilledFolders, copiesAreTheSameToTheLastBit) {
  for (const SemanticOcTree& map : someMaps())
    expectFilled(map, [&](SemanticOcTree& copy) { copyTo(copy, map); });
  SemanticOcTree notPruned = emptyMap(false);
  insertAll(notPruned, someScans(23, 3));
  expectFilled(notPruned, [&](SemanticOcTree& copy) { copyTo(copy, notPruned); });
}

TEST_F(FilledFolders, compressedTreesAreThoseInMemory) {
  for (const auto frame : {AbstractionOptions::Frame::Free, AbstractionOptions::Frame::Charged}) {
    const TemporaryFolder fresh;
    const auto scans = someScans(24, 8);
    SemanticOcTree whole = emptyMap();
    insertAll(whole, scans);
    saveScans(fresh / "map", scans);
    StoredMap stored(fresh / "map", tight().memory);
    AbstractionOptions options = someAbstraction();
    options.frame = frame;
    setAbstraction(whole, options);
    setAbstraction(stored.tree(), options);
    expectFilled(Abstraction(whole).compressedMap(), [&](SemanticOcTree& compressed) {
      Abstraction(stored.tree()).compressTo(compressed);
    });
  }
}

TEST_F(FilledFolders, stayWithinTheBudgetWhileTheyAreFilled) {
  SemanticOcTree map = emptyMap();
  insertAll(map, someScans(25, 40));
  StoredMap stored(emptyLike(map), folder / "map", tight());
  copyTo(stored.tree(), map);
  EXPECT_LT(stored.tree().memoryUsage(), map.memoryUsage() / 5);
  EXPECT_LT(stored.folder()->contents().tilesInMemory, stored.folder()->contents().tiles / 4);
}

TEST_F(FilledFolders, abstractionIsKeptAnewAndNoMoreWhereverTilesAre) {
  const auto scans = someScans(26, 8);
  SemanticOcTree whole = emptyMap(), map = emptyMap();
  MapFolder tiles(map, folder / "map", kWrite, tight(3.2));
  insertAll(whole, scans);
  insertAll(map, scans);
  AbstractionOptions more = someAbstraction();
  more.weights.terms.push_back(tree_abstraction::relevant("3", 1, {3, 4}));
  for (const AbstractionOptions& options : {someAbstraction(), more}) {
    setAbstraction(whole, options);
    setAbstraction(map, options);
    EXPECT_TRUE(map == whole);
  }
  dropAbstraction(whole);
  dropAbstraction(map);
  EXPECT_TRUE(map == whole);
  EXPECT_EQ(map.size(), whole.size());
  insertAll(whole, scans);
  insertAll(map, scans);
  EXPECT_TRUE(map == whole);
  tiles.save();
  EXPECT_TRUE(loadMap(folder / "map") == whole);
}

TEST_F(FilledFolders, refuseWhatIsNoTarget) {
  SemanticOcTree map = emptyMap();
  insertAll(map, someScans(27, 3));
  SemanticOcTree full = map, other(0.2, numberedClasses(5)), watched = emptyMap();
  setAbstraction(watched, someAbstraction());
  for (SemanticOcTree* target : {&full, &other, &watched}) {
    EXPECT_THROW(copyTo(*target, map), std::invalid_argument);
    EXPECT_THROW(mergeTo(*target, {&map}), std::invalid_argument);
  }
  saveScans(folder / "map", {});
  SemanticOcTree toRead = emptyMap();
  MapFolder tiles(toRead, folder / "map", kRead, tight());
  EXPECT_THROW(copyTo(toRead, map), std::logic_error);
}

TEST_F(FilledFolders, thatDoNotFitIntoMemorySayHowMuchTheyNeed) {
  saveScans(folder / "map", someScans(28, 8));
  const SemanticOcTree whole = loadMap(folder / "map");
  StoredMap stored(folder / "map", 0);
  const std::string message = errorOf([&] { stored.folder()->bringAll(whole.memoryUsage() / 4); });
  EXPECT_TRUE(contains(message, path("map")));
  EXPECT_TRUE(contains(message, "needs about "));
  EXPECT_TRUE(contains(message, strict_files::sizeText(whole.memoryUsage() / 4) + " are left"));
  EXPECT_LE(stored.folder()->contents().tilesInMemory, 1u);
  stored.folder()->bringAll(4 * whole.memoryUsage());
  EXPECT_EQ(stored.folder()->contents().tilesInMemory, stored.folder()->contents().tiles);
  EXPECT_TRUE(stored.tree() == whole);
}
