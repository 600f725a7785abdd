// What all programs have in common.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
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
  for (const char* argument : {"--help", "--version"}) {
    const ProgramRun full = run(argument + std::string(" 3>&2 >/dev/full 2>&3"));
    EXPECT_EQ(run(std::string(argument) + " >/dev/full; test $? = 1").status, 0) << argument;
    EXPECT_EQ(run(std::string(argument) + " >&-; test $? = 1").status, 0) << argument;
    EXPECT_NE(full.status, 0);
  }
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

TEST_P(Program, offersTheOptionThatWasMeant) {
  for (const char* meant : {"--version", "--help"}) {
    const std::string typed = std::string(meant).substr(0, 5) + std::string(meant).substr(6);
    EXPECT_TRUE(contains(run(typed).output, "did you mean '" + std::string(meant) + "'?")) << typed;
  }
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

const char* const kPcd =
    "FIELDS x y z label\nPOINTS 1\nDATA ascii\n"
    "1 2 3 1\n";

class UserData : public MapTool {
 protected:
  /** Runs a program in the folder. */
  ProgramRun run(const std::string& program, const Words& arguments) const {
    const fs::path before = fs::current_path();
    fs::current_path(folder.path());
    const ProgramRun result = runProgram(program, arguments);
    fs::current_path(before);
    return result;
  }
  /** It is refused, with this said, and these files are as before. */
  void expectUntouched(const std::string& program, const Words& arguments, const std::string& said,
                       const Words& files) const {
    Words before;
    for (const std::string& file : files) before.push_back(folder.read(file));
    const std::size_t entries = entriesOf(folder.path());
    const ProgramRun result = run(program, arguments);
    EXPECT_NE(result.status, 0) << program;
    EXPECT_TRUE(contains(result.errors, said));
    for (std::size_t i = 0; i < files.size(); ++i)
      EXPECT_EQ(folder.read(files[i]), before[i]) << files[i];
    EXPECT_EQ(entriesOf(folder.path()), entries) << program;
  }
  void writeMapping(const std::string& rawlog) const {
    folder.write("config.ini", "[map]\nresolution = 0.5\nclasses = classes.yaml\n");
    folder.write("classes.yaml", kSmallTable);
    writeSmallRawlog(folder / rawlog, robotPose(10, 1), labeledCloud(10, {{1, 0.2f, 0.2f}}, {1}));
  }
  static std::size_t entriesOf(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
  }
};

const Words kWriters = {"rawlog2semantic-map", "semantic-map-compress", "semantic-map-plan",
                        "semantic-map-drive",  "semantic-map-export",   "semantic-map-merge",
                        "semantic-map-edit",   "synth-rawlog",          "planning-study",
                        "drive-study"};

}  // namespace

TEST_F(UserData, aForgottenOutputIsNotTheLastInput) {
  for (const char* name : {"a.pcd", "b.pcd"}) folder.write(name, kPcd);
  saveTree(map, path("b.semantic"));
  expectUntouched("dataset2rawlog", {"pcd", "a.pcd", "b.pcd"}, "--output is required",
                  {"a.pcd", "b.pcd"});
  expectUntouched("semantic-map-merge", {"map.semantic", "b.semantic"}, "--output is required",
                  {"map.semantic", "b.semantic"});
  expectUntouched("semantic-map-edit", {"map.semantic", "b.semantic"}, "named by -o",
                  {"map.semantic", "b.semantic"});
  expectUntouched("semantic-map-export", {"map.semantic", "b.csv"}, "named by -o",
                  {"map.semantic"});
}

TEST_F(UserData, noInputIsEverWrittenOver) {
  folder.write("a.pcd", kPcd);
  fs::create_hard_link(folder / "map.semantic", folder / "hard.semantic");
  fs::create_symlink("map.semantic", folder / "soft.semantic");
  for (const std::string name :
       {"map.semantic", "./map.semantic", "hard.semantic", "soft.semantic"})
    for (const std::string force : {"-f", "--overwrite", "-q"}) {
      expectUntouched(
          "semantic-map-edit",
          {"map.semantic", force, "-o", name, "--box", "90", "90", "90", "91", "91", "91"},
          name + ": is an input", {"map.semantic"});
      expectUntouched("semantic-map-merge", {"map.semantic", force, "-o", name},
                      name + ": is an input", {"map.semantic"});
    }
  expectUntouched("dataset2rawlog", {"pcd", "a.pcd", "-f", "-o", "a.pcd"}, "a.pcd: is an input",
                  {"a.pcd"});
  fs::create_hard_link(folder / "map.semantic", folder / "map.ply");
  expectUntouched("semantic-map-export", {"map.semantic", "-f", "-o", "map.ply"},
                  "map.ply: is an input", {"map.semantic"});
}

TEST_F(UserData, whatIsThereStaysUnlessItIsToBeWrittenOver) {
  folder.write("a.semantic", "precious");
  folder.write("a.rawlog", "precious");
  folder.write("a.pcd", kPcd);
  for (const auto& [program, arguments] :
       std::map<std::string, Words>{{"semantic-map-edit", {"map.semantic", "-o", "a.semantic"}},
                                    {"semantic-map-merge", {"map.semantic", "-o", "a.semantic"}},
                                    {"dataset2rawlog", {"pcd", "a.pcd", "-o", "a.rawlog"}}}) {
    const std::string& file = arguments.back();
    expectUntouched(program, arguments, file + ": is there already; -f", {file});
    succeeded(run(program, joined(arguments, {"-f"})));
    EXPECT_NE(folder.read(file), "precious") << program;
    folder.write(file, "precious");
  }
}

TEST_F(UserData, aGridsPictureIsNotReplacedByTheMapsPicture) {
  ASSERT_EQ(run("semantic-map-export", {"map.semantic", "-o", "kk.yaml"}).status, 0);
  expectUntouched("semantic-map-export", {"map.semantic", "-o", "kk.png"},
                  "kk.png: is there already", {"kk.png", "kk.yaml"});
  fs::remove(folder / "kk.yaml");
  expectUntouched("semantic-map-export", {"map.semantic", "-o", "kk.yaml"},
                  "kk.png: is there already", {"kk.png"});
}

TEST_F(UserData, filesOfAFolderAreNotReplacedEither) {
  writeMapping("a.rawlog");
  for (const char* name : {"map.semantic", "view.png", "compressed.png"}) {
    const std::string file = std::string("out/") + name;
    folder.write(file, "of before");
    folder.write("out/other", "of before");
    expectUntouched("rawlog2semantic-map", {"--config", "config.ini", "-o", "out", "a.rawlog"},
                    file + ": is there already", {file});
    fs::remove(folder / file);
  }
  succeeded(run("rawlog2semantic-map", {"--config", "config.ini", "-o", "out", "a.rawlog"}));
  EXPECT_EQ(folder.read("out/other"), "of before");
}

TEST_F(UserData, otherOutputsAreNotReplacedEither) {
  writeMapping("a.rawlog");
  folder.write("labeled.rawlog", "precious");
  folder.write("preview/000000.png", "precious");
  const auto mapping = [](const Words& more) {
    return joined({"--config", "config.ini", "-o", "out", "a.rawlog"}, more);
  };
  const std::string program = "rawlog2semantic-map";
  expectUntouched(program, mapping({"--save-labeled", "labeled.rawlog"}),
                  "labeled.rawlog: is there", {"labeled.rawlog"});
  expectUntouched(program, mapping({"-f", "--save-labeled", "a.rawlog"}), "a.rawlog: is an input",
                  {"a.rawlog"});
  expectUntouched(program, mapping({"-f", "--save-labeled", "classes.yaml"}),
                  "classes.yaml: is an input", {"classes.yaml"});
  expectUntouched(program, mapping({"--preview", "preview"}), "000000.png: is there",
                  {"preview/000000.png"});
}

TEST_F(UserData, noFileIsWrittenTwice) {
  expectUntouched("synth-rawlog", {"-o", "a.tum"}, "a.tum: would be written twice", {});
  expectUntouched("semantic-map-export", {"map.semantic", "-o", "a.csv", "-o", "./a.csv"},
                  "a.csv: would be written twice", {});
}

TEST_F(UserData, aDeviceIsNoPlaceForAFile) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  expectUntouched("semantic-map-edit", {"map.semantic", "-f", "-o", "/dev/full"}, "no regular file",
                  {});
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
  const std::string rawlog =
      "Stra\xDF"
      "e.rawlog";
  writeMapping(rawlog);
  succeeded(run("rawlog2semantic-map", {"--config", "config.ini", "-o", "out", rawlog}));
  EXPECT_TRUE(fs::exists(folder / "out/map.semantic"));
  EXPECT_EQ(nlohmann::json::parse(folder.read("out/summary.json"))["rawlogs"][0],
            "Stra\xEF\xBF\xBD"
            "e.rawlog");
}
