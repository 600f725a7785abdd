#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>

#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>

#include "ViewFixture.h"

namespace {

/** The lowest panel at the left: its list of what lies upon the map, and how much lower a second
 * map puts it. */
constexpr int kListX = 28, kListY = 504, kSecondMap = 57;

SemanticOcTree part(double from, double to) {
  return semantic_octree::cropped(smallMap(),
                                  {Eigen::Vector3d(from, -20, -2), Eigen::Vector3d(to, 20, 5)});
}

bool isNear(const cv::Mat& picture, const cv::Point& at, const cv::Vec3i& bgr) {
  const cv::Vec3i difference = cv::Vec3i(picture.at<cv::Vec3b>(at)) - bgr;
  return std::max({std::abs(difference[0]), std::abs(difference[1]), std::abs(difference[2])}) < 25;
}

const cv::Vec3i kDark(20, 20, 20), kOrange(0, 159, 230), kBlue(178, 114, 0), kPaper(250, 250, 250);

}  // namespace

/** A map of the road, and beside it files of which nothing was opened. */
class SemanticMapViewFiles : public SemanticMapView {
 protected:
  SemanticMapViewFiles() {
    semantic_octree::saveTree(part(-20, 0), path("road.semantic"));
    semantic_octree::toOcTree(part(2, 20))->writeBinary(path("grass.bt"));
    folder.write("bad.semantic", "nothing of the kind");
    // North of the map: to the east, and back again.
    folder.write("path.csv",
                 "x,y,z,heading,curvature,gear,class,arc_length\n"
                 "-8,7,0,0,0,forward,\"a, b\",0\n0,7,0,0,0,forward,\"a \"\"c\"\"\",8\n"
                 "0,8,0,0,0,backward,road,9\n-8,8,0,0,0,backward,road,17\n");
    folder.write("drive.csv", "time,x,y,z,speed\r\n0,2,7,0,1\r\n1,5,7,0,1\r\n2,9,7,0,-1\r\n");
    folder.write("robot.tum", "# a comment\n0 -8 -7 0 0 0 0 1\n1 8 -7 0 0 0 0 1\n");
  }

  /** \return what the window said */
  std::string work(Words files, const Words& steps) const {
    for (std::string& file : files) file = path(file);
    return workWith(files, steps);
  }

  std::string drop(const std::string& file, const std::string& words) const {
    return "drop " + path(file) + ' ' + words;
  }

  static void expectPath(const cv::Mat& picture) {
    EXPECT_TRUE(isNear(picture, pixelOf(-4, 7, 0.3), kDark)) << "forward";
    EXPECT_TRUE(isNear(picture, pixelOf(-4, 8, 0.3), kOrange)) << "backward";
  }
  static bool hasTrajectory(const cv::Mat& picture) {
    return isNear(picture, pixelOf(1, -7, 0.3), kBlue);
  }
};

TEST_F(SemanticMapViewFiles, AreDrawnUponTheMap) {
  SKIP_WITHOUT_WINDOWS();
  const cv::Mat picture = draw({path("road.semantic"), path("path.csv"), path("robot.tum"),
                                path("drive.csv"), "--no-panels", "--camera", kTop});
  EXPECT_EQ(classAt(picture, pixelOf(-5, 2, 0.2)), 'r');
  expectPath(picture);
  EXPECT_TRUE(hasTrajectory(picture));
  EXPECT_TRUE(isNear(picture, pixelOf(3, 7, 0.3), kDark)) << "speed above 0";
  EXPECT_TRUE(isNear(picture, pixelOf(7, 7, 0.3), kOrange)) << "speed below 0";
  EXPECT_TRUE(isNear(picture, pixelOf(-4, 7.5, 0.3), kPaper)) << "between the lines";
}

TEST_F(SemanticMapViewFiles, AreOpenedWhenTheyAreDropped) {
  SKIP_WITHOUT_WINDOWS();
#ifndef MSO_DROP_FILES
  GTEST_SKIP() << "built without libX11, which drops files";
#endif
  // The check box of the one that was opened last is the first one; the second map's is below the
  // first one's. What was opened is on the screen once another click was answered.
  const std::string said = work(
      {"road.semantic", "path.csv"},
      {drop("bad.semantic", "bad.semantic'"), drop("grass.bt", "opened .*grass.bt: [0-9]* leaves"),
       drop("robot.tum", "opened .*robot.tum: 16 m"),
       at(pixelOf(-3.1, 2.1, 0.2)) + " occupied, road", "picture " + path("screen.png"),
       at({kListX, kListY + kSecondMap}) + " hides robot.tum", at({24, 71}) + " hides grass.bt",
       at(pixelOf(-3.1, 2.1, 0.2)) + " occupied, road", "picture " + path("hidden.png")});
  const cv::Mat screen = cv::imread(path("screen.png")), hidden = cv::imread(path("hidden.png"));
  ASSERT_FALSE(screen.empty() || hidden.empty());
  EXPECT_TRUE(hasTrajectory(screen));
  EXPECT_FALSE(isNear(screen, pixelOf(3.1, 3.1, 0.2), kPaper));
  EXPECT_FALSE(hasTrajectory(hidden));
  EXPECT_TRUE(isNear(hidden, pixelOf(3.1, 3.1, 0.2), kPaper));
  expectPath(screen);
  expectPath(hidden);
}

TEST_F(SemanticMapViewFiles, InFoldersOfTilesAreShownAsFarAsMemoryAllows) {
  SKIP_WITHOUT_WINDOWS();
  const SemanticOcTree map = smallMap();
  {
    SemanticOcTree tiles = semantic_octree::emptyLike(map);
    semantic_octree::MapFolderOptions options;
    options.tileSize = 3.2;
    semantic_octree::MapFolder to(tiles, path("tiles"), semantic_octree::MapFolder::Access::Write,
                                  options);
    semantic_octree::copyTo(tiles, map);
    to.save();
  }
  const std::string megabytes = std::to_string(double(map.memoryUsage()) / 5e6);
  const auto run = [&](const Words& more) {
    return runInX(joined({kViewer, path("tiles"), "--size", size(), "--camera", kTop, "--no-panels",
                          "-f", "-o", path("view.png")},
                         more));
  };
  const auto picture = [&] { return cv::imread(path("view.png")); };
  succeeded(run({}));
  EXPECT_EQ(classAt(picture(), pixelOf(-5, 2, 0.2)), 'r');
  const ProgramRun large = run({"--memory", megabytes});
  EXPECT_EQ(large.status, 1);
  EXPECT_TRUE(contains(large.errors, "--clip shows a part")) << large.errors;
  succeeded(run({"--memory", megabytes, "--clip=-6,-1,-1,-4,1,1"}));
  EXPECT_EQ(classAt(picture(), pixelOf(-5, 0, 0.2)), 'r');
  EXPECT_EQ(classAt(picture(), pixelOf(-5, 2, 0.2)), ' ');
  for (const auto& entry : std::filesystem::directory_iterator(path("tiles")))
    if (entry.path().extension() == ".semantic") std::filesystem::resize_file(entry.path(), 9);
  const std::string damaged = run({}).errors;
  EXPECT_TRUE(contains(damaged, path("tiles")) && !contains(damaged, "--clip")) << damaged;
}

TEST_F(SemanticMapView, ShowsUnknownSpaceWithinWhatIsKnownOrCut) {
  SKIP_WITHOUT_WINDOWS();
  const auto grayAt = [&](const Words& more, double x, double y) {
    const cv::Vec3b color =
        draw(joined({path("map.semantic"), "--no-panels", "--camera", kTop}, more))
            .at<cv::Vec3b>(pixelOf(x, y));
    return color[0] < 240 && std::abs(color[0] - color[2]) < 12;
  };
  // Beams from 6 m above the middle leave the corners of the box around them unknown.
  EXPECT_FALSE(grayAt({"--max-height", "-1"}, 9, 4.5));
  EXPECT_TRUE(grayAt({"--unknown", "--clip=-90,-90,1,90,90,3"}, 9, 4.5));
  EXPECT_FALSE(grayAt({"--unknown", "--clip=-90,-90,1,90,90,3"}, 11.5, 4.5)) << "beside the map";
  EXPECT_FALSE(grayAt({"--unknown", "--clip=-90,-90,1,8,90,3"}, 9, 4.5)) << "cut";
  EXPECT_FALSE(grayAt({"--unknown", "--clip=-90,-90,1,90,90,3"}, 0, 0)) << "known to be free";
}

TEST_F(SemanticMapViewFiles, ThatAreNoneAreNamed) {
  const auto errors = [&](const std::string& name, const std::string& text) {
    folder.write(name, text);
    const ProgramRun run =
        runProgram("semantic-map-view", {path("road.semantic"), path(name), "-o", path("no.png")});
    EXPECT_EQ(run.status, 1);
    return run.errors;
  };
  const auto expectError = [&](const std::string& text, const std::string& where,
                               const std::string& words) {
    const std::string said = errors("some.csv", text);
    EXPECT_TRUE(contains(said, path("some.csv") + where) && contains(said, words)) << said;
  };
  expectError("a,b\n1,2\n", ":1:", "no column 'x'");
  expectError("x,y\n1,2\n", ":1:", "no column 'z'");
  expectError("x,y,z\n1,2\n", ":2:", "expected 3 fields, found 2");
  expectError("x,y,z\n1,2,3\n\n1,2,high\n", ":4:", "z is 'high'");
  expectError("x,y,z\n1,inf,3\n", ":2:", "y is 'inf'");
  expectError("x,y,z,speed\n1,2,3,\n", ":2:", "speed is ''");
  expectError("x,y,z\n", ":", "no place in this path");
  expectError("", ":", "no place in this path");
  EXPECT_TRUE(contains(errors("bad.tum", "1 2 3\n"), path("bad.tum") + ":1"));
  const ProgramRun noMap = runProgram("semantic-map-view", {path("path.csv")});
  EXPECT_EQ(noMap.status, 1);
  EXPECT_TRUE(contains(noMap.errors, "there is no map beside") &&
              contains(noMap.errors, "path.csv"))
      << noMap.errors;
}
