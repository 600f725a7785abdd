// A node of rclcpp that maps labeled clouds, for those who compose nodes.
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_octree/TreeFile.h>
#include <strict_files/Words.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_components/register_node_macro.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <std_srvs/srv/trigger.hpp>
#include <tf2_eigen/tf2_eigen.hpp>

#include "OccupiedVoxels.h"
#include "Parameters.h"
#include "ScanQueue.h"
#include "point_fields/PointFields.h"

namespace semantic_map_ros2 {

using sensor_msgs::msg::PointCloud2;

constexpr std::chrono::milliseconds kStep{20};  // between looks at them

/** Maps the clouds of `points`, whose poses tf2 knows, by the runtime of semantic-map-ros2. It
 * publishes `~/occupied` and, with `slam`, the transform from map to odom. `~/save` writes the file
 * that `output` names, and so does the end. Its parameters are those of semantic-map-ros2; all else
 * is that program's alone. Everything runs in the executor's thread. */
class SemanticMapComponent : public rclcpp::Node {
 public:
  /** \throw std::runtime_error naming the parameter or file that is wrong */
  explicit SemanticMapComponent(const rclcpp::NodeOptions& options)
      : Node("semantic_map", options),
        m_output(
            declare_parameter("output", std::string(), describedAs("file of the map (.semantic)"))),
        m_parameters(declared()),
        m_map(m_parameters.newMap()),
        m_mapper(m_map, m_parameters.mapping()),
        m_scanClock(m_parameters.insertion.maxGap),
        m_queue(m_parameters.node, surroundings()) {
    m_hears = create_subscription<PointCloud2>(
        "points", rclcpp::SensorDataQoS().keep_last(50),
        [this](const PointCloud2::ConstSharedPtr& cloud) { add(cloud); });
    m_says = create_publisher<PointCloud2>("~/occupied", rclcpp::QoS(1).transient_local());
    m_saves = create_service<std_srvs::srv::Trigger>(
        "~/save", [this](std_srvs::srv::Trigger::Request::ConstSharedPtr,
                         std_srvs::srv::Trigger::Response::SharedPtr response) {
          response->message = save();
          response->success = response->message.empty();
        });
    m_inserts = create_wall_timer(kStep, [this] { insertWaiting(); });
    const double period = std::max(m_parameters.node.publishPeriod, kStep.count() * 1e-3);
    m_publishes = create_wall_timer(std::chrono::duration<double>(period), [this] { publish(); });
  }

  ~SemanticMapComponent() override {
    const std::string problem = m_scans == 0 || m_output.empty() ? "" : save();
    if (!problem.empty()) RCLCPP_ERROR(get_logger(), "%s", problem.c_str());
  }

 private:
  static rcl_interfaces::msg::ParameterDescriptor describedAs(const std::string& help) {
    rcl_interfaces::msg::ParameterDescriptor descriptor;
    descriptor.description = help;
    descriptor.dynamic_typing = true;  // 30 is as good as 30.0
    descriptor.read_only = true;
    return descriptor;
  }

  /** Declares the options of a section, and adds those that somebody set to the values. */
  template <class Options>
  void declare(const std::string& section, Options options) {
    strict_files::OptionList list;
    options.describe(list);
    for (const strict_files::Option& option : list.options()) {
      if (has_parameter(section + option.name)) continue;  // use_sim_time
      const auto unit = option.unit.empty() ? "" : " (" + option.unit + ")";
      const rclcpp::ParameterValue before(option.text());
      const auto value =
          declare_parameter(section + option.name, before, describedAs(option.help + unit));
      if (value != before) m_values.emplace_back(section + option.name, rclcpp::to_string(value));
    }
  }

  Parameters declared() {
    const Parameters defaults;
    declare("", defaults.node);
    declare("map.", defaults.map);
    declare("insertion.", defaults.insertion);
    declare("abstraction.", defaults.abstraction);
    declare("slam.", defaults.slam);
    for (const auto& [name, value] : get_node_parameters_interface()->get_parameter_overrides())
      if (!has_parameter(name) && name.rfind("qos_overrides.", 0) != 0)
        throw std::runtime_error("unknown parameter '" + name + "'" +
                                 strict_files::didYouMean(name, list_parameters({}, 0).names));
    return readParameters({}, m_values);
  }

  std::string save() try {
    if (m_output.empty()) return "the parameter output names no file";
    m_mapper.finish();
    saveTree(m_map, m_output);
    return "";
  } catch (const std::exception& e) {
    return strict_files::messageOf(e);
  }

  void warn(const std::string& problem) {
    RCLCPP_WARN_THROTTLE(get_logger(), *get_clock(), 5000, "%s", problem.c_str());
  }

  void add(const PointCloud2::ConstSharedPtr& cloud) {
    WaitingScan scan;
    scan.topic = m_hears->get_topic_name();
    scan.frame = cloud->header.frame_id;
    scan.stamp = rclcpp::Time(cloud->header.stamp).nanoseconds();
    scan.bytes = cloud->data.size();
    scan.read = [this, cloud] { return read(*cloud); };
    m_queue.push(std::move(scan));
  }

  semantic_slam::SensorScan read(const PointCloud2& message) {
    point_fields::RawCloud raw;
    for (const auto& f : message.fields) raw.fields.push_back({f.name, f.offset, f.datatype});
    raw.width = message.width, raw.height = message.height;
    raw.pointStep = message.point_step, raw.rowStep = message.row_step;
    raw.isBigEndian = message.is_bigendian;
    raw.data = message.data.data(), raw.size = message.data.size();
    std::string problem;
    semantic_slam::SensorScan scan;
    scan.cloud = cloudOf(raw, m_parameters.node.classField, m_map.classes(), problem);
    scan.times = timesOf(raw, rclcpp::Time(message.header.stamp).seconds());
    if (!problem.empty()) warn(problem);
    return scan;
  }

  Surroundings surroundings() {
    const auto find = [this](const std::string& target, const std::string& source,
                             Stamp stamp) -> Surroundings::Answer {
      try {
        return {tf2::transformToEigen(
                    m_transforms.lookupTransform(target, source, rclcpp::Time(stamp))),
                {}};
      } catch (const tf2::TransformException& e) {
        return {{}, e.what()};
      }
    };
    return {find, [this] { return Stamp(now().nanoseconds()); },
            [this](const std::string& what) { warn(what); }};
  }

  void insertWaiting() {
    while (m_queue.insertNext([this](const WaitingScan& waiting, const auto& scan,
                                     const Eigen::Isometry3d& T_world_robot) {
      const auto time = mrpt::Clock::fromDouble(double(waiting.stamp) * 1e-9);
      m_seconds += m_scanClock.secondsUntil(time);
      m_scanClock.note(time);
      m_mapper.insert(scan, T_world_robot, m_seconds);
      ++m_scans;
      m_stamp = rclcpp::Time(waiting.stamp);
      if (m_parameters.node.slam) sayCorrection();
    }))
      continue;
  }

  void sayCorrection() {
    geometry_msgs::msg::TransformStamped correction =
        tf2::eigenToTransform(m_mapper.T_map_odometry());
    correction.header.stamp = m_stamp;
    correction.header.frame_id = m_parameters.node.mapFrame;
    correction.child_frame_id = m_parameters.node.worldFrame();
    m_corrects.sendTransform(correction);
  }

  void publish() {
    if (m_scans == m_published || m_says->get_subscription_count() == 0) return;
    m_published = m_scans;
    const std::vector<PackedPoint> points = occupiedVoxels(m_map);
    auto message = std::make_unique<PointCloud2>();
    message->header.frame_id = m_parameters.node.mapFrame;
    message->header.stamp = m_stamp;
    for (const auto& [name, type] : fieldsOfPoint()) {
      sensor_msgs::msg::PointField field;
      field.name = name, field.datatype = type, field.count = 1;
      field.offset = std::uint32_t(4 * message->fields.size());
      message->fields.push_back(field);
    }
    message->height = 1, message->width = std::uint32_t(points.size());
    message->point_step = sizeof(PackedPoint);
    message->row_step = message->point_step * message->width;
    message->is_dense = true;
    message->data.resize(message->row_step);
    std::memcpy(message->data.data(), points.data(), message->row_step);
    m_says->publish(std::move(message));
  }

  std::string m_output;
  std::vector<std::pair<std::string, std::string>> m_values;  ///< of parameters that were set
  Parameters m_parameters;
  semantic_octree::SemanticOcTree m_map;
  semantic_slam::Mapper m_mapper;
  semantic_map::ObservationClock m_scanClock;
  double m_seconds = 0;  ///< that passed, by the clouds
  ScanQueue m_queue;
  std::size_t m_scans = 0, m_published = 0;
  rclcpp::Time m_stamp;  ///< of the last cloud
  tf2_ros::Buffer m_transforms{get_clock()};
  tf2_ros::TransformListener m_listener{m_transforms, this};
  tf2_ros::TransformBroadcaster m_corrects{this};
  rclcpp::Subscription<PointCloud2>::SharedPtr m_hears;
  rclcpp::Publisher<PointCloud2>::SharedPtr m_says;
  rclcpp::Service<std_srvs::srv::Trigger>::SharedPtr m_saves;
  rclcpp::TimerBase::SharedPtr m_inserts, m_publishes;
};

}  // namespace semantic_map_ros2

RCLCPP_COMPONENTS_REGISTER_NODE(semantic_map_ros2::SemanticMapComponent)
