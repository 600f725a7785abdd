#include <semantic_planning/vehicle/ReedsShepp.h>

#include <mrpt/math/TPose2D.h>
#include <strict_files/OptionList.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace semantic_planning {

using mrpt::math::TPose2D;

namespace {

/** A curve of a car whose turning radius is 1. */
using Word = std::array<ReedsSheppCurve::Segment, 5>;

constexpr double kPi = M_PI, kHalfPi = M_PI / 2;
constexpr double kTie = 1e-12;   // part of a length by which another must be shorter to count
constexpr double kSame = 1e-12;  // centers of circles that are nearer to each other are the same
constexpr double kNoSegment = 1e-11;  // segments that move the goal by less are left out

double wrappedQuickly(double angle) { return angle - 2 * kPi * std::nearbyint(angle / (2 * kPi)); }

/** Absolute value of the wrapped angle; for up to one turn and a half. */
double arc(double angle) { return std::abs(kPi - std::abs(kPi - std::abs(angle))); }

/** The goal seen from the start's position and the heading half-way between both headings. There a
 * shortest length is even in x, in y and in `half`. For a curve can be driven in the other gear (x
 * and half are negated), reflected (y and half), or taken from its end (y). */
struct Goal {
  Goal(const TPose2D& from, const TPose2D& to) {
    const double turns = std::nearbyint((to.phi - from.phi) / (2 * kPi));
    const double side = turns == 2 * std::nearbyint(turns / 2) ? 1 : -1;
    const double cosFrom = std::cos(from.phi / 2), sinFrom = std::sin(from.phi / 2);
    const double cosTo = std::cos(to.phi / 2), sinTo = std::sin(to.phi / 2);
    const double cosMiddle = side * (cosFrom * cosTo - sinFrom * sinTo);
    const double sinMiddle = side * (sinFrom * cosTo + cosFrom * sinTo);
    const double dx = to.x - from.x, dy = to.y - from.y;
    x = cosMiddle * dx + sinMiddle * dy;
    y = cosMiddle * dy - sinMiddle * dx;
    half = (to.phi - from.phi) / 2 - kPi * turns;
    c = std::abs(cosFrom * cosTo + sinFrom * sinTo);
    s = std::abs(cosFrom * sinTo - sinFrom * cosTo);
  }

  double x, y, half;
  double c, s;  ///< cosine and sine of half, both positive
};

/** How words are looked at. */
struct View {
  double half;            ///< heading at the end; at the start its negative
  bool mirrored = false;  ///< left stands for right
  bool reversed = false;  ///< from the end to the start
};

/** From the center of a word's first turning circle, one to the left, to that of its last. */
class Centers {
 public:
  /** \param rho2Less4 x * x + y * y - 4 without the rounding of x and y */
  Centers(double x, double y, double rho2Less4, const View& words)
      : view(words),
        beyond4(rho2Less4),
        rho(std::sqrt(x * x + y * y)),
        tangent(std::sqrt(std::max(0.0, beyond4))),
        m_x(x),
        m_y(y),
        m_theta(rho < kSame ? -words.half : kUnknown) {}

  /** Direction; of the same circle, the start's heading. */
  double theta() { return m_theta == kUnknown ? m_theta = std::atan2(m_y, m_x) : m_theta; }
  /** Angle between theta and the inner tangent. */
  double delta() { return m_delta == kUnknown ? m_delta = std::atan2(2, tangent) : m_delta; }

  const View view;
  const double beyond4, rho, tangent;  ///< distance rho, rho^2 - 4, root of that

 private:
  static constexpr double kUnknown = 10;
  const double m_x, m_y;
  double m_theta, m_delta = kUnknown;
};

/** What lies between a word's first and last arc: to the right, straight, to the left. Any of it
 * may be missing, so that all words, or their mirror images or ways back, are of this kind. */
struct Middle {
  double right, straight, left;  ///< change of heading on arcs, length of the straight

  double turn() const { return right + left; }
  double length() const { return std::abs(right) + std::abs(straight) + std::abs(left); }
};

/** A solved word: its first arc, to the left, ends at a heading. */
struct Candidate {
  double heading;
  Middle middle;
  int last;  ///< 1: ends on a circle to the left, -1: to the right
  View view;

  double firstTurn() const { return heading + view.half; }
  double lastTurn() const { return view.half - heading - middle.turn(); }
  double length() const { return middle.length() + arc(firstTurn()) + arc(lastTurn()); }
};

/** The shortest word to a goal whose coordinates are taken as positive.
 *
 * To solve a word is to find the headings at which its segments meet. Its first and last arc then
 * go the shorter way round, so that each candidate is a curve that can be driven, whatever the
 * rounding. Functions are named by letters: Left, Right, Straight; U: two arcs as long as each
 * other; Q: a quarter turn. Words that cannot be short enough are not solved: the ends turn by the
 * change of heading that the middle does not make. */
class Search {
 public:
  explicit Search(const Goal& goal)
      : m_turn(2 * std::abs(goal.half)), m_quarter(std::max(m_turn, kPi - m_turn)) {
    const double x = std::abs(goal.x), y = std::abs(goal.y), half = std::abs(goal.half);
    const View asNamed{half}, mirrored{-half, true};
    const double behind = x - 2 * goal.s, ahead = x + 2 * goal.s;
    Centers ll(behind, y, behind * behind + y * y - 4, asNamed);
    Centers rr(ahead, -y, ahead * ahead + y * y - 4, mirrored);
    const double beyond4 = x * x + y * y - 4 * goal.s * goal.s, across = 4 * y * goal.c;
    Centers lr(x, y - 2 * goal.c, beyond4 - across, asNamed);
    Centers rl(x, -y - 2 * goal.c, beyond4 + across, mirrored);
    run(ll, rr, lr, rl);
  }

  double length() const { return m_length; }
  const Candidate& shortest() const { return m_shortest; }

 private:
  void run(Centers& ll, Centers& rr, Centers& lr, Centers& rl) {
    lsl(ll), lsr(lr), lsl(rr), lsr(rl);
    lrl(ll), lrl(rr);
    lqsl(ll), lqsl(rr), lqsr(lr), lqsr(rl);
    luur(lr), luur(rl), luru(lr), luru(rl);
    lqsqr(lr), lqsqr(rl);
  }

  void lsl(Centers& c) {
    if (tooLong(c.rho + m_turn)) return;
    offer({c.theta(), {0, c.rho, 0}, 1, c.view});
    offer({c.theta() + kPi, {0, -c.rho, 0}, 1, c.view});
  }

  void lsr(Centers& c) {
    if (c.beyond4 < 0 || tooLong(c.tangent + m_turn)) return;
    offer({c.theta() + c.delta(), {0, c.tangent, 0}, -1, c.view});
    offer({c.theta() + kPi - c.delta(), {0, -c.tangent, 0}, -1, c.view});
  }

  /** Gears as in L+R-L+, L+R-L- and L+R+L-. */
  void lrl(Centers& c) {
    if (c.rho > 4 || tooLong(std::max(c.rho / 2, m_turn))) return;
    const double half = std::asin(c.rho / 4);
    offer({c.theta() + kPi - half, {2 * half, 0, 0}, 1, c.view});
    offer({c.theta() + half, {-2 * half, 0, 0}, 1, c.view});
  }

  /** L+R-S-L- with a quarter turn to the right, and from its end. */
  void lqsl(Centers& c) {
    const double straight = c.tangent - 2;
    if (straight < 0 || tooLong(straight + m_quarter)) return;
    for (const bool reversed : {false, true}) {
      const View view{c.view.half, c.view.mirrored, reversed};
      const double heading = (reversed ? -c.theta() : c.theta()) + kHalfPi;
      offer({heading - c.delta(), {-kHalfPi, straight, 0}, 1, view});
      offer({heading + c.delta(), {kHalfPi, -straight, 0}, 1, view});
    }
  }

  /** L+R-S-R- with a quarter turn in the middle, and RSRL from its end. */
  void lqsr(Centers& c) {
    const double straight = c.rho - 2;
    if (straight < 0 || tooLong(straight + m_quarter)) return;
    for (const View& view : {c.view, View{-c.view.half, !c.view.mirrored, true}}) {
      offer({c.theta() + kHalfPi, {-kHalfPi, straight, 0}, -1, view});
      offer({c.theta() + kHalfPi, {kHalfPi, -straight, 0}, -1, view});
    }
  }

  /** L+R+L-R-, both in the middle as long as each other. */
  void luur(Centers& c) {
    if (c.beyond4 > 0) return;
    const double sine2 = -c.beyond4 / (8 * (2 + c.rho));  // of u / 2, squared
    if (tooLong(std::max(m_turn, 4 * std::sqrt(sine2)))) return;
    const double u = 2 * std::asin(std::sqrt(sine2));
    offer({c.theta() + kHalfPi + u, {-u, 0, -u}, -1, c.view});
    offer({c.theta() + kHalfPi - u, {u, 0, u}, -1, c.view});
  }

  /** L+R-L-R+, both in the middle as long as each other, at most a quarter turn. */
  void luru(Centers& c) {
    if (c.beyond4 < 0 || c.beyond4 > 16 || tooLong(c.tangent / M_SQRT2 + m_turn)) return;
    const double u = 2 * std::asin(c.tangent / std::sqrt(32));
    const double gamma = std::asin(2 * std::sin(u) / c.rho);
    offer({c.theta() + kHalfPi + gamma, {u, 0, -u}, -1, c.view});
    offer({c.theta() + kHalfPi - gamma, {-u, 0, u}, -1, c.view});
  }

  /** L+R-S-L-R+ with two quarter turns. */
  void lqsqr(Centers& c) {
    const double straight = c.tangent - 4;
    if (straight < 0 || tooLong(straight + kPi + m_turn)) return;
    offer({c.theta() + kHalfPi - c.delta(), {-kHalfPi, straight, kHalfPi}, -1, c.view});
    offer({c.theta() + kHalfPi + c.delta(), {kHalfPi, -straight, -kHalfPi}, -1, c.view});
  }

  bool tooLong(double bound) const { return bound >= m_limit; }

  void offer(const Candidate& candidate) {
    const double length = candidate.length();
    if (length >= m_limit) return;
    m_shortest = candidate;
    m_length = length;
    m_limit = length * (1 - kTie);
  }

  const double m_turn;     ///< change of heading
  const double m_quarter;  ///< length of a quarter turn and what the ends then turn at least
  double m_length = std::numeric_limits<double>::infinity(), m_limit = m_length;
  Candidate m_shortest{};
};

/** The word as it is named: one turn to the left ... */
Word wordOf(const Candidate& w) {
  return {{{wrappedQuickly(w.firstTurn()), 1},
           {-w.middle.right, -1},
           {w.middle.straight, 0},
           {w.middle.left, 1},
           {w.last * wrappedQuickly(w.lastTurn()), w.last}}};
}

/** Undoes how a word was looked at: a goal with positive coordinates, and the word's own view. */
void undo(const Goal& goal, const View& view, Word& word) {
  const bool otherGear = goal.x < 0;
  const bool mirrored = otherGear ? goal.half > 0 : goal.half < 0;
  const bool reversed = mirrored ? goal.y > 0 : goal.y < 0;
  if (reversed != view.reversed) std::reverse(word.begin(), word.end());
  for (ReedsSheppCurve::Segment& segment : word) {
    if (mirrored != view.mirrored) segment.turn = -segment.turn;
    if (otherGear) segment.length = -segment.length;
  }
}

/** The shortest of the 48 words of Reeds and Shepp (1990) between two poses, turning radius 1. Of
 * words that are as long within rounding, one with fewer segments or cusps, and always the same. */
Word shortestWord(const TPose2D& from, const TPose2D& to) {
  const Goal goal(from, to);
  const Search search(goal);
  Word word = wordOf(search.shortest());
  undo(goal, search.shortest().view, word);
  for (ReedsSheppCurve::Segment& segment : word)
    if (std::abs(segment.length) * (1 + search.length()) < kNoSegment) segment.length = 0;
  return word;
}

constexpr double kTurn = 2 * M_PI;
constexpr double kSameTurn =
    1e-9;  // arcs that only rounding keeps from being none, or a whole turn

/** Into [0, a whole turn). */
double positive(double angle) {
  const double turned = angle - kTurn * std::floor(angle / kTurn);
  return turned > kTurn - kSameTurn ? 0 : turned;
}

/** Finds the shortest of the six words of Dubins (1957), which only go forward. It solves the words
 * that begin with an arc to the left; the others are their mirror images. */
class ForwardSearch {
 public:
  ForwardSearch(const TPose2D& from, const TPose2D& to) {
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
    for (std::size_t i = 0; i < 3; ++i) m_shortest[i] = {lengths[i], turns[i]};
  }

  double m_length = std::numeric_limits<double>::infinity();
  Word m_shortest{};
};

constexpr double kNoLength = 1e-9;  // m: sums of segments' lengths are not exact

/** Where `s` meters (negative: backwards) along a segment lead. */
TPose2D advance(const TPose2D& p, int turn, double s, double radius) {
  if (turn == 0) return {p.x + s * std::cos(p.phi), p.y + s * std::sin(p.phi), p.phi};
  const double phi = p.phi + turn * s / radius;
  return {p.x + turn * radius * (std::sin(phi) - std::sin(p.phi)),
          p.y - turn * radius * (std::cos(phi) - std::cos(p.phi)), std::remainder(phi, 2 * M_PI)};
}

}  // namespace

ReedsSheppCurve::ReedsSheppCurve(const TPose2D& from, double turningRadius,
                                 const std::array<Segment, 5>& segments)
    : m_from(from), m_radius(turningRadius), m_segments(segments), m_length(0) {
  for (const Segment& segment : segments) m_length += std::abs(segment.length);
}

CurvePoint ReedsSheppCurve::at(double s) const {
  CurvePoint point{m_from};
  double left = std::clamp(s, 0.0, m_length);
  for (const Segment& segment : m_segments) {
    if (segment.length == 0) continue;
    const double length = std::min(left, std::abs(segment.length));
    point.pose = advance(point.pose, segment.turn, std::copysign(length, segment.length), m_radius);
    point.curvature = segment.turn / m_radius;
    point.forward = segment.length > 0;
    left -= length;
    if (left <= kNoLength) break;
  }
  return point;
}

ReedsSheppCurve ReedsSheppCurve::reversed() const {
  std::array<Segment, 5> segments;
  std::reverse_copy(m_segments.begin(), m_segments.end(), segments.begin());
  for (Segment& segment : segments) segment.length = -segment.length;
  return {at(m_length).pose, m_radius, segments};
}

ReedsShepp::ReedsShepp(double turningRadius) : m_radius(turningRadius) {
  if (!(turningRadius > 0) || !std::isfinite(turningRadius))
    throw std::invalid_argument("ReedsShepp: turning radius is " +
                                strict_files::textOf(turningRadius) + ", expected above 0");
}

TPose2D ReedsShepp::scaled(const TPose2D& pose) const {
  return {pose.x / m_radius, pose.y / m_radius, pose.phi};
}

double ReedsShepp::distance(const TPose2D& a, const TPose2D& b) const {
  return m_radius * Search(Goal(scaled(a), scaled(b))).length();
}

double ReedsShepp::lowerBound(const TPose2D& a, const TPose2D& b) const {
  return std::max(std::hypot(b.x - a.x, b.y - a.y),
                  m_radius * std::abs(std::remainder(b.phi - a.phi, 2 * M_PI)));
}

ReedsSheppCurve ReedsShepp::connect(const TPose2D& a, const TPose2D& b) const {
  return curveOf(a, shortestWord(scaled(a), scaled(b)));
}

ReedsSheppCurve ReedsShepp::connectForward(const TPose2D& a, const TPose2D& b) const {
  return curveOf(a, ForwardSearch(scaled(a), scaled(b)).shortest());
}

ReedsSheppCurve ReedsShepp::curveOf(const TPose2D& from,
                                    std::array<ReedsSheppCurve::Segment, 5> word) const {
  for (ReedsSheppCurve::Segment& segment : word) segment.length *= m_radius;
  return {from, m_radius, word};
}

}  // namespace semantic_planning
