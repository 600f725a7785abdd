// What all programs have in common.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <regex>

#include "BuiltPrograms.h"
#include "ExportFixture.h"
#include "RunProgram.h"
#include "SmallRawlogs.h"
#include "TemporaryFolder.h"

namespace {

const std::vector<std::string> kPrograms = {
    "rawlog2semantic-map", "semantic-map-compress", "semantic-map-plan", "semantic-map-drive",
    "semantic-map-export", "semantic-map-merge",    "semantic-map-edit", "synth-rawlog",
    "planning-study",      "drive-study",           "semantic-map-info", "insertion-benchmark",
    "dataset2rawlog",      "semantic-map-view",     "semantic-map-send", "semantic-map-receive",
    "semantic-map-ros2"};

class Program : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (const std::string missing = missingLibraryOf(GetParam()); !missing.empty())
      GTEST_SKIP() << "not built: " << missing;
  }
  ProgramRun run(const std::string& arguments) const {
    return runCommand(std::string(MSO_BIN_DIR) + "/" + GetParam() + " " + arguments);
  }
};

INSTANTIATE_TEST_SUITE_P(Each, Program, testing::ValuesIn(kPrograms), [](const auto& each) {
  return std::regex_replace(each.param, std::regex("-"), "_");
});

}  // namespace

TEST_P(Program, failsWhereTheStandardOutputTakesNothing) {
  EXPECT_EQ(run("--version").status, 0);
  for (const char* argument : {"--help", "--version"})
    for (const char* output : {">/dev/full; exit $?", ">&-; exit $?"})
      EXPECT_EQ(run(argument + std::string(" ") + output).status, 1) << argument << output;
}

TEST_P(Program, endsWith64AndItsNameAfterAWrongCommandLine) {
  const ProgramRun wrong = run("--no-such-option");
  EXPECT_EQ(wrong.status, 64) << wrong.output;
  EXPECT_EQ(wrong.output.rfind(GetParam() + ": unknown option '--no-such-option'", 0), 0u)
      << wrong.output;
  EXPECT_TRUE(contains(wrong.output, GetParam() + " --help"));
}

TEST_P(Program, endsWithAMessageUnderAnyLimitOfMemory) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer takes terabytes of addresses";
#endif
  const auto statusWith = [this](int megabytes) {
    const ProgramRun run = runCommand("ulimit -c 0; ulimit -v " + std::to_string(1024 * megabytes) +
                                      "; " MSO_BIN_DIR "/" + GetParam() + " --version");
    EXPECT_TRUE(run.status == 0 || run.status == 1 || run.status == 127)
        << run.status << " with " << megabytes << " MB: " << run.output;
    EXPECT_NE(run.output, "");
    return run.status;
  };
  int tooLittle = 8, enough = 1032;
  while (enough - tooLittle > 4) {
    const int middle = (tooLittle + enough) / 2;
    (statusWith(middle) == 0 ? enough : tooLittle) = middle;
  }
  for (int megabytes = std::max(8, enough - 20); megabytes < enough + 8; megabytes += 4)
    statusWith(megabytes);
}

TEST_P(Program, speaksToPeopleInItsHelp) {
  std::string help = run("--help").output;
  if (GetParam() == "dataset2rawlog")
    for (const char* command : {"semantic-kitti", "tum", "pcd"})
      help += run(command + std::string(" --help")).output;
  for (const char* leak : {"ENUM", "->", "UINT", "FLOAT", "INT:", "POSITIVE", "NONNEGATIVE",
                           "{false}", "{true}", " in [", "TEXT:"})
    EXPECT_FALSE(contains(help, leak)) << leak << " in\n" << help;
  const std::regex noName("Usage: [^\n]*[:={]");  // CLI11 2.4 ends programs that have one
  EXPECT_FALSE(std::regex_search(help, noName)) << help;
}

TEST(UsageErrors, nameTheOptionAndOfferWhatWasMeant) {
  for (const auto& [command, message] : std::vector<std::pair<std::string, std::string>>{
           {"synth-rawlog -o a.rawlog --scene vilage", "'village'?"},
           {"synth-rawlog -o a.rawlog --sensor lidr", "'lidar'?"},
           {"insertion-benchmark --rays al x", "'all'?"},
           {"semantic-map-plan m --start=0,0,0 --goal=1,1,0 --order c -o p --graph compresed",
            "'compressed'?"},
           {"dataset2rawlog semantic-kiti x", "'semantic-kitti'?"},
           {"dataset2rawlog -q tum x -o y", ": -q belongs behind the "},
           {"semantic-map-info a --at 1,2", "info: --at: expected X,Y,Z"},
           {"semantic-map-edit a -o b --decay 1 --decay 2", "edit: --decay is given 2 times"},
           {"synth-rawlog", "--output"},
           {"semantic-map-info", "MAP is required"},
           {"semantic-map-info a b", "one argument too many: 'b'"},
           {"semantic-map-info a --distribution", "--at"},
           {"dataset2rawlog tum x -o a.rawlog", "--classes"},
           {"semantic-map-edit a -o b --resolution -1",
            "--resolution is -1, expected a number above 0"},
           {"semantic-map-edit a --output", "--output lacks its value"},
           {"semantic-map-edit a -o b --box 1,2,3", "--box: expected X,Y,Z,X2,Y2,Z2"},
           {"semantic-map-edit a --box 1,2,3,4,5 -o b", "--box: expected X,Y,Z,X2,Y2,Z2"},
           {"semantic-map-drive --goal 1,1,0 --order c --config d -o x", "--start is required"},
           {"rawlog2semantic-map a --config c -o b --pause", "--live"}}) {
    const ProgramRun run = runCommand(MSO_BIN_DIR "/" + command);
    EXPECT_EQ(run.status, 64) << run.output;
    EXPECT_TRUE(contains(run.output, message));
  }
}

namespace fs = std::filesystem;

namespace {

/** What a program is asked for, why it refuses, and files that stay as they are. */
struct Refused {
  std::string command, said;
  Words files;
};

/** A folder of inputs, and programs that run in it. */
class UserData : public MapTool {
 protected:
  void SetUp() override {
    MapTool::SetUp();
    saveTree(map, path("b.semantic"));
    for (const char* name : {"a.pcd", "b.pcd"})
      folder.write(name, "FIELDS x y z label\nPOINTS 1\nDATA ascii\n1 2 3 1\n");
    folder.write("config.ini", "[map]\nresolution = 0.5\nclasses = classes.yaml\n");
    folder.write("classes.yaml", kSmallTable);
    writeSmallRawlog(folder / "a.rawlog", robotPose(10, 1),
                     labeledCloud(10, {{1, 0.2f, 0.2f}}, {1}));
  }
  ProgramRun run(const std::string& command) const {
    return runCommand("cd '" + folder.path().string() + "' && " MSO_BIN_DIR "/" + command);
  }
  void expectUntouched(const Refused& refused) const {
    SCOPED_TRACE(refused.command);
    Words before;
    for (const std::string& file : refused.files) before.push_back(folder.read(file));
    const auto entries = entriesOf(folder.path());
    const ProgramRun result = run(refused.command);
    EXPECT_NE(result.status, 0);
    EXPECT_TRUE(contains(result.output, refused.said));
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_EQ(folder.read(refused.files[i]), before[i]) << refused.files[i];
    EXPECT_EQ(entriesOf(folder.path()), entries);
  }
  static std::ptrdiff_t entriesOf(const fs::path& folder) {
    return std::distance(fs::directory_iterator(folder), {});
  }
  const std::string mapping = "rawlog2semantic-map --config config.ini -o out a.rawlog ";
};

const Words kWriters = {"rawlog2semantic-map", "semantic-map-compress", "semantic-map-plan",
                        "semantic-map-drive",  "semantic-map-export",   "semantic-map-merge",
                        "semantic-map-edit",   "synth-rawlog",          "planning-study",
                        "drive-study"};

}  // namespace

TEST_F(UserData, isNeverAForgottenOutputNorWrittenOver) {
  fs::create_hard_link(folder / "map.semantic", folder / "hard.semantic");
  fs::create_hard_link(folder / "map.semantic", folder / "map.ply");
  fs::create_symlink("map.semantic", folder / "soft.semantic");
  for (const Refused& refused : std::vector<Refused>{
           {"dataset2rawlog pcd a.pcd b.pcd", "--output is required", {"a.pcd", "b.pcd"}},
           {"dataset2rawlog pcd a.pcd -f -o a.pcd", "a.pcd: is an input", {"a.pcd"}},
           {"semantic-map-merge map.semantic b.semantic", "--output is required", {"b.semantic"}},
           {"semantic-map-edit map.semantic b.semantic", "named by -o", {"b.semantic"}},
           {"semantic-map-export map.semantic b.csv", "named by -o", {"map.semantic"}},
           {"semantic-map-export map.semantic -f -o map.ply", "map.ply: is an input", {"map.ply"}},
           {mapping + "-f --save-labeled a.rawlog", "a.rawlog: is an input", {"a.rawlog"}},
           {mapping + "-f --save-labeled classes.yaml", "yaml: is an input", {"classes.yaml"}},
           {"synth-rawlog -o a.tum", "a.tum: would be written twice", {}},
           {"semantic-map-export map.semantic -o a.csv -o ./a.csv", "would be written twice", {}}})
    expectUntouched(refused);
  for (const std::string name :
       {"map.semantic", "./map.semantic", "hard.semantic", "soft.semantic"})
    expectUntouched({"semantic-map-merge map.semantic -f -o " + name,
                     name + ": is an input",
                     {"map.semantic"}});
}

TEST_F(UserData, staysUnlessItIsToBeWrittenOver) {
  for (const auto& [command, output] : std::vector<std::pair<std::string, std::string>>{
           {"semantic-map-edit map.semantic -o old.semantic", "old.semantic"},
           {"dataset2rawlog pcd a.pcd -o old.rawlog", "old.rawlog"},
           {"semantic-map-export map.semantic -o grid.yaml", "grid.png"},
           {mapping, "out/compressed.png"},
           {mapping, "out/map.semantic"},
           {mapping + "--save-labeled labeled.rawlog", "labeled.rawlog"},
           {mapping + "--preview preview", "preview/000000.png"}}) {
    folder.write(output, "precious");
    expectUntouched({command, output + ": is there already; -f", {output}});
    if (output.rfind("out/", 0) == 0) fs::remove(folder / output);
  }
  folder.write("out/other", "of before");
  succeeded(run("semantic-map-edit map.semantic -f -o old.semantic"));
  EXPECT_NE(folder.read("old.semantic"), "precious");
  succeeded(run(mapping));
  EXPECT_EQ(folder.read("out/other"), "of before");
}

TEST_F(UserData, aDeviceIsNoPlaceForAFile) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  expectUntouched({"semantic-map-edit map.semantic -f -o /dev/full", "no regular file", {}});
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(Programs, thatWriteNameTheirOutputAlike) {
  for (const std::string& program : kWriters) {
    if (!missingLibraryOf(program).empty()) continue;
    const std::string help = runProgram(program, {"--help"}).output;
    for (const std::string option : {"-o, *--output", "-f, *--overwrite", "-q, *--quiet"})
      EXPECT_TRUE(std::regex_search(help, std::regex(option))) << program << ' ' << option;
  }
}

TEST_F(UserData, namesThatAreNoUtf8DoNotDiscardARun) {
  fs::rename(folder / "a.rawlog", folder / "Stra\xDF.rawlog");
  succeeded(run("rawlog2semantic-map --config config.ini -o out Stra\xDF.rawlog"));
  EXPECT_TRUE(fs::exists(folder / "out/map.semantic"));
  EXPECT_EQ(nlohmann::json::parse(folder.read("out/summary.json"))["rawlogs"][0],
            "Stra\xEF\xBF\xBD.rawlog");
}
