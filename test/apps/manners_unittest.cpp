// What all programs have in common.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "BuiltPrograms.h"
#include "RunProgram.h"
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
  EXPECT_TRUE(contains(wrong.output, GetParam() + " --help")) << wrong.output;
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
           {"semantic-map-edit a -o b --box 1,2,3", "--box needs 6 values"}}) {
    const ProgramRun run = runCommand(MSO_BIN_DIR "/" + command);
    EXPECT_EQ(run.status, 64) << run.output;
    EXPECT_TRUE(contains(run.output, message)) << run.output;
  }
}
