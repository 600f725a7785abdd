#include "CostField.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "Slices.h"

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
    : m_checker(checker),
      m_prices(prices),
      m_center(checker.ground().columnAt(center.pose.x, center.pose.y)),
      m_reach(static_cast<int>(radius / checker.ground().voxelSize())),
      m_field(checker.ground()) {
  for (std::size_t i = 0; i < m_wheels.size(); ++i)
    for (const double y : checker.wheels()) {
      const double angle = static_cast<double>(i) * M_PI / 4;
      const double voxels = y / checker.ground().voxelSize();
      m_wheels[i].push_back({static_cast<int>(std::lround(-std::sin(angle) * voxels)),
                             static_cast<int>(std::lround(std::cos(angle) * voxels))});
    }
}

CostField::Place CostField::placeAt(const GroundPose& pose) const {
  const Ground& ground = m_checker.ground();
  return m_field.placeNear(ground.columnAt(pose.pose.x, pose.pose.y), pose.z, 2 * ground.step());
}

void CostField::add(const GroundPose& pose, Length cost) {
  if (const Place place = placeAt(pose); place.surface) reach(place, cost);
}

bool CostField::contains(Column c) const {
  return std::max(std::abs(c.x - m_center.x), std::abs(c.y - m_center.y)) <= m_reach;
}

void CostField::reach(const Place& place, Length cost) {
  if (!contains(place.column)) return;
  Length& known = m_field.label(place.cell).cost;
  if (known <= cost) return;
  known = cost;
  m_queue.push(cost, place.cell);
}

Length CostField::ofStep(const Place& to, std::size_t direction) const {
  const Ground& ground = m_checker.ground();
  const Surface* worst = nullptr;
  Rank rank = -1;
  for (const Column& wheel : m_wheels[direction]) {
    const Surface* s = m_field.near({to.column.x + wheel.x, to.column.y + wheel.y}, to.surface->z,
                                    2 * ground.step());
    if (!s) return kUnreached;
    if (const Rank r = m_checker.order().rank(s->classId); r > rank) worst = s, rank = r;
  }
  if (rank == colored_graph::kForbidden) return kUnreached;
  const double voxels = direction % 2 ? M_SQRT2 : 1;
  const Length length = colored_graph::lengthDown(kShare * voxels * ground.voxelSize());
  return length + m_prices.of(worst->classId, length);
}

/** To its neighbors, from each of which a step leads here. */
void CostField::leave(const Place& here, Length cost) {
  for (std::size_t i = 0; i < kSteps.size(); ++i) {
    const Length step = ofStep(here, i);
    if (step == kUnreached) continue;
    for (const int side : {1, -1}) {
      const Place from = m_field.placeNear(
          {here.column.x + side * kSteps[i].x, here.column.y + side * kSteps[i].y}, here.surface->z,
          m_checker.ground().step());
      if (from.surface) reach(from, cost + step);
    }
  }
}

Length CostField::at(const GroundPose& pose) {
  const Place asked = placeAt(pose);
  if (!asked.surface || !contains(asked.column)) return kUnreached;
  const Length& known = m_field.label(asked.cell).cost;
  while (!m_queue.empty() && m_queue.top().first < std::min(known, m_most)) {
    const auto [cost, cell] = m_queue.pop();
    Slices::count(1);
    if (cost == m_field.label(cell).cost) leave(m_field.placeOf(cell), cost);
  }
  return known;
}

}  // namespace semantic_planning
