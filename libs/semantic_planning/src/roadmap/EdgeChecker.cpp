#include <semantic_planning/roadmap/EdgeChecker.h>

#include <algorithm>
#include <cmath>

#include "ground/GroundTiles.h"
#include "vehicle/CurveWalk.h"

namespace semantic_planning {

using colored_graph::EdgeProfile;
using mrpt::math::TPose2D;

namespace {

/** Number of pieces, at most half a voxel long each. */
int pieces(double length, double voxelSize) {
  return std::max(1, static_cast<int>(std::ceil(2 * length / voxelSize)));
}

/** Arc lengths of points at most half a voxel apart, among them the ends of all segments. */
std::vector<double> stations(const ReedsSheppCurve& curve, double voxelSize) {
  std::vector<double> at = {0};
  double begin = 0;
  for (const ReedsSheppCurve::Segment& segment : curve.segments()) {
    const double length = std::abs(segment.length);
    if (length < 1e-9) continue;
    const int n = pieces(length, voxelSize);
    for (int i = 1; i <= n; ++i) at.push_back(begin + length * i / n);
    begin += length;
  }
  return at;
}

/** Lengths by class, meters, in the graph's units; they add up to the total. */
EdgeProfile rounded(const std::vector<double>& lengths, double total) {
  EdgeProfile profile;
  colored_graph::Length left = colored_graph::lengthUp(total);
  for (std::size_t id = 0; id < lengths.size(); ++id) {
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

}  // namespace

EdgeChecker::EdgeChecker(const Ground& ground, const VehicleOptions& vehicle,
                         const colored_graph::ClassOrder& order, const ClassReading& reading)
    : m_ground(ground), m_order(order), m_reading(reading), m_reedsShepp(vehicle.turningRadius) {
  vehicle.validate();
  reading.validate();
  const double voxel = ground.voxelSize(), rise = std::tan(vehicle.maxSlope * M_PI / 180);
  const auto tolerance = [&](double distance) {
    return ground.step() + static_cast<int>(std::ceil(rise * distance / voxel));
  };
  m_reach = vehicle.wheelTrack / 2;
  for (const Disc& disc : vehicle.footprint.coveringDiscs()) {
    const double needed = (disc.radius + vehicle.clearance) / voxel;
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

inline const Surface* EdgeChecker::near(Column c, int z, int tolerance) const {
  return surfaceNear(m_ground.layers().surfaces(), c, z, tolerance);
}

std::optional<GroundPose> EdgeChecker::place(const TPose2D& pose,
                                             std::optional<double> nearZ) const {
  const auto point = m_ground.find(pose.x, pose.y, nearZ);
  if (!point) return std::nullopt;
  return GroundPose{pose, point->surface.z};
}

bool EdgeChecker::discsFit(const Placement& placed, int z) const {
  for (const CheckedDisc& d : m_discs) {
    const auto [x, y] = placed(d.disc.x, d.disc.y);
    const Surface* s = near(m_ground.columnAt(x, y), z, d.tolerance);
    if (!s || !s->drivable || s->clearance2 < d.needed2) return false;
  }
  return true;
}

Fit EdgeChecker::fit(const GroundPose& pose) const {
  const Surface* s = near(m_ground.columnAt(pose.pose.x, pose.pose.y), pose.z, 0);
  if (!s || !s->drivable) return Fit::OffGround;
  return discsFit(Placement(pose.pose), pose.z) ? Fit::Free : Fit::Blocked;
}

template <class F>
bool EdgeChecker::forWheels(const Placement& placed, int z, F f) const {
  for (const double y : m_wheels) {
    const auto [wx, wy] = placed(0, y);
    const Column c = m_ground.columnAt(wx, wy);
    const Surface* s = near(c, z, m_wheelTolerance);
    if (!s) return false;
    f(*s, c);
  }
  return true;
}

ClassId EdgeChecker::read(Column c, const Surface& s) const {
  if (m_reading.kind != ClassReading::Kind::Cautious || s.filled) return s.classId;
  const auto* node = m_ground.map().search(
      {static_cast<std::uint16_t>(c.x), static_cast<std::uint16_t>(c.y), s.z});
  if (!node) return s.classId;
  const std::vector<double> p = m_ground.map().distribution(*node);
  ClassId worst = s.classId;
  for (std::size_t id = 1; id < p.size(); ++id)
    if (p[id] > m_reading.leastProbability * (1 - p[0]) && m_order.rank(id) > m_order.rank(worst))
      worst = static_cast<ClassId>(id);
  return worst;
}

std::optional<ClassId> EdgeChecker::worstUnderWheels(const Placement& placed, int z) const {
  std::optional<ClassId> worst;
  const bool grounded = forWheels(placed, z, [&](const Surface& s, Column c) {
    const ClassId id = read(c, s);
    if (!worst || m_order.rank(id) > m_order.rank(*worst)) worst = id;
  });
  return grounded ? worst : std::nullopt;
}

ClassId EdgeChecker::classAt(const GroundPose& pose) const {
  return worstUnderWheels(Placement(pose.pose), pose.z).value_or(semantic_types::kNoClass);
}

/** Spreads a length over the classes that a voxel may have. */
void EdgeChecker::addDistribution(Column c, const Surface& s, double length,
                                  Lengths& lengths) const {
  const auto* node = s.filled ? nullptr
                              : m_ground.map().search({static_cast<std::uint16_t>(c.x),
                                                       static_cast<std::uint16_t>(c.y), s.z});
  if (!node) {
    lengths[s.classId] += length;
    return;
  }
  const std::vector<double> p = m_ground.map().distribution(*node);
  const double least = m_reading.leastProbability * (1 - p[0]);
  double sum = 0;
  for (std::size_t id = 1; id < p.size(); ++id) sum += p[id] > least ? p[id] : 0;
  if (sum == 0) lengths[s.classId] += length;
  for (std::size_t id = 1; id < p.size(); ++id)
    if (p[id] > least) lengths[id] += length * p[id] / sum;
}

bool EdgeChecker::addClasses(const Placement& placed, int z, double length,
                             Lengths& lengths) const {
  if (m_reading.kind == ClassReading::Kind::Expected)
    return forWheels(placed, z, [&](const Surface& s, Column c) {
      addDistribution(c, s, length / static_cast<double>(m_wheels.size()), lengths);
    });
  const auto worst = worstUnderWheels(placed, z);
  if (worst) lengths[*worst] += length;
  return worst.has_value();
}

std::optional<EdgeProfile> EdgeChecker::profile(const GroundPose& a, const GroundPose& b) const {
  const ReedsSheppCurve curve = m_reedsShepp.connect(a.pose, b.pose);
  const int n = pieces(curve.length(), m_ground.voxelSize());
  const double piece = curve.length() / n;
  Lengths lengths(m_order.classes());
  int z = a.z;
  const bool free = walkMiddles(curve, n, [&](const Placement& placed) {
    const Surface* s = near(m_ground.columnAt(placed.x, placed.y), z, m_ground.step());
    if (!s) return false;
    z = s->z;
    return discsFit(placed, z) && addClasses(placed, z, piece, lengths);
  });
  if (!free) return std::nullopt;
  if (std::abs(z - b.z) > m_ground.step()) return std::nullopt;
  EdgeProfile profile = rounded(lengths, curve.length());
  if (profile.empty()) profile.push_back({classAt(a), 0});  // from a pose to itself
  return profile;
}

std::vector<PathPoint> EdgeChecker::trace(const ReedsSheppCurve& curve, int z) const {
  std::vector<PathPoint> points;
  for (const double s : stations(curve, m_ground.voxelSize())) {
    const CurvePoint c = curve.at(s);
    const Surface* surface = near(m_ground.columnAt(c.pose.x, c.pose.y), z, m_ground.step());
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
