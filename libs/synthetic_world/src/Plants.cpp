#include <synthetic_world/Objects.h>

namespace synthetic_world {
namespace {

constexpr double kRoot = 0.6;  // m below the ground

Color mixed(Color a, Color b, double share) {
  const auto mix = [share](int x, int y) {
    return static_cast<std::uint8_t>(x + share * (y - x) + 0.5);
  };
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

Solid trunk(const Eigen::Vector3d& base, double radius, double height) {
  return {Shaft{base.head<2>(), radius * 1.3, radius * 0.7, base.z() - kRoot, base.z() + height},
          kTrunk};
}

Solid ball(const Eigen::Vector3d& center, double radius, double halfHeight, Material material) {
  return {Spheroid{center, radius, halfHeight}, material};
}

}  // namespace

Solids broadleafTree(const Eigen::Vector3d& base, Random& random) {
  const double stem = random.uniform(1.9, 2.8), crown = random.uniform(1.3, 2.2);
  const Material leaves(kCanopy, mixed({52, 98, 40}, {112, 138, 48}, random.uniform()));
  Solids tree{trunk(base, random.uniform(0.13, 0.24), stem + crown)};
  const Eigen::Vector3d middle = base + Eigen::Vector3d(0, 0, stem + 0.8 * crown);
  tree.push_back(ball(middle, crown, 0.9 * crown, leaves));
  const int lobes = 4;
  const double turn = random.uniform(0, 2 * M_PI);
  for (int i = 0; i < lobes; ++i) {
    const double angle = turn + i * 2 * M_PI / lobes, size = crown * random.uniform(0.5, 0.7);
    const Eigen::Vector3d offset(std::cos(angle), std::sin(angle), random.uniform(-0.2, 0.75));
    tree.push_back(ball(middle + 0.68 * crown * offset, size, 0.85 * size, leaves));
  }
  return tree;
}

Solids conifer(const Eigen::Vector3d& base, Random& random) {
  const double height = random.uniform(5, 9), width = height * random.uniform(0.17, 0.23);
  const Material needles(kCanopy, mixed({34, 74, 48}, {56, 92, 52}, random.uniform()));
  Solids tree{trunk(base, 0.16, 1.5)};
  for (int tier = 0; tier < 3; ++tier) {
    const double low = base.z() + 0.9 + tier * 0.27 * height, radius = width * (1 - 0.24 * tier);
    const double top = tier == 2 ? base.z() + height : low + 0.42 * height;
    tree.emplace_back(Shaft{base.head<2>(), radius, 0, low, top}, needles);
  }
  return tree;
}

Solids bush(const Eigen::Vector3d& base, Random& random) {
  const Material leaves(kBush, mixed({62, 106, 46}, {112, 138, 66}, random.uniform()));
  Solids result;
  for (int i = 0; i < 3; ++i) {
    const double size = random.uniform(0.35, 0.75);
    const Eigen::Vector3d offset(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 0.45 * size);
    result.push_back(ball(base + offset, size, 0.8 * size, leaves));
  }
  return result;
}

Solids rock(const Eigen::Vector3d& base, Random& random) {
  const double size = random.uniform(0.3, 0.8), height = size * random.uniform(0.6, 1.2);
  const Eigen::Vector2d at = base.head<2>();
  const double yaw = random.uniform(0, M_PI);
  const Material stone(kRock, mixed({118, 114, 108}, {158, 152, 142}, random.uniform()));
  Polygon bottom, top;
  for (int i = 0; i < 6; ++i) {
    const double angle = yaw + i * M_PI / 3 + random.uniform(-0.2, 0.2);
    const Eigen::Vector2d out(std::cos(angle), std::sin(angle));
    bottom.push_back(at + size * out);
    top.push_back(at + 0.55 * size * out);
  }
  return {{Polyhedron(bottom, top, base.z() - 0.2, base.z() + height), stone}};
}

Solids hedgePanel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector2d along = (b - a).head<2>();
  const Polygon outline =
      rectangle((a + b).head<2>() / 2, std::atan2(along.y(), along.x()), along.norm() + 0.15, 0.7);
  const double low = std::min(a.z(), b.z()), high = std::max(a.z(), b.z());
  return {{Polyhedron(outline, outline, low - kRoot, high + 1.0), kBush}};
}

}  // namespace synthetic_world
