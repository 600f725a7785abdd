#pragma once
#include <semantic_octree/KeyframeMap.h>
#include <semantic_slam/PoseGraph.h>
#include <semantic_slam/Registration.h>
#include <semantic_slam/SlamOptions.h>

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

  /** What became of a scan. */
  struct Added {
    std::size_t keyframe;  ///< that it belongs to
    Eigen::Isometry3d T_keyframe_robot;
    bool isNew = false;       ///< the keyframe begins with it
    bool loopClosed = false;  ///< poses of earlier keyframes are not what they were
  };
  /** \param cloud sensor frame \param T_odometry_robot where odometry says that it was taken */
  Added add(const LabeledCloud& cloud, const Eigen::Isometry3d& T_robot_sensor,
            const Eigen::Isometry3d& T_odometry_robot);

  /** Of all keyframes, T_map_keyframe; the first is where odometry had it. */
  const std::vector<Eigen::Isometry3d>& poses() const { return m_poses; }
  const std::vector<PoseEdge>& edges() const { return m_edges; }
  std::size_t numLoops() const { return m_numLoops; }
  /** Keyframes for which odometry had to do. */
  std::size_t numLost() const { return m_numLost; }

 private:
  struct Keyframe {
    Eigen::Isometry3d T_odometry_keyframe;
    double way;                    ///< from the first one, m
    LabeledCloud cloud;            ///< thinned, frame of the keyframe
    std::vector<float> histogram;  ///< of classes by distance; sums to 1
  };
  void begin(const LabeledCloud& cloud, const Eigen::Isometry3d& T_robot_sensor,
             const Eigen::Isometry3d& T_odometry_robot);
  void connect();
  bool closeLoop();
  /** The likeliest place of a loop's other end; the newest keyframe if there is none. */
  std::size_t placeOfLoop() const;
  /** Of some keyframes' points, in the frame of one of them. */
  Registration match(std::size_t first, std::size_t last, std::size_t frame,
                     const std::vector<double>& cellSizes) const;

  SlamOptions m_options;
  std::vector<Keyframe> m_keyframes;
  std::vector<Eigen::Isometry3d> m_poses;
  std::vector<PoseEdge> m_edges;
  std::size_t m_numLoops = 0, m_numLost = 0;
  double m_lastLook = 0;
};

/** All keyframes' poses, for KeyframeMap::move(). */
std::vector<semantic_octree::KeyframePose> posesOf(const Slam& slam);

}  // namespace semantic_slam
