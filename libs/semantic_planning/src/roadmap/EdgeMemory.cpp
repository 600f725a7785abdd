#include "EdgeMemory.h"

#include <cstring>

#include "TileMarks.h"

namespace semantic_planning {

using colored_graph::EdgeProfile;

namespace {

/** A plan with 1000 vertices evaluates about 2000 curves, which are kept in some 250 bytes each:
 * fifty such plans, in 25 MB. */
constexpr std::size_t kMostAnswers = 100000;

}  // namespace

std::size_t EdgeMemory::Hash::operator()(const PosePair& poses) const {
  std::uint64_t hash = 0;
  const auto mix = [&](double number) {
    std::uint64_t bits;
    std::memcpy(&bits, &number, sizeof bits);
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 32;
  };
  for (const GroundPose* p : {&poses.first, &poses.second})
    for (const double number : {p->pose.x + 0.0, p->pose.y + 0.0, p->pose.phi + 0.0}) mix(number);
  return hash;
}

std::optional<EdgeProfile> EdgeMemory::profile(const PosePair& poses) {
  if (m_answers.size() == kMostAnswers) m_answers.clear();
  const auto [found, isNew] = m_answers.try_emplace(poses);
  Answer& answer = found->second;
  if (!isNew && holds(poses, answer.time)) {
    ++m_remembered;
  } else {
    answer.profile = m_checker.profile(poses.first, poses.second);
  }
  answer.time = m_now;
  return answer.profile;
}

void EdgeMemory::groundChanged(const std::vector<Column>& tiles) {
  if (tiles.empty()) return;
  ++m_now;
  for (const Column& tile : tiles) m_changed.at(tile) = m_now;
}

bool EdgeMemory::holds(const PosePair& poses, std::uint32_t time) const {
  if (time == m_now) return true;
  const double length =
      m_checker.motionCost().shortest(poses.first.pose, poses.second.pose).length();
  const Square square = squareAround(poses, length, m_checker);
  return !anyTileIn(m_checker.ground(), square, [&](Column tile) {
    const std::uint32_t* changed = m_changed.find(tile);
    return changed && *changed > time;
  });
}

}  // namespace semantic_planning
