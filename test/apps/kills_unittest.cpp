// What is left when a program is killed at any moment: whole files, and no litter after the next.
#include <gtest/gtest.h>
#include <semantic_octree/TreeFile.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <set>

#include "ShellCommand.h"
#include "TemporaryFolder.h"

namespace fs = std::filesystem;

namespace {

/** How often: MSO_KILLS, or a few times. */
int kills() {
  const char* number = std::getenv("MSO_KILLS");
  return number ? std::atoi(number) : 4;
}

/** rawlog2semantic-map into one folder, of the sample's drive with one voxel size or another. */
class Killed : public testing::Test {
 protected:
  CommandRun map(const std::string& resolution, const std::string& wrapper = "") const {
    const std::string sources = MSO_SOURCE_DIR;
    return runCommand(wrapper + " " MSO_BIN_DIR "/rawlog2semantic-map -f --config '" + sources +
                      "/config/maps/synthetic.ini' --resolution " + resolution + " -o '" +
                      (folder / "out").string() + "' '" + sources +
                      "/rawlog-samples/village.rawlog'");
  }
  std::set<std::string> entries() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder / "out"))
      names.insert(entry.path().filename().string());
    return names;
  }
  /** Each file is that of a run which came to its end. */
  void expectWhole(const std::set<std::string>& maps) const {
    EXPECT_TRUE(maps.count(folder.read("out/map.semantic")));
    EXPECT_NO_THROW(semantic_octree::loadTree((folder / "out/compressed.semantic").string()));
    EXPECT_TRUE(nlohmann::json::accept(folder.read("out/summary.json")));
    for (const std::string name : {"top.png", "compressed.png"})
      EXPECT_TRUE(contains(folder.read("out/" + name), "IEND")) << name;
  }

  const TemporaryFolder folder;
};

}  // namespace

TEST_F(Killed, atAnyTimeLeavesWholeFilesAndTheNextRunNothingElse) {
  using Clock = std::chrono::steady_clock;
  std::set<std::string> maps;
  double seconds = 0;
  for (const char* resolution : {"1", "0.5"}) {
    const auto begin = Clock::now();
    const CommandRun run = map(resolution);
    ASSERT_EQ(run.status, 0) << run.output;
    seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    maps.insert(folder.read("out/map.semantic"));
  }
  ASSERT_EQ(maps.size(), 2u);
  const std::set<std::string> before = entries();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> moment(0, 1.1 * seconds);
  int killed = 0, littered = 0;
  for (int i = 0; killed < kills() && i < 10 * kills() && !HasFailure(); ++i) {
    const std::string after = std::to_string(moment(random));
    killed += map(i % 2 ? "0.5" : "1", "timeout -s KILL " + after).status == 128 + SIGKILL;
    littered += entries() != before;
    expectWhole(maps);
  }
  RecordProperty("killed", killed);
  RecordProperty("littered", littered);
  ASSERT_EQ(map("1").status, 0);
  EXPECT_EQ(entries(), before);
}
