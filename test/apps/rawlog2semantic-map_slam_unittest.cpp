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
#include <memory>
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

/** A drive along the village's street, and what is not known of it. */
class Street : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<TemporaryFolder>();
    drive("street.rawlog");
    truth = readPoses(folder->read("street.tum"));
  }
  static void TearDownTestSuite() { folder = nullptr; }

  static std::string path(const std::string& name) { return (*folder / name).string(); }
  static void drive(const std::string& rawlog, const Words& more = {}) {
    succeeded(runProgram(
        "synth-rawlog",
        joined({"-o", path(rawlog), "--scene", "village", "--sensor", "lidar", "--frames", "50",
                "--rate", "1", "--speed", "1", "--rings", "32", "--columns", "360"},
               more)));
  }
  static ProgramRun map(const std::string& output, const Words& more,
                        const std::string& rawlog = "street.rawlog") {
    return runProgram("rawlog2semantic-map", joined({"-f", "--output", path(output), "--resolution",
                                                     "0.2", "--max-range", "20", path(rawlog)},
                                                    more));
  }
  /** With --slam, by odometry that has these poses. */
  static ProgramRun mapBy(const Poses& odometry, const std::string& output, const Words& more) {
    const auto file = folder->write("odometry.tum", textOf(odometry)).string();
    return map(output, joined({"--slam", "--trajectory", file}, more));
  }
  static void expectTruth(const std::string& output, double within,
                          const Eigen::Isometry3d& T = Eigen::Isometry3d::Identity()) {
    const Poses found = readPoses(folder->read(output + "/trajectory.tum"));
    EXPECT_EQ(found.size(), truth.size()) << "each scan has a pose";
    for (const auto& [time, T_found] : found)  // to a microsecond
      EXPECT_LT(distance(T * T_found, std::prev(truth.upper_bound(time + 1e-4))->second), within)
          << time;
  }
  static nlohmann::json slamOf(const std::string& output) {
    return nlohmann::json::parse(folder->read(output + "/summary.json"))["slam"];
  }

  static inline std::unique_ptr<TemporaryFolder> folder;
  static inline Poses truth;
};

}  // namespace

TEST_F(Street, isMappedIntoTilesAsInMemoryAndTheNextDriveIsFoundThere) {
  const std::string tiles = path("tiles");
  const Words intoTiles = {"--tiles", tiles, "--tile-size", "12.8", "--memory", "0.1"};
  succeeded(mapBy(drifting(truth), "plain", {}));
  expectTruth("plain", 0.15);
  EXPECT_EQ(slamOf("plain")["torn"], 0);
  EXPECT_TRUE(slamOf("plain")["warnings"].empty()) << slamOf("plain")["warnings"];
  EXPECT_EQ(std::distance(fs::directory_iterator(path("plain")), {}), 5);
  succeeded(mapBy(drifting(truth), "tiled", intoTiles));
  EXPECT_TRUE(semantic_octree::loadMap(tiles) ==
              semantic_octree::loadTree(path("plain/map.semantic")));
  EXPECT_EQ(folder->read("tiled/trajectory.tum"), folder->read("plain/trajectory.tum"));

  const std::size_t leaves = semantic_octree::loadMap(tiles).getNumLeafNodes();
  const auto moved = [&](double meters) {
    Poses poses = truth;
    for (auto& [time, T] : poses) T.pretranslate(Eigen::Vector3d(meters, 0, 0));
    return poses;
  };
  expectRefusal(mapBy(moved(2000), "far", intoTiles),
                {"no scan was found in the map that is there"});
  EXPECT_EQ(semantic_octree::loadMap(tiles).getNumLeafNodes(), leaves);
  const ProgramRun second = succeeded(mapBy(moved(0.7), "second", intoTiles));
  EXPECT_TRUE(contains(second.output, "There is a map"));
  expectTruth("second", 0.15);
  EXPECT_LT(double(semantic_octree::loadMap(tiles).getNumLeafNodes()), 1.2 * double(leaves));
}

TEST_F(Street, isBroughtIntoTheFrameOfAMap) {
  succeeded(map("before", {}));
  // Odometry drifts, and begins 1.2 m and 3 degrees beside where it is in that map.
  Poses odometry = drifting(truth);
  const Eigen::Isometry3d T_first = truth.begin()->second;
  const Eigen::Isometry3d T_off = T_first * Eigen::Translation3d(1, -0.6, 0.1) *
                                  Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitZ()) *
                                  T_first.inverse();
  for (auto& [time, T] : odometry) T = T_off * T;
  succeeded(mapBy(odometry, "after", {"--reference", path("before/map.semantic")}));
  expectTruth("after", 0.1);
  EXPECT_GT(slamOf("after")["referenced"], 10);
  EXPECT_EQ(slamOf("after")["loops"], 0);
}

TEST_F(Street, isMappedWithoutPoses) {
  {
    mrpt::io::CFileGZOutputStream file(path("bare.rawlog"));
    auto archive = mrpt::serialization::archiveFrom(file);
    labeled_cloud::RawlogReader reader(path("street.rawlog"));
    while (const auto entry = reader.next())
      for (const auto& observation : entry->observations)
        if (!std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(observation))
          archive << *observation;
  }
  EXPECT_EQ(map("bare", {}, "bare.rawlog").status, 1) << "it needs poses";
  succeeded(map("bare", {"--slam"}, "bare.rawlog"));
  expectTruth("bare", 0.1, truth.begin()->second);
  EXPECT_EQ(map("bare", {"--slam", "--static-pose"}, "bare.rawlog").status, 64)
      << "it moves, or it does not";
}

TEST_F(Street, saysWhyAReferenceCannotBeUsed) {
  const std::string other = path("other.semantic"), none = path("none.semantic");
  semantic_types::ClassTable things;
  things.add("thing", {1, 2, 3});
  semantic_octree::saveTree(SemanticOcTree(0.2, things), other);
  for (const auto& [reference, why] :
       {std::pair(none, "No such file"), {other, "class table is another one"}}) {
    const ProgramRun run = map("out", {"--slam", "--reference", reference});
    EXPECT_EQ(run.status, 1) << run.errors;
    EXPECT_TRUE(contains(run.errors, reference) && contains(run.errors, why)) << run.errors;
    EXPECT_FALSE(fs::exists(path("out")));
  }
  EXPECT_EQ(map("out", {"--reference", other}).status, 64) << "needs --slam";
}

TEST_F(Street, isDeskewedWhereScansTakeTimeAlsoIfPosesAreRight) {
  drive("turning.rawlog", {"--turn-time", "1"});  // a meter a turn
  succeeded(map("still", {}));
  const SemanticOcTree right = semantic_octree::loadTree(path("still/map.semantic"));
  for (const Words& how : {Words{}, Words{"--slam"}}) {
    succeeded(map("turning", how, "turning.rawlog"));
    const auto map = semantic_octree::loadTree(path("turning/map.semantic"));
    EXPECT_GT(shareOccupiedIn(right, map), 0.65) << how.size();
  }
}
