#include <gtest/gtest.h>
#include <semantic_planning/roadmap/CollisionChecker.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <future>
#include <random>

#include "PaintedWorld.h"

using colored_graph::EdgeProfile;
using mrpt::math::TPose2D;
using namespace semantic_planning;

namespace {

/** Arcs are looked at as chords, with a margin of less than this; meters. */
constexpr double kBulge = 0.003;

/** Looks up classes at every half voxel and clearance at every 2 mm, by public means only and
 * without memory. */
class DenseReference {
 public:
  DenseReference(const Ground& ground, const VehicleOptions& vehicle,
                 const colored_graph::ClassOrder& order)
      : m_ground(ground), m_vehicle(vehicle), m_order(order) {}

  /** Classes along a curve with their lengths, or nothing if it is blocked. */
  std::optional<std::map<ClassId, double>> lengths(const ReedsSheppCurve& curve, int z,
                                                   int zEnd) const {
    std::map<ClassId, double> lengths;
    const int n = std::max(1, int(std::ceil(2 * curve.length() / m_ground.voxelSize())));
    for (int i = 0; i < n; ++i) {
      const TPose2D pose = curve.at((i + 0.5) * (curve.length() / n)).pose;
      const Surface* s = under(pose, 0, 0, z, m_ground.step());
      if (!s) return std::nullopt;
      z = s->z;
      const auto worst = worstClass(pose, z);
      if (!worst) return std::nullopt;
      lengths[*worst] += curve.length() / n;
    }
    if (std::abs(z - zEnd) > m_ground.step()) return std::nullopt;
    return lengths;
  }

  /** \param margin more than the vehicle asks for, meters */
  bool isClear(const ReedsSheppCurve& curve, int z, double margin) const {
    const int n = std::max(1, int(std::ceil(curve.length() / 0.002)));
    for (int i = 0; i <= n; ++i) {
      const TPose2D pose = curve.at(i * (curve.length() / n)).pose;
      const Surface* s = under(pose, 0, 0, z, m_ground.step());
      if (!s) return false;
      z = s->z;
      if (!discsFit(pose, z, margin)) return false;
    }
    return true;
  }

 private:
  const Surface* under(const TPose2D& pose, double x, double y, int z, int tolerance) const {
    const double c = std::cos(pose.phi), s = std::sin(pose.phi);
    return m_ground.near(m_ground.columnAt(pose.x + c * x - s * y, pose.y + s * x + c * y), z,
                         tolerance);
  }
  int tolerance(double x, double y) const {
    const double rise = std::tan(m_vehicle.maxSlope * M_PI / 180) * std::hypot(x, y);
    return m_ground.step() + int(std::ceil(rise / m_ground.voxelSize()));
  }
  bool discsFit(const TPose2D& pose, int z, double margin) const {
    const auto discs = m_vehicle.footprint.coveringDiscs();
    return std::all_of(discs.begin(), discs.end(),
                       [&](const Disc& d) { return fits(d, pose, z, margin); });
  }
  /** What a column next to a center knows is worth as much less as that is away. */
  bool fits(const Disc& d, const TPose2D& pose, int z, double margin) const {
    for (const double dx : {0.0, -kBulge, kBulge})
      for (const double dy : {0.0, -kBulge, kBulge}) {
        const TPose2D moved(pose.x + dx, pose.y + dy, pose.phi);
        const Surface* s = under(moved, d.x, d.y, z, tolerance(d.x, d.y));
        if (s && m_ground.hasClearance(*s, d.radius + margin + std::hypot(dx, dy))) return true;
      }
    return false;
  }
  std::optional<ClassId> worstClass(const TPose2D& pose, int z) const {
    std::optional<ClassId> worst;
    for (const double y : {-m_vehicle.wheelTrack / 2, m_vehicle.wheelTrack / 2}) {
      const Surface* s = under(pose, 0, y, z, tolerance(0, y));
      if (!s) return std::nullopt;
      if (!worst || m_order.rank(s->classId) > m_order.rank(*worst)) worst = s->classId;
    }
    return worst;
  }

  const Ground& m_ground;
  const VehicleOptions& m_vehicle;
  const colored_graph::ClassOrder& m_order;
};

/** Road, grass and mud, walls, kerbs, a ramp onto a terrace, holes. */
PaintedWorld roughWorld() {
  PaintedWorld world;
  world.floor(-8, 8, -8, 8, PaintedWorld::Grass);
  world.floor(-8, 8, -1, 1.2, PaintedWorld::Road);
  world.floor(2, 4, -8, 8, PaintedWorld::Mud);
  world.box(-5, -4.4, 2, 6, 0, 1.6, PaintedWorld::Wall);
  world.box(5, 5.4, -6, -5, 0, 0.8, PaintedWorld::Wall);
  world.box(-6, -2, -6, -4, 0, 0.2, PaintedWorld::Road);  // a kerb high
  for (int i = 0; i < 4; ++i)
    world.box(0.8 * i, 8, 3, 7, 0.2 * i, 0.2 * (i + 1), PaintedWorld::Road);  // stairs
  return world;
}

/** Climbs a voxel each meter, with a road straight up. */
PaintedWorld slope() {
  PaintedWorld world;
  for (int i = 0; i < 16; ++i) {
    world.box(i - 8, 8, -8, 8, 0.2 * i, 0.2 * (i + 1), PaintedWorld::Grass);
    world.box(i - 8, 8, -1, 1.2, 0.2 * i, 0.2 * (i + 1), PaintedWorld::Road);
  }
  return world;
}

}  // namespace

class CollisionCheckerTest : public testing::Test {
 protected:
  explicit CollisionCheckerTest(PaintedWorld painted = roughWorld()) : world(std::move(painted)) {}

  std::optional<GroundPose> draw() {
    std::uniform_real_distribution<double> at(-8, 8), heading(-M_PI, M_PI);
    return checker.place({at(random), at(random), heading(random)});
  }
  /** Often on a line of voxels, or a multiple of a right angle. */
  std::optional<GroundPose> drawAligned() {
    std::uniform_int_distribution<int> at(-80, 80), heading(-1, 2);
    return checker.place({0.1 * at(random), 0.1 * at(random), heading(random) * M_PI / 2});
  }
  static bool isNear(const GroundPose& a, const GroundPose& b) {
    return std::hypot(a.pose.x - b.pose.x, a.pose.y - b.pose.y) < 4;
  }

  void expectAsDense(const GroundPose& a, const GroundPose& b) {
    const ReedsSheppCurve curve = checker.reedsShepp().connect(a.pose, b.pose);
    const DenseReference dense(ground, vehicle, order);
    const auto expected = dense.lengths(curve, a.z, b.z);
    const auto profile = checker.profile(a, b);
    ++(profile ? free : blocked);
    if (!profile) {
      overcautious += expected && dense.isClear(curve, a.z, kBulge);
      return;
    }
    ASSERT_TRUE(expected) << a.pose << " to " << b.pose;
    if (checker.fit(a) != Fit::Free) return;  // where it begins is not looked at
    ASSERT_TRUE(dense.isClear(curve, a.z, 0)) << a.pose << " to " << b.pose;
    for (const auto& part : *profile) {
      const auto at = expected->find(part.classId);
      ASSERT_NE(at, expected->end());
      EXPECT_NEAR(double(part.length), at->second * kUnits, 2 + double(profile->size()));
    }
  }

  void expectAlikeOfSearch() {
    const CollisionChecker ofSearch = checker.forSearch();
    const auto lengths = [](const CollisionChecker& asked, const GroundPose& a, const GroundPose& b,
                            double budget) {
      ClassBudget left{{0, 0, 1, 0.5, 2}, budget};
      std::vector<std::pair<ClassId, std::int64_t>> all;
      const auto profile =
          asked.profile(asked.motionCost().shortest(a.pose, b.pose), a.z, b.z, &left);
      for (const auto& part : profile.value_or(EdgeProfile()))
        all.emplace_back(part.classId, part.length);
      return all;
    };
    for (int i = 0; i < 20000; ++i) {
      const auto a = i % 2 ? draw() : drawAligned(), b = i % 2 ? draw() : drawAligned();
      if (!a || !b || !isNear(*a, *b)) continue;
      const double budget = i % 3 ? 100 : 0.5;
      const auto found = lengths(ofSearch, *a, *b, budget);
      ASSERT_EQ(found, lengths(checker, *a, *b, budget)) << a->pose << " to " << b->pose;
      ++(found.empty() ? blocked : free);
    }
    EXPECT_GT(free, 500);
    EXPECT_GT(blocked, 500);
  }

  static inline const double kUnits = double(colored_graph::lengthUp(1.0));
  PaintedWorld world;
  colored_graph::ClassOrder order{5, {{1}, {2}, {4}, {0}}};
  VehicleOptions vehicle;
  Ground ground{world.map(), vehicle, {}, order};
  CollisionChecker checker{ground, vehicle, order};
  std::mt19937 random{5};
  int free = 0, blocked = 0, overcautious = 0;
};

TEST_F(CollisionCheckerTest, seesWhatADenseLookSees) {
  for (const bool alongLinesOfVoxels : {false, true}) {
    free = blocked = overcautious = 0;
    for (int i = 0; i < 20000 && !HasFatalFailure(); ++i) {
      const auto a = alongLinesOfVoxels ? drawAligned() : draw(),
                 b = alongLinesOfVoxels ? drawAligned() : draw();
      if (a && b && isNear(*a, *b)) expectAsDense(*a, *b);
    }
    EXPECT_GT(free, 500);
    EXPECT_GT(blocked, 500);
    EXPECT_LE(overcautious, blocked / 100);
  }
}

TEST_F(CollisionCheckerTest, givesAnEdgeToItselfItsClass) {
  const auto pose = checker.place({0, 0, 1});
  const auto profile = checker.profile(*pose, *pose);
  ASSERT_TRUE(profile);
  ASSERT_EQ(profile->size(), 1u);
  EXPECT_EQ(profile->front().classId, PaintedWorld::Road);
  EXPECT_EQ(profile->front().length, 0);
}

TEST_F(CollisionCheckerTest, answersSeveralThreadsAsOne) {
  std::vector<std::pair<GroundPose, GroundPose>> edges;
  while (edges.size() < 2000) {
    const auto a = draw(), b = draw();
    if (a && b && isNear(*a, *b)) edges.emplace_back(*a, *b);
  }
  const auto lengths = [&] {
    std::vector<std::int64_t> all;
    for (const auto& [a, b] : edges) {
      const auto profile = checker.profile(a, b);
      all.push_back(profile ? -1 : 0);
      for (const auto& part : profile.value_or(EdgeProfile())) all.push_back(part.length);
    }
    return all;
  };
  const std::vector<std::int64_t> expected = lengths();
  std::vector<std::future<std::vector<std::int64_t>>> found;
  for (int i = 0; i < 4; ++i) found.push_back(std::async(std::launch::async, lengths));
  for (auto& f : found) EXPECT_TRUE(f.get() == expected);
}

TEST_F(CollisionCheckerTest, ofASearchAnswersAlike) { expectAlikeOfSearch(); }

class CollisionCheckerOnSlopeTest : public CollisionCheckerTest {
 protected:
  CollisionCheckerOnSlopeTest() : CollisionCheckerTest(slope()) {}
};

TEST_F(CollisionCheckerOnSlopeTest, ofASearchAnswersAlike) { expectAlikeOfSearch(); }

TEST(CollisionCheckerOfVehicles, keepsTheFootprintItselfClearOfPillars) {
  const std::filesystem::path config = std::filesystem::path(MSO_SOURCE_DIR) / "config";
  std::mt19937 random(7);
  std::uniform_real_distribution<double> at(-7, 7), heading(-M_PI, M_PI);
  for (const auto& file : std::filesystem::directory_iterator(config / "vehicles"))
    for (const double voxel : {0.1, 0.2}) {
      SCOPED_TRACE(file.path().string() + ' ' + std::to_string(voxel));
      PaintedWorld world(voxel);
      world.floor(-8, 8, -8, 8, PaintedWorld::Road);
      std::vector<TPose2D> pillars;  // their borders
      for (int i = 0; i < 12; ++i) {
        const double x = 0.2 * std::floor(5 * at(random)), y = 0.2 * std::floor(5 * at(random));
        world.box(x, x + 0.2, y, y + 0.2, 0, 2, PaintedWorld::Wall);
        for (int k = 0; k <= 2; ++k)
          for (int l = 0; l <= 2; ++l) pillars.emplace_back(x + 0.1 * k, y + 0.1 * l, 0);
      }
      const VehicleOptions vehicle = loadVehicle(file);
      const colored_graph::ClassOrder order(5, {{1}});
      const Ground ground(world.map(), vehicle, {}, order);
      const CollisionChecker checker(ground, vehicle, order);
      double nearest = 1;
      for (int i = 0; i < 10000; ++i) {
        const auto a = checker.place({at(random), at(random), heading(random)});
        if (!a || checker.fit(*a) != Fit::Free) continue;
        for (const TPose2D& pillar : pillars) {
          const TPose2D p = pillar - a->pose;
          nearest = std::min(nearest, vehicle.footprint.distance({p.x, p.y}));
        }
      }
      EXPECT_GE(nearest, vehicle.clearance);
      EXPECT_LT(nearest, vehicle.clearance + 2 * voxel);  // it gets that near
    }
}
