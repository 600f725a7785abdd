#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CRawlog.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_types/ClassTable.h>
#include <opencv2/imgcodecs.hpp>

#include <cmath>
#include <regex>

#include "StockApps.h"

namespace {

class Viewers : public StockApps {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_APP("RawLogViewer");
    SKIP_WITHOUT("/usr/bin/xvfb-run", "xvfb");
    SKIP_WITHOUT("/usr/bin/xauth", "xauth");
    SKIP_WITHOUT("/usr/bin/xdotool", "xdotool");
    SKIP_WITHOUT("/usr/bin/import", "imagemagick");
  }

  /** The screen with a viewer on it, after a click at (x, y) and some turns of the wheel. */
  cv::Mat screenOf(const std::string& viewer, cv::Point click, int scroll = 0) const {
    std::filesystem::remove(folder / "screen.png");
    const ProgramRun shown = run("xvfb-run -a -s '-screen 0 1280x800x24' " MSO_SOURCE_DIR
                                 "/test/stock_apps/viewer.sh screen.png " +
                                 std::to_string(click.x) + " " + std::to_string(click.y) + " " +
                                 std::to_string(scroll) + " " + viewer);
    const cv::Mat screen = cv::imread((folder / "screen.png").string());
    EXPECT_FALSE(screen.empty()) << shown.output;
    return screen.empty() ? cv::Mat(800, 1280, CV_8UC3, cv::Scalar::all(0)) : screen;
  }

  static std::string withPlugin(const std::string& program) {
    return program + " -l " + kPlugin + " ";
  }

  semantic_map::CSemanticOctoMap villageMap() const {
    semantic_map::CSemanticOctoMap map(
        0.4, semantic_types::loadClassTable(folder / "config/classes/synthetic.yaml"));
    map.loadFromSimpleMap(villageFrames(3));
    return map;
  }

  void cutVillage() const {
    mrpt::obs::CRawlog rawlog;
    ASSERT_TRUE(rawlog.loadFromRawLogFile((folder / "rawlog-samples/village.rawlog").string()));
    rawlog.remove(12, rawlog.size() - 1);
    ASSERT_TRUE(rawlog.saveToRawLogFile((folder / "short.rawlog").string()));
  }
};

/** Lines of text in RawLogViewer's list of a rawlog's objects: its name, and "[0] ...", ... */
int linesOfText(const cv::Mat& screen) {
  const cv::Mat list = screen(cv::Rect(40, 95, 9, 500));
  int lines = 0;
  bool before = false;
  for (int row = 0; row < list.rows; ++row) {
    bool dark = false;
    for (int col = 0; col < list.cols; ++col) {
      const auto p = list.at<cv::Vec3b>(row, col);
      dark = dark || p[0] + p[1] + p[2] < 450;
    }
    lines += dark && !before;
    before = dark;
  }
  return lines;
}

/** Share of a part of the viewers' 3D views that has a color, bright or dark. */
double shareOf(const cv::Mat& screen, const semantic_types::Color& color) {
  const cv::Mat view = screen(cv::Rect(420, 380, 740, 230));
  const double sum = color.r + color.g + color.b;
  int count = 0;
  for (int row = 0; row < view.rows; ++row)
    for (int col = 0; col < view.cols; ++col) {
      const auto p = view.at<cv::Vec3b>(row, col);
      const double total = std::max(1, p[0] + p[1] + p[2]);
      count += std::abs(p[2] / total - color.r / sum) < 0.02 &&
               std::abs(p[1] / total - color.g / sum) < 0.02;
    }
  return double(count) / double(view.total());
}

constexpr semantic_types::Color kGrass{138, 196, 84}, kCanopy{26, 112, 48};

TEST_F(Viewers, rawLogViewerListsLabeledCloudsAndWithoutThePluginStopsAtTheFirst) {
  cutVillage();
  const cv::Point nowhere(300, 560);
  EXPECT_EQ(linesOfText(screenOf(withPlugin("RawLogViewer") + "short.rawlog", nowhere)), 13);
  EXPECT_EQ(linesOfText(screenOf("RawLogViewer short.rawlog", nowhere)), 3);
}

TEST_F(Viewers, rawLogViewerShowsAMapInAnArchive) {
  labeled_cloud::RawlogWriter archive(folder / "map.rawlog");
  archive.write(villageMap());
  archive.finish();
  const cv::Mat screen = screenOf(withPlugin("RawLogViewer") + "map.rawlog", {100, 122});
  EXPECT_EQ(linesOfText(screen), 2);
  EXPECT_GT(shareOf(screen, kGrass), 0.01);
}

TEST_F(Viewers, sceneViewer3DShowsAMapsSceneInItsClassesColors) {
  villageMap().saveMetricMapRepresentationToFile((folder / "village").string());
  const cv::Mat screen = screenOf(withPlugin("SceneViewer3D") + "village.3Dscene", {700, 400}, 15);
  EXPECT_GT(shareOf(screen, kGrass), 0.02);
  EXPECT_GT(shareOf(screen, kCanopy), 0.01);
}

/** The shell commands of a page, as one script: what stands between "```console" and "```".
 * Commands that other tests of this folder run, for they take long or need a display, are left out.
 */
std::string commandsOf(const std::filesystem::path& page) {
  static const std::regex elsewhere("^(RawLogViewer|SceneViewer3D|LD_PRELOAD=.* rbpf-slam) ");
  std::ifstream in(page);
  std::string script = "set -e\n";
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("```", 0) == 0)
      inside = line == "```console";
    else if (inside && !std::regex_search(line, elsewhere))
      script += line + "\n";
  }
  return script;
}

}  // namespace

TEST_F(StockApps, theCommandsOfTheirPageWorkOneAfterTheOtherAndParticlesFindTheRobot) {
  SKIP_WITHOUT_APP("icp-slam");
  SKIP_WITHOUT(std::string("/usr/share/mrpt/datasets/") + kLaserRawlog, "mrpt-common");
  SKIP_WITHOUT("/usr/share/mrpt/datasets/localization_demo.simplemap.gz", "mrpt-common");
  std::filesystem::create_directory(folder / "build");
  std::filesystem::create_directory_symlink(MSO_LIB_DIR, folder / "build/lib");
  std::filesystem::create_directory_symlink(MSO_BIN_DIR, folder / "build/bin");
  folder.write("page.sh", commandsOf(MSO_SOURCE_DIR "/doc/handbook/stock-applications.md"));
  const ProgramRun read = run("sh page.sh");
  EXPECT_EQ(read.status, 0) << read.output;
  // Particles find the robot at the end of the path, which MRPT's own tests know.
  static const std::regex pattern(R"(PDF estimation: \(([-\d.]+),([-\d.]+),([-\d.]+)deg\))");
  double x = NAN, y = NAN, degrees = NAN;  // the last that was told
  for (std::sregex_iterator it(read.output.begin(), read.output.end(), pattern), end; it != end;
       ++it)
    x = std::stod((*it)[1]), y = std::stod((*it)[2]), degrees = std::stod((*it)[3]);
  EXPECT_LT(std::hypot(x - 15.904, y + 10.010), 0.3);
  EXPECT_NEAR(degrees, 4.93, 2);
  for (const char* made :
       {"icp-slam-output/_finalmaps_.txt_semantic_map__CSemanticOctoMap_01.semantic",
        "from-keyframes_semantic_map__CSemanticOctoMap_00.3Dscene",
        "pf-localization-output_000_0005000/map_semantic_map__CSemanticOctoMap_00.semantic",
        "short.rawlog", "lidar.rawlog"})
    EXPECT_TRUE(std::filesystem::exists(folder / made)) << made;
}
