#include <gtest/gtest.h>
#include <strict_files/StrictYaml.h>
#include <strict_files/TextFile.h>

#include <sstream>

#include "CommaHost.h"
#include "TemporaryFolder.h"

using namespace strict_files;

TEST(TextFile, comesBackByteForByte) {
  const TemporaryFolder folder;
  const std::string text("a\r\n\0b\xFF", 6);
  writeText(folder / "a.txt", text);
  EXPECT_EQ(readText(folder / "a.txt"), text);
  EXPECT_EQ(folder.read("a.txt"), text);
  writeText(folder / "a.txt", "");
  EXPECT_EQ(readText(folder / "a.txt"), "");
}

TEST(TextFile, thatCannotBeWrittenIsNamed) {
  EXPECT_EQ(errorOf([] { writeText("/nowhere/a.txt", "a"); }),
            "/nowhere/a.txt: cannot be written (does the folder exist?)");
}

TEST(TextFile, thatCannotBeReadIsNamed) {
  const TemporaryFolder folder;
  EXPECT_EQ(errorOf([] { readText("/nowhere/a.txt"); }), "/nowhere/a.txt: cannot be read");
  const std::string path = folder.path().string();
  EXPECT_EQ(errorOf([&] { readText(path); }), path + ": cannot be read");
}

TEST(TextLines, leaveOutCommentsBlanksAndLineEndsAndKnowTheirNumber) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.txt", "# first\n1 2\r\n \t\n3 # three\n4");
  const auto lines = readLines(file);
  ASSERT_EQ(lines.size(), 3);
  EXPECT_EQ(lines[0].text, "1 2");
  EXPECT_EQ(lines[0].where, file.string() + ":2");
  EXPECT_EQ(lines[1].text, "3");
  EXPECT_EQ(lines[2].where, file.string() + ":5");
}

TEST(TextLines, haveAsManyNumbersAsExpected) {
  EXPECT_EQ(numbersOf({"P2: 1 2.5 -3e2", "f:1"}, 3), (std::vector<double>{1, 2.5, -300}));
  EXPECT_EQ(errorOf([] {
              numbersOf({"1 2", "f:1"}, 3);
            }),
            "f:1: expected 3 numbers, found 2 in '1 2'");
  EXPECT_EQ(errorOf([] {
              numbersOf({"1 2x", "f:7"}, 2);
            }),
            "f:7: expected a number, found '2x' in '1 2x'");
  EXPECT_EQ(errorOf([] {
              numbersOf({"1 inf", "f:7"}, 2);
            }),
            "f:7: expected a number, found 'inf' in '1 inf'");
}

TEST(TextLines, haveNumbersWithPointsWhateverTheHostsLocaleIs) {
  const CommaHost host;
  EXPECT_EQ(numbersOf({"0.5 +1.25 1e-3", "f:1"}, 3), (std::vector<double>{0.5, 1.25, 0.001}));
  EXPECT_NE(errorOf([] { numbersOf({"0,5", "f:1"}, 1); }), "");
  const StrictYaml yaml("half: 0.5\nmany: 1234567\nwrong: 1.234\n", "y");
  EXPECT_EQ(yaml.number(yaml.root()["half"], "half"), 0.5);
  EXPECT_EQ(yaml.value<int>(yaml.root()["many"], "a whole number"), 1234567);
  EXPECT_NE(errorOf([&] { yaml.value<int>(yaml.root()["wrong"], "a whole number"); }), "");
}

TEST(ClassicNumbers, areThoseOfAStreamOnlyWhileTheyLive) {
  const CommaHost host;
  std::ostringstream text;
  {
    const ClassicNumbers classic(text);
    text << 1234.5 << ' ';
  }
  text << 1234.5;
  EXPECT_EQ(text.str(), "1234.5 1.234,5");
}
