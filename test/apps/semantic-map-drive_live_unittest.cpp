#include <opencv2/imgcodecs.hpp>

#include <regex>

#include "SemanticMapDrive.h"
#include "XServer.h"

namespace {

const std::string kProgram = std::string(MSO_BIN_DIR) + "/semantic-map-drive";

/** Some seconds, as a window shows them in real time. */
class LiveDrive : public SemanticMapDrive {
 protected:
  std::vector<std::string> shortDrive(const std::string& output) const {
    return argumentsWith(
        {"--config", configWith("timeLimit = 4\n"), "--output", path(output), "--no-rawlog"});
  }
  std::string csvIn(const std::string& output) const { return folder.read(output + "/drive.csv"); }
};

/** Pixels of a color, as it is or a little darker. */
int countPixels(const cv::Mat& screen, const cv::Vec3b& color) {
  int count = 0;
  for (auto it = screen.begin<cv::Vec3b>(); it != screen.end<cv::Vec3b>(); ++it) {
    const double shade = cv::norm(*it) / cv::norm(color);
    count += shade > 0.85 && shade < 1.03 &&
             cv::norm(cv::Vec3d(*it) - shade * cv::Vec3d(color), cv::NORM_INF) <= 3;
  }
  return count;
}

/** What a drive said, but for the share of slow cycles, which is the machine's. */
std::string withoutTimes(const std::string& output) {
  return std::regex_replace(output, std::regex("[0-9.]+ % of cycles"), "some cycles");
}

}  // namespace

TEST_F(LiveDrive, IsShownInAWindowAndEndsAsWithout) {
  SKIP_WITHOUT_WINDOWS();
#ifndef MSO_DROP_FILES
  GTEST_SKIP() << "needs libx11-dev to close windows";
#else
  std::vector<std::string> command = {"/usr/bin/env",
                                      "DROP_FILES=" MSO_DROP_FILES,
                                      MSO_SOURCE_DIR "/test/apps/live-window.sh",
                                      path("screen.png"),
                                      path("live/drive.csv"),
                                      kProgram,
                                      "--live"};
  for (const std::string& argument : shortDrive("live")) command.push_back(argument);
  const ProgramRun live = runInX(command);
  EXPECT_EQ(live.status, 2) << live.output << live.errors;  // not arrived in so short a time
  const cv::Mat screen = cv::imread(path("screen.png"));
  ASSERT_FALSE(screen.empty()) << live.errors;
  EXPECT_GT(countPixels(screen, {40, 40, 220}), 100) << "the path";
  EXPECT_GT(countPixels(screen, {104, 92, 92}), 5000) << "the road";
  const cv::Mat corner = screen(cv::Rect(920, 460, 340, 240));  // in the window's lower right
  EXPECT_LT(countPixels(corner, {250, 250, 250}), 800) << "the camera's picture";

  const ProgramRun without = runProgram("semantic-map-drive", shortDrive("without"));
  EXPECT_EQ(without.status, 2);
  EXPECT_EQ(withoutTimes(live.output), withoutTimes(without.output));
  EXPECT_EQ(csvIn("live"), csvIn("without"));
#endif
}

TEST_F(LiveDrive, IsAnErrorWithoutADisplay) {
  std::vector<std::string> command = {"-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", kProgram, "--live"};
  for (const std::string& argument : shortDrive("live")) command.push_back(argument);
  const ProgramRun run = runProgram("/usr/bin/env", command);
  EXPECT_EQ(run.status, 1);
  const char* const problem = hasWindows() ? "--live: there is no display" : "without windows";
  EXPECT_NE(run.errors.find(problem), std::string::npos) << run.errors;
  EXPECT_EQ(run.output, "");
  EXPECT_FALSE(has("live"));
}
