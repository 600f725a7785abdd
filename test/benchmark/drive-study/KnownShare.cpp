#include "KnownShare.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace drive_study {

using semantic_types::ClassId;
using synthetic_world::PointTruth;

namespace {

constexpr int kTile = 8;                               // voxels, of the map's changes
constexpr double kFrom = 0.3, kTo = 1.8, kStep = 0.2;  // m above the ground: heights of things

}  // namespace

KnownShare::KnownShare(semantic_octree::SemanticOcTree& map, const synthetic_world::World& world,
                       const ExploreTask& task)
    : m_map(map),
      m_world(world),
      m_classes(task.classes),
      m_far(task.within),
      m_follower(map.follow()) {
  std::set<ClassId> things = m_classes;
  for (double x = -m_far; x < m_far; x += map.getResolution())
    for (double y = -m_far; y < m_far; y += map.getResolution()) {
      if (!isGround(x, y)) continue;
      ++m_all;
      things.erase(m_world.groundClass(x, y));
    }
  if (!things.empty()) findThings(things);
}

bool KnownShare::isWithin(double x, double y) const {
  return std::max(std::abs(x), std::abs(y)) <= m_far;
}

bool KnownShare::isGround(double x, double y) const {
  if (!isWithin(x, y) || m_classes.count(m_world.groundClass(x, y)) == 0) return false;
  const double z = m_world.groundHeight(x, y) + kFrom;
  return m_world.at({x, y, z}).state == PointTruth::State::Free;
}

/** Which of the things stands in a column. */
ClassId KnownShare::thingAt(Column c, const std::set<ClassId>& things) const {
  const double x = centerOf(c.x), y = centerOf(c.y), ground = m_world.groundHeight(x, y);
  for (double up = kFrom; up < kTo; up += kStep) {
    const PointTruth truth = m_world.at({x, y, ground + up}, m_map.getResolution() / 2);
    if (things.count(truth.id) > 0) return truth.id;
  }
  return semantic_types::kNoClass;
}

void KnownShare::findThings(const std::set<ClassId>& things) {
  const int low = semantic_octree::keyOf(-m_far, m_map.getResolution()),
            high = semantic_octree::keyOf(m_far, m_map.getResolution());
  std::map<Column, ClassId> columns;
  for (int x = low; x < high; ++x)
    for (int y = low; y < high; ++y)
      if (const ClassId id = thingAt({x, y}, things)) columns[{x, y}] = id;
  while (!columns.empty()) m_things.push_back(take(columns.begin()->first, columns));
}

/** A thing is what is connected, of one class. */
KnownShare::Thing KnownShare::take(Column first, std::map<Column, ClassId>& columns) const {
  Thing thing{columns.at(first), {}};
  std::set<Column> all{first};
  std::vector<Column> open{first};
  columns.erase(first);
  const auto forNeighbors = [](Column c, auto f) {
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y) f(Column{c.x + x, c.y + y});
  };
  while (!open.empty()) {
    const Column c = open.back();
    open.pop_back();
    forNeighbors(c, [&](Column d) {
      const auto found = columns.find(d);
      if (found == columns.end() || found->second != thing.id) return;
      columns.erase(found);
      all.insert(d), open.push_back(d);
    });
  }
  for (const Column& c : all) {
    bool isOuter = false;
    forNeighbors(c, [&](Column d) { isOuter = isOuter || all.count(d) == 0; });
    if (isOuter) thing.outer.push_back(c);
  }
  return thing;
}

double KnownShare::share() {
  std::set<Column> changed;
  for (const auto& tile : m_follower.tiles().tiles) changed.insert({tile[0], tile[1]});
  for (const Column& first : changed) lookAtTile(first);
  const auto known = std::count_if(m_things.begin(), m_things.end(),
                                   [&](const Thing& thing) { return isKnown(thing); });
  const double ofGround = static_cast<double>(m_known.size()) / std::max(1, m_all);
  if (m_things.empty()) return ofGround;
  const double ofThings = static_cast<double>(known) / static_cast<double>(m_things.size());
  return m_all > 0 ? (ofGround + ofThings) / 2 : ofThings;
}

void KnownShare::lookAtTile(Column first) {
  for (int x = first.x; x < first.x + kTile; ++x)
    for (int y = first.y; y < first.y + kTile; ++y)
      if (hasRightGround({x, y}) && isGround(centerOf(x), centerOf(y)))
        m_known.insert({x, y});
      else
        m_known.erase({x, y});
}

bool KnownShare::hasRightGround(Column c) const {
  const int z = semantic_octree::keyOf(m_world.groundHeight(centerOf(c.x), centerOf(c.y)),
                                       m_map.getResolution());
  for (int k = z + 1; k >= z - 1; --k)
    if (m_classes.count(m_map.query(semantic_octree::octomapKey(c.x, c.y, k)).likeliestClass) > 0)
      return true;
  return false;
}

bool KnownShare::hasRight(Column c, ClassId thing) const {
  const double ground = m_world.groundHeight(centerOf(c.x), centerOf(c.y));
  for (double up = kFrom; up < kTo; up += kStep) {
    const int z = semantic_octree::keyOf(ground + up, m_map.getResolution());
    if (m_map.query(semantic_octree::octomapKey(c.x, c.y, z)).likeliestClass == thing) return true;
  }
  return false;
}

long KnownShare::rightOf(const Thing& thing) const {
  return std::count_if(thing.outer.begin(), thing.outer.end(),
                       [&](Column c) { return hasRight(c, thing.id); });
}

bool KnownShare::isKnown(const Thing& thing) const {
  return rightOf(thing) * 4 >= static_cast<long>(thing.outer.size());
}

long KnownShare::columns() const {
  auto right = static_cast<long>(m_known.size());
  for (const Thing& thing : m_things) right += rightOf(thing);
  return right;
}

}  // namespace drive_study
