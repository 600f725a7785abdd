// What the applications share.
#include <gtest/gtest.h>
#include <strict_files/Words.h>
#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <string>
#include <thread>

#include "Application.h"
#include "RunProgram.h"
#include "TemporaryFolder.h"
#include "figures/FigureScript.h"
#include "measuring/Measuring.h"
#include "poses/Poses.h"

using measuring::quantile;
using measuring::Stopwatch;
using measuring::TimeOf;

TEST(Quantile, liesBetweenTheTwoNearestValuesInProportion) {
  EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({10, 20, 30}, 0.25), 15);
  EXPECT_DOUBLE_EQ(quantile({9, 1, 4, 3, 2}, 0.95), 8);  // 0.8 of the way from 4 to 9
}

TEST(Quantile, ofNoValuesOrAnImpossibleShareIsRefused) {
  EXPECT_EQ(errorOf([] { quantile({}, 0.5); }), "a quantile of no values");
  for (const double share : {-0.1, 1.1, double(NAN)})
    EXPECT_TRUE(contains(errorOf([&] { quantile({1, 2}, share); }), "expected 0 to 1")) << share;
}

TEST(Stopwatch, ofAThreadDoesNotCountOthers) {
  const Stopwatch process(TimeOf::Process), thread(TimeOf::Thread);
  std::thread([] {
    for (const Stopwatch busy(TimeOf::Thread); busy.milliseconds() < 50;) {
    }
  }).join();
  EXPECT_GE(process.milliseconds(), 50);
  EXPECT_LT(thread.milliseconds(), 40);
}

TEST(JsonFile, replacesWhatIsNoUtf8InsteadOfFailing) {
  const TemporaryFolder folder;
  writeJson(folder / "names.json", nlohmann::ordered_json{{"name",
                                                           "Stra\xDF"
                                                           "e, Stra\xC3\x9F"
                                                           "e"}});
  EXPECT_EQ(nlohmann::json::parse(folder.read("names.json"))["name"],
            "Stra\xEF\xBF\xBD"
            "e, Stra\xC3\x9F"
            "e");
}

TEST(JsonFile, echoesOptionsAsNumbersBooleansAndTexts) {
  double edge = 0.25, far = std::numeric_limits<double>::infinity();
  bool keeps = true;
  std::string classes = "road, car";
  strict_files::OptionList list;
  list.add("block_size", edge, "m", "");
  list.add("max_range", far, "m", strict_files::Range().orInfinite(), "");
  list.add("keep_off", keeps, "", "");
  list.add("classes", classes, "", "");
  EXPECT_EQ(jsonOf(list).dump(),
            R"({"blockSize":0.25,"maxRange":"inf","keepOff":true,"classes":"road, car"})");
}

TEST(Poses, areNothingButThreeFiniteNumbers) {
  for (const char* text :
       {"", "1,2", "1,2,3,4", "1,2,3,", ",1,2,3", "1,,3", "1,2,3x", "1;2;3", "1,2,inf", "nan,2,3"})
    EXPECT_EQ(errorOf([&] { poses::parsePose(text); }),
              std::string("expected X,Y,DEG (meters and degrees), found '") + text + "'");
}

TEST(Poses, ofACommandLineNameTheOptionThatIsWrong) {
  CLI::App app;
  mrpt::math::TPose2D pose;
  poses::addPose(app, "--goal", pose, "Where to go");
  EXPECT_TRUE(contains(errorOf([&] { app.parse("--goal 1,2"); }), "--goal: expected X,Y,DEG"));
  app.parse("--goal 3,4,180");
  EXPECT_EQ(pose.x, 3);
}

TEST(Poses, ofSixNumbersTurnByYawFirst) {
  const Eigen::Isometry3d pose = poses::poseOfNumbers({1, 2, 3, 90, 0, 0});
  EXPECT_TRUE((pose * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 3), 1e-12));
}

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
                                         "blobs-17 (2.5)",
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
class FigureTexts : public FolderTest {
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

 private:
  const fs::path m_before = fs::current_path();
};

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
  EXPECT_EQ(figures::gnuplotText("it's\n"), "\"it\\047s\\134x\\060a\"");
  EXPECT_EQ(figures::ticText("5 %"), "\"\\065 \\045\\045\"");
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

}  // namespace
