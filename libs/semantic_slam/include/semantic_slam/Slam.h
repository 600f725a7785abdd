#pragma once
#include <semantic_slam/PoseGraph.h>
#include <semantic_slam/Reference.h>
#include <semantic_slam/Registration.h>
#include <semantic_slam/SlamOptions.h>

#include <optional>
#include <vector>

namespace semantic_slam {

/** A trajectory from odometry and labeled scans, as a graph of keyframes' poses: each is registered
 * to those before it and, where the robot is back at a place, to those of then.
 *
 * Keyframes are numbered as by semantic_octree::KeyframeMap, which a map follows it with. */
class Slam {
 public:
  /** \throw std::invalid_argument bad options. */
  explicit Slam(const SlamOptions& options);

  /** Brings the trajectory into the frame of a map that is there already: the first keyframe and,
   * as with loops, each few meters another one are registered to it, too. Odometry begins within
   * some meters of where the robot is in it. The map is not needed afterwards.
   * \throw std::logic_error scans were added. */
  void setReference(const semantic_octree::SemanticOcTree& map);

  /** What became of a scan. */
  struct Added {
    std::size_t keyframe;  ///< that it belongs to
    Eigen::Isometry3d T_keyframe_robot;
    bool isNew = false;       ///< the keyframe begins with it
    bool posesMoved = false;  ///< those of earlier keyframes: by a loop, or the reference
  };
  /** \param cloud sensor frame \param T_odometry_robot where odometry says that it was taken */
  Added add(const LabeledCloud& cloud, const Eigen::Isometry3d& T_robot_sensor,
            const Eigen::Isometry3d& T_odometry_robot);

  /** Of all keyframes, T_map_keyframe; the first is where odometry, or the reference, had it. */
  const std::vector<Eigen::Isometry3d>& poses() const { return m_poses; }
  const std::vector<PoseEdge>& edges() const { return m_edges; }
  std::size_t numLoops() const { return m_numLoops; }
  /** Keyframes that were found in the reference. */
  std::size_t numReferenced() const { return m_numReferenced; }
  /** Keyframes for which odometry had to do. */
  std::size_t numLost() const { return m_numLost; }

 private:
  /** What one scan brings. */
  struct Seen {
    LabeledCloud cloud;  ///< thinned, frame of the robot
    Eigen::Isometry3d T_odometry_robot;
  };
  struct Keyframe {
    Seen seen;
    double way;                    ///< from the first one, m
    std::vector<float> histogram;  ///< of classes by distance; sums to 1
  };
  Seen seen(const LabeledCloud& cloud, const Eigen::Isometry3d& T_robot_sensor,
            const Eigen::Isometry3d& T_odometry_robot) const;
  void begin(Seen seen, const Eigen::Isometry3d& T_map_robot);
  /** Height and tilt are odometry's: as was said, or because no beam ever told of them. */
  bool isLevel() const { return m_options.level || m_isPlanar; }
  /** That height and tilt are known, frame of the robot. */
  Matrix6 levelOf(const Eigen::Isometry3d& T_odometry_robot) const;
  /** A scan was registered there. */
  void moveOn(const Eigen::Isometry3d& T_keyframe_robot, const Eigen::Isometry3d& T_odometry_robot);
  /** Where odometry and the last keyframes' points together have a scan. \param T_last_guess where
   * odometry has it, frame of the last keyframe
   * \return nothing: it fits badly, or says otherwise than odometry. */
  std::optional<Registration> track(const Seen& seen, const Eigen::Isometry3d& T_last_guess);
  /** Of a step, frame of its end. \param way meters \param T_step from beginning to end */
  Matrix6 odometryInformation(double way, const Eigen::Isometry3d& T_step) const;
  /** Height, roll and pitch as odometry has them. */
  Eigen::Isometry3d levelled(const Eigen::Isometry3d& T_map_robot,
                             const Eigen::Isometry3d& T_odometry_robot) const;
  /** What the reference says of a scan, if it does. \return T_submap_scan is T_map_robot */
  std::optional<Registration> findInReference(const Seen& seen,
                                              const Eigen::Isometry3d& T_map_guess);
  /** \return whether poses moved */
  bool followReference();
  bool closeLoop();
  /** Takes an edge of the newest keyframe if the one of its kind before it says the same of where
   * the robot is. \return whether poses moved */
  bool confirm(std::optional<PoseEdge>& before, const PoseEdge& edge);
  bool agree(const PoseEdge& before, const PoseEdge& edge) const;
  bool fits(const Registration& r) const;
  /** The likeliest place of a loop's other end; the newest keyframe if there is none. */
  std::size_t placeOfLoop() const;
  /** Of some keyframes' points, in the frame of one of them. */
  std::vector<Submap> submapsOf(std::size_t first, std::size_t last, std::size_t frame,
                                const std::vector<double>& cellSizes) const;
  Registration match(const std::vector<Submap>& submaps, const Seen& seen,
                     const Eigen::Isometry3d& T_submap_guess, const Matrix6& prior) const;

  SlamOptions m_options;
  bool m_isPlanar = true;  ///< all scans so far had horizontal beams only
  std::vector<Keyframe> m_keyframes;
  std::vector<Eigen::Isometry3d> m_poses;
  std::vector<PoseEdge> m_edges;
  std::size_t m_numLoops = 0, m_numReferenced = 0, m_numLost = 0;
  double m_lastLook = 0, m_lastReferenced = 0;      // m of the way
  std::optional<PoseEdge> m_lastLoop, m_lastFound;  ///< they may be wrong
  Reference m_reference;                            ///< none: there is no map
  Matrix6 m_mostOfReference = Matrix6::Zero();      ///< information, at most
  std::vector<Submap> m_nearby;  ///< of the last keyframes, in the frame of the last; or none yet
  /** Where the last scan that was registered was, in the last keyframe's frame, and where odometry
   * had it. */
  Eigen::Isometry3d m_T_keyframe_last, m_T_odometry_last;
};

}  // namespace semantic_slam
