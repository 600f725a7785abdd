#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>

#include "FolderDrive.h"
#include "FullDisk.h"

using namespace folder_drive;

namespace fs = std::filesystem;

namespace {

SemanticOcTree mapOf(const std::vector<PosedCloud>& scans, std::size_t number) {
  SemanticOcTree map = emptyMap();
  insertAll(map, {scans.begin(), scans.begin() + static_cast<long>(number)});
  return map;
}

/** What reading all of a folder's tiles says, and how many of them can still be read. */
std::vector<std::string> problemsOf(const fs::path& folder) {
  SemanticOcTree map = emptyMap();
  return MapFolder(map, folder, kRead, tight()).problems();
}

}  // namespace

TEST(MapFolderFaults, aBadTileIsNamedAndTheRestIsUsable) {
  const TemporaryFolder folder;
  saveScans(folder / "map", someScans(1, 6));
  const auto files = tileFiles(folder / "map");
  ASSERT_GT(files.size(), 10u);
  EXPECT_TRUE(problemsOf(folder / "map").empty());
  const std::string one = contentOf(files[3]), other = contentOf(files[4]);
  std::string altered = one;
  altered[altered.size() / 2] ^= 4;
  const std::pair<std::string, const char*> faults[] = {
      {one.substr(0, one.size() / 2), "truncated"},
      {"", "the file is empty"},
      {altered, "altered"},
      {other, "it is no tile, or another one"},
      {one + "x", "after the end"}};
  for (const auto& [content, message] : faults) {
    write(files[3], content);
    const auto problems = problemsOf(folder / "map");
    ASSERT_EQ(problems.size(), 1u) << message;
    EXPECT_TRUE(contains(problems[0], files[3])) << problems[0];
    EXPECT_TRUE(contains(problems[0], message)) << problems[0];
    EXPECT_TRUE(contains(errorOf([&] { loadMap(folder / "map"); }), files[3]));
  }
  fs::remove(files[3]);
  EXPECT_EQ(problemsOf(folder / "map").size(), 1u);
  write(files[3], one);
  EXPECT_TRUE(problemsOf(folder / "map").empty());
}

TEST(MapFolderFaults, whatCannotBeReadLeavesTheMapAsItWas) {
  const TemporaryFolder folder;
  const auto scans = someScans(2, 6);
  saveScans(folder / "map", scans);
  const auto files = tileFiles(folder / "map");
  const std::string content = contentOf(files[5]);
  SemanticOcTree map = emptyMap();
  MapFolder tiles(map, folder / "map", kWrite, tight());
  const std::size_t nodes = map.size();
  for (std::size_t cut = 0; cut < content.size(); cut += 1 + content.size() / 10) {
    write(files[5], content.substr(0, cut));
    EXPECT_EQ(tiles.problems().size(), 1u);
    EXPECT_EQ(map.size(), nodes);
  }
  write(files[5], content + "x");  // noticed when all nodes have been read
  EXPECT_EQ(tiles.problems().size(), 1u);
  EXPECT_EQ(map.size(), nodes);
  EXPECT_THROW(insertAll(map, scans), std::runtime_error);  // one of them meets it
  EXPECT_FALSE(map.isBroken());
  write(files[5], content);
  EXPECT_TRUE(tiles.problems().empty());
}

TEST(MapFolderFaults, ofAnotherKindOfMapIsRefused) {
  const TemporaryFolder folder;
  saveScans(folder / "map", someScans(4, 2));
  SemanticOcTree coarse(0.8, numberedClasses(5)), others(0.4, numberedClasses(4));
  for (SemanticOcTree* map : {&coarse, &others}) {
    const std::string error = errorOf([&] { MapFolder(*map, folder / "map", kWrite); });
    EXPECT_TRUE(contains(error, "another resolution, other classes or parameters")) << error;
    EXPECT_TRUE(map->empty());
  }
  EXPECT_TRUE(contains(errorOf([&] {
                         SemanticOcTree map = emptyMap();
                         MapFolder(map, folder / "nowhere", kRead);
                       }),
                       "nowhere"));
}

TEST(MapFolderFaults, oneWritesAndOthersReadWhatWasSaved) {
  const TemporaryFolder folder;
  const auto scans = someScans(5, 8);
  saveScans(folder / "map", {scans.begin(), scans.begin() + 4});
  SemanticOcTree map = emptyMap(), second = emptyMap(), readers = emptyMap();
  MapFolder writer(map, folder / "map", kWrite, tight());
  EXPECT_EQ(errorOf([&] { MapFolder(second, folder / "map", kWrite); }),
            (folder / "map").string() + ": another process writes into this folder");
  {
    MapFolder reader(readers, folder / "map", kRead, tight());
    insertAll(map, {scans.begin() + 4, scans.end()});
    writer.save();
    EXPECT_TRUE(readers == mapOf(scans, 4));  // nothing that it needs was removed
    EXPECT_TRUE(loadMap(folder / "map") == mapOf(scans, 8));
  }
  const std::size_t before = tileFiles(folder / "map").size();
  writer.save();
  EXPECT_LT(tileFiles(folder / "map").size(), before);  // now it was
  EXPECT_TRUE(loadMap(folder / "map") == mapOf(scans, 8));
}

TEST(MapFolderFaults, aFullDiskLosesNothing) {
  const TemporaryFolder folder;
  const auto scans = someScans(6, 8);
  saveScans(folder / "map", {scans.begin(), scans.begin() + 4});
  SemanticOcTree map = emptyMap();
  MapFolder tiles(map, folder / "map", kWrite, tight());
  for (std::size_t i = 4; i < scans.size(); ++i) {
    map.insert(scans[i].cloud, scans[i].T_map_sensor);
    const std::string error = errorOf([&] {  // another scan, of which nothing must be left
      const FullDisk full(100);
      const PosedCloud other = someScans(60, 1)[0];
      map.insert(other.cloud, other.T_map_sensor);
    });
    EXPECT_TRUE(contains(error, "tile_") && contains(error, "cannot save map")) << i << error;
    ASSERT_FALSE(map.isBroken());
  }
  {
    const FullDisk full(100);
    EXPECT_THROW(tiles.save(), std::runtime_error);
  }
  EXPECT_TRUE(loadMap(folder / "map") == mapOf(scans, 4));
  tiles.save();
  EXPECT_TRUE(loadMap(folder / "map") == mapOf(scans, 8));
}

TEST(MapFolderFaults, killedAtAnyMomentItIsWhatWasSavedLast) {
  const auto scans = someScans(7, 12);
  for (int round = 0; round < 8; ++round) {
    const TemporaryFolder folder;
    const pid_t child = fork();
    if (child == 0) {
      SemanticOcTree map = emptyMap();
      MapFolder tiles(map, folder / "map", kWrite, tight());
      for (std::size_t i = 0; i < scans.size(); ++i) {
        map.insert(scans[i].cloud, scans[i].T_map_sensor);
        if (i % 3 == 2) tiles.save();
      }
      _exit(0);
    }
    usleep(static_cast<useconds_t>(3000 + 9000 * round));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    if (!MapFolder::isAt(folder / "map")) continue;  // it was killed before
    const SemanticOcTree found = loadMap(folder / "map");
    bool isOne = false;
    for (std::size_t n = 3; n <= scans.size(); n += 3) isOne |= found == mapOf(scans, n);
    EXPECT_TRUE(isOne);
    saveScans(folder / "map", {});  // the next one clears up
    const auto files = tileFiles(folder / "map");
    for (const auto& file : files) EXPECT_NO_THROW(loadMap(file));
  }
}
