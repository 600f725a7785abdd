// What the applications share.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

#include "JsonFile.h"
#include "TemporaryFolder.h"
#include "measuring/Quantile.h"
#include "measuring/Stopwatch.h"
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

TEST(Stopwatch, beginsAnewWithEachLap) {
  Stopwatch watch;
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_GE(watch.lap(), 200);
  EXPECT_LT(watch.milliseconds(), 200);
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
