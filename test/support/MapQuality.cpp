#include "MapQuality.h"

using semantic_octree::CellState;

void judge(const semantic_octree::SemanticOcTree& map, const LabeledFrame& frame, double range,
           MapQuality& quality) {
  for (std::size_t i = 0; i < frame.cloud.size(); ++i) {
    const Eigen::Vector3f& point = frame.cloud.points[i];
    if (frame.cloud.classes[i] == semantic_types::kNoClass || frame.isMoving(i)) continue;
    if (point.norm() > range) continue;
    ++quality.points;
    const Eigen::Vector3d p = frame.T_map_sensor * point.cast<double>();
    const CellState state = map.query(p.x(), p.y(), p.z());
    if (state.status != CellState::Status::Occupied) continue;
    ++quality.occupied;
    quality.right += state.likeliestClass == frame.cloud.classes[i];
  }
}
