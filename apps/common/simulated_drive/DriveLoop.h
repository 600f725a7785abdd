#pragma once
#include <synthetic_world/Scene.h>

#include <functional>
#include <future>

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
  /** Sensors saw something, and the map has it, or will have (mapping_latency). */
  virtual void onSensed(const DriveLoop&, const std::vector<Observation>&) {}
  /** The control made a step. */
  virtual void onDriven(const DriveLoop&) {}
  /** At the end. */
  virtual void onFinished(const DriveLoop&) {}
};

/** The closed loop, in simulated time: the world is seen, the map grows, plans change, the robot
 * drives. With a mapping latency a thread inserts each scan while the robot drives on by what was
 * known before it; a scan that comes meanwhile is not inserted. The same input makes the same
 * drive, however fast the machine is. */
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
  void keepOriginals() { m_sensors = SimulatedSensors(m_config.sensors, true); }
  const DriveRecord& run();

  double time() const { return m_time; }
  const DriveRecord& record() const { return m_record; }
  /** Waits for the scan that is being inserted, as the next one does. */
  const Mapper& mapper() const { return waitedFor(); }
  semantic_octree::SemanticOcTree compressedMap() const { return waitedFor().compressed(); }
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
  std::function<semantic_planning::StageTimes()> insertion(const std::vector<Observation>& seen);
  bool isInserting() const { return m_inserting.valid(); }
  void endInsertion();
  Mapper& waitedFor() const;
  void guide();
  bool wantsFineObstacles();
  semantic_driving::ObstaclePoints knownObstacles(double radius);
  semantic_driving::ObstaclePoints obstacles();
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
  double m_time = 0, m_lookedAt = -1e9, m_fineUntil = -1e9;
  bool m_guidesNext = false;                  ///< as soon as the map has what was seen
  double m_insertedFrom = -1e9;               ///< when the last scan that the map has was taken
  double m_insertingFrom = -1e9;              ///< and the one that is being inserted
  semantic_driving::ObstaclePoints m_before;  ///< known without that one, and the robot's pose then
  mrpt::math::TPose2D m_beforeAt;
  std::future<semantic_planning::StageTimes> m_inserting;  ///< last: it uses the others
};

}  // namespace simulated_drive
