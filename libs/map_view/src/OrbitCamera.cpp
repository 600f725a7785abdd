#include <map_view/OrbitCamera.h>

#include <strict_files/OptionList.h>
#include <strict_files/TextFile.h>

#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace map_view {
namespace {

constexpr double kRadians = M_PI / 180;

}  // namespace

Eigen::Vector3d OrbitCamera::forward() const {
  const double a = azimuth * kRadians, e = elevation * kRadians;
  return {-std::cos(a) * std::cos(e), -std::sin(a) * std::cos(e), -std::sin(e)};
}

Eigen::Vector3d OrbitCamera::right() const {
  const double a = azimuth * kRadians;
  return {-std::sin(a), std::cos(a), 0};
}

double OrbitCamera::focalLength(int height) const {
  return height / 2.0 / std::tan(fieldOfView * kRadians / 2);
}

Ray OrbitCamera::rayThrough(int x, int y, int width, int height) const {
  const double f = focalLength(height);
  const Eigen::Vector3d direction =
      forward() + right() * ((x + 0.5 - width / 2.0) / f) - up() * ((y + 0.5 - height / 2.0) / f);
  return {position(), direction.normalized()};
}

std::optional<Eigen::Vector2d> OrbitCamera::pixelOf(const Eigen::Vector3d& place, int width,
                                                    int height) const {
  const Eigen::Vector3d to = place - position();
  const double deep = to.dot(forward()), f = focalLength(height);
  if (deep <= 0) return {};
  return Eigen::Vector2d(width / 2.0 + f * to.dot(right()) / deep - 0.5,
                         height / 2.0 - f * to.dot(up()) / deep - 0.5);
}

bool OrbitCamera::maySee(const Eigen::Vector3d& center, double radius, int width,
                         int height) const {
  const Eigen::Vector3d to = center - position();
  const double f = focalLength(height), deep = to.dot(forward());
  // Signed distance to each side of the pyramid of what is seen, through the camera.
  const auto isBeside = [&](double aside, double half) {
    return std::fabs(aside) * f - deep * half > radius * std::hypot(f, half);
  };
  return deep > -radius && !isBeside(to.dot(right()), width / 2.0) &&
         !isBeside(to.dot(up()), height / 2.0);
}

OrbitCamera OrbitCamera::seeing(const Eigen::AlignedBox3d& box, int width, int height) const {
  OrbitCamera camera = *this;
  if (box.isEmpty()) return camera;
  camera.target = box.center();
  camera.distance = 1e-3;
  const double f = focalLength(height);
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d to =
        box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)) - camera.target;
    const double deep = to.dot(forward());
    for (const auto& [aside, half] :
         {std::pair(to.dot(right()), width / 2.0), std::pair(to.dot(up()), height / 2.0)})
      camera.distance = std::max(camera.distance, std::fabs(aside) * f / half - deep);
  }
  return camera;
}

std::string OrbitCamera::text() const {
  std::string text;
  for (const double number : {target.x(), target.y(), target.z(), distance, azimuth, elevation}) {
    std::ostringstream rounded;
    const strict_files::ClassicNumbers classic(rounded);
    rounded << std::round(number * 1000) / 1000;
    text += (text.empty() ? "" : ",") + rounded.str();
  }
  return text;
}

OrbitCamera OrbitCamera::ofText(const std::string& text) {
  std::array<double, 6> n{};
  std::istringstream words(text);
  std::string word;
  std::size_t count = 0;
  for (; std::getline(words, word, ','); ++count)
    if (count < n.size()) n[count] = strict_files::numberOf(word);
  if (count != n.size())
    throw std::invalid_argument("expected X,Y,Z,DISTANCE,AZIMUTH,ELEVATION, found '" + text + "'");
  OrbitCamera camera;
  camera.target = {n[0], n[1], n[2]};
  camera.distance = n[3], camera.azimuth = n[4], camera.elevation = n[5];
  const bool fine = camera.target.allFinite() && std::isfinite(camera.azimuth) &&
                    camera.distance > 0 && std::isfinite(camera.distance) &&
                    std::fabs(camera.elevation) <= 90;
  if (!fine)
    throw std::invalid_argument("is '" + text +
                                "', expected a distance above 0 and an elevation of -90 to 90");
  return camera;
}

using semantic_octree::kKeyOfOrigin;
using semantic_octree::kNumKeys;

namespace {

/** Walks along a ray from cube to cube. All in voxels, from the map's lowest corner. */
class RayWalk {
 public:
  RayWalk(const Ray& ray, double voxelSize)
      : m_origin(ray.origin.array() / voxelSize + kKeyOfOrigin), m_direction(ray.direction) {
    // Into the map, if the ray begins outside.
    double enter = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = m_direction[axis], o = m_origin[axis];
      if (d > 0) enter = std::max(enter, -o / d);
      if (d < 0) enter = std::max(enter, (kNumKeys - o) / d);
    }
    m_key = at(enter).floor().cast<int>();
    // Rounding must not leave a ray that enters through a side beside it.
    for (int axis = 0; axis < 3; ++axis)
      if (m_key[axis] == kNumKeys && m_direction[axis] < 0) --m_key[axis];
  }

  const Eigen::Array3i& key() const { return m_key; }
  bool isInMap() const { return (m_key >= 0).all() && (m_key < kNumKeys).all(); }

  void leave(const ViewCell& cell) {
    const Eigen::Array3i end = cell.lowest + cell.edge();
    int through = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const double d = m_direction[axis];
      if (d == 0) continue;
      const double t = ((d > 0 ? end[axis] : cell.lowest[axis]) - m_origin[axis]) / d;
      if (t < least) least = t, through = axis;
    }
    m_key = at(least).floor().cast<int>().max(cell.lowest).min(end - 1);
    m_key[through] = m_direction[through] > 0 ? end[through] : cell.lowest[through] - 1;
  }

 private:
  Eigen::Array3d at(double t) const { return m_origin + t * m_direction; }

  Eigen::Array3d m_origin, m_direction;
  Eigen::Array3i m_key;
};

}  // namespace

std::optional<ViewCell> firstShown(const CellSource& cells, const CellLook& look, const Ray& ray) {
  for (RayWalk walk(ray, cells.map().getResolution()); walk.isInMap();) {
    const ViewCell cell = cells.at(walk.key());
    if (cell.isOccupied() && look.isShown(cell)) return cell;
    walk.leave(cell);
  }
  return {};
}

}  // namespace map_view
