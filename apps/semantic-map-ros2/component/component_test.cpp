// The component as a container loads it, and a node that publishes clouds of a floor, in one
// process.
#include <semantic_octree/TreeFile.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>
#include <class_loader/class_loader.hpp>

#include <cmath>
#include <iostream>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_components/node_factory.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <sensor_msgs/point_cloud2_iterator.hpp>
#include <set>
#include <std_srvs/srv/trigger.hpp>

namespace {

using namespace std::chrono_literals;
using sensor_msgs::msg::PointCloud2;
using sensor_msgs::msg::PointField;

const char* const kMapFile = "component.semantic";
constexpr double kResolution = 0.2, kSensorHeight = 1.5;
constexpr std::uint16_t kRoad = 1;  // raw id in config/classes/synthetic.yaml

geometry_msgs::msg::TransformStamped stampedTransform(const rclcpp::Time& stamp, const char* frame,
                                                      const char* child, double x, double z) {
  geometry_msgs::msg::TransformStamped T;
  T.header.stamp = stamp;
  T.header.frame_id = frame;
  T.child_frame_id = child;
  T.transform.translation.x = x;
  T.transform.translation.z = z;
  T.transform.rotation.w = 1;
  return T;
}

/** A floor of road, 4 x 4 m, under the middle of voxels. */
PointCloud2 floorCloud(const rclcpp::Time& stamp) {
  PointCloud2 cloud;
  cloud.header.stamp = stamp;
  cloud.header.frame_id = "lidar";
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2Fields(4, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "z", 1,
                                PointField::FLOAT32, "label", 1, PointField::UINT16);
  modifier.resize(40 * 40);
  sensor_msgs::PointCloud2Iterator<float> x(cloud, "x");
  sensor_msgs::PointCloud2Iterator<std::uint16_t> label(cloud, "label");
  for (int i = 0; i < 40 * 40; ++i, ++x, ++label) {
    x[0] = float(1.05 + i / 40 * 0.1), x[1] = float(-1.95 + i % 40 * 0.1);
    x[2] = float(0.1 - kSensorHeight);
    *label = kRoad;
  }
  return cloud;
}

std::shared_ptr<rclcpp_components::NodeFactory> factoryOf(class_loader::ClassLoader& loader) {
  return loader.createInstance<rclcpp_components::NodeFactory>(
      "rclcpp_components::NodeFactoryTemplate<semantic_map_ros2::SemanticMapComponent>");
}

template <class Value>
rclcpp::NodeOptions optionsWith(const std::string& name, const Value& value) {
  rclcpp::NodeOptions options;
  options.use_intra_process_comms(true);
  options.parameter_overrides({{"map.classes", SEMANTIC_CONFIG "/classes/synthetic.yaml"},
                               {"map.resolution", kResolution},
                               {"publish_period", 0.1},
                               {"output", kMapFile},
                               {name, value}});
  return options;
}

int failures = 0;
void expect(bool holds, const std::string& what) {
  if (holds) return;
  std::cerr << "FAILED: " << what << std::endl;
  ++failures;
}

void refusesUnknownParameters(rclcpp_components::NodeFactory& factory) try {
  factory.create_node_instance(optionsWith("insertion.max_rnge", 9.0));
  expect(false, "an unknown parameter is refused");
} catch (const std::exception& e) {
  expect(std::string(e.what()).find("insertion.max_rnge") != std::string::npos, e.what());
}

/** A component and a node that speaks to it, in one executor. */
struct Composed {
  Composed(rclcpp_components::NodeFactory& factory, const rclcpp::NodeOptions& options)
      : component(factory.create_node_instance(options)) {
    executor.add_node(component.get_node_base_interface());
    executor.add_node(peer);
  }
  void spinFor(std::chrono::milliseconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    while (std::chrono::steady_clock::now() < end) executor.spin_once(5ms);
  }

  rclcpp_components::NodeInstanceWrapper component;
  std::shared_ptr<rclcpp::Node> peer = std::make_shared<rclcpp::Node>("peer");
  rclcpp::executors::SingleThreadedExecutor executor;
};

void mapsAFloor(rclcpp_components::NodeFactory& factory) {
  Composed composed(factory, optionsWith("insertion.max_range", 30));  // whole, though a double
  const auto& peer = composed.peer;
  tf2_ros::StaticTransformBroadcaster fixed(peer);
  tf2_ros::TransformBroadcaster moving(peer);
  const auto clouds = peer->create_publisher<PointCloud2>("points", rclcpp::SensorDataQoS());
  PointCloud2::ConstSharedPtr occupied;
  const auto hears = peer->create_subscription<PointCloud2>(
      "/semantic_map/occupied", rclcpp::QoS(1).transient_local(),
      [&](PointCloud2::ConstSharedPtr message) { occupied = message; });
  const auto saves = peer->create_client<std_srvs::srv::Trigger>("/semantic_map/save");

  fixed.sendTransform(stampedTransform(peer->now(), "base_link", "lidar", 0, kSensorHeight));
  const auto floor = [&] { return occupied && occupied->width == 400; };
  for (int i = 0; i < 50 && !floor(); ++i) {
    const rclcpp::Time now = peer->now();
    clouds->publish(floorCloud(now));  // before its transform: it has to wait
    composed.spinFor(60ms);
    moving.sendTransform(stampedTransform(now, "map", "base_link", 0, 0));
    composed.spinFor(20ms);
  }
  expect(bool(occupied), "the map is published");
  if (!occupied) return;
  expect(occupied->width == 400, "20 x 20 voxels, not " + std::to_string(occupied->width));
  expect(occupied->header.frame_id == "map", "in the map's frame");
  sensor_msgs::PointCloud2ConstIterator<float> x(*occupied, "x");
  sensor_msgs::PointCloud2ConstIterator<std::uint32_t> label(*occupied, "label");
  std::set<std::uint32_t> labels;
  double low = INFINITY, high = -INFINITY;
  for (; x != x.end(); ++x, ++label) {
    low = std::min<double>(low, x[2]), high = std::max<double>(high, x[2]);
    labels.insert(*label);
  }
  expect(labels.size() == 1, "one class");
  expect(std::abs(low - 0.1) < 1e-6 && std::abs(high - 0.1) < 1e-6, "at the floor's height");

  auto answer = saves->async_send_request(std::make_shared<std_srvs::srv::Trigger::Request>());
  expect(composed.executor.spin_until_future_complete(answer, 5s) ==
                 rclcpp::FutureReturnCode::SUCCESS &&
             answer.get()->success,
         "the map is saved");
  expect(semantic_octree::loadTree(kMapFile).getNumLeafNodes() > 400, "with what was seen");
}

}  // namespace

int main(int argc, char** argv) {
  rclcpp::init(argc, argv);
  class_loader::ClassLoader loader(COMPONENT_LIBRARY);
  {
    const auto factory = factoryOf(loader);
    refusesUnknownParameters(*factory);
    mapsAFloor(*factory);
  }
  rclcpp::shutdown();
  return failures == 0 ? 0 : 1;
}
