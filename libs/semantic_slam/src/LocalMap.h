#pragma once
#include <semantic_slam/Registration.h>

#include <deque>
#include <vector>

#include "SensorScale.h"

namespace semantic_slam {

/** What the last keyframes saw, for the next scan to be registered to. It grows with each keyframe;
 * where it has twice as many as are wanted, a second one, which began half way, takes its place
 * (Hess et al., 2016). Poses in it stay as they were registered, whatever becomes of the graph. */
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
