#pragma once
#include <semantic_abstraction/Abstraction.h>
#include <semantic_driving/DriveGuide.h>
#include <semantic_driving/ViewStrategy.h>
#include <semantic_slam/Mapper.h>
#include <strict_files/IniSection.h>

#include <filesystem>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

namespace semantic_navigation {

/** How a robot plans and drives. */
struct NavigatorOptions {
  semantic_planning::PlannerOptions planner;  ///< keepOff and shorten are on
  semantic_driving::DriveOptions drive;
  semantic_driving::GuideOptions guide;
  semantic_driving::DynamicObstacleOptions movers;
  semantic_driving::FocusOptions focus;
  semantic_driving::ExploreOptions explore;  ///< its sensor has to be set
  /** Seconds from a scan until the map has it. Above 0 a thread inserts it meanwhile, and is waited
   * for if it takes longer; the robot drives on by what was known before. */
  double mappingLatency = 0;
  std::filesystem::path reactive;   ///< MRPT's navigator (.ini), see config/reactive
  std::filesystem::path logFolder;  ///< of that navigator's logs; empty: none

  NavigatorOptions() { planner.ground.keepOff = planner.shorten = true; }
  /** What follows from the vehicle, its speed and the map: DriveOptions::setFor(), and how far it
   * looks for people and has detail. \param voxelSize meters */
  void setFor(double voxelSize);
  /** How far obstacles are looked for: all along the look-ahead, and beyond, where MRPT's navigator
   * chooses between ways; meters. */
  double obstacleRadius() const;
};

/** Reads the sections planner, drive, guide, movers, focus and explore, and checks them.
 * \param source as for strict_files::IniSection \param folder files are relative to it
 * \param drive what else [drive] may hold
 * \throw std::runtime_error naming section, key and value. */
template <class Source>
void readSections(const Source& source, const std::filesystem::path& folder,
                  strict_files::OptionList drive, NavigatorOptions& options) {
  std::string vehicle, reactive;
  strict_files::OptionList planner;
  planner.add("vehicle", vehicle, "", "file of the vehicle (.yaml)");
  options.planner.describe(planner);
  strict_files::readOptions(source, "planner", planner);
  if (!vehicle.empty()) options.planner.vehicle = semantic_planning::loadVehicle(folder / vehicle);
  options.planner.validate();
  options.drive.describe(drive);
  drive.add("reactive", reactive, "", "file of MRPT's reactive navigator (.ini)");
  drive.add("mapping_latency", options.mappingLatency, "s", strict_files::atLeast(0),
            "from a scan until the map has it; till then the robot drives by what it knew");
  strict_files::readOptions(source, "drive", drive);
  options.drive.validate();
  if (!reactive.empty()) options.reactive = (folder / reactive).lexically_normal();
  strict_files::readSection(source, "guide", options.guide);
  strict_files::readSection(source, "movers", options.movers);
  strict_files::readSection(source, "focus", options.focus);
  strict_files::readSection(source, "explore", options.explore);
}

/** Where odometry has the robot, and how it moves. */
struct RobotState {
  semantic_driving::DriveState drive;  ///< pose in the frame of odometry
  /** The robot's pose in space. The origin of its frame may be anywhere on it: how high that is
   * above the ground follows from what its sensors see. */
  Eigen::Isometry3d T_odometry_robot = Eigen::Isometry3d::Identity();
};

/** Drives a robot to goals over a map that grows meanwhile.
 *
 *     Mapper mapper(map, mapperOptions);
 *     Navigator navigator(mapper, order, options);
 *     navigator.setGoal(goal);
 *     while (navigator.isDriving()) {  // ten times a second
 *       navigator.update(robot);
 *       if (scanCame()) navigator.see(scans, seconds);
 *       sendToMotors(navigator.step(seconds));
 *     }
 *
 * What comes out depends on what goes in alone, not on how long threads take. Calls come from one
 * thread. Seconds are of one clock; where it goes back, or leaps by more than a minute, no time has
 * passed. MRPT's navigator takes mrpt::Clock. */
class Navigator {
 public:
  enum class Status {
    Idle,     ///< no goal was set
    Driving,  ///< or waiting, as long as there is hope
    Arrived,
    Nearest,      ///< at the pose nearest to the goal that fits (GuideOptions::driveToNearest)
    Unreachable,  ///< for good, see reason()
    Explored      ///< it explored, and that is over, see reason()
  };
  /** Is told how long a stage took, in milliseconds of its thread's processor time: localize,
   * focus, insert and update of a scan, movers, replan, obstacles, react. */
  using OnStage = std::function<void(const std::string& stage, double milliseconds)>;

  /** The map keeps from now on what tells the order's ranks apart (abstractionFor()).
   * \param mapper must outlive this; nobody else inserts \param order over the map's class ids
   * \throw std::exception bad options, or what MRPT does not like about its file. */
  Navigator(semantic_slam::Mapper& mapper, const colored_graph::ClassOrder& order,
            const NavigatorOptions& options);
  /** In the thread of whoever calls. */
  void onStage(OnStage onStage) { m_onStage = std::move(onStage); }

  /** Map frame. A robot that drives comes to rest first. */
  void setGoal(const mrpt::math::TPose2D& goal);
  /** From now on it looks around, without a goal, until it is over (Status::Explored).
   * \param weights of what it looks for; none: it drives to the nearest border of what is known
   * \throw std::invalid_argument bad options or weights. */
  void explore(const std::optional<tree_abstraction::AbstractionWeights>& weights) {
    explore(weights, m_options.explore);
  }
  /** Explores with other options from now on. */
  void explore(const std::optional<tree_abstraction::AbstractionWeights>& weights,
               const semantic_driving::ExploreOptions& options);
  /** Exploring is over, if it was not. \param why is part of reason(). Waits as mapper(). */
  void endExploring(const std::string& why = "it was ended");
  /** What looking at a column (map frame, meters) may still tell, nats; 0 without exploring. */
  double leftToSee(double x, double y);
  /** Where the robot is now. */
  void update(const RobotState& robot);
  /** What the sensors saw there. A scan that comes while another one is inserted is for the movers
   * alone. To be called also if nothing was seen for as long: the guide looks all the same. */
  void see(const std::vector<semantic_slam::SensorScan>& seen, double seconds);
  /** What the robot is to do now. The map gets what is due, the guide looks, if the sensors did. */
  semantic_driving::DriveCommand step(double seconds);
  /** Waits until the map has what was seen. */
  void finish();

  Status status() const;
  bool isDriving() const { return status() == Status::Driving; }
  bool hasArrived() const { return status() == Status::Arrived; }
  /** Why it is not at the goal, and will not be; what exploring that is over leaves. */
  std::string reason() const;
  /** Where the robot is in the map. */
  const semantic_driving::DriveState& state() const { return m_state; }
  /** How high the robot's frame is above the ground, m; none: no ground was seen yet. */
  std::optional<double> frameHeight() const { return m_height.meters(); }
  /** When the newest scan that the map has was taken, seconds without leaps; before all: far in the
   * past. */
  double mappedAt() const { return m_mappedAt; }
  /** Leaves of the compressed tree, as the planner knows it. Waits as mapper(). */
  std::size_t numCompressedLeaves();

  /** Waits for the scan that is being inserted. */
  const semantic_slam::Mapper& mapper() const { return waitedFor(); }
  /** The goal has to be set. */
  const semantic_driving::DriveGuide& guide() const { return *m_guide; }
  const semantic_driving::DriveController& controller() const { return m_controller; }

 private:
  bool isInserting() const { return m_inserting.valid(); }
  double withoutLeaps(double seconds) const;
  semantic_slam::Mapper& waitedFor() const;
  void insert(const std::vector<semantic_slam::SensorScan>& seen, double seconds);
  std::vector<semantic_slam::SensorScan> withoutPassing(
      std::vector<semantic_slam::SensorScan> seen) const;
  semantic_planning::StageTimes fill(const std::vector<semantic_slam::SensorScan>& seen,
                                     const semantic_slam::Mapper::Place& place,
                                     const std::vector<Eigen::Vector2d>& left, double seconds);
  void carve(const semantic_slam::Mapper::Place& at, const std::vector<Eigen::Vector2d>& left);
  semantic_slam::Mapper::Place locate(const std::vector<semantic_slam::SensorScan>& seen,
                                      double seconds);
  void focus();
  void correctState();
  bool mayGuide() const;
  void guide(double seconds);
  void chooseView();
  void conclude(const std::string& why);
  bool isTimeToChoose() const;
  /** \param unknown whatever is not known to be ground is an obstacle, too */
  semantic_driving::ObstaclePoints knownObstacles(double radius, bool unknown) const;
  semantic_driving::ObstaclePoints obstacles(double radius, bool unknown) const;
  void note(const std::string& stage, double milliseconds) const;

  NavigatorOptions m_options;
  semantic_slam::Mapper& m_mapper;
  semantic_planning::SemanticPlanner m_planner;
  semantic_octree::LeafFollower m_leaves;
  std::optional<semantic_driving::DriveGuide> m_guide;
  semantic_driving::DriveController m_controller;
  semantic_driving::DynamicObstacleTracker m_movers;
  std::unique_ptr<semantic_driving::ViewStrategy> m_views;  ///< null: it has a goal, or none
  std::optional<semantic_driving::View> m_view;             ///< the guide's goal, then
  double m_driven = 0, m_chosenAt = 0;                      ///< m
  std::string m_conclusion;                                 ///< of exploring that is over
  OnStage m_onStage;
  RobotState m_robot;
  semantic_driving::DriveState m_state;     ///< map frame
  double m_z = 0;                           ///< of the ground below it, map frame
  semantic_planning::FrameHeight m_height;  ///< by what the map had when the last scan was in it
  bool m_stands = false;                    ///< the map has what the robot stands on
  semantic_planning::FrameHeight m_fillsHeight;  ///< of the thread that fills the map
  bool m_guidesNext = false;                     ///< as soon as the map has what was seen
  bool m_restsFirst = false;                     ///< before it looks for a way to a new goal
  std::optional<double> m_steppedAt;             ///< seconds without leaps, as all that follow
  double m_leapt = 0;                            ///< seconds by which the clock did
  double m_mappedAt;
  double m_insertingFrom = 0;                 ///< when the scan that is being inserted was taken
  semantic_driving::ObstaclePoints m_before;  ///< known without that one, and the robot's pose then
  semantic_driving::ObstaclePoints m_roomBefore;
  mrpt::math::TPose2D m_beforeAt;
  std::future<semantic_planning::StageTimes> m_inserting;  ///< last: it uses the others
};

}  // namespace semantic_navigation
