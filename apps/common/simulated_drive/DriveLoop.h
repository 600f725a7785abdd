#pragma once
#include <map_folders/MapFolder.h>
#include <mrpt/obs/CObservation.h>
#include <synthetic_world/Scene.h>
#include <synthetic_world/World.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "DriveConfig.h"
#include "DriveRecord.h"

namespace simulated_drive {

/** Things that happen on the way, at times in seconds. */
struct Events {
  /** Somebody walks from one place to another, and stands there until the end, if there is one. */
  struct Person {
    double begin = 0, end = 1e9;
    Eigen::Vector2d from, to;
    double speed = 1.2;  ///< m/s
  };
  /** A barrier across a way. */
  struct Roadblock {
    double begin = 0;
    Eigen::Vector2d at;
    double yaw = 0, length = 3;  ///< radians, m
  };
  struct Span {
    double begin = 0, end = 0;
  };
  std::vector<Person> persons;
  std::vector<Roadblock> roadblocks;
  std::vector<Span> dropouts;  ///< no sensor sees anything

  synthetic_world::Solids at(const synthetic_world::World& world, double time) const;
  bool sensorsWork(double time) const;
};

/** "BEGIN,X,Y,X2,Y2" or "BEGIN,X,Y,X2,Y2,END" \throw std::invalid_argument */
Events::Person parsePerson(const std::string& text);
/** "BEGIN,X,Y,DEG,LENGTH" \throw std::invalid_argument */
Events::Roadblock parseRoadblock(const std::string& text);
/** "BEGIN,END" \throw std::invalid_argument */
Events::Span parseSpan(const std::string& text);

/** What one sensor saw, once. */
struct Observation : semantic_slam::SensorScan {
  mrpt::obs::CObservation::Ptr original;  ///< for the rawlog; null if not asked for
};

/** The camera and the LiDAR of the simulated robot. */
class SimulatedSensors {
 public:
  /** \param keepOriginals make MRPT's observations, too */
  SimulatedSensors(const SensorConfig& config, bool keepOriginals)
      : m_config(config), m_keepOriginals(keepOriginals) {}

  std::vector<Observation> sense(const synthetic_world::World& world,
                                 const Eigen::Isometry3d& T_world_robot);

 private:
  Observation camera(const synthetic_world::World& world, const Eigen::Isometry3d& T_world_robot);
  Observation lidar(const synthetic_world::World& world, const Eigen::Isometry3d& T_world_robot);

  SensorConfig m_config;
  bool m_keepOriginals;
  std::uint64_t m_frame = 0;
};

class DriveLoop;

/** What counts as a collision: whatever is higher than a step. */
synthetic_world::Footprint trueFootprint(const semantic_planning::VehicleOptions& vehicle);

/** Whoever looks on. */
class DriveObserver {
 public:
  virtual ~DriveObserver() = default;
  /** Sensors saw something, and the map has it, or will have (mapping_latency). */
  virtual void onSensed(const DriveLoop&, const std::vector<Observation>&) {}
  /** The control made a step. */
  virtual void onDriven(const DriveLoop&) {}
  /** At the end. */
  virtual void onFinished(const DriveLoop&) {}
};

/** The closed loop, in simulated time: the world is seen, and a Navigator drives the robot. The
 * same input makes the same drive, however fast the machine is. */
class DriveLoop {
 public:
  /** \param world changes as the events say
   * \param map what the robot knows at the start; none: nothing */
  DriveLoop(const DriveConfig& config, synthetic_world::World& world,
            const colored_graph::ClassOrder& order, const mrpt::math::TPose2D& start,
            const mrpt::math::TPose2D& goal, Events events,
            std::unique_ptr<semantic_octree::StoredMap> map = {},
            std::filesystem::path navlogs = {});

  void addObserver(DriveObserver& observer) { m_observers.push_back(&observer); }
  /** The drive ends when this says so. */
  void stopWhen(std::function<bool()> stop) { m_stop = std::move(stop); }
  /** Looks around instead of driving to the goal, see Navigator::explore(). */
  void explore(const std::optional<tree_abstraction::AbstractionWeights>& weights) {
    m_navigator.explore(weights);
    m_explores = true;
  }
  bool explores() const { return m_explores; }
  double leftToSee(double x, double y) { return m_navigator.leftToSee(x, y); }
  /** What changes in the map. */
  semantic_octree::MapFollower follow() { return m_map->tree().follow(); }
  void keepOriginals() { m_sensors = SimulatedSensors(m_config.sensors, true); }
  const DriveRecord& run();
  /** To another goal, from where it is, with a new record: then run() again. */
  void goOn(const mrpt::math::TPose2D& goal);

  double time() const { return m_time; }
  const DriveRecord& record() const { return m_record; }
  /** With the map; waits for the scan that is being inserted. */
  const semantic_slam::Mapper& mapper() const { return m_navigator.mapper(); }
  const semantic_driving::DriveGuide& guide() const { return m_navigator.guide(); }
  const semantic_driving::DriveController& controller() const { return m_navigator.controller(); }
  const mrpt::math::TPose2D& start() const { return m_start; }
  const mrpt::math::TPose2D& goal() const { return m_goal; }
  const DriveConfig& config() const { return m_config; }
  /** With the pose that the robot believes to have. */
  const semantic_driving::DriveState& state() const { return m_navigator.state(); }
  /** The true pose. */
  Eigen::Isometry3d T_world_robot() const;

 private:
  void begin();
  void sense();
  void move(const semantic_driving::DriveCommand& command);
  void updateRobot();
  void addRow();
  bool isOver();
  bool endAtGoal();
  bool end(DriveEnd end, const std::string& reason);
  bool endEarly(DriveEnd end, const std::string& why);
  double groundZ() const;
  void note(const std::string& stage, double milliseconds);

  DriveConfig m_config;
  synthetic_world::World& m_world;
  Events m_events;
  mrpt::math::TPose2D m_start, m_goal;
  SimulatedSensors m_sensors;
  std::unique_ptr<semantic_octree::StoredMap> m_map;
  semantic_slam::Mapper m_mapper;
  semantic_navigation::Navigator m_navigator;
  SimulatedRobot m_robot;
  SimulatedOdometry m_odometry;
  synthetic_world::Footprint m_footprint;
  DriveRecord m_record;
  std::vector<DriveObserver*> m_observers;
  std::function<bool()> m_stop;
  bool m_explores = false;
  double m_time = 0, m_lookedAt = -1e9, m_began = 0;
};

}  // namespace simulated_drive
