#pragma once
#include <synthetic_world/Scene.h>

#include <functional>

#include "DriveRecord.h"
#include "Events.h"
#include "Localization.h"
#include "Mapper.h"
#include "SimulatedRobot.h"

namespace simulated_drive {

class DriveLoop;

/** What counts as a collision: whatever is higher than a step. */
synthetic_world::Footprint trueFootprint(const semantic_planning::VehicleOptions& vehicle);

/** Whoever looks on. */
class DriveObserver {
 public:
  virtual ~DriveObserver() = default;
  /** Sensors saw something, and the map has it. */
  virtual void onSensed(const DriveLoop&, const std::vector<Observation>&) {}
  /** The control made a step. */
  virtual void onDriven(const DriveLoop&) {}
  /** At the end. */
  virtual void onFinished(const DriveLoop&) {}
};

/** The closed loop, in simulated time: the world is seen, the map grows, plans change, the robot
 * drives. The same input makes the same drive, however fast the machine is. */
class DriveLoop {
 public:
  /** \param world changes as the events say
   * \param map what the robot knows at the start; none: nothing */
  DriveLoop(const DriveConfig& config, synthetic_world::World& world,
            const colored_graph::ClassOrder& order, const mrpt::math::TPose2D& start,
            const mrpt::math::TPose2D& goal, Events events,
            std::optional<semantic_octree::SemanticOcTree> map = {},
            std::filesystem::path navlogs = {});

  void addObserver(DriveObserver& observer) { m_observers.push_back(&observer); }
  /** The drive ends when this says so. */
  void stopWhen(std::function<bool()> stop) { m_stop = std::move(stop); }
  void keepOriginals() { m_sensors = SimulatedSensors(m_config.sensors, true); }
  const DriveRecord& run();

  double time() const { return m_time; }
  const DriveRecord& record() const { return m_record; }
  const Mapper& mapper() const { return *m_mapper; }
  semantic_octree::SemanticOcTree compressedMap() const { return m_mapper->compressed(); }
  const semantic_driving::DriveGuide& guide() const { return *m_guide; }
  const semantic_driving::DriveController& controller() const { return m_controller; }
  const mrpt::math::TPose2D& start() const { return m_start; }
  const mrpt::math::TPose2D& goal() const { return m_goal; }
  const DriveConfig& config() const { return m_config; }
  /** With the pose that the robot believes to have. */
  const semantic_driving::DriveState& state() const { return m_state; }
  /** The true pose. */
  Eigen::Isometry3d T_world_robot() const;

 private:
  void sense();
  void focus();
  void insert(const std::vector<Observation>& seen);
  void guide();
  bool wantsFineObstacles();
  void drive();
  void move(const semantic_driving::DriveCommand& command);
  void addRow();
  bool isOver();
  void endAtGoal();
  Eigen::Isometry3d T_level_robot() const;
  Eigen::Isometry3d T_map_robot() const;
  double groundZ() const;
  void note(const std::string& stage, double milliseconds) {
    m_record.times[stage].push_back(milliseconds);
  }

  DriveConfig m_config;
  synthetic_world::World& m_world;
  Events m_events;
  mrpt::math::TPose2D m_start, m_goal;
  SimulatedSensors m_sensors;
  std::unique_ptr<Mapper> m_mapper;
  std::unique_ptr<semantic_driving::DriveGuide> m_guide;
  semantic_driving::DriveController m_controller;
  semantic_driving::MoverTracker m_movers;
  SimulatedRobot m_robot;
  Localization m_pose;
  semantic_driving::DriveState m_state;
  synthetic_world::Footprint m_footprint;
  DriveRecord m_record;
  std::vector<DriveObserver*> m_observers;
  std::function<bool()> m_stop;
  double m_time = 0, m_sensedAt = -1e9, m_lookedAt = -1e9, m_fineUntil = -1e9;
};

}  // namespace simulated_drive
