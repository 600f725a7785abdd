#include <semantic_planning/roadmap/CollisionChecker.h>

#include <colored_graph/ColoredGraph.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <vector>

#include "ground/GroundTiles.h"
#include "ground/OpenGround.h"
#include "vehicle/CurveWalk.h"

namespace semantic_planning {

using colored_graph::EdgeProfile;
using mrpt::math::TPose2D;

namespace {

/** Lengths by class, meters, as integers that add up to the total. */
inline colored_graph::EdgeProfile rounded(const double* lengths, int classes, double total) {
  colored_graph::EdgeProfile profile;
  colored_graph::Length left = colored_graph::lengthUp(total);
  for (int id = 0; id < classes; ++id) {
    if (lengths[id] <= 0) continue;
    const auto length = std::min(left, colored_graph::lengthDown(lengths[id]));
    profile.push_back({static_cast<colored_graph::GraphClass>(id), length});
    left -= length;
  }
  const auto longest =
      std::max_element(profile.begin(), profile.end(),
                       [](const auto& l, const auto& r) { return l.length < r.length; });
  if (longest != profile.end()) longest->length += left;
  return profile;
}

/** Whether the budget reaches. */
bool pay(ClassBudget& budget, std::optional<ClassId> id, double length) {
  if (id) budget.left -= budget.prices[*id] * length;
  return !budget.isSpent();
}

/** How fast a disc's center moves on the tightest arc, in the origin's speed. */
double speedOf(const Disc& disc, double turningRadius) {
  return std::hypot(1 + std::abs(disc.y) / turningRadius, disc.x / turningRadius);
}

/** The column that a straight line between points of two columns, which only meet at a corner,
 * goes through between them. */
Column between(const Ground& ground, Column a, const mrpt::math::TPoint2D& from, Column b,
               const mrpt::math::TPoint2D& to) {
  const double half = ground.voxelSize() / 2;
  const auto share = [half](double side, double begin, double end) {
    return (side + (end > begin ? half : -half) - begin) / (end - begin);
  };
  const bool alongX =
      share(ground.centerOf(a.x), from.x, to.x) < share(ground.centerOf(a.y), from.y, to.y);
  return alongX ? Column{b.x, a.y} : Column{a.x, b.y};
}

}  // namespace

inline const Surface* CollisionChecker::near(Column c, int z, int tolerance) const {
  return surfaceNear(m_ground.layers().surfaces(), c, z, tolerance);
}

inline bool CollisionChecker::isFree(const CheckedDisc& d, Column c, int z) const {
  const Surface* s = near(c, z, d.tolerance);
  return s && s->drivable && s->clearance2 >= d.needed2;
}

/** Moves the vehicle from placement to placement and looks at all columns that its discs' centers
 * come through: what is between placements is seen, too. What lies below the same columns is not
 * looked up again; where it begins is not looked at. */
class CollisionChecker::Sweep {
 public:
  /** \param z key of the surface below the placement */
  Sweep(const CollisionChecker& checker, const Placement& begin, int z)
      : m_checker(checker),
        m_z(z),
        m_column(checker.m_ground.columnAt(begin.x, begin.y)),
        m_discs(discsOfThread()),
        m_last(begin) {
    placeDiscs();
  }

  int z() const { return m_z; }

  bool moveTo(const Placement& placed) {
    const Column column = m_checker.m_ground.columnAt(placed.x, placed.y);
    const int before = m_z;
    const bool wasFree = m_room.ofDiscs > 0;
    if (!(column == m_column) && !enter(column)) return false;
    if (wasFree && m_room.ofDiscs == 0) placeDiscs();
    for (std::size_t i = 0; m_room.ofDiscs == 0 && i < m_discs.size(); ++i)
      if (!move(m_checker.m_discs[i], placed, m_z != before, m_discs[i])) return false;
    m_last = placed;
    return true;
  }

  /** How far it may be driven from where it is so that it is free and over the same class, meters.
   */
  double room() const {
    if (m_room.ofDiscs == 0 || m_room.ofClass == 0) return 0;
    return (std::min(m_room.ofDiscs, m_room.ofClass) - 1) * m_checker.m_ground.voxelSize();
  }

  bool addClasses(const Placement& placed, double length, Lengths& lengths) {
    if (m_room.ofClass > 0) {
      lengths[*m_worst] += length;
      return true;
    }
    const WheelColumns wheels = m_checker.wheelColumns(placed);
    if (!m_worst || m_worstZ != m_z || wheels != m_wheels)
      m_worst = m_checker.worstUnder(wheels, m_z);
    m_wheels = wheels;
    m_worstZ = m_z;
    if (m_worst) lengths[*m_worst] += length;
    return m_worst.has_value();
  }
  /** Under the wheels where classes were added. */
  std::optional<ClassId> worst() const { return m_worst; }

 private:
  /** A thread's sweeps come one after another, and most are short: to ask for memory each time
   * would be a good part of their time. */
  static std::vector<Column>& discsOfThread() {
    thread_local std::vector<Column> discs;
    return discs;
  }

  /** Where there was room, each column between is at most a step from the next one. */
  bool enter(Column column) {
    const int columns = m_room.ofDiscs > 0 ? std::max(std::abs(column.x - m_column.x),
                                                      std::abs(column.y - m_column.y))
                                           : 1;
    const Surface* s = m_checker.near(column, m_z, columns * m_checker.m_ground.step());
    if (!s) return false;
    m_z = s->z;
    m_column = column;
    if (!m_checker.m_open) return true;
    m_room = m_checker.m_open->around(column);
    if (m_room.ofClass > 0) m_worst = s->classId, m_worstZ = INT_MIN;
    return true;
  }

  Column columnOf(const CheckedDisc& d, const Placement& placed) const {
    const auto [x, y] = placed(d.disc.x, d.disc.y);
    return m_checker.m_ground.columnAt(x, y);
  }

  /** Where they were last. */
  void placeDiscs() {
    m_discs.clear();
    for (const CheckedDisc& d : m_checker.m_discs) m_discs.push_back(columnOf(d, m_last));
  }

  bool move(const CheckedDisc& d, const Placement& placed, bool climbs, Column& last) const {
    const Column column = columnOf(d, placed);
    if (!climbs && column == last) return true;
    if (!m_checker.isFree(d, column, m_z)) return false;
    if (column.x != last.x && column.y != last.y && !isFreeBetween(d, last, column, placed))
      return false;
    last = column;
    return true;
  }

  bool isFreeBetween(const CheckedDisc& d, Column last, Column column,
                     const Placement& placed) const {
    const auto [fromX, fromY] = m_last(d.disc.x, d.disc.y);
    const auto [x, y] = placed(d.disc.x, d.disc.y);
    const Column corner = between(m_checker.m_ground, last, {fromX, fromY}, column, {x, y});
    return m_checker.isFree(d, corner, m_z);
  }

  const CollisionChecker& m_checker;
  int m_z;
  Column m_column;
  std::vector<Column>& m_discs;  ///< where they are
  Placement m_last;
  OpenGround::Room m_room;  ///< where it has some, the discs' places are not known
  WheelColumns m_wheels;
  std::optional<ClassId> m_worst;  ///< under the wheels, when they were there and at this height:
  int m_worstZ = 0;
};

CollisionChecker::CollisionChecker(const Ground& ground, const VehicleOptions& vehicle,
                                   const colored_graph::ClassOrder& order)
    : m_ground(ground), m_order(order), m_reedsShepp(vehicle.turningRadius), m_motionCost(vehicle) {
  vehicle.validate();
  const double voxel = ground.voxelSize(), rise = std::tan(vehicle.maxSlope * M_PI / 180);
  const auto tolerance = [&](double distance) {
    return ground.step() + static_cast<int>(std::ceil(rise * distance / voxel));
  };
  m_reach = vehicle.wheelTrack / 2;
  const std::vector<Disc> discs = vehicle.footprint.coveringDiscs(voxel);
  double fastest = 1;  // of the discs' centers, in the origin's speed
  for (const Disc& disc : discs) fastest = std::max(fastest, speedOf(disc, vehicle.turningRadius));
  m_piece = std::min(0.5, 1 / fastest) * voxel;
  for (const Disc& disc : discs) {
    const double bulge = speedOf(disc, vehicle.turningRadius) * m_piece * m_piece /
                         (8 * vehicle.turningRadius);  // of an arc beyond its chord
    const double needed = (disc.radius + vehicle.clearance + bulge) / voxel;
    const double offset = std::hypot(disc.x, disc.y);
    m_discs.push_back(
        {disc, static_cast<int>(std::ceil(needed * needed - 1e-9)), tolerance(offset)});
    m_reach = std::max(m_reach, offset);
  }
  m_reach += 2 * voxel;
  m_wheels = vehicle.wheelTrack == 0
                 ? std::vector<double>{0}
                 : std::vector<double>{-vehicle.wheelTrack / 2, vehicle.wheelTrack / 2};
  m_wheelTolerance = tolerance(vehicle.wheelTrack / 2);
}

CollisionChecker CollisionChecker::forSearch() const {
  constexpr int kMostReach = 12;  // columns: hardly any ground is open to long vehicles
  CollisionChecker checker(*this);
  // Another column where places are in two of them, another one for what discs come through at
  // corners.
  const int discs = static_cast<int>(m_reach / m_ground.voxelSize());
  const int wheels = static_cast<int>(m_wheels.back() / m_ground.voxelSize()) + 1;
  int needed2 = 0, tolerance = m_wheelTolerance;
  for (const CheckedDisc& d : m_discs)
    needed2 = std::max(needed2, d.needed2), tolerance = std::min(tolerance, d.tolerance);
  if (discs <= kMostReach)
    checker.m_open =
        std::make_shared<OpenGround>(m_ground, OpenGround::Reach{discs, tolerance},
                                     OpenGround::Reach{wheels, m_wheelTolerance}, needed2);
  return checker;
}

std::optional<GroundPose> CollisionChecker::place(const TPose2D& pose,
                                                  std::optional<double> nearZ) const {
  const auto point = m_ground.find(pose.x, pose.y, nearZ);
  if (!point) return std::nullopt;
  return GroundPose{pose, point->surface.z};
}

Fit CollisionChecker::fit(const GroundPose& pose) const {
  const Surface* s = near(m_ground.columnAt(pose.pose.x, pose.pose.y), pose.z, 0);
  if (!s || !s->drivable) return Fit::OffGround;
  const Placement placed(pose.pose);
  const bool isFree = std::all_of(m_discs.begin(), m_discs.end(), [&](const CheckedDisc& d) {
    const auto [x, y] = placed(d.disc.x, d.disc.y);
    return this->isFree(d, m_ground.columnAt(x, y), pose.z);
  });
  return isFree ? Fit::Free : Fit::Blocked;
}

inline CollisionChecker::WheelColumns CollisionChecker::wheelColumns(
    const Placement& placed) const {
  WheelColumns columns;
  for (std::size_t i = 0; i < m_wheels.size(); ++i) {
    const auto [x, y] = placed(0, m_wheels[i]);
    columns[i] = m_ground.columnAt(x, y);
  }
  return columns;
}

std::optional<ClassId> CollisionChecker::worstUnder(const WheelColumns& wheels, int z) const {
  std::optional<ClassId> worst;
  for (std::size_t i = 0; i < m_wheels.size(); ++i) {
    const Surface* s = near(wheels[i], z, m_wheelTolerance);
    if (!s) return std::nullopt;
    if (!worst || m_order.rank(s->classId) > m_order.rank(*worst)) worst = s->classId;
  }
  return worst;
}

ClassId CollisionChecker::classAt(const GroundPose& pose) const {
  return worstUnder(wheelColumns(Placement(pose.pose)), pose.z).value_or(semantic_types::kNoClass);
}

std::optional<EdgeProfile> CollisionChecker::profile(const GroundPose& a,
                                                     const GroundPose& b) const {
  return profile(m_motionCost.shortest(a.pose, b.pose), a.z, b.z);
}

std::optional<EdgeProfile> CollisionChecker::profile(const ReedsSheppCurve& curve, int from, int to,
                                                     ClassBudget* budget) const {
  const int n = std::max(1, static_cast<int>(std::ceil(curve.length() / m_piece)));
  const double piece = curve.length() / n;
  Lengths lengths;
  std::fill_n(lengths.begin(), m_order.classes(), 0);
  Sweep sweep(*this, Placement(curve.from()), from);
  const auto fits = [&](const Placement& placed) { return sweep.moveTo(placed); };
  const auto counts = [&](const Placement& placed, int left) {
    if (!sweep.moveTo(placed)) return 0;
    const int pieces = std::clamp(static_cast<int>(sweep.room() / piece), 1, left);
    for (int i = 0; i < pieces; ++i)
      if (!sweep.addClasses(placed, piece, lengths) ||
          (budget && !pay(*budget, sweep.worst(), piece)))
        return 0;
    return pieces;
  };
  const bool isFree = walkCurve(curve, n, counts, fits);
  if (!isFree) return std::nullopt;
  if (std::abs(sweep.z() - to) > m_ground.step()) return std::nullopt;
  EdgeProfile profile = rounded(lengths.data(), m_order.classes(), curve.length());
  if (profile.empty()) profile.push_back({classAt({curve.from(), from}), 0});  // without length
  return profile;
}

namespace {

/** Arc lengths of points at most half a voxel apart, among them the ends of all segments. */
std::vector<double> stations(const ReedsSheppCurve& curve, double voxelSize) {
  std::vector<double> at = {0};
  double begin = 0;
  for (const ReedsSheppCurve::Segment& segment : curve.segments()) {
    const double length = std::abs(segment.length);
    if (length < 1e-6) continue;  // what rounding leaves
    const int n = std::max(1, static_cast<int>(std::ceil(length / (voxelSize / 2))));
    for (int i = 1; i <= n; ++i) at.push_back(begin + length * i / n);
    begin += length;
  }
  return at;
}

}  // namespace

std::vector<PathPoint> CollisionChecker::trace(const ReedsSheppCurve& curve, int z) const {
  std::vector<PathPoint> points;
  for (const double s : stations(curve, m_ground.voxelSize())) {
    const CurvePoint c = curve.at(s);
    const Surface* surface =
        m_ground.near(m_ground.columnAt(c.pose.x, c.pose.y), z, m_ground.step());
    if (surface) z = surface->z;
    PathPoint p;
    p.x = c.pose.x, p.y = c.pose.y, p.z = m_ground.centerOf(z), p.heading = c.pose.phi;
    p.curvature = c.curvature, p.forward = c.forward;
    p.classId = classAt({c.pose, z});
    p.arcLength = s;
    points.push_back(p);
  }
  return points;
}

}  // namespace semantic_planning
