#include <gtest/gtest.h>
#include <labeled_cloud/LabelImage.h>
#include <labeled_cloud/Rawlogs.h>
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semantic_octree/TreeFile.h>
#include <semantic_types/ClassTable.h>

#include "LiveMap.h"
#include "RunProgram.h"

namespace {

namespace fs = std::filesystem;
using mrpt::obs::CObservation3DRangeScan;
using ros2::Stamp;

const fs::path kSources = MSO_SOURCE_DIR;

/** MRPT counts 100 ns since 1601. */
Stamp stampOf(mrpt::Clock::time_point time) {
  return (time.time_since_epoch().count() - 116'444'736'000'000'000) * 100;
}

/** config/maps/synthetic.ini as ROS has parameters. */
const char* kParameters = R"(
/**:
  ros__parameters:
    map: {resolution: 0.2, classes: CLASSES}
    insertion.max_range: 30.0
    insertion: {flying_pixel_threshold: 0.02}
    abstraction:
      relevant: "road+lane-marking: 1"
      irrelevant: "canopy+bush: 0.3, grass: 0.3"
      alpha: 0.002
)";

/** Sends what a rawlog holds, as ROS's drivers would. */
class Sender {
 public:
  Sender(LiveMap& live, const semantic_types::ClassTable& table)
      : m_live(live),
        m_converter(table),
        m_labels(table),
        m_points(live.node(), "points", {}),
        m_depth(live.node(), "depth/image", {}),
        m_labelImages(live.node(), "labels/image", {}),
        m_cameras(live.node(), "depth/camera_info", {}) {}

  void send(const mrpt::obs::CObservation& observation, const mrpt::poses::CPose3D& pose) {
    const Stamp stamp = stampOf(observation.timestamp);
    if (const auto* camera = dynamic_cast<const CObservation3DRangeScan*>(&observation))
      sendDepth(*camera, stamp);
    else
      sendPoints(observation, stamp);
    m_live.place("map", "base_link", labeled_cloud::toEigen(pose), stamp);
    m_live.waitForScans(++m_sent);
  }
  std::size_t sent() const { return m_sent; }

 private:
  void placeSensor(const mrpt::obs::CObservation& observation,
                   const Eigen::Isometry3d& T_sensor_frame) {
    if (!m_placed.insert(observation.sensorLabel).second) return;
    mrpt::poses::CPose3D pose;
    observation.getSensorPose(pose);
    m_live.place("base_link", observation.sensorLabel,
                 labeled_cloud::toEigen(pose) * T_sensor_frame, 0, true);
  }
  void sendPoints(const mrpt::obs::CObservation& observation, Stamp stamp) {
    placeSensor(observation, Eigen::Isometry3d::Identity());
    const auto scan = m_converter.convert(observation);
    m_live.send(m_points, PointMessage(scan->cloud, observation.sensorLabel, stamp).message());
  }
  void sendDepth(const CObservation3DRangeScan& scan, Stamp stamp) {
    Eigen::Isometry3d T_camera_optical = Eigen::Isometry3d::Identity();
    T_camera_optical.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    placeSensor(scan, T_camera_optical);
    scan.load();
    const auto labels = m_labels.label(scan);
    const auto& camera = scan.cameraParams;
    const std::string mm = "16UC1", mono = "mono8";
    std::vector<std::uint8_t> ranges, ids(labels->classes.begin(), labels->classes.end());
    for (unsigned row = 0; row < camera.nrows; ++row)
      for (unsigned col = 0; col < camera.ncols; ++col) {
        const std::uint16_t range = scan.rangeImage(row, col);
        ranges.push_back(std::uint8_t(range & 255)), ranges.push_back(std::uint8_t(range >> 8));
      }
    EXPECT_EQ(scan.rangeUnits, 0.001f);
    ros2::CameraInfo info{};
    info.header = ros2::headerOf(stamp, scan.sensorLabel);
    info.width = camera.ncols, info.height = camera.nrows;
    info.k[0] = camera.fx(), info.k[4] = camera.fy(), info.k[2] = camera.cx(),
    info.k[5] = camera.cy(), info.k[8] = 1;
    m_live.send(m_cameras, info);
    ros2::Image image{};
    image.header = info.header;
    image.width = camera.ncols, image.height = camera.nrows;
    image.encoding = ros2::textOf(mono), image.step = camera.ncols;
    ros2::refer(image.data, ids);
    m_live.send(m_labelImages, image);
    image.encoding = ros2::textOf(mm), image.step = 2 * camera.ncols;
    ros2::refer(image.data, ranges);
    m_live.send(m_depth, image);
  }

  LiveMap& m_live;
  labeled_cloud::ScanConverter m_converter;
  labeled_cloud::EmbeddedLabels m_labels;
  ros2::Publication<ros2::PointCloud2> m_points;
  ros2::Publication<ros2::Image> m_depth, m_labelImages;
  ros2::Publication<ros2::CameraInfo> m_cameras;
  std::set<std::string> m_placed;
  std::size_t m_sent = 0;
};

}  // namespace

TEST(SampleOverDds, makesTheMapOfTheRawlogToTheLastBit) {
  const fs::path rawlog = kSources / "rawlog-samples/village.rawlog";
  const std::string classes = (kSources / "config/classes/synthetic.yaml").string();
  std::string parameters = kParameters;
  parameters.replace(parameters.find("CLASSES"), 7, classes);
  const TemporaryFolder folder;
  LiveMap live({"--params-file", folder.write("p.yaml", parameters).string(), "-p",
                "transform_timeout:=100"});
  const auto table = semantic_types::loadClassTable(classes);
  Sender sender(live, table);
  const auto poses = labeled_cloud::readTrajectory({rawlog});
  labeled_cloud::RawlogReader reader(rawlog);
  while (const auto entry = reader.next())
    for (const auto& observation : entry->observations)
      if (labeled_cloud::ScanConverter::accepts(*observation) && !HasFailure())
        sender.send(*observation, *poses.at(observation->timestamp));
  ASSERT_EQ(live.end(), kStopped) << live.said();
  EXPECT_EQ(sender.sent(), 48u);

  succeeded(runProgram("rawlog2semantic-map",
                       {"--config", (kSources / "config/maps/synthetic.ini").string(), "-o",
                        (folder / "out").string(), rawlog.string()}));
  EXPECT_TRUE(live.map() == semantic_octree::loadTree((folder / "out/map.semantic").string()));
  EXPECT_TRUE(live.folder.read("map.semantic") == folder.read("out/map.semantic"));
}
