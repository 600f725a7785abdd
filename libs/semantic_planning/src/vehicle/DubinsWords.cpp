#include "DubinsWords.h"

#include <cmath>
#include <limits>

namespace semantic_planning {

using mrpt::math::TPose2D;

namespace {

constexpr double kTurn = 2 * M_PI;
constexpr double kSameTurn =
    1e-9;  // arcs that only rounding keeps from being none, or a whole turn

/** Into [0, a whole turn). */
double positive(double angle) {
  const double turned = angle - kTurn * std::floor(angle / kTurn);
  return turned > kTurn - kSameTurn ? 0 : turned;
}

/** Solves words for curves that begin with an arc to the left; those that begin to the right are
 * their mirror images. */
class ForwardSearch {
 public:
  void offerBoth(const TPose2D& from, const TPose2D& to) {
    const double dx = to.x - from.x, dy = to.y - from.y;
    const double c = std::cos(from.phi), s = std::sin(from.phi);
    const double ahead = c * dx + s * dy, left = c * dy - s * dx, turn = to.phi - from.phi;
    offer(ahead, left, turn, 1);
    offer(ahead, -left, -turn, -1);
  }
  const Word& shortest() const { return m_shortest; }

 private:
  /** To a goal that is so far ahead and to the left. \param side 1, or -1 in the mirror. */
  void offer(double ahead, double left, double turn, int side) {
    straightToSameSide(ahead - std::sin(turn), left + std::cos(turn) - 1, turn, side);
    const double x = ahead + std::sin(turn), y = left - std::cos(turn) - 1;
    straightToOtherSide(x, y, turn, side);
  }

  /** LSL, and LRL. \param x, y from the first circle's center to the last one's */
  void straightToSameSide(double x, double y, double turn, int side) {
    const double distance = std::hypot(x, y), direction = std::atan2(y, x);
    const double first = positive(direction);
    keep({first, distance, positive(turn - first)}, {side, 0, side});
    if (distance > 4) return;
    const double half = std::acos(distance / 4);  // at the first center, to the middle one's
    const double begin = positive(direction + half + M_PI / 2), middle = M_PI + 2 * half;
    keep({begin, middle, positive(turn - begin + middle)}, {side, -side, side});
  }

  /** LSR. */
  void straightToOtherSide(double x, double y, double turn, int side) {
    const double distance2 = x * x + y * y;
    if (distance2 < 4) return;
    const double straight = std::sqrt(distance2 - 4);
    const double first = positive(std::atan2(y, x) + std::atan2(2, straight));
    keep({first, straight, positive(first - turn)}, {side, 0, -side});
  }

  void keep(const std::array<double, 3>& lengths, const std::array<int, 3>& turns) {
    const double length = lengths[0] + lengths[1] + lengths[2];
    if (length >= m_length) return;
    m_length = length;
    m_shortest = {};
    for (std::size_t i = 0; i < 3; ++i) m_shortest[i] = {turns[i], lengths[i]};
  }

  double m_length = std::numeric_limits<double>::infinity();
  Word m_shortest{};
};

}  // namespace

Word shortestForwardWord(const TPose2D& from, const TPose2D& to) {
  ForwardSearch search;
  search.offerBoth(from, to);
  return search.shortest();
}

}  // namespace semantic_planning
