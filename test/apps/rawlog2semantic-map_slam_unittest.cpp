// A drive whose trajectory drifts, and what --slam makes of it.
#include <gtest/gtest.h>
#include <labeled_cloud/Rawlogs.h>
#include <map_folders/MapFolder.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/serialization/CArchive.h>
#include <semantic_octree/TreeFile.h>

#include <Eigen/Geometry>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "RunProgram.h"
#include "TemporaryFolder.h"

namespace {

namespace fs = std::filesystem;
using semantic_octree::SemanticOcTree;
using Poses = std::map<double, Eigen::Isometry3d>;

/** As the data sets of TUM have it: time x y z qx qy qz qw. */
Poses readPoses(const std::string& text) {
  Poses poses;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    double time;
    Eigen::Vector3d t;
    Eigen::Quaterniond q;
    words >> time >> t.x() >> t.y() >> t.z() >> q.x() >> q.y() >> q.z() >> q.w();
    poses[time] = Eigen::Translation3d(t) * q.normalized();
  }
  return poses;
}

std::string textOf(const Poses& poses) {
  std::ostringstream out;
  out.precision(17);
  for (const auto& [time, T] : poses) {
    const Eigen::Quaterniond q(T.linear());
    out << time << ' ' << T.translation().transpose() << ' ' << q.x() << ' ' << q.y() << ' '
        << q.z() << ' ' << q.w() << '\n';
  }
  return out.str();
}

/** 1 % too long, and 0.1 degrees a meter too far to the left. */
Poses drifting(const Poses& truth) {
  Poses poses;
  Eigen::Isometry3d before, T = truth.begin()->second;
  for (const auto& [time, T_true] : truth) {
    if (!poses.empty()) {
      Eigen::Isometry3d motion = before.inverse() * T_true;
      const double way = motion.translation().norm();
      motion.translation() *= 1.01;
      T = T * motion * Eigen::AngleAxisd(0.1 * M_PI / 180 * way, Eigen::Vector3d::UnitZ());
    }
    poses[time] = T;
    before = T_true;
  }
  return poses;
}

double distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.translation() - b.translation()).norm();
}

/** Share of a map's occupied leaves whose middle is occupied in another one. */
double shareOccupiedIn(const SemanticOcTree& other, const SemanticOcTree& map) {
  int occupied = 0, there = 0;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    if (!map.isNodeOccupied(*leaf)) continue;
    ++occupied;
    there += other.query(leaf.getX(), leaf.getY(), leaf.getZ()).status ==
             semantic_octree::CellState::Status::Occupied;
  }
  return double(there) / occupied;
}

TEST(Rawlog2SemanticMapWithSlam, correctsATrajectoryThatDrifts) {
  const TemporaryFolder folder;
  const std::string rawlog = (folder / "park.rawlog").string();
  succeeded(runProgram("synth-rawlog", {"-o", rawlog, "--scene", "park", "--sensor", "lidar",
                                        "--frames", "235", "--rate", "1", "--speed", "1", "--rings",
                                        "32", "--columns", "360", "--label-noise", "0.1"}));
  const Poses truth = readPoses(folder.read("park.tum")), noisy = drifting(truth);
  const auto noisyFile = folder.write("noisy.tum", textOf(noisy));
  const auto mapWith = [&](const fs::path& trajectory, const Words& more) {
    const std::string out = (folder / "out").string();
    succeeded(runProgram("rawlog2semantic-map",
                         joined({"-f", "--output", out, "--resolution", "0.4", "--max-range", "20",
                                 "--trajectory", trajectory.string(), rawlog},
                                more)));
    return semantic_octree::loadTree(out + "/map.semantic");
  };
  const SemanticOcTree trueMap = mapWith(folder / "park.tum", {}),
                       map = mapWith(noisyFile, {"--slam"});
  EXPECT_GT(shareOccupiedIn(trueMap, map), 0.8);

  const Poses corrected = readPoses(folder.read("out/trajectory.tum"));
  const auto summary = nlohmann::json::parse(folder.read("out/summary.json"));
  const auto& slam = summary["slam"];
  EXPECT_EQ(corrected.size(), summary["observations"]["inserted"]) << "each scan has a pose";
  EXPECT_LE(slam["keyframes"], corrected.size());
  EXPECT_EQ(slam["torn"], 0);
  EXPECT_TRUE(slam["warnings"].empty()) << slam["warnings"];
  EXPECT_GT(slam["loops"], 0);
  ASSERT_GT(corrected.size(), 100u);
  const double last = corrected.rbegin()->first;
  const auto at = [last](const Poses& poses) {  // times are those of the rawlog, to a microsecond
    return std::prev(poses.upper_bound(last + 1e-4))->second;
  };
  EXPECT_GT(distance(at(noisy), at(truth)), 3);
  EXPECT_LT(distance(corrected.rbegin()->second, at(truth)), 0.3);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "out"), {}), 5);
}

/** A drive along the village's street, and what is not known of it. */
struct Street {
  TemporaryFolder folder;
  std::string rawlog = (folder / "street.rawlog").string();

  /** \param turnTime of the LiDAR, s */
  explicit Street(const std::string& turnTime = "0") {
    succeeded(runProgram(
        "synth-rawlog",
        {"-o", rawlog, "--scene", "village", "--sensor", "lidar", "--frames", "50", "--rate", "1",
         "--speed", "1", "--rings", "32", "--columns", "360", "--turn-time", turnTime}));
  }
  ProgramRun map(const std::string& output, const Words& more) const {
    return runProgram("rawlog2semantic-map",
                      joined({"-f", "--output", (folder / output).string(), "--resolution", "0.2",
                              "--max-range", "20", rawlog},
                             more));
  }
};

}  // namespace

TEST(Rawlog2SemanticMapWithSlam, bringsADriveIntoTheFrameOfAMap) {
  const Street street;
  const Poses truth = readPoses(street.folder.read("street.tum"));
  ASSERT_EQ(street.map("before", {}).status, 0);
  // Odometry drifts, and begins 1.2 m and 3 degrees beside where it is in that map.
  Poses odometry = drifting(truth);
  const Eigen::Isometry3d T_first = truth.begin()->second;
  const Eigen::Isometry3d T_off = T_first * Eigen::Translation3d(1, -0.6, 0.1) *
                                  Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitZ()) *
                                  T_first.inverse();
  for (auto& [time, T] : odometry) T = T_off * T;
  const auto noisy = street.folder.write("noisy.tum", textOf(odometry)).string();
  succeeded(street.map("after", {"--trajectory", noisy, "--slam", "--reference",
                                 (street.folder / "before/map.semantic").string()}));
  const Poses corrected = readPoses(street.folder.read("after/trajectory.tum"));
  ASSERT_GT(corrected.size(), 40u);
  for (const auto& [time, T] : corrected) {
    const auto& T_true = std::prev(truth.upper_bound(time + 1e-4))->second;
    EXPECT_LT(distance(T, T_true), 0.1) << time;
  }
  const auto slam = nlohmann::json::parse(street.folder.read("after/summary.json"))["slam"];
  EXPECT_GT(slam["referenced"], 10);
  EXPECT_EQ(slam["loops"], 0);
}

TEST(Rawlog2SemanticMapWithSlam, mapsIntoTilesWhatItMapsInMemoryAndFindsTheNextDriveThere) {
  const Street street;
  const Poses truth = readPoses(street.folder.read("street.tum"));
  const auto noisy = street.folder.write("noisy.tum", textOf(drifting(truth))).string();
  const std::string tiles = (street.folder / "tiles").string();
  const Words intoTiles = {"--tiles", tiles, "--tile-size", "12.8", "--memory", "0.1"};
  const auto with = [&](Words more, const std::string& trajectory) {
    more.insert(more.end(), {"--slam", "--trajectory", trajectory});
    return more;
  };
  ASSERT_EQ(street.map("plain", with({}, noisy)).status, 0);
  succeeded(street.map("tiled", with(intoTiles, noisy)));
  EXPECT_TRUE(semantic_octree::loadMap(tiles) ==
              semantic_octree::loadTree((street.folder / "plain/map.semantic").string()));
  EXPECT_EQ(street.folder.read("tiled/trajectory.tum"), street.folder.read("plain/trajectory.tum"));

  const std::size_t leaves = semantic_octree::loadMap(tiles).getNumLeafNodes();
  const auto moved = [&](double meters) {
    Poses poses = truth;
    for (auto& [time, T] : poses) T.pretranslate(Eigen::Vector3d(meters, 0, 0));
    return street.folder.write("moved.tum", textOf(poses)).string();
  };
  const ProgramRun far = street.map("far", with(intoTiles, moved(2000)));
  EXPECT_EQ(far.status, 1);
  EXPECT_TRUE(contains(far.errors, "no scan was found in the map that is there"));
  EXPECT_EQ(semantic_octree::loadMap(tiles).getNumLeafNodes(), leaves);

  const ProgramRun second = succeeded(street.map("second", with(intoTiles, moved(0.7))));
  EXPECT_TRUE(contains(second.output, "There is a map"));
  for (const auto& [time, T] : readPoses(street.folder.read("second/trajectory.tum")))
    EXPECT_LT(distance(T, std::prev(truth.upper_bound(time + 1e-4))->second), 0.15) << time;
  EXPECT_LT(double(semantic_octree::loadMap(tiles).getNumLeafNodes()), 1.2 * double(leaves));
}

TEST(Rawlog2SemanticMapWithSlam, mapsARawlogWithoutPoses) {
  const Street street;
  const auto bare = street.folder / "bare.rawlog";
  {
    mrpt::io::CFileGZOutputStream file(bare.string());
    auto archive = mrpt::serialization::archiveFrom(file);
    labeled_cloud::RawlogReader reader(street.rawlog);
    while (const auto entry = reader.next())
      for (const auto& observation : entry->observations)
        if (!std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(observation))
          archive << *observation;
  }
  const std::string out = (street.folder / "out").string();
  const Words arguments = {"--output",    out,  "--resolution", "0.2",
                           "--max-range", "20", bare.string()};
  EXPECT_EQ(runProgram("rawlog2semantic-map", arguments).status, 1) << "it needs poses";
  auto slam = arguments;
  slam.emplace_back("--slam");
  succeeded(runProgram("rawlog2semantic-map", slam));
  const Poses truth = readPoses(street.folder.read("street.tum")),
              found = readPoses(street.folder.read("out/trajectory.tum"));
  ASSERT_EQ(found.size(), 50u);
  for (const auto& [time, T] : found) {
    const auto& T_true = std::prev(truth.upper_bound(time + 1e-4))->second;
    EXPECT_LT(distance(truth.begin()->second * T, T_true), 0.1) << time;
  }
  slam.emplace_back("--static-pose");
  EXPECT_EQ(runProgram("rawlog2semantic-map", slam).status, 64) << "it moves, or it does not";
}

TEST(Rawlog2SemanticMapWithSlam, saysWhyAReferenceCannotBeUsed) {
  const Street street;
  const auto fails = [&](const std::string& reference, const std::string& why) {
    const ProgramRun run = street.map("out", {"--slam", "--reference", reference});
    EXPECT_EQ(run.status, 1) << run.errors;
    EXPECT_TRUE(contains(run.errors, reference));
    EXPECT_TRUE(contains(run.errors, why));
    EXPECT_FALSE(fs::exists(street.folder / "out"));
  };
  fails((street.folder / "none.semantic").string(), "No such file");
  const std::string other = (street.folder / "other.semantic").string();
  semantic_types::ClassTable things;
  things.add("thing", {1, 2, 3});
  semantic_octree::saveTree(SemanticOcTree(0.2, things), other);
  fails(other, "class table is another one");
  EXPECT_EQ(street.map("out", {"--reference", other}).status, 64) << "needs --slam";
}

TEST(Rawlog2SemanticMapWithSlam, scansThatTakeTimeAreDeskewedAlsoWherePosesAreRight) {
  const Street still, turning("1");  // a meter a turn
  ASSERT_EQ(still.map("out", {}).status, 0);
  const SemanticOcTree right = semantic_octree::loadTree(still.folder / "out/map.semantic");
  for (const Words& how : {Words{}, Words{"--slam"}}) {
    ASSERT_EQ(turning.map("out", how).status, 0);
    const auto map = semantic_octree::loadTree(turning.folder / "out/map.semantic");
    EXPECT_GT(shareOccupiedIn(right, map), 0.65) << how.size();
  }
}
