#include "VertexPool.h"

#include <algorithm>

#include "TileMarks.h"

namespace semantic_planning {

using colored_graph::kNoVertex;

bool VertexPool::isUsable(const GroundPose& candidate) const {
  return m_checker.fit(candidate) == Fit::Free &&
         m_checker.order().rank(m_checker.classAt(candidate)) != colored_graph::kForbidden;
}

void VertexPool::add(const GroundPose& candidate, const std::optional<CandidatePoint>& point) {
  std::size_t index = m_members.size();
  if (m_free.empty()) {
    m_members.emplace_back();
  } else {
    index = m_free.back();
    m_free.pop_back();
  }
  m_members[index] = {candidate, kNoVertex, true};
  if (point) m_ofPoint[*point].push_back(index);
  if (isUsable(candidate)) m_toInsert.push_back(index);
}

void VertexPool::dropVertex(Member& member) {
  if (member.vertex != kNoVertex) m_toRemove.push_back(member.vertex);
  member.vertex = kNoVertex;
}

void VertexPool::remove(const CandidatePoint& point) {
  const auto found = m_ofPoint.find(point);
  if (found == m_ofPoint.end()) return;
  for (const std::size_t index : found->second) {
    dropVertex(m_members[index]);
    m_members[index].present = false;
    m_free.push_back(index);
  }
  m_ofPoint.erase(found);
}

std::vector<CandidatePoint> VertexPool::turnedPoints(
    const std::vector<Column>& tiles, double distance,
    const std::function<double(const CandidatePoint&)>& headingOf) const {
  const TileMarks changed(m_checker.ground(), tiles);
  std::vector<CandidatePoint> turned;
  for (const auto& [point, members] : m_ofPoint) {
    const auto& pose = m_members[members.front()].candidate.pose;
    if (changed.anyIn({pose.x, pose.y, distance}) && headingOf(point) != pose.phi)
      turned.push_back(point);
  }
  return turned;
}

/** The ground may have gone up or down by what the wheels climb. */
bool VertexPool::standsOnGround(Member& member) {
  GroundPose& pose = member.candidate;
  const Ground& ground = m_checker.ground();
  const Column column = ground.columnAt(pose.pose.x, pose.pose.y);
  const Surface* s = ground.near(column, pose.z, ground.step());
  if (!s || s->z == pose.z) return s != nullptr;
  pose.z = s->z;
  dropVertex(member);
  return true;
}

void VertexPool::look(std::size_t index) {
  Member& member = m_members[index];
  if (!standsOnGround(member) || !isUsable(member.candidate)) return dropVertex(member);
  if (member.vertex == kNoVertex) {
    m_toInsert.push_back(index);
  } else if (const ClassId id = m_checker.classAt(member.candidate);
             id != m_roadmap.graph().vertexClass(member.vertex)) {
    m_roadmap.graph().setVertexClass(member.vertex, id);
    ++m_counts.recolored;
  }
}

void VertexPool::refresh(const std::vector<Column>& changedTiles) {
  const TileMarks changed(m_checker.ground(), changedTiles);
  for (std::size_t i = 0; i < m_members.size(); ++i) {
    const auto& pose = m_members[i].candidate.pose;
    if (m_members[i].present && changed.anyIn({pose.x, pose.y, m_checker.reach()})) look(i);
  }
}

void VertexPool::apply() {
  std::vector<std::size_t> inserted;
  std::vector<GroundPose> poses;
  std::vector<ClassId> classes;
  std::sort(m_toInsert.begin(), m_toInsert.end());
  m_toInsert.erase(std::unique(m_toInsert.begin(), m_toInsert.end()), m_toInsert.end());
  for (const std::size_t index : m_toInsert) {
    const Member& member = m_members[index];
    if (!member.present || member.vertex != kNoVertex || !isUsable(member.candidate)) continue;
    inserted.push_back(index);
    poses.push_back(member.candidate);
    classes.push_back(m_checker.classAt(member.candidate));
  }
  if (!poses.empty() || !m_toRemove.empty()) {
    const auto ids = m_roadmap.replace(m_toRemove, poses, classes);
    for (std::size_t i = 0; i < ids.size(); ++i) m_members[inserted[i]].vertex = ids[i];
  }
  m_counts.inserted += poses.size();
  m_counts.removed += m_toRemove.size();
  m_toInsert.clear();
  m_toRemove.clear();
}

}  // namespace semantic_planning
