#include <gtest/gtest.h>
#include <map_operations/SmoothedView.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "Voxels.h"

using namespace semantic_octree;

namespace {

constexpr double kViewResolution = 0.3;
constexpr int kViewClasses = 5;

/** Most labels are those of thick slabs, the others by chance. */
SemanticOcTree mapOfScans(unsigned seed) {
  SemanticOcTree map(kViewResolution, numberedClasses(kViewClasses));
  std::mt19937 random(seed);
  for (int place = 0; place < 3; ++place) {
    PosedCloud scan = randomScan(random);
    for (std::size_t i = 0; i < scan.cloud.classes.size(); ++i)
      if (const Eigen::Vector3f& p = scan.cloud.points[i]; i % 16 != 0 && p.allFinite())
        scan.cloud.classes[i] = (scan.T_map_sensor * p.cast<double>()).z() > 0 ? 4 : 2;
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

/** The record of a voxel, if it has one. */
std::optional<SemanticOcTree::Belief> beliefAt(const SemanticOcTree& map, const VoxelId& id) {
  const auto leaf = map.search(keyOf(id));
  if (!leaf || !leaf.hasClassRecord()) return std::nullopt;
  return map.belief(leaf);
}

/** What a voxel and its neighbors tell, added up. */
struct Told {
  std::optional<SemanticOcTree::Belief> own;
  std::vector<double> sum;  ///< kViewClasses + 1
  double weights = 0;
};

Told toldAt(const SemanticOcTree& map, const VoxelId& id, double weight) {
  Told told{beliefAt(map, id), std::vector<double>(kViewClasses + 1, 0.0)};
  const double most = map.filterParameters().calibration.factors.empty() ? 3.2 : 2.2;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        const int axes = std::abs(x) + std::abs(y) + std::abs(z);
        const auto belief = beliefAt(map, {id[0] + x, id[1] + y, id[2] + z});
        if (!belief || (told.own && axes > 1)) continue;
        std::vector<double> h;
        for (int k = 1; k <= kViewClasses; ++k)
          h.push_back(belief->logOddsOf(static_cast<ClassId>(k)));
        const auto [low, high] = std::minmax_element(h.begin(), h.end());
        const double share = axes == 0 ? 1 : weight / (axes == 1 ? 1 : axes == 2 ? 2 : 4);
        const double range = *high - *low, counted = axes == 0 ? range : std::min(range, most);
        for (std::size_t k = 0; k < h.size(); ++k)
          told.sum[k + 1] += share * std::max(h[k] - *high, -counted);
        told.weights += range > 0 ? share * counted / range : share;
      }
  return told;
}

/** The formulas of the documentation, term by term: kViewClasses + 1 probabilities; none where no
 * voxel has a label. */
std::optional<std::vector<double>> expectedClasses(const SemanticOcTree& map, double repeated,
                                                   const Told& told) {
  auto [own, sum, weights] = told;
  if (weights == 0) return std::nullopt;
  weights = std::max(1.0, weights);
  const double divisor = 1 + repeated * (weights - 1);
  for (double& x : sum) x /= divisor;
  const FilterParameters& f = map.filterParameters();
  const double lowest = *std::max_element(sum.begin() + 1, sum.end()) +
                        std::log(f.minOccupancy / (1 - f.minOccupancy) / kViewClasses) -
                        std::log(f.maxProbability / (1 - f.maxProbability));
  double total = 0;
  for (int k = 1; k <= kViewClasses; ++k)
    total += sum[k] = (f.calibration.factors.empty()
                           ? 1
                           : std::pow(f.calibration.factors[k - 1], std::sqrt(weights / divisor))) *
                      std::exp(f.calibration.power * std::max(sum[k], lowest));
  for (int k = 1; k <= kViewClasses; ++k) sum[k] *= (own ? 1 - f.calibration.shared : 1) / total;
  for (int i = 0; own && i < own->count; ++i) sum[own->ids[i]] += f.calibration.shared / own->count;
  return sum;
}

/** How far neighbors repeat each other: so that p(a voxel's own likeliest class | occupied) is
 * alike with them and without, in the mean over occupied voxels. */
double repeatedIn(const SemanticOcTree& map, double weight) {
  std::vector<std::pair<ClassId, Told>> occupied;
  double own = 0;
  for (const auto& [id, p] : voxelsOf(map)) {
    const CellState state = map.query(keyOf(id));
    if (state.status != CellState::Status::Occupied || !beliefAt(map, id)) continue;
    own += (*expectedClasses(map, 0, toldAt(map, id, 0)))[state.likeliestClass];
    occupied.emplace_back(state.likeliestClass, toldAt(map, id, weight));
  }
  double least = 0, most = 1;
  for (int halving = 0; halving < 20; ++halving) {
    const double middle = (least + most) / 2;
    double together = 0;
    for (const auto& [id, told] : occupied) together += (*expectedClasses(map, middle, told))[id];
    (together > own ? least : most) = middle;
  }
  return (least + most) / 2;
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
    Eigen::Isometry3d above(Eigen::Translation3d(0, 0, 50));
    for (Eigen::Vector3f& p : cloud.points) p.z() -= 50;
    map.insert(cloud, above, insertion);
  }
}

}  // namespace

TEST(SmoothedView, addsWhatNeighborsTellAsDocumented) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    SemanticOcTree map = mapOfScans(seed);
    for (const double weight : {0.1, 0.4, 1.0}) {
      map.setCalibration(weight == 0.1 ? Calibration{0.15, 0} : Calibration{0.3, 0.2});
      std::vector<double> factors(kViewClasses, 0.9);
      factors[1] = 1.5;
      if (weight == 0.4) map.setCalibration({0.3, 0.2, factors});
      const SmoothedView view(map, {weight});
      const double repeated = repeatedIn(map, weight);

      EXPECT_GT(repeated, 0.05);
      EXPECT_LT(repeated, 0.95);
      int answered = 0, changed = 0;
      for (const VoxelId& id : voxelsIn(map)) {
        const auto expected = expectedClasses(map, repeated, toldAt(map, id, weight));
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

TEST(SmoothedView, statesWhatTheMapDoesWhereNoNeighborHasALabel) {
  std::vector<Label> labels;
  for (int x = -9; x <= 9; x += 2) labels.push_back({{x, 0, 0}, ClassId(1 + (x + 9) % 5), 3});
  SemanticOcTree map = mapOfLabels(labels);
  map.setCalibration({0.6, 0.2});
  const SmoothedView view(map, {1.0});
  for (const Label& label : labels) {
    const auto own = map.distribution(map.search(keyOf(label.voxel)));
    const auto smoothed = view.distribution(keyOf(label.voxel));
    for (std::size_t k = 0; k < own.size(); ++k) EXPECT_NEAR(smoothed[k], own[k], 1e-3);
  }
}

// Three voxels of ten name a wrong class: each by itself, or in patches of 5 x 5.
TEST(SmoothedView, isMadeSureByNeighborsThatErrByThemselvesAndNotByOthers) {
  const auto surest = [](int patch) {
    std::mt19937 random(1);
    std::map<std::pair<int, int>, ClassId> classes;
    std::vector<Label> labels;
    for (int x = 0; x < 60; ++x)
      for (int y = 0; y < 60; ++y) {
        const auto place = classes.try_emplace({x / patch, y / patch}, ClassId(1));
        if (place.second && random() % 10 < 3)
          place.first->second = static_cast<ClassId>(2 + random() % 4);
        labels.push_back({{x, y, 0}, place.first->second});
      }
    SemanticOcTree map = mapOfLabels(labels);
    map.setCalibration({0.5, 0});  // states 2/3 of a single label
    const SmoothedView view(map);
    double own = 0, together = 0, most = 0;
    for (const Label& label : labels) {
      const octomap::OcTreeKey key = keyOf(label.voxel);
      const double occupancy = map.query(key).occupancy;
      const std::vector<double> p = view.distribution(key);
      own += map.query(key).probability / occupancy;
      together += p[label.id] / occupancy;
      most = std::max(most, p[1] / occupancy);
    }
    const auto number = static_cast<double>(labels.size());
    EXPECT_NEAR(together / number, own / number, 1e-3);
    return most - own / number;
  };
  EXPECT_GT(surest(1), 0.2);
  EXPECT_LT(surest(5), 0.1);
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
  EXPECT_EQ(classAt(1.0, 3, 3), 1);
}

TEST(SmoothedView, worksAtTheMapsBorderAndOutside) {
  SemanticOcTree map(1.0, numberedClasses(kViewClasses));
  const auto insertAt = [&map](const Eigen::Vector3d& place, ClassId id) {
    LabeledCloud cloud;
    cloud.points = {{1.5f, 0.f, 0.f}};
    cloud.classes = {id};
    Eigen::Isometry3d T_map_sensor(Eigen::Translation3d(place - Eigen::Vector3d(1.5, 0, 0)));
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
