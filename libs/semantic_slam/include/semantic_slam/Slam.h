#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_slam/PoseGraph.h>
#include <semantic_slam/SlamOptions.h>
#include <semantic_types/LabeledCloud.h>

#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace semantic_slam {

using semantic_types::LabeledCloud;

/** What one sensor saw, once. */
struct SensorScan {
  LabeledCloud cloud;  ///< sensor frame, meters
  Eigen::Isometry3d T_robot_sensor = Eigen::Isometry3d::Identity();
  /** Points at least this far from the sensor, m, stand for beams without a return: they carve, and
   * are no evidence of where the robot is. */
  double emptyFrom = std::numeric_limits<double>::infinity();
  /** When each point was taken, seconds after the time of the scan; empty: all at that time. */
  std::vector<float> times = {};
};

/** The scan as it would be if all points had been taken at one time, by a robot that goes on at
 * constant velocity. Points of that time keep their bits, and all if the velocity is zero.
 * \param velocity (m/s; rad/s), frame of the robot \param at seconds after the time of the scan
 * \throw std::invalid_argument there are times, but not one for each point */
SensorScan deskewed(SensorScan scan, const Vector6& velocity, double at = 0);

/** How a trajectory came about. */
struct SlamReport {
  std::size_t scans = 0, keyframes = 0;
  std::size_t lost = 0;        ///< scans that fit nothing: they are where odometry has them
  std::size_t torn = 0;        ///< places that nothing but a guess leads across
  std::size_t joined = 0;      ///< of these, those after which the robot was found again
  std::size_t loops = 0;       ///< edges to places of before
  std::size_t undone = 0;      ///< loops that contradicted the trajectory between their ends
  std::size_t open = 0;        ///< looks since the last loop that two places fit: none was closed
  std::size_t referenced = 0;  ///< keyframes that were found in the reference
  double way = 0;              ///< m
  double unheld = 0;           ///< of it, where scans did not hold the robot in each direction
  double apart = 0;     ///< m by which looks at places of before contradict the poses, at most
  double carried = 0;   ///< m, at most, from where odometry had the robot to where it was found
  double standing = 0;  ///< m that scans moved at most while odometry stood still as if off
  /** By how much odometry says more than the scans: of the way (0.1: 10 % too far), and of turns.
   */
  double wayError = 0, turnError = 0;
  bool hasOdometry = false;
  bool isPlanar = false;  ///< all beams are horizontal

  /** Sentences that say why the map is probably wrong, and what to try; none if nothing says so. */
  std::vector<std::string> warnings() const;
};

/** A trajectory from labeled scans, and from odometry where there is some, as a graph of keyframes'
 * poses. Each scan is registered to the keyframes before it. Where the robot may be back at a
 * place, the last stretch is searched in what was seen there, and registered to it.
 *
 * Keyframes are numbered as by semantic_octree::KeyframeMap, which a map follows it with. */
class Slam {
 public:
  /** \param folder for what loops are searched in, in a file that goes when this goes; empty: in
   * memory \throw std::invalid_argument bad options \throw std::runtime_error naming the folder:
   * it cannot be written to, now or later. */
  explicit Slam(const SlamOptions& options, const std::filesystem::path& folder = {});
  ~Slam();
  Slam(Slam&&) noexcept;

  /** Brings the trajectory into an existing map's frame: the first keyframe, and another each few
   * meters, are registered to it, too. Odometry begins within some meters of where the robot is in
   * it. The map is not needed afterwards.
   * \throw std::logic_error scans were added. */
  void setReference(const semantic_octree::SemanticOcTree& map);

  /** What became of a scan. */
  struct Added {
    std::size_t keyframe;  ///< that it belongs to
    Eigen::Isometry3d T_keyframe_robot;
    bool isNew = false;       ///< the keyframe begins with it
    bool posesMoved = false;  ///< those of earlier keyframes: by a loop, or the reference
    Vector6 velocity = Vector6::Zero();  ///< (m/s; rad/s), robot's frame: what to deskew it by
  };
  /** A scan whose points have times is deskewed, by how the robot moved since the scan before.
   * \param T_odometry_robot where odometry says that it was taken; none: the robot goes on as
   * before (constant velocity) \param seconds when it was taken, of any clock */
  Added add(const SensorScan& scan, const std::optional<Eigen::Isometry3d>& T_odometry_robot,
            double seconds = 0);
  Added add(const LabeledCloud& cloud, const Eigen::Isometry3d& T_robot_sensor,
            const std::optional<Eigen::Isometry3d>& T_odometry_robot) {
    return add({cloud, T_robot_sensor}, T_odometry_robot);
  }
  /** Brings all loops into the poses. \return whether poses moved */
  bool finish();

  /** Keyframes that may go: what they saw was seen from so many of before, and from so many later
   * ones that stay. The early ones hold the map where it is, the late ones say what is there now.
   * Neither the first nor the last ones; none while places are sought. */
  std::vector<std::size_t> outnumbered(std::size_t by) const;
  /** Takes keyframes out that may go, with their loops; those after them are numbered anew. Poses
   * stay, and each step is what they say, for loops that go have moved them. */
  void forget(const std::vector<std::size_t>& keyframes);

  /** T_map_keyframe of all keyframes; the first is where odometry had it, unless the reference says
   * where they are. */
  const std::vector<Eigen::Isometry3d>& poses() const;
  const std::vector<PoseEdge>& edges() const;
  SlamReport report() const;

 private:
  std::unique_ptr<class SlamEngine> m;
};

}  // namespace semantic_slam
