#include <opencv2/imgcodecs.hpp>

#include <algorithm>

#include "MappingFixture.h"
#include "XServer.h"

namespace {

namespace fs = std::filesystem;

const std::string kProgram = std::string(MSO_BIN_DIR) + "/rawlog2semantic-map";

class LiveMapping : public Rawlog2SemanticMap {
 protected:
  LiveMapping() {
    folder.write("weights.ini",
                 std::string(kSmallConfig) + "[abstraction]\nrelevant = road: 1\nalpha = 0.001\n");
  }
  /** Four scans of a field of road; cars behind it come with the second one. */
  void SetUp() override {
    Rawlog2SemanticMap::SetUp();
    std::vector<Eigen::Vector3f> points;
    std::vector<semantic_types::ClassId> classes;
    for (float x = 2; x < 14; x += 0.25f)
      for (float y = -6; y < 6; y += 0.25f) {
        points.emplace_back(x, y, -1.3f);
        classes.push_back(x < 12 ? 1 : 3);
      }
    const auto scan = [&](double seconds) { return labeledCloud(seconds, points, classes); };
    const std::size_t cars = std::size_t(std::count(classes.begin(), classes.end(), 3));
    const auto onlyRoad = labeledCloud(10, {points.begin(), points.end() - std::ptrdiff_t(cars)},
                                       {classes.begin(), classes.end() - std::ptrdiff_t(cars)});
    writeSmallRawlog(folder / "field.rawlog", robotPose(10, 0), onlyRoad, robotPose(11, 0.3),
                     scan(11), robotPose(12, 0.6), scan(12), robotPose(13, 0.9), scan(13));
  }
  Words arguments(const std::string& output) const {
    return {"--config", path("weights.ini"), "--output", path(output), path("field.rawlog")};
  }
};

}  // namespace

TEST_F(LiveMapping, ShowsTheMapScanByScanAndMakesTheSame) {
  SKIP_WITHOUT_WINDOWS();
  // In the panel at the upper left: "step", twice, and "pause", which lets it go on.
  const ProgramRun live =
      succeeded(runInX(joined({MSO_SOURCE_DIR "/test/apps/view-window.sh", path("said.txt"),
                               kProgram, "--live", "--pause", "-v"},
                              arguments("live"),
                              {"--", "140 53 inserted", "140 53 inserted",
                               "picture " + path("screen.png"), "25 53 CSemanticOctoMap"})));
  const cv::Mat screen = cv::imread(path("screen.png"));
  ASSERT_FALSE(screen.empty());
  int road = 0, car = 0;
  for (auto it = screen.begin<cv::Vec3b>(); it != screen.end<cv::Vec3b>(); ++it) {
    road += (*it)[2] > 200 && (*it)[0] < 10 && (*it)[1] < 10;
    car += (*it)[0] > 200 && (*it)[1] < 10 && (*it)[2] < 10;
  }
  EXPECT_GT(road, 3000);
  EXPECT_GT(car, 200) << "more than beside its name";

  const ProgramRun without = succeeded(runProgram("rawlog2semantic-map", arguments("without")));
  for (const std::string name : {"/map.semantic", "/compressed.semantic", "/top.png"})
    EXPECT_EQ(folder.read("live" + name), folder.read("without" + name)) << name;
}

TEST_F(LiveMapping, ShowsTheCamerasPictureWithItsLabels) {
  SKIP_WITHOUT_WINDOWS();
  // The first scan of the sample is a camera's: half of its colors are those of the classes.
  succeeded(runInX(
      {MSO_SOURCE_DIR "/test/apps/view-window.sh", path("said.txt"), kProgram, "--live", "--pause",
       "-v", "--config", MSO_SOURCE_DIR "/config/maps/synthetic.ini", "-o", path("live"),
       MSO_SOURCE_DIR "/rawlog-samples/village.rawlog", "--", "140 53 'CAMERA'): inserted",
       "140 53 'LIDAR'): inserted", "picture " + path("screen.png")}));
  const cv::Mat screen = cv::imread(path("screen.png"));
  ASSERT_FALSE(screen.empty());
  int paper = 0, all = 0;
  for (int row = 460; row < 700; ++row)
    for (int col = 920; col < 1260; ++col)
      paper += screen.at<cv::Vec3b>(row, col) == cv::Vec3b(250, 250, 250), ++all;
  EXPECT_LT(paper, all / 100) << "the picture is opaque";
}

TEST_F(LiveMapping, IsAnErrorWithoutADisplay) {
  const ProgramRun run = runProgram(
      "/usr/bin/env",
      joined({"-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", kProgram, "--live"}, arguments("live")));
  EXPECT_EQ(run.status, 1);
  const char* const problem = hasWindows() ? "--live: there is no display" : "without windows";
  EXPECT_TRUE(contains(run.errors, problem)) << run.errors;
  EXPECT_FALSE(fs::exists(folder / "live"));
}

TEST_F(LiveMapping, IsNeededForAPause) {
  const ProgramRun run = runProgram("rawlog2semantic-map", joined(arguments("live"), {"--pause"}));
  EXPECT_EQ(run.status, 64);
  EXPECT_TRUE(contains(run.errors, "--live")) << run.errors;
}
