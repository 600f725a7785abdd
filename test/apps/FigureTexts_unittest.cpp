// Texts of figures that would be commands if gnuplot took them for such.
#include <gtest/gtest.h>
#include <strict_files/Words.h>

#include "ShellCommand.h"
#include "TemporaryFolder.h"
#include "figures/FigureScript.h"

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kTexts = {"road\n!touch x\n",
                                         "'\n!touch x\n",
                                         "a', system('touch x'), '",
                                         "a'' . system(\"touch x\") #",
                                         "a\" . system('touch x') #",
                                         "`touch x`",
                                         "$(touch x)",
                                         "@touch",
                                         "100 %s of %g%%",
                                         "a_b^c{/Bold d}~e&f",
                                         "\"q\" 'q' \\n \\",
                                         "# no comment",
                                         "Stra\xC3\x9F"
                                         "e\x1b[2J"};

/** As gnuplot writes it into an SVG file. */
std::string inSvg(const std::string& text) {
  std::string result;
  for (const char c : strict_files::printable(text))
    result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : std::string(1, c);
  return ">" + result + "<";
}

/** Draws in a folder of its own, which the test is in for that time. */
class FigureTexts : public testing::Test {
 protected:
  void SetUp() override {
    if (runCommand("gnuplot --version").status != 0) GTEST_SKIP() << "gnuplot is not installed";
    fs::current_path(folder.path());
  }
  void TearDown() override { fs::current_path(m_before); }
  std::string drawn(const std::string& commands) const {
    figures::drawWithGnuplot(
        "set terminal svg noenhanced size 3000,600\nset macros\ntouch = 'x'\n" + commands +
            "\nplot [0:20] 1 notitle\n",
        "drawn.svg");
    return folder.read("drawn.svg");
  }

  TemporaryFolder folder;

 private:
  const fs::path m_before = fs::current_path();
};

}  // namespace

TEST_F(FigureTexts, areDrawnAsTheyAreAndRunNothing) {
  for (const std::string& text : kTexts) {
    const std::string word = figures::gnuplotText(text);
    const std::string tics = figures::tics(1, [&](std::size_t) { return text; });
    for (const std::string& command :
         {"set title " + word, "set label " + word + " at 1,1", "set xlabel " + word,
          "set xtics " + tics, "plot [0:20] 2 title " + word})
      EXPECT_TRUE(contains(drawn(command), inSvg(text))) << command;
  }
  EXPECT_FALSE(fs::exists("x"));
}

TEST(FigureText, showsWhatIsNoText) {
  EXPECT_EQ(figures::gnuplotText("it's\n"), "\"it\\047s\\134x0a\"");
  EXPECT_EQ(figures::ticText("5 %"), "\"5 \\045\\045\"");
}

TEST_F(FigureTexts, namesOfFilesAreNoPartOfAScript) {
  for (const char* name : {"|touch x", "a'\n!touch x\n'.png", "`touch x`", " > x"}) {
    figures::drawWithGnuplot(figures::scriptFor(200, 100).str() + "plot [0:1] 1\n", name);
    EXPECT_EQ(folder.read(name).substr(1, 3), "PNG") << name;
  }
  EXPECT_FALSE(fs::exists("x"));
}

TEST_F(FigureTexts, aScriptThatCannotBeDrawnLeavesNoFile) {
  EXPECT_EQ(errorOf([] { figures::drawWithGnuplot("plot nothing\n", "a.png"); }),
            "gnuplot could not draw");
  EXPECT_FALSE(fs::exists("a.png"));
}
