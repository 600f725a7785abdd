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

/** A low, upright panel between two points of the ground, which overlaps the next. */
Solids panel(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double overlap, double thickness,
             double height, Material material) {
  const Eigen::Vector2d along = (b - a).head<2>();
  const Polygon outline = rectangle((a + b).head<2>() / 2, std::atan2(along.y(), along.x()),
                                    along.norm() + overlap, thickness);
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
  Solids result = panel(a, b, 0.02, 0.05, 1.05, kFence);
  result.emplace_back(Shaft{a.head<2>(), 0.07, 0.07, a.z() - 0.5, a.z() + 1.2}, kFence);
  return result;
}

Solids wallPanel(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double height) {
  return panel(a, b, 0.02, 0.3, height, kWall);
}

Solids hedgePanel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return panel(a, b, 0.15, 0.7, 1.0, kBush);
}

Solids roadblock(const Eigen::Vector3d& base, double yaw, double length) {
  Assembly a(base, yaw);
  const Material board(kFence, {214, 68, 52});
  a.box({0, 0}, {0.12, length}, 0.15, 1.1, board);
  for (const double y : {-length / 2, length / 2}) a.box({0, y}, {0.5, 0.3}, -0.4, 1.1, board);
  return a.parts;
}

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
    const double y = random.uniform(-0.5, 0.5), x = random.uniform(-0.5, 0.5);
    const Eigen::Vector3d offset(x, y, 0.45 * size);
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

namespace {

constexpr double kFoundation = 3.0;  // m below the ground: hills may be steep

constexpr Color kPlaster[] = {{226, 214, 190}, {214, 188, 150}, {196, 128, 98}, {206, 206, 200},
                              {228, 206, 150}, {172, 110, 88},  {186, 196, 200}};
constexpr Color kTiles[] = {{150, 72, 54}, {124, 62, 50}, {96, 84, 84}, {166, 92, 64}};

Eigen::Vector2d ahead(double yaw) { return {std::cos(yaw), std::sin(yaw)}; }
Eigen::Vector2d leftOf(double yaw) { return {-std::sin(yaw), std::cos(yaw)}; }

Solid box(const Eigen::Vector2d& center, double yaw, const Eigen::Vector2d& size, double low,
          double high, Material side, Material top) {
  const Polygon outline = rectangle(center, yaw, size.x(), size.y());
  return {Polyhedron(outline, outline, low, high), side, top};
}

}  // namespace

Solids house(const Eigen::Vector3d& base, double yaw, const Eigen::Vector2d& size, int storeys,
             Random& random) {
  const Material plaster(kBuilding, kPlaster[random.below(7)]);
  const Material tiles(kRoof, kTiles[random.below(4)]), door(kBuilding, {98, 66, 48});
  const Eigen::Vector2d at = base.head<2>();
  const double floor = base.z() + 0.2, eaves = floor + storeys * kStorey;
  Solids result{
      box(at, yaw, size, base.z() - kFoundation, eaves, plaster, tiles).withWindows(floor)};
  result.emplace_back(Polyhedron::gable(at, yaw, size.x() + 0.8, size.y() + 1.0, eaves - 0.05,
                                        eaves + 0.34 * size.y()),
                      tiles);
  const Eigen::Vector2d doorAt = at + leftOf(yaw) * size.y() / 2;
  result.push_back(box(doorAt, yaw, {1.2, 0.16}, base.z() - 1, floor + 2.35, door, door));
  const Eigen::Vector2d chimney =
      at + ahead(yaw) * size.x() * random.uniform(-0.3, 0.3) + leftOf(yaw) * size.y() * 0.2;
  const Material brick(kRoof, {128, 70, 58});
  result.push_back(
      box(chimney, yaw, {0.7, 0.6}, eaves, eaves + 0.34 * size.y() + 0.7, brick, brick));
  return result;
}

Solids block(const Eigen::Vector3d& base, double yaw, const Eigen::Vector2d& size, int storeys,
             Color tint) {
  const Eigen::Vector2d at = base.head<2>();
  const double floor = base.z() + 0.2, top = floor + storeys * kStorey + 0.5;
  const Material wall(kBuilding, tint), gravelRoof(kRoof, {120, 108, 104});
  Solids result{
      box(at, yaw, size, base.z() - kFoundation, top, wall, gravelRoof).withWindows(floor)};
  result.push_back(
      box(at, yaw, {size.x() * 0.3, size.y() * 0.3}, top, top + 1.6, wall, gravelRoof));
  const Material glass(kWindow), canopy(kRoof, {92, 92, 96});
  const Eigen::Vector2d entrance = at + leftOf(yaw) * size.y() / 2;
  result.push_back(box(entrance, yaw, {3.0, 0.3}, base.z() - 1, floor + 2.4, glass, glass));
  result.push_back(box(entrance + leftOf(yaw) * 0.9, yaw, {4.0, 2.0}, floor + 2.6, floor + 2.85,
                       canopy, canopy));
  return result;
}

namespace {

struct Row {
  const char* name;
  Color map, natural;
};

constexpr Row kRows[kClassCount] = {
    {"road", {92, 92, 104}, {98, 98, 102}},
    {"lane-marking", {245, 245, 235}, {228, 228, 222}},
    {"sidewalk", {186, 178, 190}, {176, 172, 166}},
    {"gravel", {214, 194, 148}, {190, 176, 150}},
    {"dirt", {160, 112, 66}, {142, 108, 76}},
    {"grass", {138, 196, 84}, {104, 142, 62}},
    {"flower-bed", {236, 110, 190}, {196, 92, 140}},
    {"water", {66, 152, 222}, {74, 112, 140}},
    {"trunk", {92, 58, 30}, {96, 74, 54}},
    {"canopy", {26, 112, 48}, {58, 104, 44}},
    {"bush", {92, 150, 108}, {74, 118, 52}},
    {"rock", {136, 140, 150}, {138, 134, 128}},
    {"building", {236, 178, 112}, {212, 196, 170}},
    {"window", {128, 214, 232}, {74, 92, 110}},
    {"roof", {182, 70, 52}, {156, 78, 60}},
    {"wall", {184, 132, 206}, {164, 152, 138}},
    {"fence", {198, 136, 60}, {146, 112, 80}},
    {"pole", {64, 60, 130}, {116, 120, 124}},
    {"sign", {250, 212, 30}, {238, 206, 52}},
    {"bench", {128, 44, 112}, {124, 84, 52}},
    {"car", {216, 34, 48}, {170, 40, 44}},
    {"person", {255, 84, 0}, {196, 92, 60}},
};

ClassTable makeTable() {
  ClassTable table;
  for (const Row& row : kRows) table.add(row.name, row.map);
  return table;
}

}  // namespace

const ClassTable& classTable() {
  static const ClassTable table = makeTable();
  return table;
}

Color naturalColor(ClassId id) {
  classTable().color(id);  // throws for an id that is not in the table
  return kRows[id - 1].natural;
}

}  // namespace synthetic_world
