#include <gtest/gtest.h>
#include <map_operations/SmoothedView.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>

#include "Voxels.h"

using namespace semantic_octree;

namespace {

constexpr double kViewResolution = 0.3;
constexpr int kViewClasses = 5;

SemanticOcTree mapOfScans(unsigned seed) {
  SemanticOcTree map(kViewResolution, numberedClasses(kViewClasses));
  std::mt19937 random(seed);
  for (int place = 0; place < 3; ++place) {
    const PosedCloud scan = randomScan(random);
    for (int repeat = 0; repeat < 3; ++repeat) map.insert(scan.cloud, scan.T_map_sensor);
  }
  return map;
}

/** The known voxels, and those around them. */
std::vector<VoxelId> voxelsIn(const SemanticOcTree& map) {
  std::vector<VoxelId> ids;
  for (const auto& [id, p] : voxelsOf(map))
    for (const int x : {0, 2}) ids.push_back({id[0] + x, id[1], id[2]});
  return ids;
}

/** What the map says of a voxel's classes by itself: ln p(class | occupied); none without a label.
 */
std::optional<std::vector<double>> ownLogs(const SemanticOcTree& map, const VoxelId& id) {
  if (map.query(keyOf(id)).likeliestClass == kNoClass) return std::nullopt;
  std::vector<double> logs = map.distribution(*map.search(keyOf(id)));
  for (int k = 1; k <= kViewClasses; ++k) logs[k] = std::log(logs[k] / (1 - logs[0]));
  return logs;
}

/** The sum of the documentation, term by term: kViewClasses + 1 probabilities; none where no voxel
 * has a label. */
std::optional<std::vector<double>> expectedClasses(const SemanticOcTree& map, const VoxelId& id,
                                                   double weight) {
  const auto own = ownLogs(map, id);
  std::vector<double> sum = own.value_or(std::vector<double>(kViewClasses + 1));
  double weights = own ? 1 : 0;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        const int axes = std::abs(x) + std::abs(y) + std::abs(z);
        if (axes == 0 || (own && axes > 1)) continue;
        const auto logs = ownLogs(map, {id[0] + x, id[1] + y, id[2] + z});
        if (!logs) continue;
        const double share = weight / (axes == 1 ? 1 : axes == 2 ? 2 : 4);
        for (int k = 1; k <= kViewClasses; ++k) sum[k] += share * (*logs)[k];
        weights += share;
      }
  if (weights == 0) return std::nullopt;
  for (double& x : sum) x /= std::sqrt(std::max(1.0, weights));
  const FilterParameters& f = map.filterParameters();
  const double lowest = *std::max_element(sum.begin() + 1, sum.end()) +
                        std::log(f.minOccupancy / (1 - f.minOccupancy) / kViewClasses) -
                        std::log(f.maxProbability / (1 - f.maxProbability));
  double total = 0;
  for (int k = 1; k <= kViewClasses; ++k) total += sum[k] = std::exp(std::max(sum[k], lowest));
  for (int k = 1; k <= kViewClasses; ++k) sum[k] /= total;
  return sum;
}

/** A flat ground of one voxel's height, each voxel as often hit with its label as it says. */
struct Label {
  VoxelId voxel;
  ClassId id;
  int times = 1;
};
SemanticOcTree mapOfLabels(const std::vector<Label>& labels) {
  SemanticOcTree map(kViewResolution, numberedClasses(kViewClasses));
  for (int time = 0;; ++time) {
    LabeledCloud cloud;
    for (const Label& label : labels) {
      if (time >= label.times) continue;
      cloud.points.push_back(centerOf(label.voxel, kViewResolution).cast<float>());
      cloud.classes.push_back(label.id);
    }
    if (cloud.empty()) return map;
    InsertionOptions insertion;
    insertion.maxRange = 100;
    Eigen::Isometry3d above = Eigen::Isometry3d::Identity();
    above.translation().z() = 50;
    for (Eigen::Vector3f& p : cloud.points) p.z() -= 50;
    map.insert(cloud, above, insertion);
  }
}

}  // namespace

TEST(SmoothedView, addsWhatNeighborsTellAsDocumented) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const SemanticOcTree map = mapOfScans(seed);
    for (const double weight : {0.1, 0.4, 1.0}) {
      const SmoothedView view(map, {weight});
      int answered = 0, changed = 0;
      for (const VoxelId& id : voxelsIn(map)) {
        const auto expected = expectedClasses(map, id, weight);
        const CellState own = map.query(keyOf(id)), state = view.query(keyOf(id));
        EXPECT_EQ(state.status, own.status);
        EXPECT_EQ(state.occupancy, own.occupancy);
        if (!expected) {
          EXPECT_EQ(state.likeliestClass, kNoClass);
          continue;
        }
        const std::vector<double> p = view.distribution(keyOf(id));
        EXPECT_NEAR(p[0], 1 - own.occupancy, 1e-12);
        for (int k = 1; k <= kViewClasses; ++k)
          ASSERT_NEAR(p[k], own.occupancy * (*expected)[k], 1e-5) << "class " << k;
        EXPECT_EQ(state.probability, p[state.likeliestClass]);
        EXPECT_EQ(state.probability, *std::max_element(p.begin() + 1, p.end()));
        ++answered;
        changed += state.likeliestClass != own.likeliestClass;
      }
      EXPECT_GT(answered, 1000);
      EXPECT_GT(changed, answered / 10);
    }
  }
}

// Two classes on either side of a line, at any angle and place, whatever the weight.
RC_GTEST_PROP(SmoothedView, leavesStraightBordersWhereTheyAre, ()) {
  const double angle = *rc::gen::inRange(0, 360) * M_PI / 180;
  const double offset = *rc::gen::inRange(-200, 200) * 0.01;
  const double weight = *rc::gen::inRange(1, 101) * 0.01;
  std::vector<Label> labels;
  for (int x = -8; x <= 8; ++x)
    for (int y = -8; y <= 8; ++y) {
      const bool left = x * std::cos(angle) + y * std::sin(angle) < offset;
      labels.push_back({{x, y, 0}, static_cast<ClassId>(left ? 1 : 2), 4});
    }
  const SemanticOcTree map = mapOfLabels(labels);
  const SmoothedView view(map, {weight});
  for (const Label& label : labels) {
    const auto [x, y, z] = label.voxel;
    if (std::max(std::abs(x), std::abs(y)) == 8) continue;  // the ground's rim
    RC_ASSERT(view.query(keyOf(label.voxel)).likeliestClass == label.id);
  }
}

TEST(SmoothedView, keepsThinLinesAndWithALowWeightSinglePosts) {
  std::vector<Label> labels;
  for (int x = -5; x <= 5; ++x)
    for (int y = -5; y <= 5; ++y) {
      const bool special = x == 0 || (x == 3 && y == 3);
      labels.push_back({{x, y, 0}, static_cast<ClassId>(special ? 3 : 1), 4});
    }
  const SemanticOcTree map = mapOfLabels(labels);
  const auto classAt = [&](double weight, int x, int y) {
    return SmoothedView(map, {weight}).query(keyOf({x, y, 0})).likeliestClass;
  };
  EXPECT_EQ(classAt(1.0, 0, 2), 3);
  EXPECT_EQ(classAt(0.2, 3, 3), 3);
  EXPECT_EQ(classAt(0.4, 3, 3), 1);
}

TEST(SmoothedView, worksAtTheMapsBorderAndOutside) {
  SemanticOcTree map(1.0, numberedClasses(kViewClasses));
  const auto insertAt = [&map](const Eigen::Vector3d& place, ClassId id) {
    LabeledCloud cloud;
    cloud.points = {{1.5f, 0.f, 0.f}};
    cloud.classes = {id};
    Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
    T_map_sensor.translation() = place - Eigen::Vector3d(1.5, 0, 0);
    map.insert(cloud, T_map_sensor);
  };
  const SmoothedView view(map);
  insertAt({32766.5, 32767.5, -32767.5}, 3);
  EXPECT_EQ(view.query(32766.5, 32767.5, -32767.5).likeliestClass, 3);
  const octomap::OcTreeKey corner(65535, 65535, 0);
  const std::vector<double> before = view.distribution(corner);
  EXPECT_GT(before[3], before[2]);
  insertAt({32766.5, -32767.5, -32767.5}, 2);  // at the other end: no neighbor
  EXPECT_EQ(view.distribution(corner), before);
  EXPECT_EQ(view.query({65535, 65535, 65535}).likeliestClass, kNoClass);
  EXPECT_EQ(view.distribution(32767.5, 32767.5, -32767.5), before);
  EXPECT_THROW(view.distribution(1e9, 0, 0), std::out_of_range);
  EXPECT_EQ(view.query(1e9, 0, std::nan("")).status, CellState::Status::Unknown);
  const SemanticOcTree empty(0.1, numberedClasses(4));
  const std::vector<double> p = SmoothedView(empty).distribution(keyOf({0, 0, 0}));
  EXPECT_EQ(p, std::vector<double>({0.5, 0.125, 0.125, 0.125, 0.125}));
}

TEST(SmoothedView, refusesWeightsThatAreNone) {
  const SemanticOcTree map(0.1, numberedClasses(2));
  for (const double weight : {-0.1, 1.1, std::nan("")})
    EXPECT_THROW(SmoothedView(map, {weight}), std::invalid_argument);
}
