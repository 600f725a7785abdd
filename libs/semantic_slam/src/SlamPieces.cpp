#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "SlamEngine.h"

namespace semantic_slam {
namespace {

/** Share of a stretch's points after a loss that fit what was seen before it. Stretches that follow
 * each other have .6 to 1 (1 in 20 less than .7), places that do not .1 to .6. */
constexpr double kHolds = 0.55, kHoldsMeters = 0.3;
/** Share of the highest score of a place that is searched everywhere. Right places have .5 to .9;
 * wrong ones, up to .7, have others beside them that fit as well. */
constexpr double kFoundScore = 0.5;
/** While the robot drives, its piece is searched when it is so long, m, and each time that it grew
 * by the factor. */
constexpr double kFirstLook = 4, kNextLook = 1.4;
/** Keyframes that are searched at most; points of them; edge of the search's cells, of a loop's. */
constexpr std::size_t kSearched = 40, kMostPoints = 400;
constexpr double kCells = 2;
/** Share of points that fit where a piece is found; two looks have to agree. */
constexpr double kFoundMatched = 0.7;
/** By so many m, and m for each of the piece's way, odometry may err. */
constexpr double kErr = 0.5, kErrWay = 0.03;
/** Information of the step that leads to a piece. */
const Matrix6 kUnknown = informationOf(100, 10);

}  // namespace

void SlamEngine::settleDoubt(std::size_t later) {
  if (!m_doubted || *m_doubted + later > m_keyframes.size()) return;
  const std::size_t first = *m_doubted;
  m_doubted.reset();
  if (first > 0 && !holdsAcross(first)) tearAt(first);
}

bool SlamEngine::holdsAcross(std::size_t first) const {
  const std::size_t newest = m_keyframes.size() - 1, place = first - 1;
  const auto before = static_cast<std::size_t>(m_scale.submapKeyframes);
  const Seen then = pointsOf(first - std::min(first, before), place, place);
  const Pose T_guess = m_poses[place].inverse() * m_poses[newest];
  const Registration r = match(submapsOf(then.cloud, m_scale.cells),
                               pointsOf(first, newest, newest), T_guess, Matrix6::Zero());
  return r.coveredShare >= kCovered && r.matchedShare >= kHolds &&
         (T_guess.inverse() * r.T_submap_scan).translation().norm() < kHoldsMeters;
}

void SlamEngine::tearAt(std::size_t first) {
  m_tears.push_back(first);
  m_nextJoin = kFirstLook;
  m_pendingPiece.reset();
  m_pendingLoops.clear();
  const auto leadsAcross = [first](const PoseEdge& e) {
    return e.isDoubtful && e.a != PoseEdge::kMap && e.a < first && e.b >= first;
  };
  m_edges.erase(std::remove_if(m_edges.begin(), m_edges.end(), leadsAcross), m_edges.end());
  // What was registered to the wrong place is registered anew, to the piece alone.
  m_local.clear();
  for (std::size_t k = first; k < m_keyframes.size(); ++k) {
    const auto edge = std::find_if(m_edges.begin(), m_edges.end(),
                                   [k](const PoseEdge& e) { return !e.isDoubtful && e.b == k; });
    const Seen seen = seenAt(k);
    if (k == first) {
      edge->information = kUnknown;
    } else {
      const Pose T_guess = m_local.T_local_last() * edge->T_a_b;
      const Registration r = match(m_local.submaps(), seen, T_guess, guessed(edge->T_a_b));
      edge->T_a_b = rigid(m_local.T_local_last().inverse() * r.T_submap_scan);
      m_poses[k] = levelled(m_poses[k - 1] * edge->T_a_b, seen.T_odometry_robot);
    }
    m_local.add(seen.cloud, k == first ? Pose::Identity() : edge->T_a_b, m_scale,
                m_options.useClasses);
  }
}

std::vector<double> SlamEngine::gaps() const {
  std::vector<double> gaps;
  for (const PoseEdge& edge : m_edges)
    if (!edge.isDoubtful && std::binary_search(m_tears.begin(), m_tears.end(), edge.b)) {
      const Eigen::Vector3d said = m_poses[edge.a] * edge.T_a_b.translation();
      const double off = (m_poses[edge.b].translation() - said).norm();
      if (off >= kErr) gaps.push_back(off);
    }
  return gaps;
}

auto SlamEngine::parts() const -> std::vector<Part> {
  const auto pieceOf = [this](std::size_t k) {
    const auto next = std::upper_bound(m_tears.begin(), m_tears.end(), k);
    return static_cast<std::size_t>(next - m_tears.begin());
  };
  const std::size_t map = m_tears.size() + 1;  // its frame is a piece without keyframes
  std::vector<std::size_t> partOf(map + 1);
  std::iota(partOf.begin(), partOf.end(), 0);
  for (const PoseEdge& edge : m_edges) {
    if (!edge.isDoubtful) continue;
    const std::size_t a = partOf[edge.a == PoseEdge::kMap ? map : pieceOf(edge.a)],
                      b = partOf[pieceOf(edge.b)];
    if (a != b) std::replace(partOf.begin(), partOf.end(), a, b);
  }
  std::vector<Part> parts(partOf.size());
  for (std::size_t k = 0; k < m_keyframes.size(); ++k) parts[partOf[pieceOf(k)]].push_back(k);
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.size() > b.size(); });
  while (!parts.empty() && parts.back().empty()) parts.pop_back();
  return parts;
}

bool SlamEngine::joinPiece() {
  if (m_tears.empty()) return false;
  const std::size_t newest = m_keyframes.size() - 1, first = m_tears.back();
  const double way = m_keyframes[newest].way - m_keyframes[first].way;
  if (way < m_nextJoin) return false;
  m_nextJoin = kNextLook * way;
  const auto all = parts();
  const auto own = std::find_if(all.begin(), all.end(),
                                [newest](const Part& part) { return part.back() == newest; });
  if (own->front() < first) return false;  // it is joined
  const Stretch last{newest - std::min(newest - first, kSearched), newest};
  const auto found = findStretch(placesOf(all[own == all.begin()]), last, m_looks);
  if (!found) return false;
  std::vector<PoseEdge> finds{*found};
  if (m_pendingPiece && agree(*m_pendingPiece, *found)) finds.push_back(*m_pendingPiece);
  m_pendingPiece = found;
  return join(*own, finds);
}

bool SlamEngine::joinParts() {
  bool moved = false;
  auto all = parts();
  for (std::size_t i = 1; i < all.size(); ++i)
    if (join(all[i], findPart(all[0], all[i]))) {
      moved = true;
      all = parts();
      i = 0;  // what was not found before may be now
    }
  return moved;
}

bool SlamEngine::holdsMap(const Part& part) const {
  const auto isLook = [](const PoseEdge& edge) { return edge.a == PoseEdge::kMap; };
  const auto look = std::find_if(m_edges.begin(), m_edges.end(), isLook);
  const std::size_t held = look == m_edges.end() ? 0 : look->b;
  return std::binary_search(part.begin(), part.end(), held);
}

bool SlamEngine::join(const Part& part, const std::vector<PoseEdge>& finds) {
  if (finds.empty()) return false;
  const PoseEdge& found = finds.front();
  const double way = m_keyframes[part.back()].way - m_keyframes[part.front()].way;
  const Pose T_moved = T_map_b(found) * m_poses[found.b].inverse();
  const Eigen::Vector3d at = m_poses[found.b].translation();
  const double carried = (T_moved * at - at).norm();
  if (carried >= kErr + kErrWay * way) {
    if (finds.size() < 2) return false;
    const bool stays = holdsMap(part);  // then all others come to it
    const Pose T = stays ? T_moved.inverse() : T_moved;
    for (std::size_t k = 0; k < m_poses.size(); ++k)
      if (std::binary_search(part.begin(), part.end(), k) != stays)
        m_poses[k] = levelled(rigid(T * m_poses[k]), m_keyframes[k].seen.T_odometry_robot);
  }
  m_edges.insert(m_edges.end(), finds.begin(), finds.end());
  ++m_report.loops;
  optimizePoses();
  return true;
}

auto SlamEngine::stretchesOf(const Part& part) -> std::vector<Stretch> {
  const std::size_t step = (std::min(kSearched, part.size()) + 3) / 4;
  std::vector<Stretch> stretches;
  for (std::size_t i = 1, first = 0; i < part.size(); ++i) {
    if (part[i] != part[i - 1] + 1) first = i;
    if ((part.size() - 1 - i) % step == 0 && i + 1 >= first + step)
      stretches.emplace_back(part[i - std::min(i - first, kSearched)], part[i]);
  }
  return stretches;
}

std::vector<PoseEdge> SlamEngine::findPart(const Part& others, const Part& part) const {
  const Places places = placesOf(others);
  const std::vector<Stretch> stretches = stretchesOf(part);
  std::vector<PoseEdge> finds, most;
  for (const Stretch& stretch : stretches) {
    std::size_t looks = PlaneSearch::kMostLooks;
    if (const auto found = findStretch(places, stretch, looks)) finds.push_back(*found);
  }
  for (const PoseEdge& find : finds) {
    std::vector<PoseEdge> alike{find};
    for (const PoseEdge& other : finds)
      if (agree(find, other)) alike.push_back(other);
    if (alike.size() > most.size()) most = alike;
  }
  return most;
}

auto SlamEngine::placesOf(const Part& part) const -> Places {
  const double cell = kCells * m_scale.gridCell;
  PlanePoints all;
  Eigen::AlignedBox2d box;
  for (const std::size_t k : part)
    for (const Eigen::Vector2d& p :
         uprightPoints(moved(seenAt(k).cloud, m_poses[k]), m_scale.isPlanar, cell)) {
      all.push_back(p);
      box.extend(p);
    }
  const Eigen::Vector2d middle = box.center();
  return {part,
          PlaneSearch(all, cell),
          {middle.x(), middle.y(), 0},
          {box.sizes().maxCoeff() / 2, M_PI}};
}

std::optional<PoseEdge> SlamEngine::findStretch(const Places& places, const Stretch& keyframes,
                                                std::size_t& looks) const {
  const std::size_t last = keyframes.second;
  const Seen stretch = pointsOf(keyframes.first, last, last);
  const PlanePoints searched =
      uprightPoints(stretch.cloud, m_scale.isPlanar, kCells * m_scale.gridCell);
  PlanePoints some;
  const std::size_t every = 1 + searched.size() / kMostPoints;
  for (std::size_t i = 0; i < searched.size(); i += every) some.push_back(searched[i]);
  const auto found = places.search.find(some, places.middle, places.window, kFoundScore, looks);
  if (!found || !found->isAlone) return std::nullopt;
  const Pose T_map = poseOfFlat(found->pose);
  const Part& part = places.keyframes;
  const auto distance = [&](std::size_t k) {
    return (m_poses[k].translation() - T_map.translation()).norm();
  };
  const auto nearest =
      std::min_element(part.begin(), part.end(),
                       [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
  auto begin = nearest, end = nearest;
  while (begin != part.begin() && *(begin - 1) + 1 == *begin) --begin;
  while (end + 1 != part.end() && *end + 1 == *(end + 1)) ++end;
  return edgeNear(T_map, *begin, *end, kSearched / 2, stretch, last, kFoundMatched);
}

}  // namespace semantic_slam
