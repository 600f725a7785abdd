#include <gtest/gtest.h>
#include <map_view/OrbitCamera.h>
#include <semantic_octree/OctomapConversion.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_octree/TreeFile.h>

#include <octomap/OcTree.h>
#include <opencv2/imgcodecs.hpp>
#include <regex>

#include "RunProgram.h"
#include "TemporaryFolder.h"
#include "XServer.h"

namespace {

namespace fs = std::filesystem;
using semantic_octree::SemanticOcTree;

const std::string kProgram = std::string(MSO_BIN_DIR) + "/semantic-map-view";
constexpr int kWidth = 900, kHeight = 700;
constexpr semantic_types::Color kRoad{90, 90, 200}, kGrass{60, 200, 60}, kWall{200, 60, 60};

/** Voxels of 0.2 m: in the west road, in the east grass, 10 m x 10 m each, around the origin; in
 * the middle of the grass a block of wall, 2 m high. */
SemanticOcTree smallMap() {
  semantic_types::ClassTable classes;
  classes.add("road", kRoad);
  classes.add("grass", kGrass);
  classes.add("wall", kWall);
  semantic_types::LabeledCloud cloud;
  const auto add = [&](float x, float y, float z, semantic_types::ClassId id) {
    cloud.points.emplace_back(x, y, z - 6);
    cloud.classes.push_back(id);
  };
  for (float x = -9.9f; x < 10; x += 0.2f)
    for (float y = -4.9f; y < 5; y += 0.2f) {
      const bool wall = x > 4 && x < 6 && y > -1 && y < 1;
      add(x, y, 0.1f, wall ? 3 : x < 0 ? 1 : 2);
      for (float z = 0.3f; wall && z < 2; z += 0.2f) add(x, y, z, 3);
    }
  SemanticOcTree map(0.2, classes);
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
  T_map_sensor.translation().z() = 6;
  for (int i = 0; i < 3; ++i) map.insert(cloud, T_map_sensor);
  return map;
}

/** From above, north up. */
const std::string kTop = "0,0,0,40,-90,90";

class SemanticMapView : public testing::Test {
 protected:
  SemanticMapView() { semantic_octree::saveTree(smallMap(), path("map.semantic")); }

  std::string path(const std::string& name) const { return (folder / name).string(); }
  std::string size() const { return std::to_string(kWidth) + "x" + std::to_string(kHeight); }

  /** The window's picture. */
  cv::Mat draw(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), kProgram);
    for (const std::string& more :
         std::vector<std::string>{"--size", size(), "-f", "-o", path("view.png")})
      arguments.push_back(more);
    const ProgramRun run = runInX(arguments);
    EXPECT_EQ(run.status, 0) << run.output << run.errors;
    const cv::Mat picture = cv::imread(path("view.png"));
    EXPECT_EQ(picture.cols, kWidth);
    EXPECT_EQ(picture.rows, kHeight);
    return picture;
  }

  TemporaryFolder folder;
};

/** Where kTop shows a place, pixels. */
cv::Point pixelOf(double x, double y, double z = 0) {
  const auto camera = map_view::OrbitCamera::ofText(kTop);
  const double scale = camera.focalLength(kHeight) / (camera.distance - z);
  return {int(kWidth / 2.0 + scale * x), int(kHeight / 2.0 - scale * y)};
}

/** Which of the colors it is, in whatever light: 'r'oad, 'g'rass, 'w'all, or nothing. */
char classAt(const cv::Mat& picture, const cv::Point& at) {
  const cv::Vec3b c = picture.at<cv::Vec3b>(at);
  if (!cv::Rect({0, 0}, picture.size()).contains(at)) return '?';
  const int most = std::max({c[0], c[1], c[2]}), least = std::min({c[0], c[1], c[2]});
  if (most - least < 40) return ' ';
  return most == c[0] ? 'r' : most == c[1] ? 'g' : 'w';
}

}  // namespace

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

TEST_F(SemanticMapView, OpensMapsOfOctoMap) {
  SKIP_WITHOUT_WINDOWS();
  semantic_octree::toOcTree(smallMap())->writeBinary(path("map.bt"));
  const cv::Mat picture =
      draw({path("map.bt"), "--no-panels", "--camera", kTop, "--color", "height"});
  EXPECT_NE(classAt(picture, pixelOf(-5, 2, 0.2)), ' ');
  EXPECT_EQ(classAt(picture, pixelOf(11, 0, 0)), ' ');
}

TEST_F(SemanticMapView, AnswersAClickOnACell) {
  SKIP_WITHOUT_WINDOWS();
  const auto click = [](const cv::Point& at, const std::string& words) {
    return std::to_string(at.x) + " " + std::to_string(at.y) + " " + words;
  };
  const ProgramRun run = runInX({MSO_SOURCE_DIR "/test/apps/view-window.sh", path("said.txt"),
                                 kProgram, path("map.semantic"), "--size", size(), "--camera", kTop,
                                 "--", click(pixelOf(-1.1, -2.1, 0.2), "key 32762 32757 32768"),
                                 click(pixelOf(5.1, 0.1, 2), "occupied, wall")});
  EXPECT_EQ(run.status, 0) << run.output << run.errors;
  const std::string said = folder.read("said.txt");
  EXPECT_TRUE(contains(said, "occupied, road")) << said;
}

TEST_F(SemanticMapView, SavesWeightsFromWhichTheSameLeavesFollow) {
  SKIP_WITHOUT_WINDOWS();
  // In the panel at the right: a place on the slider of alpha, and the button below.
  const std::string slider = std::to_string(kWidth - 170) + " 272 leaves, alpha",
                    save = std::to_string(kWidth - 230) + " 555 wrote ./weights-1.yaml";
  const ProgramRun run =
      runInX({"/usr/bin/env", "-C", folder.path().string(),
              MSO_SOURCE_DIR "/test/apps/view-window.sh", path("said.txt"), kProgram,
              path("map.semantic"), "--size", size(), "--compress", "--", slider, save});
  ASSERT_EQ(run.status, 0) << run.output << run.errors;
  const std::string said = folder.read("said.txt");
  std::smatch view, compress, begin;
  ASSERT_TRUE(std::regex_search(said, view, std::regex("weights-1.yaml: ([0-9]+) leaves"))) << said;
  ASSERT_TRUE(std::regex_search(said, begin, std::regex("([0-9]+) leaves, alpha"))) << said;
  EXPECT_NE(view[1], begin[1]) << "the slider did nothing:\n" << said;
  const ProgramRun other = runProgram(
      "semantic-map-compress",
      {path("map.semantic"), "--weights", path("weights-1.yaml"), "-o", path("compressed")});
  EXPECT_EQ(other.status, 0) << other.errors;
  ASSERT_TRUE(std::regex_search(other.output, compress, std::regex("([0-9]+) of [0-9]+ leaves")))
      << other.output;
  EXPECT_EQ(view[1], compress[1]);
}

TEST_F(SemanticMapView, FindsAPathBetweenTwoClicks) {
  SKIP_WITHOUT_WINDOWS();
  folder.write("order.yaml", "best_to_worst: [road, grass]\n");
  // In the panel at the lower left: the buttons "start" and "goal".
  const std::string y = std::to_string(kHeight - 76);
  const auto at = [](const cv::Point& p) {
    return std::to_string(p.x) + " " + std::to_string(p.y);
  };
  const ProgramRun run = runInX(
      {MSO_SOURCE_DIR "/test/apps/view-window.sh", path("said.txt"), kProgram, path("map.semantic"),
       "--size", size(), "--camera", kTop, "--classes", path("order.yaml"), "--",
       "60 " + y + " click where the vehicle is", at(pixelOf(-3, -2, 0.2)) + " start at -3",
       "156 " + y + " click where it is to go", at(pixelOf(3, 3, 0.2)) + " path of"});
  EXPECT_EQ(run.status, 0) << run.output << run.errors;
  std::smatch length;
  const std::string said = folder.read("said.txt");
  ASSERT_TRUE(std::regex_search(said, length, std::regex("path of ([0-9.]+) m"))) << said;
  EXPECT_GE(std::stod(length[1]), std::hypot(6, 5) - 0.5);
  EXPECT_LT(std::stod(length[1]), 15);
}

TEST_F(SemanticMapView, PlansFromAndToHeadingsThatAreDragged) {
  SKIP_WITHOUT_WINDOWS();
  folder.write("order.yaml", "best_to_worst: [road, grass]\n");
  const std::string y = std::to_string(kHeight - 76);
  const auto drag = [](const cv::Point& from, const cv::Point& to, const std::string& words) {
    std::string step = "drag";
    for (const int x : {from.x, from.y, to.x, to.y}) step += ' ' + std::to_string(x);
    return step + ' ' + words;
  };
  const ProgramRun run =
      runInX({MSO_SOURCE_DIR "/test/apps/view-window.sh", path("said.txt"), kProgram,
              path("map.semantic"), "--size", size(), "--camera", kTop, "--classes",
              path("order.yaml"), "--", "60 " + y + " click where the vehicle is",
              drag(pixelOf(-4, -2, 0.2), pixelOf(-6, -2, 0.2), "start at -4"),
              "156 " + y + " click where it is to go",
              drag(pixelOf(3, 2, 0.2), pixelOf(3, 4, 0.2), "path of")});
  EXPECT_EQ(run.status, 0) << run.output << run.errors;
  const std::string said = folder.read("said.txt");
  const auto heading = [&](const std::string& of) {
    std::smatch found;
    const bool is = std::regex_search(said, found, std::regex(of + " at.*heading (-?[0-9]+) deg"));
    return is ? std::stod(found[1]) : 1000;
  };
  EXPECT_NEAR(std::abs(heading("start")), 180, 3) << said;
  EXPECT_NEAR(heading("goal"), 90, 3) << said;
  std::smatch length;
  ASSERT_TRUE(std::regex_search(said, length, std::regex("path of ([0-9.]+) m"))) << said;
  EXPECT_GE(std::stod(length[1]), std::hypot(7, 4) + 0.5) << "it has to turn";
}

TEST_F(SemanticMapView, SaysWhatIsMissingInsteadOfFailing) {
  const auto without = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> command = {"-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", kProgram};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return runProgram("/usr/bin/env", command);
  };
  const ProgramRun noDisplay = without({path("map.semantic")});
  EXPECT_EQ(noDisplay.status, 1);
  EXPECT_TRUE(contains(noDisplay.errors, "there is no display")) << noDisplay.errors;
  EXPECT_TRUE(contains(noDisplay.errors, "semantic-map-export")) << noDisplay.errors;
  const ProgramRun otherDisplay =
      runProgram("/usr/bin/env", {"DISPLAY=:4711", kProgram, path("map.semantic")});
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
                                                        {"--max-height", "high"}}) {
    const ProgramRun run = runProgram("semantic-map-view", {path("map.semantic"), option, value});
    EXPECT_EQ(run.status, 64) << option << ' ' << value << run.errors;
    EXPECT_TRUE(contains(run.errors, option) && contains(run.errors, value)) << run.errors;
  }
}
