#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "RunProgram.h"
#include "TemporaryFolder.h"

namespace {

const std::string kConfig = std::string(MSO_SOURCE_DIR) + "/config/";

class SemanticMapDrive : public testing::Test {
 protected:
  ProgramRun drive(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"--world",
                                          "village",
                                          "--start=-14,-19,10",
                                          "--goal=-6,-17,20",
                                          "--classes",
                                          kConfig + "plan/synthetic.yaml",
                                          "--config",
                                          kConfig + "drive/synthetic.ini",
                                          "--output",
                                          path("drive"),
                                          "--no-pictures"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram("semantic-map-drive", arguments);
  }

  nlohmann::json jsonIn(const std::string& file) const {
    return nlohmann::json::parse(std::ifstream(path(file)));
  }
  bool has(const std::string& file) const { return std::filesystem::exists(path(file)); }
  std::string path(const std::string& name) const { return (folder / name).string(); }

  TemporaryFolder folder;
};

}  // namespace

TEST_F(SemanticMapDrive, KeepsPicturesOnTheWayAndNoneOfALongerDrive) {
  ASSERT_EQ(drive({"--no-rawlog", "--picture-every", "5"}).status, 0);
  const double seconds = jsonIn("drive/drive.json")["seconds"];
  const int last = static_cast<int>(seconds / 5) + 1;  // and one at the end
  EXPECT_TRUE(has("drive/drive-000" + std::to_string(last) + ".png"));
  EXPECT_FALSE(has("drive/drive-000" + std::to_string(last + 1) + ".png"));
  ASSERT_EQ(drive({"--no-rawlog", "--picture-every", "100"}).status, 0);
  EXPECT_TRUE(has("drive/drive-0001.png"));
  EXPECT_FALSE(has("drive/drive-0002.png"));
}

TEST_F(SemanticMapDrive, WritesARawlogThatBecomesAMap) {
  ASSERT_EQ(drive({}).status, 0);
  const auto cycles = jsonIn("drive/drive.json")["milliseconds"]["insert"]["cycles"].get<int>();
  const ProgramRun made =
      runProgram("rawlog2semantic-map",
                 {path("drive/drive.rawlog"), "--config",
                  kConfig + "rawlog2semantic-map/synthetic.ini", "--output", path("map")});
  ASSERT_EQ(made.status, 0) << made.errors;
  // An image and a LiDAR scan each time.
  EXPECT_NE(made.output.find(std::to_string(2 * cycles) + " scans inserted"), std::string::npos)
      << made.output;
  EXPECT_TRUE(has("map/map.semantic"));
}

TEST_F(SemanticMapDrive, SaysWhatIsMissing) {
  const ProgramRun run =
      runProgram("semantic-map-drive", {"--classes", kConfig + "plan/synthetic.yaml", "--config",
                                        kConfig + "drive/synthetic.ini", "--output", path("x")});
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.errors.find("--start and --goal are missing"), std::string::npos) << run.errors;
}
