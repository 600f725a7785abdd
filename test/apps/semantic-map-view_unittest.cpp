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
  const ProgramRun run =
      runInX({kViewer, path("map.semantic"), "--size", "400x320", "--camera", kTop, "--animation",
              folder.write("turn.gif", "before").string(), "-f"});
  EXPECT_EQ(run.status, 0) << run.output << run.errors;
  const std::string gif = folder.read("turn.gif");
  EXPECT_EQ(gif.substr(0, 6), "GIF89a");
  const auto word = [&](std::size_t at) {
    return int(std::uint8_t(gif.at(at))) + 256 * int(std::uint8_t(gif.at(at + 1)));
  };
  EXPECT_EQ(word(6), 400);
  EXPECT_EQ(word(8), 320);
}

TEST_F(SemanticMapView, SaysWhatIsMissingInsteadOfFailing) {
  const auto without = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> command = {"-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", kViewer};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return runProgram("/usr/bin/env", command);
  };
  const ProgramRun noDisplay = without({path("map.semantic")});
  EXPECT_EQ(noDisplay.status, 1);
  EXPECT_TRUE(contains(noDisplay.errors, "there is no display")) << noDisplay.errors;
  EXPECT_TRUE(contains(noDisplay.errors, "semantic-map-export")) << noDisplay.errors;
  const ProgramRun otherDisplay =
      runProgram("/usr/bin/env", {"DISPLAY=:4711", kViewer, path("map.semantic")});
  EXPECT_EQ(otherDisplay.status, 1);
  EXPECT_TRUE(contains(otherDisplay.errors, "':4711' cannot be opened")) << otherDisplay.errors;
  EXPECT_TRUE(contains(without({path("none.semantic")}).errors, "none.semantic"));
  folder.write("bad.semantic", "nothing of the kind");
  EXPECT_TRUE(contains(without({path("bad.semantic")}).errors, "bad.semantic"));
  for (const char* option : {"--weights", "--classes"}) {
    const ProgramRun run = without({path("map.semantic"), option, path("none.yaml")});
    EXPECT_EQ(run.status, 1);
    EXPECT_TRUE(contains(run.errors, "none.yaml")) << run.errors;
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
