#include <synthetic_world/Objects.h>

namespace synthetic_world {
namespace {

/** Builds parts given in an object's own frame: x ahead, y left, z up from the ground. */
class Assembly {
 public:
  Assembly(const Eigen::Vector3d& base, double yaw) : m_base(base), m_yaw(yaw) {}

  void box(const Eigen::Vector2d& at, const Eigen::Vector2d& size, double low, double high,
           Material material) {
    stump(at, size, at, size, low, high, material, material);
  }
  /** A box whose top may be smaller and elsewhere than its bottom. */
  void stump(const Eigen::Vector2d& at, const Eigen::Vector2d& size, const Eigen::Vector2d& topAt,
             const Eigen::Vector2d& topSize, double low, double high, Material side, Material top) {
    const auto outline = [&](const Eigen::Vector2d& center, const Eigen::Vector2d& s) {
      return placed(rectangle(center, 0, s.x(), s.y()), m_base.head<2>(), m_yaw);
    };
    parts.emplace_back(
        Polyhedron(outline(at, size), outline(topAt, topSize), m_base.z() + low, m_base.z() + high),
        side, top);
  }
  void shaft(const Eigen::Vector2d& at, double bottomRadius, double topRadius, double low,
             double high, Material material) {
    const Eigen::Vector2d center = placed({at}, m_base.head<2>(), m_yaw).front();
    parts.emplace_back(Shaft{center, bottomRadius, topRadius, m_base.z() + low, m_base.z() + high},
                       material);
  }
  void ball(const Eigen::Vector3d& at, double radius, double halfHeight, Material material) {
    const Eigen::Vector2d center = placed({at.head<2>()}, m_base.head<2>(), m_yaw).front();
    parts.emplace_back(Spheroid{{center.x(), center.y(), m_base.z() + at.z()}, radius, halfHeight},
                       material);
  }

  Solids parts;

 private:
  Eigen::Vector3d m_base;
  double m_yaw;
};

constexpr Color kRubber{38, 38, 40}, kGlass{58, 72, 86}, kSkin{206, 160, 130};

/** A low, upright panel between two points of the ground. */
Solids panel(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double thickness, double height,
             Material material) {
  const Eigen::Vector2d along = (b - a).head<2>();
  const Polygon outline = rectangle((a + b).head<2>() / 2, std::atan2(along.y(), along.x()),
                                    along.norm() + 0.02, thickness);
  const double low = std::min(a.z(), b.z()), high = std::max(a.z(), b.z());
  return {{Polyhedron(outline, outline, low - 0.6, high + height), material}};
}

}  // namespace

Solids car(const Eigen::Vector3d& base, double yaw, Color tint) {
  Assembly a(base, yaw);
  const Material paint(kCar, tint), rubber(kCar, kRubber), glass(kCar, kGlass);
  for (const double x : {-1.3, 1.35})
    for (const double y : {-0.78, 0.78}) a.box({x, y}, {0.62, 0.22}, -0.25, 0.5, rubber);
  a.box({0, 0}, {4.3, 1.76}, 0.26, 0.84, paint);
  a.stump({-0.25, 0}, {2.7, 1.66}, {-0.35, 0}, {1.5, 1.34}, 0.84, 1.46, glass, paint);
  return a.parts;
}

Solids person(const Eigen::Vector3d& base, double yaw, Color clothes, double stride) {
  Assembly a(base, yaw);
  const Material shirt(kPerson, clothes), trousers(kPerson, {58, 62, 84}), skin(kPerson, kSkin);
  const double step = 0.26 * std::sin(M_PI * stride);
  a.shaft({step, 0.1}, 0.09, 0.11, -0.1, 0.88, trousers);
  a.shaft({-step, -0.1}, 0.09, 0.11, -0.1, 0.88, trousers);
  a.shaft({0, 0}, 0.2, 0.22, 0.8, 1.45, shirt);
  a.shaft({-step, 0.28}, 0.06, 0.07, 0.75, 1.42, shirt);
  a.shaft({step, -0.28}, 0.06, 0.07, 0.75, 1.42, shirt);
  a.ball({0, 0, 1.62}, 0.12, 0.15, skin);
  return a.parts;
}

Solids bench(const Eigen::Vector3d& base, double yaw) {
  Assembly a(base, yaw);
  for (const double y : {-0.75, 0.75}) a.box({0, y}, {0.4, 0.1}, -0.3, 0.4, kBench);
  a.box({0, 0}, {0.5, 1.8}, 0.4, 0.47, kBench);
  a.box({-0.22, 0}, {0.08, 1.8}, 0.45, 0.85, kBench);
  return a.parts;
}

Solids lamp(const Eigen::Vector3d& base, double yaw) {
  Assembly a(base, yaw);
  a.shaft({0, 0}, 0.1, 0.06, -0.5, 5.2, kPole);
  a.box({0.6, 0}, {1.3, 0.08}, 5.1, 5.2, kPole);
  a.box({1.1, 0}, {0.6, 0.26}, 5.0, 5.12, Material(kPole, {226, 224, 206}));
  return a.parts;
}

Solids sign(const Eigen::Vector3d& base, double yaw) {
  Assembly a(base, yaw);
  a.shaft({0, 0}, 0.05, 0.05, -0.5, 2.7, kPole);
  a.box({0.07, 0}, {0.04, 0.75}, 2.0, 2.7, kSign);
  return a.parts;
}

Solids fencePanel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Solids result = panel(a, b, 0.05, 1.05, kFence);
  result.emplace_back(Shaft{a.head<2>(), 0.07, 0.07, a.z() - 0.5, a.z() + 1.2}, kFence);
  return result;
}

Solids wallPanel(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double height) {
  return panel(a, b, 0.3, height, kWall);
}

Solids roadblock(const Eigen::Vector3d& base, double yaw, double length) {
  Assembly a(base, yaw);
  const Material board(kFence, {214, 68, 52});
  a.box({0, 0}, {0.12, length}, 0.15, 1.1, board);
  for (const double y : {-length / 2, length / 2}) a.box({0, y}, {0.5, 0.3}, -0.4, 1.1, board);
  return a.parts;
}

}  // namespace synthetic_world
