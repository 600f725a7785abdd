#include <map_folders/MapFolder.h>

#include <map>
#include <regex>

#include "SemanticMapDrive.h"

namespace {

/** With a map of the sample village, in a file and in tiles. */
class DrivesInFolders : public SemanticMapDrive {
 protected:
  static void SetUpTestSuite() {
    made = std::make_unique<TemporaryFolder>();
    const std::string config = std::string(MSO_SOURCE_DIR) + "/config/maps/synthetic.ini";
    const std::string log = std::string(MSO_SOURCE_DIR) + "/rawlog-samples/village.rawlog";
    const auto path = [](const char* name) { return (*made / name).string(); };
    const std::vector<std::string> mapping = {"--config", config, log, "--output"};
    std::vector<std::string> whole = mapping, tiles = mapping;
    whole.push_back(path("map"));
    tiles.insert(tiles.end(), {path("log"), "--tiles", path("tiles"), "--tile-size", "12.8"});
    ASSERT_EQ(runProgram("rawlog2semantic-map", whole).status, 0);
    ASSERT_EQ(runProgram("rawlog2semantic-map", tiles).status, 0);
  }
  static void TearDownTestSuite() { made = nullptr; }

  static std::map<std::string, std::string> filesIn(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      std::ifstream in(entry.path(), std::ios::binary);
      files[entry.path().filename()] = {std::istreambuf_iterator<char>(in), {}};
    }
    return files;
  }
  /** The shipped configuration, with another latency. */
  std::string configWithLatency(const std::string& seconds) const {
    std::ifstream in(kConfig + "drives/synthetic.ini");
    std::string text{std::istreambuf_iterator<char>(in), {}};
    text = std::regex_replace(text, std::regex("\\.\\./"), kConfig);
    return folder
        .write("drive.ini", std::regex_replace(text, std::regex("mapping_latency = 0"),
                                               "mapping_latency = " + seconds))
        .string();
  }
  static std::string of(const char* name) { return (*made / name).string(); }

  static std::unique_ptr<TemporaryFolder> made;
};

std::unique_ptr<TemporaryFolder> DrivesInFolders::made;

}  // namespace

TEST_F(DrivesInFolders, AreTheDrivesInTheMapInOnePieceToTheLastBit) {
  const auto before = filesIn(of("tiles"));
  const std::vector<std::string> ends = {"--no-rawlog", "--picture-every", "10", "--map"};
  for (const std::string latency : {"0", "0.3"}) {
    SCOPED_TRACE(latency);
    const auto driveIn = [&](const std::string& map, const std::string& output) {
      auto arguments = argumentsWith(
          {"--config", configWithLatency(latency), "--output", path(output), "--memory", "1"});
      arguments.insert(arguments.end(), ends.begin(), ends.end());
      arguments.push_back(map);
      const ProgramRun run = runProgram("semantic-map-drive", arguments);
      ASSERT_EQ(run.status, 0) << run.errors;
    };
    driveIn(of("map/map.semantic"), "whole");
    driveIn(of("tiles"), "tiles");
    for (const char* file : {"drive.csv", "map.semantic", "drive.png", "drive-0001.png"}) {
      SCOPED_TRACE(file);
      EXPECT_FALSE(folder.read("whole/" + std::string(file)).empty());
      EXPECT_TRUE(folder.read("whole/" + std::string(file)) ==
                  folder.read("tiles/" + std::string(file)));
    }
    EXPECT_EQ(jsonIn("whole/drive.json")["compressedLeaves"],
              jsonIn("tiles/drive.json")["compressedLeaves"]);
  }
  EXPECT_TRUE(filesIn(of("tiles")) == before);
  EXPECT_TRUE(semantic_octree::loadMap(of("tiles")) ==
              semantic_octree::loadMap(of("map/map.semantic")));
}

TEST_F(DrivesInFolders, HaveNoWindow) {
  const ProgramRun run = drive({"--map", of("tiles"), "--live"});
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.errors.find("--live: a map in a folder of tiles is not shown"), std::string::npos)
      << run.errors;
}

TEST_F(DrivesInFolders, SayWhichTileIsBad) {
  std::filesystem::copy(of("tiles"), path("bad"));
  for (const auto& entry : std::filesystem::directory_iterator(path("bad")))
    if (entry.path().filename().string().rfind("tile_", 0) == 0)
      std::filesystem::resize_file(entry.path(), std::filesystem::file_size(entry.path()) / 2);
  const ProgramRun run = drive({"--map", path("bad")});
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.errors.find("tile_"), std::string::npos) << run.errors;
  EXPECT_NE(run.errors.find("truncated"), std::string::npos) << run.errors;
  EXPECT_FALSE(has("drive/drive.csv"));
}
