// Nothing that a user has is written over unless it is asked for, and no input ever is.
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "BuiltPrograms.h"
#include "ExportFixture.h"
#include "SmallRawlogs.h"

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
    EXPECT_TRUE(contains(result.errors, said)) << result.errors;
    for (std::size_t i = 0; i < files.size(); ++i)
      EXPECT_EQ(folder.read(files[i]), before[i]) << files[i];
    EXPECT_EQ(entriesOf(folder.path()), entries) << program;
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
  folder.write("config.ini", "[map]\nresolution = 0.5\nclasses = classes.yaml\n");
  folder.write("classes.yaml", kSmallTable);
  writeSmallRawlog(folder / "a.rawlog", robotPose(10, 1), labeledCloud(10, {{1, 0.2f, 0.2f}}, {1}));
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
  folder.write("config.ini", "[map]\nresolution = 0.5\nclasses = classes.yaml\n");
  folder.write("classes.yaml", kSmallTable);
  folder.write("labeled.rawlog", "precious");
  folder.write("preview/000000.png", "precious");
  folder.write("p.png", "precious");
  writeSmallRawlog(folder / "a.rawlog", robotPose(10, 1), labeledCloud(10, {{1, 0.2f, 0.2f}}, {1}));
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
  expectUntouched("synth-rawlog", {"--picture", "p.png"}, "p.png: is there", {"p.png"});
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
  folder.write("config.ini", "[map]\nresolution = 0.5\nclasses = classes.yaml\n");
  folder.write("classes.yaml", kSmallTable);
  const std::string rawlog =
      "Stra\xDF"
      "e.rawlog";
  writeSmallRawlog(folder / rawlog, robotPose(10, 1), labeledCloud(10, {{1, 0.2f, 0.2f}}, {1}));
  succeeded(run("rawlog2semantic-map", {"--config", "config.ini", "-o", "out", rawlog}));
  EXPECT_TRUE(fs::exists(folder / "out/map.semantic"));
  EXPECT_EQ(nlohmann::json::parse(folder.read("out/summary.json"))["rawlogs"][0],
            "Stra\xEF\xBF\xBD"
            "e.rawlog");
}
