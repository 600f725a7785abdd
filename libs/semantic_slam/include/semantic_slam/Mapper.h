#pragma once
#include <map_correction/KeyframeMap.h>
#include <map_operations/Calibrator.h>
#include <semantic_slam/Slam.h>

#include <cstddef>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace semantic_slam {

/** What a Mapper does with scans. */
struct MapperOptions {
  semantic_octree::InsertionOptions insertion;
  /** Scans are registered to each other, loops are closed, and the map follows. Without, odometry
   * is believed. */
  bool localize = false;
  SlamOptions slam;
  /** With `localize`: of the scans that begin no keyframe each n-th is inserted; 1: all. With more,
   * a robot that waits does not become ever surer of what may go away. */
  int insertEvery = 1;
  /** With `localize`: a folder for the scans that a closed loop may move, and for what loops are
   * searched in; empty: the former are temporary files, the latter in memory. */
  std::filesystem::path scans;
  /** With `localize`: from so many keyframes on, those go with what they saw that others outnumber
   * (Slam::outnumbered()). So what is kept grows with the ground, not with the way of a robot that
   * drives on and on. Fewer take no memory to speak of. For logs, which end: SIZE_MAX. */
  std::size_t forgetsFrom = 1000;
};

/** Keeps a robot's map and where the robot is in it. Scans are registered to keyframes that do not
 * change, not to the map made of them. So a pose's error does not come back as evidence for it.
 * What the map states is calibrated (Calibrator) by the labels until 4, 8, 16 ... scans, and until
 * keyframes move. One thread finds this out. The map states so from the next of these times on, on
 * slow machines as on fast ones, and from finish() on. */
class Mapper {
 public:
  /** With `localize`, the mapper alone may change an empty map (but for its abstraction), which
   * follows when poses move. One with content is not moved, and poses are in its frame.
   * \param map must outlive the mapper \param reference another map in whose frame poses are to
   * be, see Slam; not needed afterwards
   * \throw std::invalid_argument bad options \throw std::runtime_error as KeyframeMap. */
  Mapper(semantic_octree::SemanticOcTree& map, const MapperOptions& options,
         const semantic_octree::SemanticOcTree* reference = nullptr);

  /** \param isMover by class id: its points are no evidence of where the robot is. */
  void setMovers(std::vector<bool> isMover) { m_isMover = std::move(isMover); }

  /** Where a scan was taken. */
  struct Place {
    Eigen::Isometry3d T_map_robot;
    std::optional<Slam::Added> added;    ///< to the keyframes, if it localizes
    Vector6 velocity = Vector6::Zero();  ///< (m/s; rad/s), robot's frame: what to deskew scans by
  };
  /** Scans of sensors, seen at a time, that are in the map now. */
  struct Inserted {
    Place place;
    std::vector<semantic_octree::InsertionReport> scans;  ///< none: left out (`insertEvery`)
  };

  /** locate() and insert(), see there. */
  Inserted insert(const LabeledCloud& cloud, const Eigen::Isometry3d& T_robot_sensor,
                  const std::optional<Eigen::Isometry3d>& T_odometry_robot, double seconds) {
    return insert({cloud, T_robot_sensor}, T_odometry_robot, seconds);
  }
  Inserted insert(const SensorScan& scan, const std::optional<Eigen::Isometry3d>& T_odometry_robot,
                  double seconds) {
    const std::vector<SensorScan> seen = {scan};
    return insert(seen, locate(seen, T_odometry_robot, seconds), seconds);
  }
  /** Finds where scans were taken, and closes loops. T_map_odometry() knows at once, the map with
   * insert(), which has to follow, before the next locate().
   * \param T_odometry_robot of the robot's frame when they were taken; with SlamOptions::level its
   * height and tilt are right. None: with `localize` scans alone tell where the robot is, and
   * T_map_odometry() stays
   * \param seconds when they were taken, of any clock: how fast the robot was follows from it
   * \throw std::invalid_argument there is none, and no `localize` */
  Place locate(const std::vector<SensorScan>& seen,
               const std::optional<Eigen::Isometry3d>& T_odometry_robot, double seconds = 0);
  /** The robot is elsewhere than it was found to be, as a person says, or before the first scan
   * somewhere else than where odometry begins. The next scan is registered to the map from there.
   * What was inserted until now moves no more: it is the map in whose frame poses are.
   * \throw std::logic_error without `localize` */
  void relocalize(const Eigen::Isometry3d& T_map_odometry);
  /** Inserts what was seen at once, deskewed where points have times, or leaves it out; moves
   * keyframes, if a loop was closed. The map ages by the time since the last scan. Another thread
   * may do it, as long as none reads the map. \param seconds when they were taken, of any clock
   * \throw std::exception as SemanticOcTree::insert() */
  Inserted insert(const std::vector<SensorScan>& seen, const Place& place, double seconds);
  /** Adds what the robot stands on, and its sensors do not see.
   * \param points in the robot's frame; nothing is carved \param place of the last insert() */
  void insertBelow(const LabeledCloud& points, const Place& place);
  /** Carves what is within a radius (meters) of a point, as if it had been seen to be free: of what
   * sensors do not see, but is known all the same. \param p in the robot's frame, meters
   * \param place of the last insert() */
  void insertFree(const Eigen::Vector3d& p, double radius, const Place& place);
  /** The map ages until then, see SemanticOcTree::age(). */
  void age(double seconds);
  /** Moves keyframes that are off by less than it is worth on the way: the map is then that of
   * slam()'s poses, to the last bit. */
  void finish();

  /** ROS's transform from "map" to "odom": identity, and with `localize` what scans correct. */
  const Eigen::Isometry3d& T_map_odometry() const { return m_T_map_odometry; }
  /** Null without `localize`. */
  const Slam* slam() const { return m_slam ? &*m_slam : nullptr; }
  semantic_octree::SemanticOcTree& map() { return m_map; }
  const semantic_octree::SemanticOcTree& map() const { return m_map; }

 private:
  Slam::Added addToSlam(const std::vector<SensorScan>& seen,
                        const std::optional<Eigen::Isometry3d>& T_odometry_robot, double seconds);
  SensorScan evidenceOf(const std::vector<SensorScan>& seen) const;
  bool isLeftOut(const Place& place);
  semantic_octree::InsertionReport insertAt(const Place& place, const LabeledCloud& cloud,
                                            const Eigen::Isometry3d& T_robot_cloud,
                                            const semantic_octree::InsertionOptions& options,
                                            double secondsSince);
  void moveKeyframes(double meters);
  void forget();
  void calibrate();
  void stateCalibrated();
  double secondsUntil(double seconds) const;

  semantic_octree::SemanticOcTree& m_map;
  MapperOptions m_options;
  std::vector<bool> m_isMover;
  std::optional<Slam> m_slam;
  std::unique_ptr<semantic_octree::KeyframeMap> m_keyframes;  ///< if the map may be corrected
  std::vector<semantic_octree::KeyframeId> m_ids;             ///< in it, of m_slam's keyframes
  std::size_t m_forgetAt;                                     ///< keyframes
  Eigen::Isometry3d m_T_map_odometry = Eigen::Isometry3d::Identity();
  /** What Slam takes for odometry's frame. */
  Eigen::Isometry3d m_T_start_odometry = Eigen::Isometry3d::Identity();
  /** Without `localize`: where odometry had the robot, and when; and how fast it was since then. */
  std::optional<std::pair<Eigen::Isometry3d, double>> m_last;
  Vector6 m_velocity = Vector6::Zero();
  int m_leftOut = 0;  ///< scans since the last that was inserted
  semantic_octree::Calibrator m_calibrator;
  std::size_t m_numScans = 0, m_calibrateAt = 4;
  std::future<semantic_octree::Calibration> m_calibration;  ///< until the next is due
  std::optional<double> m_agedAt;                           ///< seconds
};

}  // namespace semantic_slam
