#include <algorithm>
#include <cmath>

#include "SlamEngine.h"

namespace semantic_slam {
namespace {

/** Share of a stretch's points after a loss that fit what was seen before it. Stretches that follow
 * each other have .6 to 1 (1 in 20 less than .7), places that do not .1 to .6. */
constexpr double kHolds = 0.55, kHoldsMeters = 0.3;
/** Share of the highest score of a place that is searched everywhere. Right places have .7 to .9,
 * wrong ones up to .7. */
constexpr double kFoundScore = 0.65;
/** A piece is searched when it is so long, m, and each time that it grew by the factor; first when
 * twice as long for each of the last pieces that was not found, of so many. */
constexpr double kFirstLook = 4, kNextLook = 1.4;
constexpr int kMostNotFound = 3;
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

bool SlamEngine::mendPieces(bool isLast) {
  const auto beside = static_cast<std::size_t>(m_scale.submapKeyframes / 2);
  if (m_doubted && *m_doubted + (isLast ? 1 : beside) <= m_keyframes.size()) {
    const std::size_t first = *m_doubted;
    m_doubted.reset();
    if (first > 0 && !holdsAcross(first)) tearAt(first);
  }
  if (isLast) m_nextJoin = 0;
  return m_piece && joinPiece();
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
  ++m_report.torn;
  // Where pieces are not found, the next ones hardly are, and each look takes long.
  m_notFound = m_piece ? m_notFound + 1 : 0;
  m_piece = first;
  m_nextJoin = std::ldexp(kFirstLook, std::min(m_notFound, kMostNotFound));
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

bool SlamEngine::joinPiece() {
  const std::size_t newest = m_keyframes.size() - 1;
  const double way = m_keyframes[newest].way - m_keyframes[*m_piece].way;
  if (way < m_nextJoin) return false;
  m_nextJoin = kNextLook * way;
  const auto found = findPiece();
  if (!found) return false;
  const Pose T_moved = T_map_b(*found) * m_poses[newest].inverse();
  const double carried =
      (T_moved * m_poses[newest].translation() - m_poses[newest].translation()).norm();
  const bool isWhereItIs = carried < kErr + kErrWay * way;
  const auto before = m_pendingPiece;
  m_pendingPiece = found;
  if (!isWhereItIs && !(before && agree(*before, *found))) return false;
  if (isWhereItIs) {
    --m_report.torn;
  } else {
    ++m_report.joined;
    m_report.carried = std::max(m_report.carried, carried);
    for (std::size_t k = *m_piece; k <= newest; ++k)
      m_poses[k] = levelled(rigid(T_moved * m_poses[k]), m_keyframes[k].seen.T_odometry_robot);
    m_edges.push_back(*before);
  }
  m_edges.push_back(*found);
  ++m_report.loops;
  m_report.twofold = 0;
  m_piece.reset();
  optimizePoses();
  return true;
}

std::optional<PoseEdge> SlamEngine::findPiece() {
  const std::size_t newest = m_keyframes.size() - 1, first = *m_piece;
  const double cell = kCells * m_scale.gridCell;
  const std::size_t length = std::min(newest - first, kSearched);
  const Seen stretch = pointsOf(newest - length, newest, newest);
  PlanePoints all;
  for (std::size_t k = 0; k < first; ++k)
    for (const Eigen::Vector2d& p :
         uprightPoints(moved(seenAt(k).cloud, m_poses[k]), m_scale.isPlanar, cell))
      all.push_back(p);
  PlanePoints some;
  const PlanePoints searched = uprightPoints(stretch.cloud, m_scale.isPlanar, cell);
  const std::size_t every = 1 + searched.size() / kMostPoints;
  for (std::size_t i = 0; i < searched.size(); i += every) some.push_back(searched[i]);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : all) box.extend(p);
  const Eigen::Vector2d middle = box.center();
  const auto found = PlaneSearch(all, cell).find(some, {middle.x(), middle.y(), 0},
                                                 {box.sizes().maxCoeff() / 2, M_PI}, kFoundScore);
  m_report.twofold += found && !found->isAlone;
  if (!found || !found->isAlone) return std::nullopt;
  return edgeNear(poseOfFlat(found->pose), 0, first - 1, kSearched / 2, stretch, kFoundMatched);
}

}  // namespace semantic_slam
