#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>

#include <fstream>
#include <map>

#include "FolderDrive.h"
#include "FollowedTree.h"

using namespace folder_drive;

namespace {

constexpr auto kDraft = MapFolder::Access::Draft;

MapFolderOptions draftIn(const std::filesystem::path& place) {
  MapFolderOptions options = tight();
  options.draft = place;
  return options;
}

/** Names and bytes of what is in a folder. */
std::map<std::string, std::string> filesIn(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream in(entry.path(), std::ios::binary);
    files[entry.path().filename()] = {std::istreambuf_iterator<char>(in), {}};
  }
  return files;
}

std::vector<PosedCloud> firstOf(const std::vector<PosedCloud>& scans, std::size_t n) {
  return {scans.begin(), scans.begin() + static_cast<std::ptrdiff_t>(n)};
}

}  // namespace

TEST(MapDrafts, becomeTheMapInOnePieceAndLeaveTheFolderAsItIs) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const TemporaryFolder folder;
    const auto scans = someScans(seed, 12);
    saveScans(folder / "map", firstOf(scans, 6));
    const auto before = filesIn(folder / "map");
    SemanticOcTree map = emptyMap(), whole = emptyMap();
    insertAll(whole, firstOf(scans, 6));
    {
      MapFolder draft(map, folder / "map", kDraft, draftIn(folder / "draft"));
      setAbstraction(map, someAbstraction());
      setAbstraction(whole, someAbstraction());
      EXPECT_FALSE(map.isReadOnly());
      FollowedTree told(map);
      for (std::size_t i = 6; i < scans.size(); ++i) {
        insertAll(map, {scans[i]});
        insertAll(whole, {scans[i]});
        EXPECT_EQ(Abstraction(map).leaves(), Abstraction(whole).leaves());
        told.follow();
      }
      EXPECT_FALSE(std::filesystem::is_empty(folder / "draft"));
      EXPECT_GT(draft.contents().sentOut, 10u);
      EXPECT_TRUE(map == whole);
      EXPECT_EQ(bytesOf(map), bytesOf(whole));
      EXPECT_THROW(draft.save(), std::logic_error);
    }
    EXPECT_TRUE(filesIn(folder / "map") == before);
    EXPECT_FALSE(std::filesystem::exists(folder / "draft"));
  }
}

TEST(MapDrafts, goOnWhileAnotherProcessSavesTheFolder) {
  const TemporaryFolder folder;
  const auto scans = someScans(4, 9);
  saveScans(folder / "map", firstOf(scans, 3));
  SemanticOcTree map = emptyMap(), whole = emptyMap();
  const MapFolder draft(map, folder / "map", kDraft, draftIn(folder / "draft"));
  insertAll(map, {scans[3], scans[4]});
  saveScans(folder / "map", {scans.begin() + 5, scans.end()});  // adds to it
  insertAll(map, {scans[3], scans[4]});
  insertAll(whole, firstOf(scans, 5));
  insertAll(whole, {scans[3], scans[4]});
  EXPECT_TRUE(map == whole);
}

TEST(MapDrafts, needAPlace) {
  const TemporaryFolder folder;
  saveScans(folder / "map", someScans(5, 2));
  SemanticOcTree map = emptyMap();
  EXPECT_THROW(MapFolder(map, folder / "map", kDraft, tight()), std::invalid_argument);
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
