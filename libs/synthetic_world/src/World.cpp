#include <synthetic_world/World.h>

#include <algorithm>
#include <limits>

namespace synthetic_world {

SolidIndex::SolidIndex(const Terrain& terrain, const Solids& solids)
    : m_halfExtent(terrain.halfExtent()), m_width(terrain.cells()), m_highest(terrain.highest()) {
  m_cells.reserve(static_cast<std::size_t>(m_width) * m_width);
  for (int cy = 0; cy < m_width; ++cy)
    for (int cx = 0; cx < m_width; ++cx) m_cells.push_back({terrain.cellTop(cx, cy), {}});
  for (std::size_t i = 0; i < solids.size(); ++i) insert(solids[i], static_cast<std::uint32_t>(i));
}

int SolidIndex::cellOf(double coordinate) const {
  const double cell = std::floor((coordinate + m_halfExtent) / Terrain::kCell);
  return static_cast<int>(std::clamp(cell, 0.0, m_width - 1.0));
}

void SolidIndex::insert(const Solid& solid, std::uint32_t number) {
  const Section section = *solid.section(solid.low(), solid.high());
  const Eigen::Vector2d low = solid.center().array() - solid.radius();
  const Eigen::Vector2d high = solid.center().array() + solid.radius();
  for (int cy = cellOf(low.y()); cy <= cellOf(high.y()); ++cy)
    for (int cx = cellOf(low.x()); cx <= cellOf(high.x()); ++cx) {
      const Eigen::Vector2d middle(cx + 0.5 - m_halfExtent, cy + 0.5 - m_halfExtent);
      // A margin, so that rounding in the walk along a ray never steps around a solid.
      if (section.distanceTo(rectangle(middle, 0, 1.001, 1.001)) > 0) continue;
      Cell& cell = m_cells[cy * m_width + cx];
      cell.solids.push_back(number);
      cell.top = std::max(cell.top, solid.high());
    }
  m_highest = std::max(m_highest, solid.high());
}

World::World(Terrain terrain, GroundCover cover, Solids solids)
    : m_terrain(std::move(terrain)),
      m_cover(std::move(cover)),
      m_solids(std::move(solids)),
      m_index(m_terrain, m_solids) {}

Eigen::Isometry3d World::poseOnGround(double x, double y, double yaw) const {
  const Eigen::Vector3d up = m_terrain.normal(x, y);
  // The horizontal heading, tilted onto the slope without turning its compass direction.
  const double c = std::cos(yaw), s = std::sin(yaw);
  const Eigen::Vector3d ahead =
      Eigen::Vector3d(c, s, -(up.x() * c + up.y() * s) / up.z()).normalized();
  Eigen::Isometry3d T_world_robot = Eigen::Isometry3d::Identity();
  T_world_robot.linear() << ahead, up.cross(ahead), up;
  T_world_robot.translation() << x, y, groundHeight(x, y);
  return T_world_robot;
}

namespace {

/** Collects the surfaces around a point, given by their signed distances. */
class TruthSearch {
 public:
  explicit TruthSearch(double tolerance) : m_tolerance(tolerance) {}

  /** \param solid Null for the ground. */
  void consider(double signedDistance, const Solid* solid) {
    const double far = std::abs(signedDistance);
    if (signedDistance > m_tolerance) return;
    Candidate& best = far <= m_tolerance ? m_surface : m_deep;
    if (far < best.far) best = {far, solid};
  }

  /** Deep in something hides the surfaces of others: nothing sees them. */
  PointTruth answer(const Eigen::Vector3d& p, ClassId ground) const {
    using State = PointTruth::State;
    const bool deep = m_deep.found();
    const Candidate& best = deep ? m_deep : m_surface;
    if (!best.found()) return {State::Free, kNoClass};
    if (!best.solid) return {deep ? State::Underground : State::Surface, ground};
    return {deep ? State::Inside : State::Surface, best.solid->materialAt(p).id};
  }

 private:
  struct Candidate {
    double far = std::numeric_limits<double>::infinity();
    const Solid* solid = nullptr;
    bool found() const { return std::isfinite(far); }
  };
  double m_tolerance;
  Candidate m_surface, m_deep;
};

}  // namespace

PointTruth World::at(const Eigen::Vector3d& p, double tolerance) const {
  TruthSearch search(tolerance);
  for (const Solid& s : m_movables) search.consider(s.signedDistance(p), &s);
  if (m_terrain.contains(p.x(), p.y()))
    search.consider(p.z() - groundHeight(p.x(), p.y()), nullptr);
  for (int cy = m_index.cellOf(p.y() - tolerance); cy <= m_index.cellOf(p.y() + tolerance); ++cy)
    for (int cx = m_index.cellOf(p.x() - tolerance); cx <= m_index.cellOf(p.x() + tolerance); ++cx)
      for (const std::uint32_t i : m_index.solids(cx, cy))
        search.consider(m_solids[i].signedDistance(p), &m_solids[i]);
  return search.answer(p, groundClass(p.x(), p.y()));
}

double World::clearance(const Footprint& footprint, double x, double y, double yaw,
                        double limit) const {
  const Polygon robot = placed(footprint.outline, {x, y}, yaw);
  const double ground = groundHeight(x, y);
  const double low = ground + footprint.clearance, high = ground + footprint.height;
  double least = limit;
  const auto consider = [&](const Solid& s) {
    if (const auto section = s.section(low, high))
      least = std::min(least, section->distanceTo(robot));
  };
  for (const Solid& s : m_movables) consider(s);

  Eigen::Vector2d from = robot.front(), to = robot.front();
  for (const Eigen::Vector2d& v : robot) from = from.cwiseMin(v), to = to.cwiseMax(v);
  for (int cy = m_index.cellOf(from.y() - limit); cy <= m_index.cellOf(to.y() + limit); ++cy)
    for (int cx = m_index.cellOf(from.x() - limit); cx <= m_index.cellOf(to.x() + limit); ++cx)
      for (const std::uint32_t i : m_index.solids(cx, cy)) consider(m_solids[i]);
  return least;
}

namespace {

constexpr double kCell = 2.0;  // meters

}  // namespace

GroundCover::GroundCover(double halfExtent, ClassId background)
    : m_halfExtent(halfExtent),
      m_width(static_cast<int>(std::ceil(2 * halfExtent / kCell))),
      m_background(background),
      m_cells(static_cast<std::size_t>(m_width) * m_width) {}

bool GroundCover::Stroke::covers(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d v = p - start;
  const double along = v.dot(direction);
  if (!round)
    return along >= 0 && along <= length &&
           (v - along * direction).squaredNorm() <= radius * radius;
  return (v - std::clamp(along, 0.0, length) * direction).squaredNorm() <= radius * radius;
}

int GroundCover::cellOf(double coordinate) const {
  const double cell = std::floor((coordinate + m_halfExtent) / kCell);
  return static_cast<int>(std::clamp(cell, 0.0, m_width - 1.0));
}

void GroundCover::paint(const Stroke& stroke) {
  const Eigen::Vector2d end = stroke.start + stroke.length * stroke.direction;
  const Eigen::Vector2d low = stroke.start.cwiseMin(end).array() - stroke.radius;
  const Eigen::Vector2d high = stroke.start.cwiseMax(end).array() + stroke.radius;
  for (int cy = cellOf(low.y()); cy <= cellOf(high.y()); ++cy)
    for (int cx = cellOf(low.x()); cx <= cellOf(high.x()); ++cx)
      m_cells[cy * m_width + cx].push_back(static_cast<std::uint32_t>(m_strokes.size()));
  m_strokes.push_back(stroke);
}

void GroundCover::paintStroke(ClassId id, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                              double radius) {
  const double length = (b - a).norm();
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
  if (length > 0) direction = (b - a) / length;
  paint({a, direction, length, radius, true, id});
}

void GroundCover::paintBand(ClassId id, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                            double width) {
  const double length = (b - a).norm();
  paint({a, (b - a) / length, length, width / 2, false, id});
}

void GroundCover::paintCurve(ClassId id, const Curve& curve, double radius) {
  const int pieces = std::max(1, static_cast<int>(std::ceil(curve.length() / 1.5)));
  const double step = curve.length() / pieces;
  for (int i = 0; i < pieces; ++i)
    paintStroke(id, curve.at(i * step), curve.at((i + 1) * step), radius);
}

ClassId GroundCover::at(double x, double y) const {
  const auto& cell = m_cells[cellOf(y) * m_width + cellOf(x)];
  for (auto i = cell.rbegin(); i != cell.rend(); ++i)
    if (m_strokes[*i].covers({x, y})) return m_strokes[*i].id;
  return m_background;
}

namespace {

double waveHeight(const Terrain::Wave& w, double x, double y) {
  const double along = x * std::cos(w.direction) + y * std::sin(w.direction);
  return w.amplitude * std::sin(2 * M_PI * along / w.length + w.phase);
}

/** Least root in [from, to] of a t^2 + b t + c, which is positive at `from`. */
std::optional<double> firstRoot(double a, double b, double c, double from, double to) {
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return std::nullopt;
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  const double r1 = q != 0 ? c / q : 0, r2 = a != 0 ? q / a : r1;
  for (const double r : {std::min(r1, r2), std::max(r1, r2)})
    if (r >= from && r <= to) return r;
  return std::nullopt;
}

}  // namespace

Terrain::Terrain(int halfExtent, const std::vector<Wave>& waves)
    : m_halfExtent(halfExtent), m_width(2 * halfExtent + 1) {
  m_nodes.reserve(static_cast<std::size_t>(m_width) * m_width);
  for (int ny = 0; ny < m_width; ++ny)
    for (int nx = 0; nx < m_width; ++nx) {
      double z = 0;
      for (const Wave& w : waves) z += waveHeight(w, nx - halfExtent, ny - halfExtent);
      m_nodes.push_back(z);
    }
  m_highest = *std::max_element(m_nodes.begin(), m_nodes.end());
}

double Terrain::height(double x, double y) const {
  const double fx = std::clamp(x + m_halfExtent, 0.0, 2 * m_halfExtent);
  const double fy = std::clamp(y + m_halfExtent, 0.0, 2 * m_halfExtent);
  const int cx = std::min(static_cast<int>(fx), cells() - 1);
  const int cy = std::min(static_cast<int>(fy), cells() - 1);
  const double u = fx - cx, v = fy - cy;
  return (1 - v) * ((1 - u) * node(cx, cy) + u * node(cx + 1, cy)) +
         v * ((1 - u) * node(cx, cy + 1) + u * node(cx + 1, cy + 1));
}

Eigen::Vector3d Terrain::normal(double x, double y) const {
  const double h = 0.25;
  return Eigen::Vector3d((height(x - h, y) - height(x + h, y)) / (2 * h),
                         (height(x, y - h) - height(x, y + h)) / (2 * h), 1)
      .normalized();
}

double Terrain::cellTop(int cx, int cy) const {
  return std::max(std::max(node(cx, cy), node(cx + 1, cy)),
                  std::max(node(cx, cy + 1), node(cx + 1, cy + 1)));
}

std::optional<double> Terrain::enter(int cx, int cy, const Eigen::Vector3d& o,
                                     const Eigen::Vector3d& d, double from, double to) const {
  // Along the ray, height above the cell's surface is a quadratic polynomial in the range.
  const double z00 = node(cx, cy), zu = node(cx + 1, cy) - z00, zv = node(cx, cy + 1) - z00;
  const double zuv = node(cx + 1, cy + 1) - z00 - zu - zv;
  const double u0 = o.x() + m_halfExtent - cx, v0 = o.y() + m_halfExtent - cy;
  const double a = -zuv * d.x() * d.y();
  const double b = d.z() - zu * d.x() - zv * d.y() - zuv * (u0 * d.y() + v0 * d.x());
  const double c = o.z() - z00 - zu * u0 - zv * v0 - zuv * u0 * v0;
  if ((a * from + b) * from + c <= 0) return from;
  if (const auto root = firstRoot(a, b, c, from, to)) return root;
  // Rounding can hide a root at the very end.
  if ((a * to + b) * to + c <= 0) return to;
  return std::nullopt;
}

namespace {

/** The cells of the terrain under a ray, one after the other (Amanatides and Woo 1987). */
class GridWalk {
 public:
  /** The part of the ray between the ranges `from` and `to`, which must lie over the terrain. */
  GridWalk(const Terrain& terrain, const Eigen::Vector3d& o, const Eigen::Vector3d& d, double from,
           double to)
      : m_cells(terrain.cells()), m_enter(from), m_end(to) {
    for (int a = 0; a < 2; ++a) {
      const double start = o[a] + from * d[a] + terrain.halfExtent();
      cell[a] = static_cast<int>(std::clamp(std::floor(start), 0.0, m_cells - 1.0));
      m_step[a] = d[a] > 0 ? 1 : -1;
      m_delta[a] = d[a] == 0 ? kNever : Terrain::kCell / std::abs(d[a]);
      const double border = cell[a] + (d[a] > 0 ? 1 : 0) - terrain.halfExtent();
      m_next[a] = d[a] == 0 ? kNever : (border - o[a]) / d[a];
    }
  }

  int cell[2];
  /** Ranges at which the ray enters and leaves the cell. */
  double enter() const { return m_enter; }
  double leave() const { return std::max(m_enter, std::min({m_next[0], m_next[1], m_end})); }

  /** Goes to the next cell. \return false at the end of the ray or of the terrain. */
  bool advance() {
    const int a = m_next[0] < m_next[1] ? 0 : 1;
    if (m_next[a] >= m_end) return false;
    m_enter = std::max(m_enter, m_next[a]);
    m_next[a] += m_delta[a];
    cell[a] += m_step[a];
    return cell[a] >= 0 && cell[a] < m_cells;
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  int m_cells, m_step[2];
  double m_enter, m_end, m_delta[2], m_next[2];
};

/** The nearest entry among those offered so far; solid == nullptr stands for the ground. */
struct Nearest {
  Entry entry{std::numeric_limits<double>::infinity(), Eigen::Vector3d::UnitZ(), 0};
  const Solid* solid = nullptr;

  void offer(const Solid& s, const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
    const auto e = s.enter(o, d);
    if (e && e->range < entry.range) entry = *e, solid = &s;
  }
};

/** Part of the ray that is over the terrain and below `highest`; empty if from > to. */
struct Span {
  double from, to;
};

Span clip(const Eigen::Vector3d& o, const Eigen::Vector3d& d, double halfExtent, double highest,
          double maxRange) {
  Span span{0, maxRange};
  const auto keepBelow = [&](double position, double speed, double limit) {
    if (speed > 0) span.to = std::min(span.to, (limit - position) / speed);
    if (speed < 0) span.from = std::max(span.from, (limit - position) / speed);
    if (speed == 0 && position > limit) span.to = -1;
  };
  for (int a = 0; a < 2; ++a) {
    keepBelow(o[a], d[a], halfExtent);
    keepBelow(-o[a], -d[a], halfExtent);
  }
  keepBelow(o.z(), d.z(), highest);
  return span;
}

}  // namespace

std::optional<Hit> World::castRay(const Eigen::Vector3d& o, const Eigen::Vector3d& d,
                                  double maxRange) const {
  Nearest nearest;
  for (const Solid& s : m_movables) nearest.offer(s, o, d);

  const Span span = clip(o, d, halfExtent(), m_index.highest(), maxRange);
  if (span.from <= span.to) {
    GridWalk walk(m_terrain, o, d, span.from, span.to);
    do {
      const int cx = walk.cell[0], cy = walk.cell[1];
      const double in = walk.enter(), out = walk.leave();
      if (o.z() + std::min(in * d.z(), out * d.z()) > m_index.top(cx, cy)) continue;
      for (const std::uint32_t i : m_index.solids(cx, cy)) nearest.offer(m_solids[i], o, d);
      const auto ground = m_terrain.enter(cx, cy, o, d, in, out);
      if (ground && *ground < nearest.entry.range)
        nearest = {{*ground, Eigen::Vector3d::UnitZ(), 0}, nullptr};
      if (nearest.entry.range <= out) break;
    } while (walk.advance());
  }

  if (!(nearest.entry.range <= maxRange)) return std::nullopt;
  Hit hit{nearest.entry.range, o + nearest.entry.range * d, nearest.entry.normal, {}};
  if (nearest.solid) {
    hit.material = nearest.solid->materialAt(hit.point, nearest.entry.face);
  } else {
    hit.normal = m_terrain.normal(hit.point.x(), hit.point.y());
    hit.material = groundClass(hit.point.x(), hit.point.y());
  }
  return hit;
}

}  // namespace synthetic_world
