#include <semantic_octree/SemanticOcTree.h>

#include <cmath>
#include <stdexcept>

namespace semantic_octree {
namespace {

/** The voxels along a ray, one after the other (Amanatides, Woo, "A Fast Voxel Traversal Algorithm
 * for Ray Tracing"). */
class VoxelWalk {
 public:
  VoxelWalk(const SemanticOcTree& tree, const octomap::point3d& origin,
            const octomap::point3d& direction) {
    const double voxel = tree.getResolution();
    const octomap::OcTreeKey first = tree.coordToKey(origin);
    for (unsigned axis = 0; axis < 3; ++axis) {
      const double o = origin(axis), d = direction(axis);
      m_key[axis] = first[axis];
      m_step[axis] = d > 0 ? 1 : d < 0 ? -1 : 0;
      const double border = centerOf(m_key[axis], voxel) + 0.5 * m_step[axis] * voxel;
      m_next[axis] = m_step[axis] == 0 ? HUGE_VAL : (border - o) / d;
      m_perVoxel[axis] = m_step[axis] == 0 ? HUGE_VAL : voxel / std::fabs(d);
    }
  }

  bool isInside() const {
    for (const int key : m_key)
      if (key < 0 || key >= kNumKeys) return false;
    return true;
  }
  octomap::OcTreeKey key() const { return octomapKey(m_key[0], m_key[1], m_key[2]); }
  /** Along the direction, where the present voxel is left. */
  double leftAt() const { return std::min(m_next[0], std::min(m_next[1], m_next[2])); }
  void step() {
    int axis = m_next[0] < m_next[1] ? 0 : 1;
    if (!(m_next[axis] < m_next[2])) axis = 2;
    m_key[axis] += m_step[axis];
    m_next[axis] += m_perVoxel[axis];
  }

 private:
  int m_key[3], m_step[3];
  double m_next[3], m_perVoxel[3];
};

}  // namespace

bool SemanticOcTree::computeRayKeys(const octomap::point3d& origin, const octomap::point3d& end,
                                    octomap::KeyRay& ray) const {
  ray.reset();
  octomap::OcTreeKey key, last;
  if (!coordToKeyChecked(origin, key) || !coordToKeyChecked(end, last)) return false;
  for (VoxelWalk walk(*this, origin, end - origin); walk.isInside(); walk.step()) {
    if (walk.key() == last || !(walk.leftAt() <= 1)) break;
    ray.addKey(walk.key());
  }
  return true;
}

std::optional<RayHit> SemanticOcTree::castRay(const octomap::point3d& origin,
                                              const octomap::point3d& direction, double maxRange,
                                              bool ignoreUnknown) const {
  const octomap::point3d unit = direction.normalized();
  if (!(unit.norm() > 0.5) || !std::isfinite(unit.norm()))
    throw std::invalid_argument("ray cast: a direction that is zero or not finite");
  octomap::OcTreeKey key;
  if (empty() || !coordToKeyChecked(origin, key)) return std::nullopt;
  bool isFirst = true;
  for (VoxelWalk walk(*this, origin, unit); walk.isInside(); walk.step()) {
    const octomap::point3d center = keyToCoord(walk.key());
    if (!isFirst && maxRange > 0 && (center - origin).norm() > maxRange) break;
    isFirst = false;
    const Node node = search(walk.key());
    if (!node && !ignoreUnknown) break;
    if (node && isNodeOccupied(node)) return RayHit{walk.key(), center, query(node)};
  }
  return std::nullopt;
}

}  // namespace semantic_octree
