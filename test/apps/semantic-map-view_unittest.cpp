#include <algorithm>
#include <regex>

#include "ViewFixture.h"

TEST_F(SemanticMapView, ShowsClassesInTheirColorsWhereTheyAre) {
  SKIP_WITHOUT_WINDOWS();
  const cv::Mat picture = draw({path("map.semantic"), "--no-panels", "--camera", kTop});
  EXPECT_EQ(classAt(picture, pixelOf(-5, 2, 0.2)), 'r');
  EXPECT_EQ(classAt(picture, pixelOf(-1, -4, 0.2)), 'r');
  EXPECT_EQ(classAt(picture, pixelOf(2, 3, 0.2)), 'g');
  EXPECT_EQ(classAt(picture, pixelOf(5, 0, 2)), 'w');
  EXPECT_EQ(classAt(picture, pixelOf(11, 0, 0)), ' ');
  EXPECT_EQ(classAt(picture, pixelOf(0, 6, 0)), ' ');
  const cv::Mat cut =
      draw({path("map.semantic"), "--no-panels", "--camera", kTop, "--max-height", "-1"});
  EXPECT_EQ(classAt(cut, pixelOf(5, 0, 2)), ' ') << "all is above";
  const cv::Mat sure =
      draw({path("map.semantic"), "--no-panels", "--camera", kTop, "--color", "probability"});
  EXPECT_EQ(classAt(sure, pixelOf(-5, 2, 0.2)), 'g') << "green is sure";
}

TEST_F(SemanticMapView, ShowsTheCompressedTreeAlsoWithoutPanels) {
  SKIP_WITHOUT_WINDOWS();
  const Words arguments = {path("map.semantic"), "--no-panels", "--camera", kTop};
  const cv::Mat full = draw(arguments), small = draw(joined(arguments, {"--compress"}));
  EXPECT_GT(cv::norm(full, small, cv::NORM_L1), 1e5);
  for (const int x : {20, kWidth - 20})
    EXPECT_EQ(full.at<cv::Vec3b>(20, x), small.at<cv::Vec3b>(20, x)) << "a panel";
}

TEST_F(SemanticMapView, ShowsWhatIsInsideOfABox) {
  SKIP_WITHOUT_WINDOWS();
  const cv::Mat picture = draw(
      {path("map.semantic"), "--no-panels", "--camera", kTop, "--clip", "-6,-4,-1,7,-0.5,1.5"});
  EXPECT_EQ(classAt(picture, pixelOf(-5, -2, 0.2)), 'r');
  EXPECT_EQ(classAt(picture, pixelOf(-7, -2, 0.2)), ' ') << "-x";
  EXPECT_EQ(classAt(picture, pixelOf(6.5, -2, 0.2)), 'g');
  EXPECT_EQ(classAt(picture, pixelOf(8, -2, 0.2)), ' ') << "+x";
  EXPECT_EQ(classAt(picture, pixelOf(-5, 2, 0.2)), ' ') << "+y";
  EXPECT_EQ(classAt(picture, pixelOf(2, -4.5, 0.2)), ' ') << "-y";
}

TEST_F(SemanticMapView, WritesAnAnimation) {
  SKIP_WITHOUT_WINDOWS();
  succeeded(runInX({kViewer, path("map.semantic"), "--size", "400x320", "--camera", kTop,
                    "--animation", folder.write("turn.gif", "before").string(), "-f"}));
  const std::string gif = folder.read("turn.gif");
  EXPECT_EQ(gif.substr(0, 6), "GIF89a");
  const auto word = [&](std::size_t at) {
    return int(std::uint8_t(gif.at(at))) + 256 * int(std::uint8_t(gif.at(at + 1)));
  };
  EXPECT_EQ(word(6), 400);
  EXPECT_EQ(word(8), 320);
}

TEST_F(SemanticMapView, SaysWhatIsMissingInsteadOfFailing) {
  const auto without = [&](const Words& arguments) {
    return runProgram("/usr/bin/env",
                      joined({"-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", kViewer}, arguments));
  };
  const ProgramRun noDisplay = without({path("map.semantic")});
  EXPECT_EQ(noDisplay.status, 1);
  EXPECT_TRUE(contains(noDisplay.errors, "there is no display"));
  EXPECT_TRUE(contains(noDisplay.errors, "semantic-map-export"));
  const ProgramRun otherDisplay =
      runProgram("/usr/bin/env", {"DISPLAY=:4711", kViewer, path("map.semantic")});
  EXPECT_EQ(otherDisplay.status, 1);
  EXPECT_TRUE(contains(otherDisplay.errors, "':4711' cannot be opened"));
  EXPECT_TRUE(contains(without({path("none.semantic")}).errors, "none.semantic"));
  folder.write("bad.semantic", "nothing of the kind");
  EXPECT_TRUE(contains(without({path("bad.semantic")}).errors, "bad.semantic"));
  for (const char* option : {"--weights", "--order"}) {
    const ProgramRun run = without({path("map.semantic"), option, path("none.yaml")});
    EXPECT_EQ(run.status, 1);
    EXPECT_TRUE(contains(run.errors, "none.yaml"));
  }
  folder.write("bad.bt", "nothing of the kind");
  EXPECT_TRUE(contains(without({path("bad.bt")}).errors, "bad.bt"));
}

TEST_F(SemanticMapView, RefusesWrongCommandLines) {
  for (const auto& [option, value] :
       std::vector<std::pair<std::string, std::string>>{{"--size", "12"},
                                                        {"--size", "100x100"},
                                                        {"--camera", "1,2,3"},
                                                        {"--color", "red"},
                                                        {"--camera", "0,0,0,-1,0,0"},
                                                        {"--clip", "0,0,0,1,1"},
                                                        {"--clip", "0,0,0,1,1,0"},
                                                        {"--max-height", "high"}}) {
    const ProgramRun run = runProgram("semantic-map-view", {path("map.semantic"), option, value});
    EXPECT_EQ(run.status, 64) << option << ' ' << value << run.errors;
    EXPECT_TRUE(contains(run.errors, option) && contains(run.errors, value)) << run.errors;
  }
}

TEST_F(SemanticMapView, AnswersAClickOnACell) {
  SKIP_WITHOUT_WINDOWS();
  const std::string said = work({}, {at(pixelOf(-1.1, -2.1, 0.2)) + " key 32762 32757 32768",
                                     at(pixelOf(5.1, 0.1, 2)) + " occupied, wall"});
  EXPECT_TRUE(contains(said, "occupied, road"));
}

TEST_F(SemanticMapView, SaysWhyACellIsExpandedOrNot) {
  SKIP_WITHOUT_WINDOWS();
  // A voxel of the wall, which is expanded down to voxels, and one amid the grass, which is not.
  int lines = 0, open = 0;
  for (const cv::Point& pixel : {pixelOf(4.1, 0.9, 2), pixelOf(3.1, 3.1, 0.2)}) {
    const std::string said = work({"--compress"}, {at(pixel) + " expanded, G"});
    std::smatch alpha, key;
    ASSERT_TRUE(std::regex_search(said, alpha, std::regex("leaves, alpha ([0-9.e-]+)"))) << said;
    ASSERT_TRUE(std::regex_search(said, key, std::regex("key (\\d+) (\\d+) (\\d+), edge"))) << said;
    const auto expected = expandedAround({std::stoi(key[1]), std::stoi(key[2]), std::stoi(key[3])},
                                         std::stod(alpha[1]));
    const std::regex line(
        "([0-9.]+ m): (not )?expanded, G (\\S+) = max\\(0, (\\S+) - (\\S+) \\* (\\S+) \\+ "
        "(\\S+)\\), "
        "road 1 \\* (\\S+), grass 1 \\* (\\S+), wall 1 \\* (\\S+), free_space 0 \\* \\S+\n");
    bool aboveIs = true;
    for (std::sregex_iterator found(said.begin(), said.end(), line), end; found != end; ++found) {
      const auto number = [&](std::size_t i) { return std::stod((*found)[i]); };
      const bool isExpanded = !(*found)[2].matched;
      ASSERT_EQ(expected.count((*found)[1]), 1u) << said;
      EXPECT_EQ(isExpanded, aboveIs && expected.at((*found)[1])) << found->str();
      EXPECT_EQ(isExpanded, aboveIs && number(3) > 0) << found->str();
      aboveIs = isExpanded;
      const double gain = number(8) + number(9) + number(10);
      EXPECT_NEAR(number(4), gain, 0.02 * gain + 1e-4) << "three digits";
      EXPECT_NEAR(number(3), std::max(0.0, number(4) - number(5) * number(6) + number(7)),
                  0.02 * number(4) + 1e-3)
          << found->str();
      ++lines, open += isExpanded;
    }
  }
  EXPECT_GE(lines, 5) << "four of the voxel in a block of 3.2 m";
  EXPECT_GE(open, 4);
  EXPECT_LT(open, lines);
}

TEST_F(SemanticMapView, SavesWeightsFromWhichTheSameLeavesFollow) {
  SKIP_WITHOUT_WINDOWS();
  // In the panel at the right: a place on the slider of alpha, and the button below.
  const std::string slider = std::to_string(kWidth - 170) + " 190 leaves, alpha",
                    save = std::to_string(kWidth - 230) + " 418 wrote ./weights-1.yaml";
  succeeded(runInX({"/usr/bin/env", "-C", folder.path().string(),
                    MSO_SOURCE_DIR "/test/apps/view-window.sh", path("said.txt"), kViewer,
                    path("map.semantic"), "--size", size(), "--compress", "--", slider, save}));
  const std::string said = folder.read("said.txt");
  std::smatch view, compress, begin;
  ASSERT_TRUE(std::regex_search(said, view, std::regex("weights-1.yaml: ([0-9]+) leaves"))) << said;
  ASSERT_TRUE(std::regex_search(said, begin, std::regex("([0-9]+) leaves, alpha"))) << said;
  EXPECT_NE(view[1], begin[1]) << "the slider did nothing:\n" << said;
  const ProgramRun other = succeeded(runProgram(
      "semantic-map-compress",
      {path("map.semantic"), "--weights", path("weights-1.yaml"), "-o", path("compressed")}));
  ASSERT_TRUE(std::regex_search(other.output, compress, std::regex("([0-9]+) of [0-9]+ leaves")))
      << other.output;
  EXPECT_EQ(view[1], compress[1]);
}

/** The window with an order of classes; the panel at the right has the buttons "start" and "goal".
 */
class SemanticMapViewPlans : public SemanticMapView {
 protected:
  SemanticMapViewPlans() { folder.write("order.yaml", "best_to_worst: [road, grass]\n"); }

  /** Runs the window: how the start is set, how the goal, what comes then. */
  void plan(const std::string& start, const std::string& goal,
            const std::vector<std::string>& then = {}) {
    std::vector<std::string> steps{"650 244 click where the vehicle is", start,
                                   "745 244 click where it is to go", goal};
    steps.insert(steps.end(), then.begin(), then.end());
    said = work({"--order", path("order.yaml")}, steps);
  }

  /** The lengths of all paths that the window told, m. */
  std::vector<double> lengths() const {
    const std::regex path("path of ([0-9.]+) m");
    std::vector<double> found;
    for (std::sregex_iterator i(said.begin(), said.end(), path), end; i != end; ++i)
      found.push_back(std::stod((*i)[1]));
    return found;
  }

  std::string said;
};

TEST_F(SemanticMapViewPlans, BetweenTwoClicks) {
  SKIP_WITHOUT_WINDOWS();
  plan(at(pixelOf(-3, -2, 0.2)) + " start at -3", at(pixelOf(3, 3, 0.2)) + " path of");
  ASSERT_FALSE(lengths().empty()) << said;
  EXPECT_GE(lengths()[0], std::hypot(6, 5) - 0.5);
  EXPECT_LT(lengths()[0], 15);
}

TEST_F(SemanticMapViewPlans, FromAndToHeadingsThatAreDragged) {
  SKIP_WITHOUT_WINDOWS();
  const auto drag = [](const cv::Point& from, const cv::Point& to, const std::string& words) {
    return "drag " + at(from) + ' ' + at(to) + ' ' + words;
  };
  plan(drag(pixelOf(-4, -2, 0.2), pixelOf(-6, -2, 0.2), "start at -4"),
       drag(pixelOf(3, 2, 0.2), pixelOf(3, 4, 0.2), "path of"));
  const auto heading = [&](const std::string& of) {
    std::smatch found;
    const bool is = std::regex_search(said, found, std::regex(of + " at.*heading (-?[0-9]+) deg"));
    return is ? std::stod(found[1]) : 1000;
  };
  EXPECT_NEAR(std::abs(heading("start")), 180, 3) << said;
  EXPECT_NEAR(heading("goal"), 90, 3) << said;
  ASSERT_FALSE(lengths().empty()) << said;
  EXPECT_GE(lengths()[0], std::hypot(7, 4) + 0.5) << "it has to turn";
}

TEST_F(SemanticMapViewPlans, AnewAfterTheOrderOfClassesWasDragged) {
  SKIP_WITHOUT_WINDOWS();
  // Along the road's border: straight on, or by the grass, if that is better. The arrow beside it.
  plan(at(pixelOf(-1, -2.5, 0.2)) + " start at -1", at(pixelOf(-1, 2.5, 0.2)) + " path of",
       {"852 310 order: grass > road", at(pixelOf(3.1, 3.1, 0.2)) + " occupied, grass"});
  ASSERT_EQ(lengths().size(), 2u) << said;
  EXPECT_GT(lengths()[1], lengths()[0] + 0.2) << said;
}

TEST_F(SemanticMapViewPlans, WithClassesAndAVehicleThatAreChosenInTheWindow) {
  SKIP_WITHOUT_WINDOWS();
#ifndef MSO_DROP_FILES
  GTEST_SKIP() << "needs the development files of X11";
#endif
  folder.write("wide.yaml", "footprint: [[-4, -4], [4, -4], [4, 4], [-4, 4]]\n");
  folder.write("other.yaml", "best_to_worst: [grass]\n");
  said = work({}, {"touch 745 214", "650 244 click where the vehicle is",
                   at(pixelOf(-3, -2, 0.2)) + " start at -3", "745 244 click where it is to go",
                   at(pixelOf(-3, 3, 0.2)) + " no path: no class is allowed", "616 310 order: road",
                   at(pixelOf(-1.1, -2.1, 0.2)) + " occupied, road",
                   "drop " + path("wide.yaml") + " opened .*wide.yaml: the vehicle",
                   "drop " + path("other.yaml") + " opened .*other.yaml: an order of classes"});
  const std::size_t chosen = said.find("order: road"), wide = said.find("no path:", chosen);
  ASSERT_EQ(lengths().size(), 1u) << said;
  const std::size_t found = said.find("path of");
  EXPECT_GT(found, chosen) << said;
  EXPECT_LT(found, wide) << said;
  EXPECT_NE(wide, std::string::npos) << "the wide one has no room\n" << said;
  EXPECT_NE(said.find("no path:", wide + 1), std::string::npos) << "nor on grass\n" << said;
}

/** Gaps between panels, along a column of pixels that is in their borders. */
int gapsAlong(const cv::Mat& picture, int column) {
  int gaps = 0;
  bool inPanel = false;
  for (int row = 0; row < picture.rows; ++row) {
    const bool is = picture.at<cv::Vec3b>(row, column)[1] < 100;
    gaps += inPanel && !is;
    inPanel = is;
  }
  return gaps;
}

TEST_F(SemanticMapView, HasPanelsBesideEachOtherAndTheMapsMiddle) {
  SKIP_WITHOUT_WINDOWS();
  folder.write("robot.tum", "0 -8 -7 0 0 0 0 1\n1 8 -7 0 0 0 0 1\n");
  folder.write("order.yaml", "best_to_worst: [road, grass]\n");
  for (const cv::Size window : {cv::Size(1280, 720), cv::Size(1000, 600)}) {
    const auto picture = [&](const Words& more) {
      succeeded(runInX(joined({kViewer, path("map.semantic"), path("robot.tum"), "--size",
                               std::to_string(window.width) + "x" + std::to_string(window.height),
                               "--camera", "0,0,0,90,-90,90", "-f", "-o", path("view.png")},
                              more)));
      return cv::imread(path("view.png"));
    };
    const cv::Mat with = picture({}), without = picture({"--no-panels"});
    ASSERT_EQ(with.size(), window);
    const cv::Rect middle(270, 0, window.width - 270 - 320, window.height);
    EXPECT_EQ(cv::norm(with(middle), without(middle), cv::NORM_INF), 0);
    const cv::Mat most = picture({"--compress", "--order", path("order.yaml")});
    EXPECT_EQ(gapsAlong(most, 11), 3) << "map, clip, files";
    EXPECT_EQ(gapsAlong(most, window.width - 11), 3) << "cell, compress, path";
  }
}

TEST_F(SemanticMapView, SaysWhatColorsMean) {
  SKIP_WITHOUT_WINDOWS();
  const auto hasYellow = [&](const std::string& coloring) {
    const cv::Mat all =
        draw({path("map.semantic"), "--camera", "0,0,0,200,-90,90", "--color", coloring});
    const cv::Mat panel = all(cv::Rect(0, 0, 254, kHeight));
    return std::any_of(panel.begin<cv::Vec3b>(), panel.end<cv::Vec3b>(),
                       [](const cv::Vec3b& c) { return c[2] > 240 && c[1] > 220 && c[0] < 60; });
  };
  EXPECT_TRUE(hasYellow("height")) << "at the upper end of the scale";
  EXPECT_FALSE(hasYellow("class"));
}

TEST_F(SemanticMapView, IsCutWhereNumbersSay) {
  SKIP_WITHOUT_WINDOWS();
  // The panel "Clip" unfolds; the second field is the highest x.
  work({}, {"touch 130 437", "enter 205 491 2", "picture " + path("cut.png")});
  const cv::Mat cut = cv::imread(path("cut.png"));
  ASSERT_FALSE(cut.empty());
  EXPECT_EQ(classAt(cut, pixelOf(-2, 2, 0.2)), 'r');
  EXPECT_EQ(classAt(cut, pixelOf(1, 2, 0.2)), 'g');
  EXPECT_EQ(classAt(cut, pixelOf(3, 2, 0.2)), ' ');
}

TEST_F(SemanticMapView, PutsARingAroundTheCellThatWasPicked) {
  SKIP_WITHOUT_WINDOWS();
  const cv::Point cell = pixelOf(-1.1, -2.1, 0.2);
  work({}, {at(cell) + " occupied, road", "key Shift_L", "picture " + path("picked.png")});
  const cv::Mat picked = cv::imread(path("picked.png"));
  ASSERT_FALSE(picked.empty());
  for (const cv::Point& way : {cv::Point(16, 0), cv::Point(-16, 0), cv::Point(0, 16)}) {
    int yellow = 0;
    for (int i = -3; i <= 3; ++i) {
      const cv::Vec3b c = picked.at<cv::Vec3b>(cell + way + way * i / 16);
      yellow += c[2] > 200 && c[1] > 170 && c[0] < 80;
    }
    EXPECT_GT(yellow, 0) << way;
  }
}

TEST_F(SemanticMapView, ComesNearerToThePointer) {
  SKIP_WITHOUT_WINDOWS();
  const cv::Point p = pixelOf(-3.1, 3.1, 0.1), q = pixelOf(2.1, -3.1, 0.1);
  const std::string said =
      work({}, {at(p) + " occupied", at(q) + " occupied", "wheel " + at(p) + " 8",
                at(p) + " occupied", at(q) + " occupied"});
  std::vector<std::string> keys;
  const std::regex key("key \\d+ \\d+ \\d+");
  for (std::sregex_iterator i(said.begin(), said.end(), key), end; i != end; ++i)
    if (keys.empty() || i->str() != keys.back()) keys.push_back(i->str());
  ASSERT_EQ(keys.size(), 4u) << said;
  EXPECT_EQ(keys[0], keys[2]) << "it stays below the pointer";
  EXPECT_NE(keys[1], keys[3]) << "all else moves away";
}

TEST_F(SemanticMapView, ClosesMenusWithEscape) {
  SKIP_WITHOUT_WINDOWS();
  const auto picture = [this](const std::string& name) { return "picture " + path(name); };
  // The menu of colors, which unfolds to the right. The pointer rests elsewhere.
  work({}, {"touch 450 680", picture("closed.png"), "touch 158 78", "touch 450 22",
            picture("open.png"), "key Escape", "touch 450 680", picture("again.png")});
  const cv::Rect beside(262, 8, 120, 200);
  const auto part = [&](const std::string& name) { return cv::imread(path(name))(beside).clone(); };
  EXPECT_GT(cv::norm(part("closed.png"), part("open.png"), cv::NORM_INF), 100);
  EXPECT_EQ(cv::norm(part("closed.png"), part("again.png"), cv::NORM_INF), 0);
}
