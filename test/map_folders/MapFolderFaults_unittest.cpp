#include <gtest/gtest.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/OutputFiles.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#include <csignal>
#include <map>
#include <regex>

#include "CommaHost.h"
#include "FolderDrive.h"
#include "FullDisk.h"

using namespace folder_drive;

namespace fs = std::filesystem;

namespace {

using MapFolderFaults = FolderTest;

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

TEST_F(MapFolderFaults, aBadTileIsNamedTheRestIsUsableAndTheMapAsItWas) {
  const auto scans = someScans(2, 6);
  saveScans(folder / "map", scans);
  const auto files = tileFiles(folder / "map");
  ASSERT_GT(files.size(), 10u);
  EXPECT_TRUE(problemsOf(folder / "map").empty());
  const std::string one = contentOf(files[3]), other = contentOf(files[4]);
  std::string altered = one;
  altered[altered.size() / 2] ^= 4;
  SemanticOcTree map = emptyMap();
  MapFolder tiles(map, folder / "map", kWrite, tight());
  const std::size_t nodes = map.size();
  std::vector<std::pair<std::string, const char*>> faults = {
      {"", "the file is empty"},
      {altered, "altered"},
      {other, "it is no tile, or another one"},
      {one + "x", "after the end"}};
  for (std::size_t cut = 1; cut < one.size(); cut += 1 + one.size() / 10)
    faults.emplace_back(one.substr(0, cut), "truncated");
  for (const auto& [content, message] : faults) {
    write(files[3], content);
    EXPECT_EQ(tiles.problems().size(), 1u);
    EXPECT_EQ(map.size(), nodes);
    const auto problems = problemsOf(folder / "map");
    ASSERT_EQ(problems.size(), 1u) << message;
    EXPECT_TRUE(contains(problems[0], files[3]));
    EXPECT_TRUE(contains(problems[0], message));
    EXPECT_TRUE(contains(errorOf([&] { loadMap(folder / "map"); }), files[3]));
  }
  fs::remove(files[3]);
  EXPECT_EQ(problemsOf(folder / "map").size(), 1u);
  EXPECT_THROW(insertAll(map, scans), std::runtime_error);  // one of them meets it
  EXPECT_FALSE(map.isBroken());
  write(files[3], one);
  EXPECT_TRUE(problemsOf(folder / "map").empty() && tiles.problems().empty());
}

TEST_F(MapFolderFaults, aTileThatIsMissingIsNamedBeforeAnythingIsWritten) {
  saveScans(folder / "map", someScans(2, 2));
  const fs::path tile = tileFiles(folder / "map").front();
  fs::remove(tile);
  SemanticOcTree map = emptyMap();
  EXPECT_TRUE(contains(errorOf([&] { MapFolder(map, folder / "map", kWrite); }),
                       tile.string() + "': it is missing"));
}

TEST_F(MapFolderFaults, ofAnotherKindOfMapIsRefused) {
  saveScans(folder / "map", someScans(4, 2));
  SemanticOcTree coarse(0.8, numberedClasses(5)), others(0.4, numberedClasses(4));
  for (SemanticOcTree* map : {&coarse, &others}) {
    const std::string error = errorOf([&] { MapFolder(*map, folder / "map", kWrite); });
    EXPECT_TRUE(contains(error, "another resolution, other classes or parameters"));
    EXPECT_TRUE(map->empty());
  }
  EXPECT_TRUE(contains(errorOf([&] {
                         SemanticOcTree map = emptyMap();
                         MapFolder(map, folder / "nowhere", kRead);
                       }),
                       "nowhere"));
}

TEST_F(MapFolderFaults, oneWritesAndOthersReadWhatWasSaved) {
  const auto scans = someScans(5, 8);
  saveScans(folder / "map", {scans.begin(), scans.begin() + 4});
  SemanticOcTree map = emptyMap(), second = emptyMap(), readers = emptyMap();
  MapFolder writer(map, folder / "map", kWrite, tight());
  EXPECT_EQ(errorOf([&] { MapFolder(second, folder / "map", kWrite); }),
            path("map") + ": another process writes into this folder");
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

TEST_F(MapFolderFaults, aFullDiskLosesNothing) {
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

TEST_F(MapFolderFaults, killedAtAnyMomentItIsWhatWasSavedLast) {
  const auto scans = someScans(7, 12);
  for (int round = 0; round < 8; ++round) {
    const TemporaryFolder fresh;
    const pid_t child = fork();
    if (child == 0) {
      SemanticOcTree map = emptyMap();
      MapFolder tiles(map, fresh / "map", kWrite, tight());
      for (std::size_t i = 0; i < scans.size(); ++i) {
        map.insert(scans[i].cloud, scans[i].T_map_sensor);
        if (i % 3 == 2) tiles.save();
      }
      _exit(0);
    }
    usleep(static_cast<useconds_t>(3000 + 9000 * round));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    if (!MapFolder::isAt(fresh / "map")) continue;  // it was killed before
    const SemanticOcTree found = loadMap(fresh / "map");
    bool isOne = false;
    for (std::size_t n = 3; n <= scans.size(); n += 3) isOne |= found == mapOf(scans, n);
    EXPECT_TRUE(isOne);
    saveScans(fresh / "map", {});  // the next one clears up
    const auto files = tileFiles(fresh / "map");
    for (const auto& file : files) EXPECT_NO_THROW(loadMap(file));
  }
}

namespace fs = std::filesystem;

namespace {

// A folder's index is believed only where it says of itself and of its files what they are.

/** An index with the checksum that it should have. */
std::string checked(const std::string& index) {
  const std::string text = index.substr(0, index.rfind("\nchecksum: ") + 1);
  const auto crc = crc32(0, reinterpret_cast<const Bytef*>(text.data()), uInt(text.size()));
  return text + "checksum: " + std::to_string(crc) + "\n";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/** A map that was saved twice, while a reader kept what the second save replaced. */
class FolderIndex : public testing::Test {
 protected:
  FolderIndex() {
    const auto scans = someScans(1, 6);
    saveScans(map, {scans.begin(), scans.begin() + 3});
    for (const fs::path& file : tileFiles(map)) first[placeIn(file)] = contentOf(file);
    firstLeaves = contentOf(map / "leaves.1.semantic");
    SemanticOcTree readers = emptyMap();
    const MapFolder reader(readers, map, kRead, tight());
    saveScans(map, {scans.begin() + 3, scans.end()});
    good = contentOf(map / "index.yaml");
  }

  static std::string placeIn(const fs::path& file) { return file.stem().stem().string(); }
  std::map<std::string, std::string> filesThere() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(map))
      if (entry.is_regular_file() && entry.path().extension() != ".lock")
        files[fs::relative(entry.path(), map).string()] = contentOf(entry.path());
    return files;
  }
  /** To whoever reads and whoever wants to write, who then removes nothing. */
  std::string refusalOf(const std::string& index) const {
    write(map / "index.yaml", index);
    const auto before = filesThere();
    const std::string error = errorOf([&] { loadMap(map.string()); });
    for (const auto access : {kWrite, MapFolder::Access::Replace}) {
      SemanticOcTree empty = emptyMap();
      errorOf([&] { MapFolder(empty, map, access, tight()).bringAll(); });
    }
    EXPECT_TRUE(error.empty() || filesThere() == before) << error;
    EXPECT_TRUE(error.empty() || contains(error, map.string())) << error;
    return error;
  }

  const TemporaryFolder folder;
  const fs::path map = folder / "map";
  std::map<std::string, std::string> first;  ///< tiles of the first save, by place
  std::string firstLeaves, good;
};

}  // namespace

TEST_F(FolderIndex, thatWasCutOrAlteredAnywhereIsRefused) {
  for (std::size_t at = 0; at < good.size(); at += 53) {
    std::string altered = good;
    altered[at] = static_cast<char>(altered[at] ^ 1);
    for (const std::string& index : {altered, good.substr(0, at)})
      ASSERT_TRUE(contains(refusalOf(index), "cut off or altered")) << at;
  }
  EXPECT_EQ(refusalOf(good), "");
}

TEST_F(FolderIndex, withAnotherNumberAndItsChecksumIsComparedWithTheFiles) {
  const std::string tables = good.substr(0, good.find("\nold:")), rest = "\nold: []\nchecksum: 0\n";
  EXPECT_EQ(refusalOf(checked(tables + rest)), "");
  const std::regex number("[0-9]+");
  const auto begin = static_cast<std::ptrdiff_t>(tables.find("\nversion"));
  for (std::sregex_iterator it(tables.begin() + begin, tables.end(), number), end; it != end;
       ++it) {
    std::string altered = tables;
    char& digit = altered[static_cast<std::size_t>(begin + it->position() + it->length() - 1)];
    digit = digit == '9' ? '8' : static_cast<char>(digit + 1);
    write(map / "index.yaml", checked(altered + rest));
    EXPECT_NE(errorOf([&] { loadMap(map.string()); }), "")
        << altered.substr(begin + it->position() - 20, 60);
  }
}

TEST_F(FolderIndex, withWhatItsKeysMayNotBeIsRefused) {
  const std::size_t leaves = good.find("\nleaves:"), end = good.find("\nleaves_checksum");
  const std::string noLeaves = good.substr(0, leaves) + "\nleaves: 5" + good.substr(end);
  const std::pair<std::string, const char*> faults[] = {
      {noLeaves, "leaves: expected a list"},
      {replaced(good, "\nframe", "\nextra: 1\nframe"), "unknown key 'extra'"},
      {replaced(good, "frame: map", "frame: [map]"), "frame: expected a word"},
      {replaced(good, "nodes: ", "nodes: 0x"), "expected a whole number"},
      {replaced(good, "nodes: ", "nodes: -"), "out of range"},
      {replaced(good, "checksum: ", "checksum: 9999999999"), "expected a whole number"},
      {replaced(good, "tiles: 1}", "tiles: 3}"), "a leaf that cannot be"},
      {replaced(good, "tile_size: 6.4", "tile_size: 6.5"), "tile_size"},
      {replaced(good, "\nold:\n", "\nold:\n  - ../other.1.semantic\n"), "old: expected names"},
      {replaced(good, "\nold:\n", "\nold:\n  - leaves.2.semantic\n"), "old: expected names"},
      {replaced(good, "\nold:\n", "\nold:\n  - leaves." + std::string(300000, '1') + ".semantic\n"),
       "old: expected names"},
      {replaced(good, "\nversion: 2\n", "\nversion: 3\n"), "version of the format"}};
  for (const auto& [index, message] : faults)
    EXPECT_TRUE(contains(refusalOf(checked(index)), message))
        << message << refusalOf(checked(index));
}

TEST_F(FolderIndex, namesTilesThatNoOlderOnesAndNoOthersCanReplace) {
  int older = 0;
  std::string previous;
  for (const fs::path& file : tileFiles(map)) {
    const std::string own = contentOf(file);
    if (!contains(file.string(), ".2.semantic")) continue;
    for (const std::string& other : {first[placeIn(file)], previous}) {
      if (other.empty() || other == own) continue;
      write(file, other);
      const std::string error = errorOf([&] { loadMap(map.string()); });
      EXPECT_TRUE(contains(error, file.string()));
      EXPECT_TRUE(contains(error, "it is no"));
      older += contains(error, "index.yaml names: checksum ");
    }
    write(file, own);
    previous = own;
  }
  EXPECT_GT(older, 5);
  ASSERT_NE(contentOf(map / "leaves.2.semantic"), firstLeaves);
  write(map / "leaves.2.semantic", firstLeaves);
  EXPECT_TRUE(contains(errorOf([&] { loadMap(map.string()); }), "leaves.2.semantic"));
}

TEST_F(FolderIndex, hasGenerationsUpToWhereTheNextCanBeRead) {
  const auto atGeneration = [&](std::uint64_t generation) {
    const std::string name = "leaves." + std::to_string(generation) + ".semantic";
    write(map / name, contentOf(map / "leaves.2.semantic"));
    write(map / "index.yaml", checked(replaced(good, "\ngeneration: 2",
                                               "\ngeneration: " + std::to_string(generation))));
    const std::string toRead = errorOf([&] { loadMap(map.string()); });
    const std::string toWrite = errorOf([&] { saveScans(map, someScans(2, 1)); });
    EXPECT_EQ(errorOf([&] { loadMap(map.string()); }), toRead);
    fs::remove(map / name);
    return std::pair(toRead, toWrite);
  };
  constexpr std::uint64_t kMost = std::uint64_t(1) << 53;
  for (const std::uint64_t generation : {kMost, kMost + 1})
    EXPECT_TRUE(contains(atGeneration(generation).first, "found '" + std::to_string(generation)));
  EXPECT_EQ(atGeneration(kMost - 1).first, "");
  EXPECT_TRUE(contains(atGeneration(kMost - 1).second, "to write into this folder"));
  EXPECT_EQ(atGeneration(kMost / 2).second, "");
}

TEST_F(FolderIndex, isWhatTellsOldFilesFromThoseOfOthers) {
  const auto others = {"tile_9_9_9.1.semantic", "tile_9_9_9.7.semantic", "notes.txt"};
  for (const char* name : others) write(map / name, "somebody's");
  saveScans(map, someScans(2, 2));
  EXPECT_TRUE(fs::exists(map / "leaves.8.semantic"));  // above what is there
  EXPECT_FALSE(fs::exists(map / "leaves.1.semantic"));
  EXPECT_FALSE(fs::exists(map / "leaves.2.semantic"));
  for (const char* name : others) EXPECT_EQ(contentOf(map / name), "somebody's");
  EXPECT_EQ(MapFolder::othersAt(map).files, 3u);
  EXPECT_EQ(MapFolder::othersAt(map).bytes, 30u);
}

TEST_F(FolderIndex, isLeftAloneWhenADiskIsFullOrAProcessToldToLeave) {
  EXPECT_EQ(refusalOf(good), "");  // who opens it to write removes what is old
  const auto before = filesThere();
  for (const fs::path& place : {map, folder / "new"}) {
    for (const bool isTold : {false, true}) {
      const pid_t child = fork();
      if (child == 0) {
        SemanticOcTree tree = emptyMap();
        {
          MapFolder tiles(tree, place, kWrite, tight());
          insertAll(tree, someScans(3, 4));
          if (tiles.contents().sentOut < 5) _exit(1);
          if (isTold) strict_files::leaveWithoutOutputs(5);
          const FullDisk full(100);
          if (errorOf([&] { tiles.save(); }).empty()) _exit(2);
        }
        _exit(5);
      }
      int status = 0;
      waitpid(child, &status, 0);
      EXPECT_EQ(WEXITSTATUS(status), 5);
      EXPECT_TRUE(filesThere() == before || place != map);
      EXPECT_FALSE(fs::exists(folder / "new"));
    }
  }
}

TEST_F(FolderIndex, isTheSameInAHostWithDecimalCommas) {
  const auto save = [](const fs::path& place) { saveScans(place, someScans(4, 3)); };
  save(folder / "classic");
  const fs::path classes = folder.write(
      "classes.yaml",
      "classes:\n - {id: 1, name: a, color: [0, 0, 0], raw: [1234567], half_life: 0.25}\n");
  {
    const CommaHost host;
    save(folder / "comma");
    EXPECT_TRUE(loadMap(folder / "comma") == loadMap(folder / "classic"));
    const semantic_types::ClassTable table = semantic_types::loadClassTable(classes);
    EXPECT_EQ(table.fromRaw(1234567), 1);
    EXPECT_EQ(table.halfLife(1), 0.25);
  }
  for (const auto& entry : fs::directory_iterator(folder / "classic"))
    EXPECT_EQ(contentOf(folder / "comma" / entry.path().filename().string()),
              contentOf(entry.path()));
}
