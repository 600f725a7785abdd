#include "CostField.h"

#include <cmath>
#include <utility>

namespace semantic_planning {

using colored_graph::Length;
using colored_graph::Rank;

namespace {

constexpr std::array<Column, 4> kSteps = {{{1, 0}, {1, 1}, {0, 1}, {-1, 1}}};
/** Share of a way along eight directions: ways between these are up to 8 % shorter. */
constexpr double kShare = 0.96;

}  // namespace

CostField::CostField(const GroundPose& center, double radius, const CollisionChecker& checker,
                     const ClassPrices& prices)
    : m_checker(checker), m_prices(prices) {
  const Ground& ground = checker.ground();
  const int reach = static_cast<int>(radius / ground.voxelSize());
  const Column c = ground.columnAt(center.pose.x, center.pose.y);
  m_low = {c.x - reach, c.y - reach};
  m_edge = 2 * reach + 1;
  m_cells.resize(static_cast<std::size_t>(m_edge) * static_cast<std::size_t>(m_edge));
  for (std::size_t i = 0; i < m_wheels.size(); ++i)
    for (const double y : checker.wheels()) {
      const double angle = static_cast<double>(i) * M_PI / 4, voxels = y / ground.voxelSize();
      m_wheels[i].push_back({static_cast<int>(std::lround(-std::sin(angle) * voxels)),
                             static_cast<int>(std::lround(std::cos(angle) * voxels))});
    }
}

int CostField::indexOf(Column c) const {
  const int x = c.x - m_low.x, y = c.y - m_low.y;
  return x < 0 || y < 0 || x >= m_edge || y >= m_edge ? -1 : y * m_edge + x;
}

void CostField::add(const GroundPose& pose, Length cost) {
  const int index = indexOf(pose);
  if (index < 0 || m_cells[static_cast<std::size_t>(index)].cost <= cost) return;
  m_cells[static_cast<std::size_t>(index)].cost = cost;
  m_queue.push({cost, index, pose.z});
}

Length CostField::ofStep(Column to, int z, std::size_t direction) const {
  const Ground& ground = m_checker.ground();
  const Surface* worst = nullptr;
  Rank rank = -1;
  for (const Column& wheel : m_wheels[direction]) {
    const Surface* s = ground.near({to.x + wheel.x, to.y + wheel.y}, z, 2 * ground.step());
    if (!s) return kUnreached;
    if (const Rank r = m_checker.order().rank(s->classId); r > rank) worst = s, rank = r;
  }
  if (rank == colored_graph::kForbidden) return kUnreached;
  const double voxels = direction % 2 ? M_SQRT2 : 1;
  const Length length = colored_graph::lengthDown(kShare * voxels * ground.voxelSize());
  return length + m_prices.of(worst->classId, length);
}

/** To its neighbors, from each of which a step leads here. */
void CostField::leave(const Entry& entry) {
  const Ground& ground = m_checker.ground();
  const Column here{m_low.x + entry.index % m_edge, m_low.y + entry.index / m_edge};
  for (std::size_t i = 0; i < kSteps.size(); ++i) {
    const Length step = ofStep(here, entry.z, i);
    if (step == kUnreached) continue;
    for (const int side : {1, -1}) {
      const Column from{here.x + side * kSteps[i].x, here.y + side * kSteps[i].y};
      const int index = indexOf(from);
      if (index < 0) continue;
      Cell& cell = m_cells[static_cast<std::size_t>(index)];
      if (cell.cost <= entry.cost + step) continue;
      const Surface* s = ground.near(from, entry.z, ground.step());
      if (!s || !s->drivable) continue;
      cell.cost = entry.cost + step;
      m_queue.push({cell.cost, index, s->z});
    }
  }
}

void CostField::spread(Length most, const GroundPose* until) {
  const int last = until ? indexOf(*until) : -1;
  while (!m_queue.empty()) {
    const Entry entry = m_queue.top();
    if (entry.cost >= most || entry.index == last) return;
    m_queue.pop();
    if (std::exchange(m_cells[static_cast<std::size_t>(entry.index)].done, true)) continue;
    leave(entry);
  }
}

Length CostField::at(const GroundPose& pose) const {
  const int index = indexOf(pose);
  return index < 0 ? kUnreached : m_cells[static_cast<std::size_t>(index)].cost;
}

}  // namespace semantic_planning
