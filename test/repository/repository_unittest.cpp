// The rules that this repository sets itself, and that each rule sees what breaks it.
#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <map>
#include <regex>
#include <set>

#include "IncludeRules.h"
#include "SourceTree.h"
#include "TemporaryFolder.h"
#include "TextRules.h"

namespace fs = std::filesystem;

namespace {

using Findings = std::vector<std::string>;

class Repository : public testing::Test {
 protected:
  const fs::path root = MSO_SOURCE_DIR;
  const TemporaryFolder own;
  const fs::path scratch = own.path();

  void write(const std::string& file, const std::string& text) const { own.write(file, text); }

  /** What this project consists of, without what a build or a user puts beside it. */
  std::vector<fs::path> projectFolders() const {
    std::vector<fs::path> folders;
    for (const auto* name : {".ci",
                             ".github",
                             ".pre-commit-config.yaml",
                             "apps",
                             "cmake",
                             "config",
                             "doc",
                             "libs",
                             "rawlog-samples",
                             "scripts",
                             "test",
                             "README.md",
                             "CHANGELOG.md",
                             "CITATION.cff",
                             "CONTRIBUTING.md",
                             "CMakeLists.txt",
                             "CMakePresets.json",
                             "Doxyfile",
                             "debian-packages.txt",
                             "package.xml",
                             "run-demo",
                             "run-tests"})
      if (fs::exists(root / name)) folders.push_back(root / name);
    return folders;
  }
};

TEST_F(Repository, librariesIncludeOnlyWhatTheirRowAllows) {
  EXPECT_EQ(forbiddenIncludes(root / "libs", includeTable(root / "doc/development.md")),
            Findings());
}

TEST_F(Repository, anIncludeAcrossABoundaryIsFound) {
  write("pure/include/pure/Good.h", "#include <Eigen/Core>\n#include <pure/Other.h>\n");
  write("pure/src/Bad.cpp", "#include <vector>\n  #  include <mrpt/poses/CPose3D.h>\n");
  EXPECT_EQ(forbiddenIncludes(scratch, {{"pure", {"Eigen"}}}),
            Findings{"pure/src/Bad.cpp:2: pure may not include mrpt/poses/CPose3D.h"});
}

TEST_F(Repository, aQuotedIncludeReachesOnlyFilesBesideIt) {
  write("pure/src/Near.h", "");
  write("pure/src/Bad.cpp", "#include \"Near.h\"\n#include \"../../other/src/Far.h\"\n");
  write("other/src/Far.h", "");
  EXPECT_EQ(forbiddenIncludes(scratch, {{"pure", {}}, {"other", {}}}),
            Findings{"pure/src/Bad.cpp:2: pure may not include ../../other/src/Far.h"});
}

TEST_F(Repository, anIncludeBackUpBetweenTheRoomsOfALibraryIsFound) {
  write("house/src/cellar/Bad.cpp",
        "#include <house/attic/Roof.h>\n#include \"attic/Beams.h\"\n#include \"Near.h\"\n");
  write("house/src/cellar/Near.h", "#include <house/cellar/Stone.h>\n");
  write("house/src/attic/Good.cpp",
        "#include <house/cellar/Stone.h>\n#include \"cellar/Near.h\"\n");
  EXPECT_EQ(forbiddenIncludes(scratch, {{"house/cellar", {}}, {"house/attic", {"house/cellar"}}}),
            (Findings{"house/src/cellar/Bad.cpp:1: house/cellar may not include house/attic/Roof.h",
                      "house/src/cellar/Bad.cpp:2: house/cellar may not include attic/Beams.h"}));
}

TEST_F(Repository, anIncludeOfAStoreThatIsForOthersIsFound) {
  write("house/store/house/store/Beams.h", "#include <house/store/Nails.h>\n");
  write("guest/src/Bad.cpp", "#include <house/Door.h>\n#include <house/store/Beams.h>\n");
  EXPECT_EQ(forbiddenIncludes(scratch, {{"house", {}}, {"guest", {"house"}}}),
            Findings{"guest/src/Bad.cpp:2: guest may not include house/store/Beams.h"});
}

TEST_F(Repository, aLibraryThatPrintsIsFound) {
  write("pure/src/Bad.cpp", "#include <iostream>\n");
  EXPECT_EQ(forbiddenIncludes(scratch, {{"pure", {}}}),
            Findings{"pure/src/Bad.cpp:1: prints: <iostream> belongs to applications"});
}

TEST_F(Repository, aLibraryWithoutARowIsFound) {
  write("fresh/src/File.cpp", "#include <vector>\n");
  EXPECT_EQ(forbiddenIncludes(scratch, {}),
            Findings{"fresh/src/File.cpp:1: fresh has no row in the table of includes"});
}

TEST_F(Repository, whoeverSortsOrFindsIncludesAlgorithm) {
  for (const char* folder : {"libs", "apps", "test", "doc"})
    EXPECT_EQ(algorithmsWithoutTheirHeader(root / folder), Findings());
  write("Good.cpp",
        "#include <algorithm>\nvoid f(V& v) { std::"
        "sort(v.begin(), v.end()); }\n");
  write("Bad.cpp",
        "#include <vector>\nint n = text.find(x);\nauto i = std::"
        "find_if(a, b, c);\n");
  EXPECT_EQ(algorithmsWithoutTheirHeader(scratch),
            Findings{"Bad.cpp:3: std::find_if needs <algorithm>"});
}

TEST_F(Repository, longSourcesAreNamed) {
  for (const char* folder : {"libs", "apps", "test"})
    for (const std::string& finding : filesLongerThan(400, root / folder))
      std::cout << "warning: " << folder << '/' << finding << '\n';
  write("Long.cpp", "1\n2\n3\n");
  write("Short.h", "1\n2\n");
  EXPECT_EQ(filesLongerThan(2, scratch), Findings{"Long.cpp:3: more than 2 lines"});
}

TEST_F(Repository, programsAndTestsLinkLibrariesInsteadOfSourcesOfPrograms) {
  for (const char* folder : {"apps", "test"})
    EXPECT_EQ(borrowedSources(root / folder), Findings()) << folder;
  write("a/CMakeLists.txt", "add_executable(a\n  ../map-tool/Report.cpp\n  Near.cpp)\n");
  write("a/main.cpp",
        "#include \"../../apps/map-tool/Report.h\"\n#include \"../fixtures/Town.h\"\n");
  EXPECT_EQ(borrowedSources(scratch), (Findings{"a/CMakeLists.txt:2: a source of another program",
                                                "a/main.cpp:1: a source of another program"}));
}

TEST_F(Repository, namesOfOptionsHaveNoSpaces) {
  for (const char* folder : {"apps", "test/benchmark"})
    EXPECT_EQ(optionNamesWithSpaces(root / folder), Findings());
  write("main.cpp",
        "app.add_option(\"FILE\", file, \"A file to read\");\n"
        "app.add_option_function<std::string>(\n    \"FILE... OUT\", take);\n");
  EXPECT_EQ(optionNamesWithSpaces(scratch), Findings{"main.cpp:2: a name with spaces"});
}

TEST_F(Repository, linesHaveNoSpaceAtTheirEndNoCarriageReturnAndNoPathOfAMachine) {
  for (const auto rule : {linesWithTrailingSpace, linesWithCarriageReturn, linesTiedToAMachine})
    for (const fs::path& part : projectFolders()) EXPECT_EQ(rule(part), Findings()) << part;
  write("space.txt", "good\nbad \nbad\t\n");
  EXPECT_EQ(linesWithTrailingSpace(scratch),
            (Findings{"space.txt:2: space at the end of the line",
                      "space.txt:3: space at the end of the line"}));
  write("return.txt", "good\nb\rad\nbad\r\n");
  EXPECT_EQ(linesWithCarriageReturn(scratch),
            (Findings{"return.txt:2: a carriage return", "return.txt:3: a carriage return"}));
  write("machine.txt",
        "cd /"
        "home/me\nhttps://deb."
        "debian.org\na/tmp/b /usr/share/mrpt\n");
  EXPECT_EQ(linesTiedToAMachine(scratch),
            (Findings{"machine.txt:1: a path or a server of one machine",
                      "machine.txt:2: a path or a server of one machine"}));
}

TEST_F(Repository, linksBetweenDocumentsLeadSomewhere) {
  for (const fs::path& folder : projectFolders()) {
    for (const fs::path& file : textFiles(folder)) {
      if (file.extension() != ".md") continue;
      EXPECT_EQ(brokenLinks(file), Findings());
    }
  }
  write("there.md", "");
  write("file.md", "[a](there.md) [b](there.md#part)\n[c](https://x.org/y) ![d](gone.png)\n");
  EXPECT_EQ(brokenLinks(scratch / "file.md"), Findings{"file.md:2: no file gone.png"});
}

TEST_F(Repository, documentsShowTheExamplesAsTheyAre) {
  for (const fs::path& folder : {root / "README.md", root / "doc"})
    for (const fs::path& file : textFiles(folder))
      EXPECT_EQ(excerptsThatDiffer(file), Findings()) << file;
  write("main.cpp", "int main() {\n  load();\n  save();\n}\n");
  write("file.md",
        "From [it](main.cpp):\n\n```cpp\nload();\nsave();\n```\nOf nothing:\n```cpp\nx();\n```\n"
        "Again [it](main.cpp):\n```cpp\nload();\n\nclose();\n```\n");
  EXPECT_EQ(excerptsThatDiffer(scratch / "file.md"),
            Findings{"file.md:12: main.cpp does not have these lines"});
}

TEST_F(Repository, theExamplesAreShort) {
  EXPECT_EQ(filesLongerThan(39, root / "doc/examples"), Findings());
}

TEST_F(Repository, eachLibraryIsDescribedInOneSentenceAndDocumented) {
  static const std::regex row(R"(^\| \[`(\w+)`\]\(../libs/\w+\) \| (.*) \|$)");
  std::map<std::string, std::string> sentences;
  for (const SourceLine& line : linesOf(root / "doc/README.md"))
    if (std::smatch match; std::regex_match(line.text, match, row)) sentences[match[1]] = match[2];
  for (const auto& library : fs::directory_iterator(root / "libs")) {
    if (!library.is_directory()) continue;
    const std::string sentence = sentences[library.path().filename().string()];
    EXPECT_GT(sentence.size(), 10u) << library.path() << " is not in the table of doc/README.md";
    EXPECT_EQ(firstComment(library.path() / "CMakeLists.txt").rfind(sentence, 0), 0u)
        << library.path() << ": " << sentence;
    if (!fs::exists(library.path() / "include")) continue;
    const std::string includes = "libs/" + library.path().filename().string() + "/include";
    EXPECT_TRUE(contains(textOf(root / "Doxyfile"), includes)) << includes;
  }
}

TEST_F(Repository, noTwoPagesHaveOneName) {
  std::map<fs::path, fs::path> pages;
  for (const fs::path& file : textFiles(root / "doc")) {
    if (file.filename() == "README.md" || file.filename() == "CMakeLists.txt") continue;
    EXPECT_TRUE(pages.emplace(file.filename(), file).second) << file;
  }
}

TEST_F(Repository, everyApplicationHasAReadme) {
  for (const char* folder : {"apps", "test/benchmark"})
    for (const auto& entry : fs::directory_iterator(root / folder)) {
      if (!fs::exists(entry.path() / "CMakeLists.txt")) continue;
      EXPECT_TRUE(fs::exists(entry.path() / "README.md")) << entry.path();
    }
}

TEST_F(Repository, filesThatRepeatTheVersionHaveThatOfTheProject) {
  std::ifstream file(root / "VERSION");
  std::string version;
  std::getline(file, version);
  EXPECT_TRUE(contains(textOf(root / "package.xml"), "<version>" + version + "</version>\n"));
  EXPECT_TRUE(contains(textOf(root / "CITATION.cff"), "\nversion: " + version + "\n"));
}

TEST_F(Repository, everyPackageIsListedOnce) {
  std::set<std::string> seen;
  for (const SourceLine& line : linesOf(root / "debian-packages.txt")) {
    if (line.text.empty() || line.text.front() == '#' || line.text.front() == '[') continue;
    const std::string package = line.text.substr(0, line.text.find(' '));
    EXPECT_TRUE(seen.insert(package).second) << package << " in line " << line.number;
  }
}

const std::filesystem::path kRoot = MSO_SOURCE_DIR;

TEST(Messages, thatTheHandbookExplainsAreThoseOfTheSources) {
  EXPECT_EQ(messagesNobodySays(kRoot / "doc/handbook/troubleshooting.md",
                               {kRoot / "libs", kRoot / "apps"}),
            Findings());
}

TEST(Messages, thatNobodySaysAreFound) {
  const TemporaryFolder folder;
  folder.write(
      "main.cpp",
      "fail(file + \": has \" + count + \" bytes too \"\n     \"many\"); fail(\"unknown \" + "
      "kind);\nkind = \"section\";\n");
  folder.write("file.md",
               "| message | what |\n|---|---|\n| `FILE: has 3 bytes too many` | `other` |\n"
               "| `unknown section` | |\n| `FILE: has no bytes`, `unknown key X` | |\n");
  EXPECT_EQ(messagesNobodySays(folder / "file.md", {folder.path()}),
            (Findings{"file.md:5: has no bytes", "file.md:5: unknown key"}));
}

const fs::path kSources = MSO_SOURCE_DIR;

/** The README and the pages of doc/, without studies, which are frozen, and the page of options,
 * which is written by a program. */
std::vector<fs::path> pages() {
  std::vector<fs::path> pages = {kSources / "README.md"};
  for (const fs::path& file : textFiles(kSources / "doc"))
    if (file.extension() == ".md" && file.filename() != "options.md" &&
        file.parent_path().filename() != "studies")
      pages.push_back(file);
  return pages;
}

/** Names the pages of a folder that have more words than that. */
void nameLongPages(const fs::path& folder, std::size_t most) {
  for (const fs::path& file : textFiles(folder)) {
    if (file.extension() != ".md" || file.filename() == "options.md") continue;
    const std::size_t words = countWords(textOf(file));
    if (words > most)
      std::cout << "warning: " << file.lexically_relative(kSources).string() << " has " << words
                << " words, more than " << most << '\n';
  }
}

}  // namespace

TEST(Prose, ofAllPagesHasAtMostThirtyThousandWords) {
  std::size_t words = 0;
  for (const fs::path& page : pages()) words += countWords(textOf(page));
  RecordProperty("words", static_cast<int>(words));
  EXPECT_GT(words, 10'000u);
  EXPECT_LE(words, 30'000u);
}

TEST(Prose, hasSentencesOfWhichNineInTenHaveAtMost25Words) {
  std::vector<std::size_t> lengths;
  for (const fs::path& page : pages())
    for (const std::string& sentence : sentencesOf(textOf(page)))
      lengths.push_back(countWords(sentence));
  EXPECT_LE(quantile(lengths, 0.9), 25u);
}

TEST(Prose, ofLongPagesIsNamed) {
  nameLongPages(kSources / "doc/how-it-works", 1200);
  nameLongPages(kSources / "doc/handbook", 800);
  nameLongPages(kSources / "apps", 400);
}

TEST(Prose, isCountedWithoutHeadingsAndCode) {
  EXPECT_EQ(
      sentencesOf(
          "# A heading of five words\n\nOne two [three four](five.md) `a b`\nsix. "
          "And a second *sentence* here!\n\n    code of four words\n\n"
          "```sh\nmore code of words\n```\n"
          "- an item of words\n- only three words\n\n| a cell of words | no |\n|---|---|\n"),
      (std::vector<std::string>{"One two three four Code six", "And a second *sentence* here! ",
                                "an item of words ", " a cell of words "}));
  EXPECT_EQ(countWords("one - two2 | (three) --"), 3u);
}

TEST(Prose, thatIsTooLongIsFound) {
  EXPECT_EQ(quantile({30, 1, 2, 3, 4, 5, 6, 7, 8, 9}, 0.9), 9u);
  EXPECT_EQ(quantile({30, 31, 2, 3, 4, 5, 6, 7, 8, 9}, 0.9), 30u);
}
