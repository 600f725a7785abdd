// What becomes of outputs when a program is told to end.
#include <gtest/gtest.h>
#include <labeled_cloud/Rawlogs.h>
#include <semantic_octree/TreeFile.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <set>

#include "RunProgram.h"
#include "TemporaryFolder.h"

namespace fs = std::filesystem;

namespace {

/** rawlog2semantic-map on many times the sample's drive, which takes far longer than the tests. */
class Interrupted : public FolderTest {
 protected:
  void SetUp() override {
    folder.write("out/map.semantic", "of before");
    for (int i = 0; i < 30; ++i) {
      rawlogs += ' ' + std::to_string(i) + ".rawlog";
      fs::create_symlink(sources / "rawlog-samples/village.rawlog",
                         folder / (std::to_string(i) + ".rawlog"));
    }
  }

  /** Starts the program, and when it has inserted something, the shell's commands, which know it as
   * $pid. \return its exit status */
  int runAnd(const std::string& commands, const std::string& when = "inserted") const {
    const std::string map = (sources / "config/maps/synthetic.ini").string();
    folder.write("script", "cd '" + folder.path().string() + "'\nrm -f log\n" + MSO_BIN_DIR +
                               "/rawlog2semantic-map -v -f --config " + map + " -o out" + rawlogs +
                               " >log 2>&1 &\npid=$!\n" + "until grep -q '" + when +
                               "' log; do sleep 0.05; done\n" + commands + "\nwait $pid\n");
    return runCommand("sh " + path("script")).status;
  }
  std::string log() const { return folder.read("log"); }
  bool leftAnything() const {
    for (const auto& entry : fs::directory_iterator(folder / "out"))
      if (entry.path().filename().string().rfind(".unfinished-", 0) == 0) return true;
    return false;
  }

  const fs::path sources = MSO_SOURCE_DIR;
  std::string rawlogs;
};

TEST_F(Interrupted, onceItWritesWhatIsThereAndSaysSo) {
  EXPECT_EQ(runAnd("kill -INT $pid"), 130) << log();
  EXPECT_TRUE(contains(log(), "will stop after this observation"));
  EXPECT_TRUE(contains(log(), "stopped early"));
  const auto summary = nlohmann::json::parse(folder.read("out/summary.json"));
  EXPECT_EQ(summary["stopped"], true);
  const int inserted = summary["observations"]["inserted"];
  EXPECT_GE(inserted, 1);
  EXPECT_LT(inserted, 30 * 24);
  EXPECT_GT(semantic_octree::loadTree(path("out/map.semantic")).size(), 100u);
  EXPECT_FALSE(leftAnything());
}

TEST_F(Interrupted, beforeTheFirstScanItSaysSoAndLeavesWhatWasThere) {
  EXPECT_EQ(runAnd("kill -INT $pid", "Reading the robot"), 130) << log();
  EXPECT_TRUE(contains(log(), "stopped before the first scan"));
  EXPECT_EQ(folder.read("out/map.semantic"), "of before");
  EXPECT_FALSE(leftAnything());
}

TEST_F(Interrupted, twiceOrByItsTerminalsEndItLeavesAtOnce) {
  const std::string twice =
      "kill -INT $pid; until grep -q 'will stop' log; do sleep 0.01; done; kill -INT $pid";
  for (const auto& [commands, status] : {std::pair(twice, 130), {"kill -HUP $pid", 129}}) {
    EXPECT_EQ(runAnd(commands), status) << log();
    EXPECT_EQ(folder.read("out/map.semantic"), "of before");
    EXPECT_FALSE(leftAnything());
  }
}

TEST_F(Interrupted, killedItLeavesWhatTheNextRunRemoves) {
  EXPECT_EQ(runAnd("kill -KILL $pid"), 137) << log();
  EXPECT_EQ(folder.read("out/map.semantic"), "of before");
  EXPECT_TRUE(leftAnything());
  EXPECT_EQ(runAnd("kill -INT $pid"), 130) << log();
  EXPECT_FALSE(leftAnything());
}

/** Runs a program in the folder, asks it once to stop when it has begun its output, and waits.
 * \param meanwhile a command of the shell before that */
ProgramRun stopEarly(const TemporaryFolder& folder, const std::string& command,
                     const std::string& meanwhile = ":") {
  folder.write("script", "cd '" + folder.path().string() + "'\n" + MSO_BIN_DIR "/" + command +
                             " &\npid=$!\n" +
                             "until ls -d .unfinished-* */.unfinished-* 2>/dev/null | grep -q .\n" +
                             "do sleep 0.05; done\n" + meanwhile +
                             "\nsleep 0.5\nkill -INT $pid\nwait $pid\n");
  return runCommand("sh " + (folder / "script").string());
}

TEST(StoppedEarly, aSyntheticDriveIsAShorterOne) {
  const TemporaryFolder folder;
  const ProgramRun run =
      stopEarly(folder, "synth-rawlog -o a.rawlog --frames 1000000 --sensor lidar --columns 60");
  EXPECT_EQ(run.status, 130) << run.output;
  EXPECT_TRUE(contains(run.output, "will stop after this frame"));
  labeled_cloud::RawlogReader reader(folder / "a.rawlog");
  int entries = 0;
  while (reader.next()) ++entries;
  EXPECT_GE(entries, 2);
  EXPECT_TRUE(contains(folder.read("a.truth.yaml"), "\nframes: " + std::to_string(entries / 2)));
}

TEST(StoppedEarly, aRobotHasDrivenAsFarAsItGot) {
  const TemporaryFolder folder;
  const std::string config = std::string(MSO_SOURCE_DIR) + "/config/";
  const ProgramRun run = stopEarly(
      folder,
      "semantic-map-drive --start=-14,-19,10 --goal=25,-12,90 --no-pictures -o out --config " +
          config + "drives/synthetic.ini --order " + config + "orders/synthetic.yaml");
  EXPECT_EQ(run.status, 130) << run.output;
  EXPECT_EQ(nlohmann::json::parse(folder.read("out/drive.json"))["end"], "stopped");
  EXPECT_TRUE(fs::exists(folder / "out/map.semantic"));
}

TEST(WrittenMeanwhile, byOthersStaysAndTheResultIsKeptBesideIt) {
  const TemporaryFolder folder;
  const std::string command =
      "synth-rawlog -o a.rawlog --frames 1000000 --sensor lidar --columns 60";
  const ProgramRun run = stopEarly(folder, command, "echo theirs >a.rawlog");
  EXPECT_EQ(run.status, 1) << run.output;
  EXPECT_TRUE(contains(run.output, "somebody else has written it since"));
  EXPECT_EQ(folder.read("a.rawlog"), "theirs\n");
  const std::size_t name = run.output.rfind("kept-");
  ASSERT_NE(name, std::string::npos) << run.output;
  const std::string kept = run.output.substr(name, run.output.find('\n', name) - name);
  EXPECT_TRUE(labeled_cloud::RawlogReader(folder / kept).next()) << kept;
  EXPECT_EQ(stopEarly(folder, command + " -f", "echo theirs >a.rawlog").status, 130);
  EXPECT_TRUE(labeled_cloud::RawlogReader(folder / "a.rawlog").next());
}

/** How often: MSO_KILLS, or a few times. */
int kills() {
  const char* number = std::getenv("MSO_KILLS");
  return number ? std::atoi(number) : 4;
}

/** rawlog2semantic-map into one folder, of the sample's drive with one voxel size or another. */
class Killed : public testing::Test {
 protected:
  ProgramRun map(const std::string& resolution, const std::string& wrapper = "") const {
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
    const ProgramRun run = map(resolution);
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
