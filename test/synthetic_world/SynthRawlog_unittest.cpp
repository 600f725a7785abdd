#include <gtest/gtest.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/containers/yaml.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/TextFile.h>
#include <synthetic_world/Scene.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <regex>

#include "SynthRawlogRun.h"

namespace {

using namespace synth_rawlog_run;
using labeled_cloud::CObservationLabeledCloud;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationRobotPose;
using mrpt::poses::CPose3D;
using strict_files::readText;
using synthetic_world::makeScene;
using synthetic_world::PointTruth;

const std::string kSmall =
    " --frames 3 --rate 1 --speed 8 --width 64 --height 48 --rings 8 --columns 90 ";

TEST(SynthRawlog, writesPoseCameraAndLidarOfEachFrame) {
  const Folder folder;
  ASSERT_EQ(run(folder, "-f -o x.rawlog --scene campus" + kSmall).status, 0);
  const auto all = observationsOf(folder / "x.rawlog");
  ASSERT_EQ(all.size(), 9u);
  EXPECT_EQ(only<CObservationRobotPose>(all).size(), 3u);
  EXPECT_EQ(only<CObservation3DRangeScan>(all).size(), 3u);
  EXPECT_EQ(only<CObservationLabeledCloud>(all).size(), 3u);
  for (int i = 0; i < 9; ++i) {
    EXPECT_EQ(all[i]->sensorLabel, (std::array{"ROBOT", "CAMERA", "LIDAR"}[i % 3]));
    EXPECT_NEAR(mrpt::Clock::toDouble(all[i]->timestamp), 1704067200 + i / 3, 1e-6);
  }
  for (const auto& cloud : only<CObservationLabeledCloud>(all)) EXPECT_NO_THROW(cloud->validate());
}

TEST(SynthRawlog, sensorOptionChoosesWhatIsWritten) {
  const Folder folder;
  ASSERT_EQ(run(folder, "-f -o x.rawlog --sensor camera" + kSmall).status, 0);
  EXPECT_TRUE(only<CObservationLabeledCloud>(observationsOf(folder / "x.rawlog")).empty());
  ASSERT_EQ(run(folder, "-f -o x.rawlog --sensor lidar" + kSmall).status, 0);
  EXPECT_TRUE(only<CObservation3DRangeScan>(observationsOf(folder / "x.rawlog")).empty());
}

TEST(SynthRawlog, peopleWalkAcrossTheRoute) {
  const Folder folder;
  std::ptrdiff_t seen[2] = {};
  for (const int many : {0, 1}) {
    const std::string people = "--people " + std::to_string(100 * many);
    ASSERT_EQ(run(folder, "-f -o x.rawlog --sensor lidar " + people + kSmall).status, 0);
    for (const auto& scan : only<CObservationLabeledCloud>(observationsOf(folder / "x.rawlog")))
      seen[many] += std::count(scan->cloud.classes.begin(), scan->cloud.classes.end(),
                               synthetic_world::kPerson);
  }
  EXPECT_GT(seen[1], seen[0] + 5);
}

TEST(SynthRawlog, unprojectedDepthsLandOnSurfacesOfTheirLabels) {
  const Folder folder;
  ASSERT_EQ(run(folder, "-f -o x.rawlog --scene village --seed 3 --range-noise 0" + kSmall).status,
            0);
  const auto scene = makeScene("village", 3);
  const auto all = observationsOf(folder / "x.rawlog");
  const auto poses = only<CObservationRobotPose>(all);
  const auto scans = only<CObservation3DRangeScan>(all);
  for (int k = 0; k < 3; ++k) {
    auto& scan = *scans[k];
    mrpt::obs::T3DPointsProjectionParams params;
    params.takeIntoAccountSensorPoseOnRobot = true;
    params.robotPoseInTheWorld = poses[k]->pose.mean;
    scan.unprojectInto(scan, params);
    ASSERT_GT(scan.points3D_x.size(), 1000u);
    int wrong = 0;
    for (std::size_t i = 0; i < scan.points3D_x.size(); ++i) {
      const Eigen::Vector3d p(scan.points3D_x[i], scan.points3D_y[i], scan.points3D_z[i]);
      const PointTruth truth = scene.world.at(p, 0.003);  // depths are whole millimeters
      EXPECT_EQ(truth.state, PointTruth::State::Surface) << p.transpose();
      const auto bits = labelBits(scan, scan.points3D_idxs_y[i], scan.points3D_idxs_x[i]);
      wrong += bits != 1u << truth.id;
    }
    EXPECT_LE(wrong, static_cast<int>(scan.points3D_x.size() / 200));  // at borders
  }
}

TEST(SynthRawlog, pointsOfATurnThatTakesTimeLandOnSurfacesFromWhereTheRobotIsByThen) {
  const Folder folder;
  ASSERT_EQ(
      run(folder, "-f -o x.rawlog --sensor lidar --range-noise 0 --turn-time 0.5" + kSmall).status,
      0);
  const auto scene = makeScene("village", 1);
  const auto clouds = only<CObservationLabeledCloud>(observationsOf(folder / "x.rawlog"));
  for (int k = 0; k < 3; ++k) {
    const auto T_robot_lidar = labeled_cloud::toEigen(clouds[k]->sensorPose);
    ASSERT_EQ(clouds[k]->times.size(), clouds[k]->cloud.size());
    for (std::size_t i = 0; i < clouds[k]->times.size(); ++i) {
      const float t = clouds[k]->times[i];
      EXPECT_TRUE(t >= 0 && t < 0.5) << t;
      const Eigen::Vector3d p = scene.T_world_robot(8 * (k + static_cast<double>(t))) *
                                T_robot_lidar * clouds[k]->cloud.points[i].cast<double>();
      EXPECT_EQ(scene.world.at(p, 1e-3).state, PointTruth::State::Surface) << p.transpose();
    }
  }
}

TEST(SynthRawlog, sameCommandWritesTheSameBytes) {
  const Folder folder;
  const std::string noise = kSmall + " --label-noise 0.1 --people 2 ";
  for (const std::string kind : {"", "--odometry"}) {
    ASSERT_EQ(run(folder, "-f -o a.rawlog" + noise + kind).status, 0);
    ASSERT_EQ(run(folder, "-f -o b.rawlog" + noise + kind).status, 0);
    EXPECT_EQ(folder.read("a.rawlog"), folder.read("b.rawlog"));
    EXPECT_EQ(folder.read("a.tum"), folder.read("b.tum"));
  }
  ASSERT_EQ(run(folder, "-f -o b.rawlog" + noise + "--odometry --seed 10").status, 0);
  EXPECT_NE(folder.read("a.rawlog"), folder.read("b.rawlog"));
}

TEST(SynthRawlog, movementsSumUpToTheTrueWayWithoutNoiseOnly) {
  const Folder folder;
  const auto endOf = [&](const std::string& noise) {
    const std::string arguments = "-f -o x.rawlog --odometry --odometry-noise " + noise + kSmall;
    EXPECT_EQ(run(folder, arguments).status, 0);
    const auto trajectory = labeled_cloud::readTrajectory({folder / "x.rawlog"});
    return *trajectory.at(mrpt::Clock::fromDouble(1704067202));
  };
  const CPose3D exact = endOf("0"), noisy = endOf("0.05");
  ASSERT_EQ(run(folder, "-f -o y.rawlog" + kSmall).status, 0);
  const auto poses = only<CObservationRobotPose>(observationsOf(folder / "y.rawlog"));
  const CPose3D way = poses[2]->pose.mean - poses[0]->pose.mean;
  EXPECT_LT((exact.asVectorVal() - way.asVectorVal()).array().abs().maxCoeff(), 1e-9);
  EXPECT_GT(noisy.distanceTo(way), 0.01);
  EXPECT_LT(noisy.distanceTo(way), 3);
}

TEST(SynthRawlog, writesTheSameWorldInRugdsClasses) {
  const Folder folder;
  const std::string file = MSO_SOURCE_DIR "/config/classes/synthetic_as_rugd.yaml";
  ASSERT_EQ(run(folder, "-f -o x.rawlog --scene campus" + kSmall).status, 0);
  ASSERT_EQ(run(folder, "-f -o y.rawlog --scene campus --classes '" + file + "'" + kSmall).status,
            0);
  const auto rugd = semantic_types::loadClassTable(file);
  const auto world = observationsOf(folder / "x.rawlog"),
             same = observationsOf(folder / "y.rawlog");
  const auto clouds = only<CObservationLabeledCloud>(world),
             inRugd = only<CObservationLabeledCloud>(same);
  ASSERT_EQ(clouds.size(), inRugd.size());
  for (std::size_t k = 0; k < clouds.size(); ++k) {
    ASSERT_EQ(inRugd[k]->classNames.size(), 24u);
    ASSERT_EQ(clouds[k]->cloud.points, inRugd[k]->cloud.points);
    for (std::size_t i = 0; i < clouds[k]->cloud.size(); ++i) {
      const auto id = inRugd[k]->cloud.classes[i];
      ASSERT_EQ(id, rugd.fromRaw(clouds[k]->cloud.classes[i]));
      ASSERT_EQ(inRugd[k]->classNames[id - 1], rugd.name(id));
    }
  }
  const auto scan = only<CObservation3DRangeScan>(world)[1],
             scanInRugd = only<CObservation3DRangeScan>(same)[1];
  EXPECT_EQ(scanInRugd->pixelLabels->pixelLabelNames.at(10), "asphalt");
  for (int row = 0; row < 48; ++row)
    for (int column = 0; column < 64; ++column)
      for (int id = 1; id <= synthetic_world::kClassCount; ++id)
        if (labelBits(*scan, row, column) == 1u << id) {
          ASSERT_EQ(labelBits(*scanInRugd, row, column), 1u << rugd.fromRaw(id));
        }
  EXPECT_TRUE(contains(folder.read("y.truth.yaml"), "name: rock-bed"));
}

TEST(SynthRawlog, theTruthNamesClassesWhateverTheirNames) {
  const Folder folder;
  const std::string names[] = {"a, b: {c}", "it's \"#1\"", "[d]"};
  std::ofstream table(folder / "odd.yaml");
  table << "unknown_raw_id: no_class\nclasses:\n";
  for (int id = 1; id <= 3; ++id)
    table << "  - {id: " << id << ", name: " << nlohmann::json(names[id - 1])
          << ", color: [0, 0, 0], raw: [" << id << "]}\n";
  table.close();
  ASSERT_EQ(run(folder, "-o x.rawlog" + kSmall + "--classes odd.yaml").status, 0);
  const auto truth = mrpt::containers::yaml::FromFile((folder / "x.truth.yaml").string());
  for (int i = 0; i < 3; ++i) EXPECT_EQ(truth["classes"](i)["name"].as<std::string>(), names[i]);
}

TEST(SynthRawlog, refusesAClassTableThatDoesNotFoldTheWorldOrIsTooLarge) {
  const Folder folder;
  std::ofstream(folder / "few.yaml") << "classes:\n  - {id: 1, name: a, color: [0, 0, 0]}\n";
  const ProgramRun few = run(folder, "-o x.rawlog" + kSmall + "--classes few.yaml");
  EXPECT_EQ(few.status, 1);
  EXPECT_TRUE(contains(few.output, "few.yaml: raw class id 2 is not in the class table"));
  std::ofstream many(folder / "many.yaml");
  many << "classes:\n";
  for (int i = 1; i <= 32; ++i)
    many << "  - {id: " << i << ", name: c" << i << ", color: [0, 0, 0]}\n";
  many.close();
  const ProgramRun tooMany = run(folder, "-o x.rawlog" + kSmall + "--classes many.yaml");
  EXPECT_EQ(tooMany.status, 1);
  EXPECT_TRUE(contains(tooMany.output, "32 classes, and a pixel's labels hold 31"));
  EXPECT_FALSE(fs::exists(folder / "x.rawlog"));
}

TEST(SynthRawlog, badInputIsRefusedWithItsReason) {
  const Folder folder;
  const std::pair<std::string, std::string> cases[] = {
      {"-o x.rawlog --scene moon", "moon"},
      {"-o x.rawlog --sensor nose", "nose"},
      {"-o x.rawlog --frames 0", "--frames"},
      {"-o x.rawlog --rate 0", "--rate"},
      {"-o x.rawlog --speed -1", "--speed"},
      {"-o x.rawlog --hills 3", "--hills"},
      {"-o x.rawlog --width 1", "--width is 1"},
      {"-o x.rawlog --fov 200", "--fov is 200"},
      {"-o x.rawlog --camera-range 100", "--camera-range is 100"},
      {"-o x.rawlog --rings 0", "--rings is 0"},
      {"-o x.rawlog --range-noise -1", "--range-noise is -1"},
      {"-o x.rawlog --label-noise 2", "--label-noise is 2"},
      {"-o x.rawlog --ghosts nan", "--ghosts is"},
      {"-o x.rawlog --unknown 1", "--unknown"},
      {"-o absent/x.rawlog", "absent/x.rawlog"}};
  for (const auto& [arguments, reason] : cases) {
    const ProgramRun outcome = run(folder, arguments);
    EXPECT_NE(outcome.status, 0) << arguments;
    EXPECT_TRUE(contains(outcome.output, reason)) << arguments << ": " << outcome.output;
  }
  EXPECT_FALSE(fs::exists(folder / "x.rawlog"));
}

const fs::path kSamples = fs::path(MSO_SOURCE_DIR) / "rawlog-samples";

/** The arguments of the command that the samples' README says made them. */
std::string documentedArguments() {
  const std::string readme =
      std::regex_replace(readText(kSamples / "README.md"), std::regex("\\\\\n\\s*"), "");
  std::smatch match;
  if (!std::regex_search(readme, match, std::regex("\n    synth-rawlog ([^\n]*)")))
    throw std::runtime_error("rawlog-samples/README.md: no command");
  return match[1];
}

// Processors differ in the last digit of sines and logarithms. A value between two millimeters or
// classes may fall to either side, in a few pixels of a million.
constexpr double kFewPixels = 1e-4;

void expectSameImage(const CObservation3DRangeScan& a, const CObservation3DRangeScan& b) {
  ASSERT_EQ(a.rangeImage.rows(), b.rangeImage.rows());
  ASSERT_EQ(a.rangeImage.cols(), b.rangeImage.cols());
  int different = 0;
  for (int row = 0; row < a.rangeImage.rows(); ++row)
    for (int column = 0; column < a.rangeImage.cols(); ++column)
      different += a.rangeImage(row, column) != b.rangeImage(row, column) ||
                   labelBits(a, row, column) != labelBits(b, row, column);
  EXPECT_LE(different, 1 + kFewPixels * a.rangeImage.size());
  EXPECT_EQ(a.cameraParams, b.cameraParams);
  EXPECT_EQ(a.sensorPose, b.sensorPose);
}

void expectSameCloud(const CObservationLabeledCloud& a, const CObservationLabeledCloud& b) {
  ASSERT_EQ(a.cloud.size(), b.cloud.size());
  int different = 0;
  for (std::size_t i = 0; i < a.cloud.size(); ++i)
    different += (a.cloud.points[i] - b.cloud.points[i]).norm() > 1e-4 ||
                 a.cloud.classes[i] != b.cloud.classes[i];
  EXPECT_LE(different, 1 + kFewPixels * a.cloud.size());
  EXPECT_EQ(a.classNames, b.classNames);
  EXPECT_EQ(a.sensorPose, b.sensorPose);
}

TEST(SampleRawlog, isWhatTheDocumentedCommandWrites) {
  const Folder folder;
  ASSERT_EQ(run(folder, documentedArguments()).status, 0) << documentedArguments();
  const auto sample = observationsOf(kSamples / "village.rawlog");
  const auto made = observationsOf(folder / "village.rawlog");
  ASSERT_EQ(sample.size(), made.size());
  for (std::size_t i = 0; i < sample.size(); ++i)
    EXPECT_EQ(sample[i]->timestamp, made[i]->timestamp);

  const auto poses = only<CObservationRobotPose>(sample),
             otherPoses = only<CObservationRobotPose>(made);
  const auto images = only<CObservation3DRangeScan>(sample),
             otherImages = only<CObservation3DRangeScan>(made);
  const auto clouds = only<CObservationLabeledCloud>(sample),
             otherClouds = only<CObservationLabeledCloud>(made);
  ASSERT_EQ(poses.size(), images.size());
  ASSERT_EQ(poses.size(), clouds.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT(poses[i]->pose.mean.distanceTo(otherPoses[i]->pose.mean), 1e-9);
    expectSameImage(*images[i], *otherImages[i]);
    expectSameCloud(*clouds[i], *otherClouds[i]);
  }
  EXPECT_EQ(readText(kSamples / "village.tum"), folder.read("village.tum"));
  EXPECT_EQ(readText(kSamples / "village.truth.yaml"), folder.read("village.truth.yaml"));
}

}  // namespace
