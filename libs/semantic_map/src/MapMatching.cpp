#include <mrpt/maps/CSimplePointsMap.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_octree/SemanticOcTree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>

namespace semantic_map {

using mrpt::maps::CMetricMap;
using mrpt::maps::CPointsMap;
using mrpt::maps::TMatchingExtraResults;
using mrpt::maps::TMatchingParams;
using mrpt::math::TPoint3D;
using mrpt::tfest::TMatchingPairList;
using semantic_octree::SemanticOcTree;

namespace {

/** Finds the occupied voxel whose center is nearest to a point: a descent of the tree that leaves
 * out what is free and what is too far. */
class NearestOccupied {
 public:
  enum class Distance { InSpace, FromAbove };

  struct Voxel {
    Eigen::Vector3d center;  ///< m
    double squaredDistance;  ///< m^2
  };

  /** \param distance FromAbove: heights do not count */
  NearestOccupied(const SemanticOcTree& tree, Distance distance)
      : m_tree(tree), m_weights(1, 1, distance == Distance::InSpace ? 1 : 0) {}

  /** Nothing if all are at this distance (m) or farther. */
  std::optional<Voxel> operator()(const Eigen::Vector3d& point, double within) const {
    std::optional<Voxel> best;
    if (m_tree.empty()) return best;
    const double size = m_tree.getNodeSize(0);
    double bound = within * within;
    descend({m_tree.root(), Eigen::Vector3d::Constant(-size / 2), size}, point, bound, best);
    return best;
  }

 private:
  /** A node of the tree and its cube. */
  struct Cube {
    semantic_octree::SemanticOcTreeNode node;
    Eigen::Vector3d low;  ///< corner, m
    double size;          ///< edge, m
  };
  Voxel nearestIn(const Cube& cube, const Eigen::Vector3d& point) const {
    const double voxel = m_tree.getResolution();
    const double last = std::round(cube.size / voxel) - 1;
    const auto index = [&](double offset) {
      return std::clamp(std::floor(offset / voxel), 0.0, last) + 0.5;
    };
    const Eigen::Vector3d center = cube.low + voxel * (point - cube.low).unaryExpr(index);
    return {center, (center - point).cwiseAbs2().dot(m_weights)};
  }
  void descend(const Cube& cube, const Eigen::Vector3d& point, double& bound,
               std::optional<Voxel>& best) const {
    const Voxel voxel = nearestIn(cube, point);
    if (!m_tree.isNodeOccupied(cube.node) || !(voxel.squaredDistance < bound)) return;
    if (cube.node.isLeaf()) {
      best = voxel;
      bound = voxel.squaredDistance;
      return;
    }
    using Child = std::pair<double, Cube>;
    std::array<Child, 8> children;
    const auto nearer = [](const Child& a, const Child& b) { return a.first < b.first; };
    auto end = children.begin();
    for (int i = 0; i < 8; ++i) {
      const auto node = cube.node.child(i);
      if (!node) continue;
      const double half = cube.size / 2;
      const Cube child{node, cube.low + half * Eigen::Vector3d(i & 1, i >> 1 & 1, i >> 2 & 1),
                       half};
      *end = {nearestIn(child, point).squaredDistance, child};
      std::rotate(std::upper_bound(children.begin(), end, *end, nearer), end, end + 1);
      ++end;
    }
    for (auto child = children.begin(); child != end; ++child)
      descend(child->second, point, bound, best);
  }

  const SemanticOcTree& m_tree;
  Eigen::Vector3d m_weights;
};

void addCenters(const SemanticOcTree::leaf_iterator& leaf, double voxel, CPointsMap& points) {
  const int n = static_cast<int>(std::lround(leaf.getSize() / voxel));
  const auto at = [&](double center, int i) {
    return static_cast<float>(center + (i + 0.5 - 0.5 * n) * voxel);
  };
  for (int i = 0; i < n * n * n; ++i)
    points.insertPoint(at(leaf.getX(), i % n), at(leaf.getY(), i / n % n),
                       at(leaf.getZ(), i / n / n));
}

const CPointsMap& pointsOf(const CMetricMap* map) {
  if (!map) throw std::invalid_argument("matching: no map to match with");
  if (const auto* points = dynamic_cast<const CPointsMap*>(map)) return *points;
  if (const CPointsMap* points = map->getAsSimplePointsMap()) return *points;
  throw std::invalid_argument(
      std::string("matching: a semantic octree map matches points maps, not ") +
      map->GetRuntimeClass()->className);
}

/** Finds the pairs of points and voxels, as CPointsMap does for pairs of points. */
class Matcher {
 public:
  Matcher(const SemanticOcTree& tree, NearestOccupied::Distance distance,
          const TMatchingParams& params)
      : m_tree(tree),
        m_nearest(tree, distance),
        m_weight(distance == NearestOccupied::Distance::InSpace ? 1 : 0),
        m_params(params) {
    if (params.decimation_other_map_points == 0 ||
        params.offset_other_map_points >= params.decimation_other_map_points)
      throw std::invalid_argument("matching: the offset must be below the decimation");
    if (params.onlyUniqueRobust && !params.onlyKeepTheClosest)
      throw std::invalid_argument("matching: onlyUniqueRobust needs onlyKeepTheClosest");
  }

  void match(const CPointsMap& points, const mrpt::poses::CPose3D& T_this_other,
             TMatchingPairList& pairs, TMatchingExtraResults& extra) {
    for (std::size_t i = m_params.offset_other_map_points; i < points.size();
         i += m_params.decimation_other_map_points) {
      TPoint3D local;
      points.getPoint(i, local.x, local.y, local.z);
      add(i, local, T_this_other.composePoint(local));
    }
    extra = {};
    const auto found = double(m_pairs.size());
    if (found > 0) extra.sumSqrDist = float(m_sumOfSquares / found);
    if (points.size() > 0)
      extra.correspondencesRatio =
          float(double(m_params.decimation_other_map_points) * found / double(points.size()));
    pairs.clear();
    if (m_params.onlyUniqueRobust)
      m_pairs.filterUniqueRobustPairs(m_voxels.size(), pairs);
    else
      pairs = std::move(m_pairs);
  }

 private:
  double reach(const TPoint3D& point) const {
    const TPoint3D from = point - m_params.angularDistPivotPoint;
    return m_params.maxDistForCorrespondence +
           m_params.maxAngularDistForCorrespondence *
               std::sqrt(from.x * from.x + from.y * from.y + m_weight * from.z * from.z);
  }

  void add(std::size_t index, const TPoint3D& local, const TPoint3D& point) {
    const auto voxel = m_nearest({point.x, point.y, point.z}, reach(point));
    if (!voxel) return;
    const Eigen::Vector3f global = voxel->center.cast<float>();
    m_pairs.emplace_back(indexOf(voxel->center), index, global.x(), global.y(), global.z(),
                         float(local.x), float(local.y), float(local.z));
    m_pairs.back().errorSquareAfterTransformation = float(voxel->squaredDistance);
    m_sumOfSquares += voxel->squaredDistance;
  }

  /** Numbers of voxels, in the order in which they are met. */
  std::uint32_t indexOf(const Eigen::Vector3d& center) {
    const auto key = m_tree.coordToKey(center.x(), center.y(), center.z());
    return m_voxels.emplace(std::array{key[0], key[1], key[2]}, m_voxels.size()).first->second;
  }

  const SemanticOcTree& m_tree;
  NearestOccupied m_nearest;
  double m_weight;
  TMatchingParams m_params;
  TMatchingPairList m_pairs;
  double m_sumOfSquares = 0;
  std::map<std::array<octomap::key_type, 3>, std::uint32_t> m_voxels;
};

}  // namespace

const mrpt::maps::CSimplePointsMap* CSemanticOctoMap::getAsSimplePointsMap() const {
  const std::lock_guard lock(m_centersMutex);
  const auto folder = reading();
  if (!m_changes) m_changes = const_cast<SemanticOcTree&>(m_tree).follow();
  const semantic_octree::TileChange change = m_changes->tiles();
  if (m_centers && !change.all && change.tiles.empty()) return m_centers.get();
  m_centers = std::make_shared<mrpt::maps::CSimplePointsMap>();
  for (auto leaf = m_tree.begin_leafs(), end = m_tree.end_leafs(); leaf != end; ++leaf)
    if (m_tree.isNodeOccupied(*leaf)) addCenters(leaf, m_tree.getResolution(), *m_centers);
  return m_centers.get();
}

void CSemanticOctoMap::determineMatching2D(const CMetricMap* other,
                                           const mrpt::poses::CPose2D& T_this_other,
                                           TMatchingPairList& pairs, const TMatchingParams& params,
                                           TMatchingExtraResults& extra) const {
  const CPointsMap& points = pointsOf(other);
  const auto lock = reading();
  Matcher(m_tree, NearestOccupied::Distance::FromAbove, params)
      .match(points, mrpt::poses::CPose3D(T_this_other), pairs, extra);
}

void CSemanticOctoMap::determineMatching3D(const CMetricMap* other,
                                           const mrpt::poses::CPose3D& T_this_other,
                                           TMatchingPairList& pairs, const TMatchingParams& params,
                                           TMatchingExtraResults& extra) const {
  const CPointsMap& points = pointsOf(other);
  const auto lock = reading();
  Matcher(m_tree, NearestOccupied::Distance::InSpace, params)
      .match(points, T_this_other, pairs, extra);
}

float CSemanticOctoMap::compute3DMatchingRatio(
    const CMetricMap* other, const mrpt::poses::CPose3D& T_this_other,
    const mrpt::maps::TMatchingRatioParams& params) const {
  TMatchingParams matching;
  matching.maxDistForCorrespondence = params.maxDistForCorr;
  TMatchingPairList pairs;
  TMatchingExtraResults extra;
  determineMatching3D(other, T_this_other, pairs, matching, extra);
  return extra.correspondencesRatio;
}

float CSemanticOctoMap::squareDistanceToClosestCorrespondence(float x, float y) const {
  const auto lock = reading();
  const NearestOccupied nearest(m_tree, NearestOccupied::Distance::FromAbove);
  const auto voxel = nearest({x, y, 0}, std::numeric_limits<double>::infinity());
  if (!voxel) throw std::logic_error("the map has no occupied voxel");
  return float(voxel->squaredDistance);
}

}  // namespace semantic_map
