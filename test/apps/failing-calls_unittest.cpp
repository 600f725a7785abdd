// What programs leave when one call of the operating system fails: the old files or the new ones.
#include <gtest/gtest.h>
#include <labeled_cloud/Rawlogs.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "../semantic_planning/PaintedWorld.h"
#include "ExportFixture.h"
#include "RunProgram.h"
#include "SmallRawlogs.h"

namespace fs = std::filesystem;

namespace {

/** How many calls of a kind fail for each program: MSO_CALLS_EACH, or a few, first and last ones.
 */
int callsOfEach() {
  const char* number = std::getenv("MSO_CALLS_EACH");
  return number ? std::atoi(number) : 4;
}

using Files = std::map<std::string, std::string>;

bool tellsTimes(const std::string& name) {
  return fs::path(name).extension() == ".json" || name == "report.csv";
}

std::ptrdiff_t linesOf(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

/** Programs in a folder with their inputs; what they write is in `out`. */
class FailingCalls : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    saveTree(smallPlace(0, 2), path("map.semantic"));
    saveTree(smallPlace(2, 1), path("other.semantic"));
    folder.write("weights.yaml",
                 "{name: road, relevant: {road: 1}, alpha: 0.01, block_size: 3.2}\n");
    folder.write("order.yaml", "best_to_worst: [road, grass]\n");
    PaintedWorld world;
    world.floor(-10, 10, -6, 6, PaintedWorld::Grass);
    world.floor(-10, 10, -2, 2, PaintedWorld::Road);
    saveTree(world.map(), path("world.semantic"));
    folder.write("small.ini", "[map]\nresolution = 0.5\nclasses = classes.yaml\n");
    folder.write("classes.yaml", kSmallTable);
    folder.write("a.pcd", "FIELDS x y z label\nPOINTS 1\nDATA ascii\n1 2 3 1\n");
    writeSmallRawlog(folder / "small.rawlog", robotPose(10, 1.1),
                     labeledCloud(10, {{1.1f, 0.2f, 0.2f}, {-1, 3, 0.2f}}, {1, 1}));
    fs::create_directory(folder / "out");
    for (const char* name : {"a.semantic", "map.semantic", "path.csv", "report.json", "a.rawlog"})
      folder.write(std::string("out/") + name, "of before");
  }
  std::string path(const std::string& name) const { return (folder / name).string(); }

  /** The program with its n-th call of a kind failing; below 0: none. */
  ProgramRun run(const std::string& kind = "", int n = -1) const {
    std::string command = "cd '" + folder.path().string() + "'; ";
    if (contains(GetParam(), "receive"))
      command += "rm -f sent; " MSO_BIN_DIR
                 "/semantic-map-send map.semantic --weights weights.yaml --port 0 >sent 2>&1 & "
                 "trap 'kill $!' EXIT; until grep -qs 'port [0-9]' sent; do sleep 0.02; done; ";
    if (!kind.empty())
      command += "MSO_FAIL='" + kind + ' ' + std::to_string(n) + "' MSO_FAIL_BELOW='" +
                 folder.path().string() + "' MSO_CALLS='" + path("calls") +
                 "' LD_PRELOAD='" MSO_FAILING_CALLS "' ";
    return runCommand(
        command + MSO_BIN_DIR "/" +
        std::regex_replace(GetParam(), std::regex("@"), folder.path().string() + '/'));
  }
  int callsOf(const std::string& kind) const {
    fs::remove(folder / "calls");
    putBack();
    EXPECT_EQ(run(kind).status, 0);
    std::error_code none;
    const auto calls = fs::file_size(folder / "calls", none);
    return none ? 0 : static_cast<int>(calls);
  }

  Files files() const {
    Files all;
    for (const auto& entry : fs::recursive_directory_iterator(folder / "out"))
      if (const std::string name = fs::relative(entry.path(), folder / "out").string();
          !entry.is_directory())
        all[name] = folder.read("out/" + name);
    return all;
  }
  void putBack() const {
    fs::remove_all(folder / "out");
    fs::create_directory(folder / "out");
    for (const auto& [name, content] : before) folder.write("out/" + name, content);
  }
  /** \param mayLitter what could not be removed may be there */
  void expectOldOrNew(bool isNew, bool mayLitter) const {
    for (const auto& [name, content] : files()) {
      const auto old = before.find(name), now = after.find(name);
      const bool isOld = old != before.end() && old->second == content;
      const bool isAfter =
          now != after.end() && (now->second == content ||
                                 (tellsTimes(name) && linesOf(now->second) == linesOf(content)));
      EXPECT_TRUE(isAfter || (isOld && !isNew) || (mayLitter && !isOld && now == after.end()))
          << name << (now == after.end() ? " is left" : " is neither the old nor the new one");
    }
    for (const auto& [name, content] : isNew ? after : before)
      EXPECT_TRUE(fs::exists(folder / "out" / name) || after.count(name) == 0 ||
                  fs::path(name).filename() == ".readers.lock")  // who could not take it goes on
          << name << " is gone";
  }
  void expectMessage(const ProgramRun& run) const {
    const std::string name = GetParam().substr(0, GetParam().find(' '));
    const std::size_t at = run.output.rfind(name + ": ");
    EXPECT_NE(at, std::string::npos) << run.output;
    if (at == std::string::npos) return;
    const std::string message = run.output.substr(at);
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << message;
    EXPECT_TRUE(contains(message, folder.path().string()) || contains(message, ".png")) << message;
    EXPECT_FALSE(contains(message, "Success")) << message;
  }

  Files before, after;
  TemporaryFolder folder;
};

const Words kJobs = {
    "semantic-map-edit @map.semantic -f -o @out/a.semantic",
    "semantic-map-merge @map.semantic @other.semantic -f -o @out/tiles --tiles 1.6",
    "semantic-map-export @map.semantic -f -o @out/a.csv -o @out/a.ply -o @out/a.yaml -o @out/a.ot "
    "-o @out/a.3Dscene",
    "semantic-map-compress @map.semantic --weights @weights.yaml -f -o @out",
    "semantic-map-evaluate @map.semantic --scans @small.rawlog -f -o @out",
    "semantic-map-plan @world.semantic --order @order.yaml --start=-8,0,0 --goal=8,0,0 -f -o "
    "@out",
    "semantic-map-receive 127.0.0.1:$(grep -o '[0-9]*$' sent) -f -o @out/a.semantic",
    "rawlog2semantic-map --config @small.ini -f -o @out --save-labeled @out/a.rawlog @small.rawlog",
    "rawlog2semantic-map --config @small.ini -f -o @out --tiles @out/tiles --tile-size 4 "
    "@small.rawlog",
    "synth-rawlog --sensor lidar --columns 60 --frames 2 -f -o @out/a.rawlog",
    "dataset2rawlog pcd @a.pcd --classes @classes.yaml -f -o @out/a.rawlog"};

INSTANTIATE_TEST_SUITE_P(Each, FailingCalls, testing::ValuesIn(kJobs), [](const auto& each) {
  return std::regex_replace(each.param.substr(0, 19), std::regex("[^a-z]"), "_") +
         std::to_string(each.index);
});

}  // namespace

TEST_P(FailingCalls, leaveTheOldFilesOrTheNewAndSayWhy) {
  before = files();
  const ProgramRun whole = run();
  ASSERT_EQ(whole.status, 0) << whole.output;
  after = files();
  for (const std::string kind : {"open", "write", "sync", "rename", "unlink"}) {
    const int calls = callsOf(kind), each = std::min(calls, callsOfEach());
    for (int i = 0; i < each; ++i) {
      const int n = each > 1 ? i * (calls - 1) / (each - 1) : 0;
      SCOPED_TRACE(kind + " " + std::to_string(n) + " of " + std::to_string(calls));
      putBack();
      const ProgramRun failed = run(kind, n);
      EXPECT_LT(failed.status, 2) << failed.output;
      if (failed.status != 0) expectMessage(failed);
      expectOldOrNew(failed.status == 0, kind == "unlink");
      if (!HasFailure()) continue;
      ADD_FAILURE() << failed.output;
      return;
    }
  }
}

TEST(FailingLock, isNoLeaveToWrite) {
  const TemporaryFolder folder;
  const std::string map = (folder / "map.semantic").string(), tiles = (folder / "tiles").string();
  saveTree(smallPlace(0, 2), map);
  const ProgramRun failed = runCommand("MSO_FAIL='open 0' MSO_FAIL_BELOW='" + tiles +
                                       "/.writer.lock' LD_PRELOAD='" MSO_FAILING_CALLS
                                       "' " MSO_BIN_DIR "/semantic-map-merge '" +
                                       map + "' -o '" + tiles + "' --tiles 1.6");
  EXPECT_EQ(failed.status, 1) << failed.output;
  EXPECT_TRUE(contains(failed.output, "tiles: Too many open files")) << failed.output;
  EXPECT_FALSE(fs::exists(tiles));
}
