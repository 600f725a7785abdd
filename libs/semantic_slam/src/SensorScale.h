#pragma once
#include <semantic_slam/Registration.h>
#include <semantic_types/LabeledCloud.h>

#include <cmath>
#include <deque>
#include <vector>

namespace semantic_slam {

using semantic_types::LabeledCloud;

constexpr double kDegree = M_PI / 180;

/** Lengths that follow from the sensor: horizontal beams or beams in space, and how far its returns
 * are. Rooms ask for finer ones than streets. */
struct SensorScale {
  bool isPlanar = true;
  double keyframeDistance = 0;  ///< m; a keyframe begins so far from the one before
  double keyframeAngle = 0;     ///< radians; or turned by so much
  int submapKeyframes = 0;    ///< a scan is registered to so many keyframes, at most twice as many
  double cube = 0;            ///< m; of the points in such a cube one is kept
  std::vector<double> cells;  ///< m; edges of a submap's cubes, coarse ones first
  double gridCell = 0;        ///< m; of the grids in which loops are searched
  double loopLength = 0;      ///< m; least way between a loop's ends
  double leastMatched = 0;    ///< share of points that fit at a loop's other end

  /** \param cloud a scan in the robot's frame */
  static SensorScale of(const LabeledCloud& cloud, bool isPlanar);
};

/** A submap of the cloud for each edge of cubes (m). */
std::vector<Submap> submapsOf(const LabeledCloud& cloud, const std::vector<double>& cells,
                              bool useClasses, bool isPlanar, double deviation = 0);

/** What the last keyframes saw, for the next scan to be registered to. It grows with each keyframe.
 * At twice the wanted number a second one, which began half way, takes its place (Hess et al.,
 * 2016). Poses in it stay as they were registered, whatever becomes of the graph. */
class LocalMap {
 public:
  void clear() { m_parts.clear(); }
  bool empty() const { return m_parts.empty(); }

  /** \param cloud of a new keyframe, its frame \param T_last_keyframe in the frame of the one
   * before */
  void add(const LabeledCloud& cloud, const Eigen::Isometry3d& T_last_keyframe,
           const SensorScale& scale, bool useClasses);

  const std::vector<Submap>& submaps() const { return m_parts.front().submaps; }
  /** The last keyframe's pose, in the frame of submaps(). */
  const Eigen::Isometry3d& T_local_last() const { return m_parts.front().poses.back(); }
  /** Poses of its keyframes, the last ones that were added, in the frame of submaps(). */
  const std::vector<Eigen::Isometry3d>& poses() const { return m_parts.front().poses; }

 private:
  struct Part {
    std::vector<Submap> submaps;
    std::vector<Eigen::Isometry3d> poses;  ///< the first is its frame
  };
  std::deque<Part> m_parts;
};

}  // namespace semantic_slam
