// Programs and folders of tiles: what comes out is what comes of the map in one piece.
#include <gtest/gtest.h>
#include <map_folders/MapFolder.h>
#include <strict_files/TextFile.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <tuple>

#include "RunProgram.h"
#include "TemporaryFolder.h"

using namespace semantic_octree;

namespace {

const std::string kSources = MSO_SOURCE_DIR;

/** Two maps of the sample's drive, in a file and in tiles of 12.8 m, made under a budget of 0.1 MB.
 */
class MapFolders : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new TemporaryFolder;
    run("rawlog2semantic-map", mapping("plain"));
    run("rawlog2semantic-map", mapping("tiled", true));
  }
  static void TearDownTestSuite() {
    delete folder;
    folder = nullptr;
  }

  static std::string path(const std::string& name) { return (*folder / name).string(); }
  static Words mapping(const std::string& output, bool inTiles = false) {
    return joined({"--config", kSources + "/config/maps/synthetic.ini", "--resolution", "0.8", "-f",
                   "-o", path(output)},
                  inTiles
                      ? Words{"--tiles", path("tiles"), "--tile-size", "12.8", "--memory", "0.1"}
                      : Words{},
                  {kSources + "/rawlog-samples/village.rawlog"});
  }
  static ProgramRun run(const std::string& program, const Words& arguments) {
    return succeeded(runProgram(program, arguments));
  }
  /** Runs it with both maps, and compares the files of this name that it writes. */
  static void expectSame(const std::string& program, const std::string& name,
                         const Words& options = {}) {
    for (const std::string map : {"plain/map.semantic", "tiles"}) {
      run(program, joined({path(map), "-f", "-o", path(map + "." + name)}, options,
                          map == "tiles" ? Words{"--memory", "0.1"} : Words{}));
    }
    EXPECT_FALSE(folder->read("tiles." + name).empty());
    EXPECT_EQ(folder->read("tiles." + name), folder->read("plain/map.semantic." + name));
  }

  static TemporaryFolder* folder;
};

TemporaryFolder* MapFolders::folder = nullptr;

}  // namespace

TEST_F(MapFolders, haveTheMapThatAFileHas) {
  EXPECT_TRUE(MapFolder::isAt(path("tiles")));
  EXPECT_TRUE(loadMap(path("tiles")) == loadMap(path("plain/map.semantic")));
  EXPECT_FALSE(std::filesystem::exists(path("tiled/map.semantic")));
  const auto summaryOf = [](const std::string& output) {
    return nlohmann::json::parse(folder->read(output + "/summary.json"));
  };
  EXPECT_EQ(summaryOf("tiled")["map"]["leaves"], summaryOf("plain")["map"]["leaves"]);
  EXPECT_EQ(summaryOf("tiled")["points"], summaryOf("plain")["points"]);
}

TEST_F(MapFolders, areReadTileByTileToTheSameResults) {
  expectSame("semantic-map-edit", "whole.semantic");
  expectSame("semantic-map-edit", "corner.semantic",
             {"--box", "-20", "-20", "-1", "20", "20", "4"});
  expectSame("semantic-map-edit", "coarse.semantic", {"--resolution", "1.6"});
  expectSame("semantic-map-edit", "aged.semantic",
             {"--half-lives", kSources + "/config/classes/synthetic_decay.yaml", "--decay", "9"});
  const std::string other = path("other.semantic");
  std::filesystem::copy(path("plain/map.semantic"), other);
  expectSame("semantic-map-merge", "sum.semantic", {other});
  expectSame("semantic-map-export", "points.csv");
  expectSame("semantic-map-export", "tree.ot");
  expectSame("semantic-map-export", "classes.png");
  expectSame("semantic-map-export", "map.3Dscene");
  expectSame("semantic-map-export", "grid.gridmap");
  expectSame("semantic-map-merge", "part.semantic",
             {other, "--box", "-25.6", "-inf", "-1", "12.8", "0", "inf"});
}

TEST_F(MapFolders, takeSumsIn) {
  run("semantic-map-merge", {path("tiles"), path("plain/map.semantic"), "-o", path("twice"),
                             "--tiles", "25.6", "--memory", "0.1"});
  run("semantic-map-merge",
      {path("plain/map.semantic"), path("tiles"), "-o", path("twice.semantic")});
  EXPECT_TRUE(loadMap(path("twice")) == loadMap(path("twice.semantic")));
  run("semantic-map-edit", {path("twice"), "-o", path("smaller"), "--tiles", "12.8"});
  EXPECT_TRUE(loadMap(path("smaller")) == loadMap(path("twice.semantic")));
}

TEST_F(MapFolders, areAskedAndPlannedOnAsMapsInOnePiece) {
  run("synth-rawlog", {"-o", path("scans.rawlog"), "--sensor", "lidar", "--columns", "180",
                       "--frames", "2", "--start", "3", "-f"});
  for (const std::string map : {"plain/map.semantic", "tiles"}) {
    const std::string name = map.substr(0, 5);
    run("semantic-map-evaluate", {path(map), "--scans", path("scans.rawlog"), "-o",
                                  path("quality-" + name), "--memory", "0.1"});
    run("semantic-map-plan", {path(map), "--start=-14,-19,10", "--goal=25,-12,90", "--order",
                              kSources + "/config/orders/synthetic.yaml", "-o",
                              path("plan-" + name), "--memory", "0.1"});
  }
  const auto quality = [](const std::string& name) {
    return nlohmann::json::parse(folder->read("quality-" + name + "/quality.json")).front();
  };
  EXPECT_GT(quality("plain")["points"], 1000);
  EXPECT_EQ(quality("tiles"), quality("plain"));
  EXPECT_GT(folder->read("plan-tiles/path.csv").size(), 100u);
  for (const char* file : {"path.csv", "roadmap.graph", "plan.png"})
    EXPECT_EQ(folder->read(std::string("plan-tiles/") + file),
              folder->read(std::string("plan-plain/") + file));
}

TEST_F(MapFolders, areGoneThroughWithABarOnATerminal) {
  if (runCommand("command -v script").status != 0) GTEST_SKIP() << "needs bsdutils";
  const std::string tiles = path("tiles"), edited = path("bar.semantic");
  for (const auto& [command, bar, end] :
       std::vector<std::tuple<std::string, std::string, std::string>>{
           {"edit " + tiles + " -o " + edited, "Editing: [", edited},
           {"edit -f --pose 1,2,0,30,0,0 " + tiles + " -o " + edited, "Editing: [", edited},
           {"info " + tiles, "Reading: [", tiles},
           {"plan " + tiles + " --start=-14,-19,10 --goal=25,-12,90 --order " + kSources +
                "/config/orders/synthetic.yaml -o " + path("bar-plan"),
            "Finding the ground: [", "Path of "}}) {
    const std::string text = runCommand("script -qec '" MSO_BIN_DIR "/semantic-map-" + command +
                                        " --memory 0.1' /dev/null")
                                 .output;
    EXPECT_TRUE(contains(text, bar));
    EXPECT_TRUE(contains(text, "\r\033[K" + end));
  }
  EXPECT_FALSE(
      contains(runCommand(MSO_BIN_DIR "/semantic-map-info --json " + tiles).output, "Read"));
}

TEST_F(MapFolders, areCompressedToTheSameTrees) {
  const std::string one = path("one.yaml"), five = kSources + "/config/weights/synthetic.yaml";
  strict_files::writeText(one, "block_size: 3.2\nname: road\nrelevant: {road: 1}\n");
  const std::vector<Words> wanted = {{five}, {one, "--leaves", "5000"}, {one, "--bytes", "40000"}};
  for (const Words& target : wanted) {
    for (const std::string map : {"plain/map.semantic", "tiles"}) {
      run("semantic-map-compress", joined({path(map), "-o", path("compressed-" + map.substr(0, 5)),
                                           "--memory", "0.1", "-f", "--weights"},
                                          target));
    }
    std::size_t solutions = 0, folders = 0;
    for (const auto& entry : std::filesystem::directory_iterator(path("compressed-tiles"))) {
      const std::string name = entry.path().filename().string();
      folders += entry.is_directory();
      if (entry.path().extension() != ".semantic" && entry.path().extension() != ".png") continue;
      EXPECT_EQ(folder->read("compressed-tiles/" + name), folder->read("compressed-plain/" + name))
          << name;
      solutions += entry.path().extension() == ".semantic";
    }
    EXPECT_GE(solutions, 5u);
    EXPECT_EQ(folders, 0u);  // nothing is left of what was needed on the way
  }
}

TEST_F(MapFolders, takeAnotherDriveIn) {
  std::filesystem::copy(path("tiles"), path("both"));
  Words arguments = mapping("again", true);
  *std::find(arguments.begin(), arguments.end(), path("tiles")) = path("both");
  run("rawlog2semantic-map", arguments);
  const ProgramRun info = run("semantic-map-info", {path("both")});
  EXPECT_TRUE(contains(info.output, "tiles of 12.8 m"));
  EXPECT_TRUE(contains(info.output, "saved 2 times"));
  EXPECT_FALSE(loadMap(path("both")) == loadMap(path("tiles")));
}

TEST_F(MapFolders, withABadTileAreUsableWhereItIsNot) {
  std::filesystem::copy(path("tiles"), path("bad"));
  std::filesystem::path tile;
  for (const auto& entry : std::filesystem::directory_iterator(path("bad")))
    if (entry.path().filename().string().rfind("tile_-1_-1_0.", 0) == 0) tile = entry.path();
  ASSERT_FALSE(tile.empty());
  std::filesystem::resize_file(tile, std::filesystem::file_size(tile) / 2);
  const ProgramRun info = runProgram("semantic-map-info", {path("bad")});
  EXPECT_EQ(info.status, 1);
  EXPECT_TRUE(contains(info.errors, tile.string() + "': truncated"));
  EXPECT_TRUE(contains(info.errors, "\nsemantic-map-info: tiles that cannot be read"));
  const std::string elsewhere = "30,3,0.5", inIt = "-3,-3,0.5";
  EXPECT_EQ(run("semantic-map-info", {path("bad"), "--at", elsewhere}).output,
            run("semantic-map-info", {path("tiles"), "--at", elsewhere}).output);
  EXPECT_EQ(runProgram("semantic-map-info", {path("bad"), "--at", inIt}).status, 1);
}

TEST_F(MapFolders, withAnIndexThatIsNotOfTheirFilesAreRefused) {
  const std::filesystem::path bad = path("wrong");
  std::filesystem::copy(path("tiles"), bad);
  std::string index = strict_files::readText(bad / "index.yaml");
  strict_files::writeText(bad / "index.yaml", index.insert(index.find("nodes: ") + 7, "1"));
  const std::string plain = path("plain/map.semantic"), never = path("never.semantic");
  for (const std::string& command : {"info " + bad.string(), "info " + bad.string() + " --at 0,0,0",
                                     "merge " + plain + " " + bad.string() + " -o " + never,
                                     "edit " + plain + " -f --tiles 12.8 -o " + bad.string()}) {
    const ProgramRun run = runCommand(MSO_BIN_DIR "/semantic-map-" + command);
    EXPECT_EQ(run.status, 1) << command;
    EXPECT_TRUE(contains(run.output, (bad / "index.yaml").string())) << command;
  }
  EXPECT_FALSE(std::filesystem::exists(never));
  // Each tile's file is a map.
  std::filesystem::remove(bad / "index.yaml");
  Words tiles = {"-o", path("anew"), "--tiles", "12.8"};
  for (const auto& entry : std::filesystem::directory_iterator(bad))
    if (entry.path().extension() == ".semantic") tiles.push_back(entry.path().string());
  run("semantic-map-merge", tiles);
  EXPECT_TRUE(loadMap(path("anew")) == loadMap(path("tiles")));
}

TEST_F(MapFolders, haveOneWriter) {
  SemanticOcTree map = MapFolder::emptyMap(path("tiles"));
  const MapFolder writer(map, path("tiles"), MapFolder::Access::Write);
  expectRefusal(runProgram("rawlog2semantic-map", mapping("refused", true)),
                {"another process writes into this folder"});
  run("semantic-map-info", {path("tiles")});
}
