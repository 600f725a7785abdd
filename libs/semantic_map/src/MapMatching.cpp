#include <mrpt/maps/CSimplePointsMap.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_octree/SemanticOcTree.h>

#include <cmath>
#include <stdexcept>

namespace semantic_map {

using mrpt::maps::CMetricMap;
using mrpt::maps::CPointsMap;
using mrpt::maps::TMatchingExtraResults;
using mrpt::maps::TMatchingParams;
using mrpt::tfest::TMatchingPairList;
using semantic_octree::SemanticOcTree;

namespace {

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

}  // namespace

std::shared_ptr<const mrpt::maps::CSimplePointsMap> CSemanticOctoMap::centers() const {
  const std::lock_guard lock(m_centersMutex);
  const auto folder = reading();
  if (!m_changes) m_changes = const_cast<SemanticOcTree&>(m_tree).follow();
  const semantic_octree::TileChange change = m_changes->tiles();
  if (m_centers && !change.all && change.tiles.empty()) return m_centers;
  m_centers = std::make_shared<mrpt::maps::CSimplePointsMap>();
  m_centersFromAbove.reset();
  for (auto leaf = m_tree.begin_leafs(), end = m_tree.end_leafs(); leaf != end; ++leaf)
    if (m_tree.isNodeOccupied(*leaf)) addCenters(leaf, m_tree.getResolution(), *m_centers);
  return m_centers;
}

const mrpt::maps::CSimplePointsMap* CSemanticOctoMap::getAsSimplePointsMap() const {
  return centers().get();
}

std::shared_ptr<const mrpt::maps::CSimplePointsMap> CSemanticOctoMap::centersFromAbove() const {
  const auto points = centers();
  const std::lock_guard lock(m_centersMutex);
  if (!m_centersFromAbove)
    m_centersFromAbove = std::make_shared<mrpt::maps::CSimplePointsMap>(*points);
  return m_centersFromAbove;
}

void CSemanticOctoMap::determineMatching2D(const CMetricMap* other,
                                           const mrpt::poses::CPose2D& T_this_other,
                                           TMatchingPairList& pairs, const TMatchingParams& params,
                                           TMatchingExtraResults& extra) const {
  centersFromAbove()->determineMatching2D(&pointsOf(other), T_this_other, pairs, params, extra);
}

void CSemanticOctoMap::determineMatching3D(const CMetricMap* other,
                                           const mrpt::poses::CPose3D& T_this_other,
                                           TMatchingPairList& pairs, const TMatchingParams& params,
                                           TMatchingExtraResults& extra) const {
  centers()->determineMatching3D(&pointsOf(other), T_this_other, pairs, params, extra);
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
  const auto points = centersFromAbove();
  if (points->empty()) throw std::logic_error("the map has no occupied voxel");
  return points->squareDistanceToClosestCorrespondence(x, y);
}

}  // namespace semantic_map
