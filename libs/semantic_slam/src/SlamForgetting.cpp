#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "SlamEngine.h"

namespace semantic_slam {

std::vector<std::size_t> SlamEngine::outnumbered(std::size_t by) const {
  constexpr std::size_t kOneIn = 20;  // columns may be undecided: stray points fall anywhere
  if (m_keyframes.empty() || m_doubted || parts().size() > 1) return {};
  struct Looks {
    std::size_t earlier = 0, later = 0;
  };
  std::map<Column, Looks> looks;
  std::vector<std::set<Column>> seen;
  for (std::size_t k = 0; k < m_keyframes.size(); ++k)
    for (const Column& c : seen.emplace_back(columnsSeenFrom(k))) ++looks[c].earlier;
  std::vector<std::size_t> many;
  const double way = m_keyframes.back().way - m_scale.loopLength;
  for (std::size_t k = m_keyframes.size(); k-- > 0;) {
    for (const Column& c : seen[k]) --looks[c].earlier;
    const auto undecided = std::count_if(seen[k].begin(), seen[k].end(), [&](const Column& c) {
      return std::min(looks[c].earlier, looks[c].later) < by;
    });
    const bool isLast =
        k + m_local.poses().size() >= m_keyframes.size() || m_keyframes[k].way >= way;
    if (k > 0 && !isLast && kOneIn * static_cast<std::size_t>(undecided) <= seen[k].size())
      many.push_back(k);
    else
      for (const Column& c : seen[k]) ++looks[c].later;
  }
  return many;
}

auto SlamEngine::columnsSeenFrom(std::size_t keyframe) const -> std::set<Column> {
  std::set<Column> columns;
  const double edge = m_scale.cells.front();
  for (const Eigen::Vector3f& p : moved(seenAt(keyframe).cloud, m_poses[keyframe]).points)
    columns.emplace(std::floor(p.x() / edge), std::floor(p.y() / edge));
  return columns;
}

auto SlamEngine::edgesOfOthers(const std::vector<bool>& isGone,
                               const std::vector<std::size_t>& now) const -> std::vector<PoseEdge> {
  std::vector<PoseEdge> edges;
  std::optional<PoseEdge> open;  // to one that goes
  for (PoseEdge edge : m_edges) {
    if (edge.isDoubtful && (isGone[edge.b] || (edge.a != PoseEdge::kMap && isGone[edge.a])))
      continue;
    if (!edge.isDoubtful) {
      if (open) edge.information = inSeries(open->information, edge), edge.a = open->a;
      open.reset();
      edge.T_a_b = rigid(m_poses[edge.a].inverse() * m_poses[edge.b]);  // as loops that go have it
    }
    if (isGone[edge.b]) {
      open = edge;
      continue;
    }
    edge.b = now[edge.b];
    if (edge.a != PoseEdge::kMap) edge.a = now[edge.a];
    edges.push_back(edge);
  }
  return edges;
}

void SlamEngine::forget(const std::vector<std::size_t>& keyframes) {
  if (keyframes.empty()) return;
  std::vector<bool> isGone(m_keyframes.size(), false);
  for (const std::size_t k : keyframes) isGone.at(k) = true;
  std::vector<std::size_t> now;
  std::vector<Keyframe> kept;
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < m_keyframes.size(); ++k) {
    now.push_back(kept.size());
    Keyframe& keyframe = m_keyframes[k];
    if (isGone[k] && m_file)
      m_file->discard(keyframe.place, keyframe.numPoints * (sizeof(Eigen::Vector3f) + 1));
    if (isGone[k]) continue;
    kept.push_back(std::move(keyframe));
    poses.push_back(m_poses[k]);
  }
  m_edges = edgesOfOthers(isGone, now);
  m_keyframes = std::move(kept);
  m_poses = std::move(poses);
  m_looked = m_keyframes.size();
  m_pendingLoops.clear();
  m_pendingReferences.clear();
  m_pendingPiece.reset();
  m_tears.clear();  // all pieces are joined
}

}  // namespace semantic_slam
