#include <map_operations/Calibrator.h>
#include <semantic_octree/store/CalibrationFit.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "LabelEdges.h"
#include "LabelProcess.h"

namespace semantic_octree {
namespace {

constexpr std::size_t kMostVoxels = 32768;
/** Most points of a scan that are looked at. */
constexpr std::size_t kMostPoints = 32768;
/** Most labels of a voxel that are kept. */
constexpr std::size_t kMostLabels = 64;
/** What the map has counts like so many labels. */
constexpr double kLabelsBefore = 100;
/** Labels of each class that count as seen at first, right as often as the filter's accuracy says.
 * A matrix is cautious where a class is rare; a fit does not state the accuracy once more. */
constexpr double kLabelsOfMatrix = 1000, kLabelsOfFit = 20;
/** Where labels are right, no more than so many of all classes: of many, most are rare. */
constexpr double kLabelsOfRight = 400;
/** Labels of a voxel that are too few to outvote each other. */
constexpr std::size_t kFew = 2;
constexpr double kSteps = 256;
/** Log-odds (ln 25) of two classes from which on a voxel is of one of them. */
constexpr double kOfOne = 3.2;
/** Labels err if more voxels than one in so many differ away from borders. With right labels one in
 * 70 to 3000 does, with 2 % wrong ones one in 40, with 5 to 10 % one in 16 to 7. */
constexpr double kDiffering = 25;
/** Voxels that were looked at before, whose labels did not differ. */
constexpr double kVoxelsBefore = 100;

/** Voxels on each side of the map's origin. */
constexpr int kHalf = 1 << 15;

octomap::OcTreeKey keyOf(std::uint64_t voxel) {
  return {static_cast<octomap::key_type>(voxel >> 32), static_cast<octomap::key_type>(voxel >> 16),
          static_cast<octomap::key_type>(voxel)};
}

/** The likeliest class of a point's label. */
ClassId labelOf(const LabeledCloud& cloud, std::size_t point, std::size_t numClasses) {
  if (cloud.probabilities.empty()) return cloud.classes[point];
  const float* const q = &cloud.probabilities[point * numClasses];
  const float* const best = std::max_element(q, q + numClasses);
  return *best > 0 ? static_cast<ClassId>(best - q + 1) : kNoClass;
}

void check(const LabeledCloud& cloud, std::size_t numClasses) {
  if (cloud.probabilities.empty() ? !cloud.classes.empty() && cloud.classes.size() != cloud.size()
                                  : cloud.probabilities.size() != numClasses * cloud.size())
    throw std::invalid_argument("calibration: labels of another number of points");
}

/** Whether beside a voxel lie both classes: a voxel that is of one rather than of the other, and
 * one the other way. */
bool isAtBorder(const SemanticOcTree& map, const octomap::OcTreeKey& voxel, ClassId a, ClassId b) {
  bool hasA = false, hasB = false;
  for (int i = 0; i < 27; ++i) {
    if (i == 13) continue;  // the voxel itself
    const auto beside = [i, &voxel](int axis, int step) {
      return static_cast<octomap::key_type>(voxel[axis] + i / step % 3 - 1);
    };
    const SemanticOcTreeNode leaf = map.search({beside(0, 1), beside(1, 3), beside(2, 9)});
    if (!leaf || !leaf.hasClassRecord() || leaf.getLogOdds() <= 0) continue;
    const SemanticOcTree::Belief belief = map.belief(leaf);
    const double lead = belief.logOddsOf(a) - belief.logOddsOf(b);
    hasA = hasA || lead > kOfOne;
    hasB = hasB || -lead > kOfOne;
  }
  return hasA && hasB;
}

}  // namespace

bool Calibrator::keeps(std::uint64_t voxel) const {
  return (voxel * 0x9e3779b97f4a7c15u >> 48) % m_oneIn == 0;
}

void Calibrator::add(const LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor,
                     const InsertionOptions& options) {
  const auto K = static_cast<std::size_t>(m_numClasses);
  check(cloud, K);
  if (K == 1 || (cloud.classes.empty() && cloud.probabilities.empty())) return;
  const double farthest = options.maxRange > 0 ? options.maxRange : HUGE_VAL;
  const Eigen::Matrix3d turn = T_map_sensor.linear() / m_voxelSize;
  const Eigen::Vector3d shift = (T_map_sensor.translation() / m_voxelSize).array() + kHalf;
  std::vector<std::pair<std::uint64_t, ClassId>> labels;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const ClassId id = labelOf(cloud, i, K);
    const double range = cloud.points[i].norm();
    if (id == kNoClass || !(range >= options.minRange && range <= farthest)) continue;
    const Eigen::Array3d p = turn * cloud.points[i].cast<double>() + shift;
    if (!(p >= 0 && p < 2 * kHalf).all()) continue;
    const auto voxel = static_cast<std::uint64_t>(p.x()) << 32 |
                       static_cast<std::uint64_t>(p.y()) << 16 | static_cast<std::uint64_t>(p.z());
    if (keeps(voxel)) labels.emplace_back(voxel, id);
  }
  while (labels.size() > kMostPoints) {
    keepFewer();
    labels.erase(std::remove_if(labels.begin(), labels.end(),
                                [this](const auto& label) { return !keeps(label.first); }),
                 labels.end());
  }
  std::sort(labels.begin(), labels.end());
  for (auto i = labels.begin(); i != labels.end();) {
    const std::uint64_t voxel = i->first;
    ClassId best = kNoClass;
    std::ptrdiff_t most = 0;
    while (i != labels.end() && i->first == voxel) {
      const auto next = std::upper_bound(i, labels.end(), *i);
      if (next - i > most) most = next - i, best = i->second;
      i = next;
    }
    std::string& ofVoxel = m_voxels[voxel];
    if (ofVoxel.size() < kMostLabels) ofVoxel.push_back(static_cast<char>(best));
  }
  while (m_voxels.size() > kMostVoxels) keepFewer();
}

void Calibrator::keepFewer() {
  m_oneIn *= 2;
  for (auto i = m_voxels.begin(); i != m_voxels.end();)
    i = keeps(i->first) ? std::next(i) : m_voxels.erase(i);
}

LabeledVoxels Calibrator::seenAgain() const {
  LabeledVoxels voxels;
  for (const auto& [voxel, labels] : m_voxels)
    if (labels.size() > 1) ++voxels[labels];
  return voxels;
}

bool Calibrator::labelsErr(const SemanticOcTree& map) const {
  double looked = kVoxelsBefore, differ = 0;
  for (const auto& [voxel, labels] : m_voxels) {
    if (labels.size() < 2) continue;
    ++looked;
    const auto first = static_cast<ClassId>(labels[0]), second = static_cast<ClassId>(labels[1]);
    if (first != second && !isAtBorder(map, keyOf(voxel), first, second)) ++differ;
  }
  return kDiffering * differ > looked;
}

std::vector<std::vector<double>> Calibrator::confusion(double accuracy) const {
  return LabelProcess(seenAgain(), m_numClasses, accuracy, kLabelsOfMatrix).counts();
}

std::function<Calibration()> Calibrator::fitLater(const SemanticOcTree& map) const {
  const Calibration has = map.filterParameters().calibration;
  std::size_t numLabels = 0;
  for (const auto& [voxel, labels] : m_voxels)
    numLabels += labels.size() - std::min(kFew, labels.size());
  if (numLabels == 0) return [has] { return has; };
  std::vector<std::pair<std::uint64_t, SemanticOcTree::Belief>> beliefs;
  for (const auto& [voxel, labels] : m_voxels) {
    const SemanticOcTreeNode leaf = map.search(keyOf(voxel));
    if (leaf && leaf.hasClassRecord() && leaf.getLogOdds() > 0)
      beliefs.emplace_back(voxel, map.belief(leaf));
  }
  if (beliefs.empty()) return [has] { return has; };
  const FilterParameters& parameters = map.filterParameters();
  const bool err = !has.factors.empty() || labelsErr(map);
  return [has, numLabels, err, hasFactors = err && parameters.classPrior.empty(),
          beliefs = std::move(beliefs), labels = *this, accuracy = parameters.accuracy]() mutable {
    std::sort(beliefs.begin(), beliefs.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    const LabeledVoxels seen = labels.seenAgain();
    const int numClasses = labels.m_numClasses;
    std::vector<LabelProcess> processes;
    const double before = err ? kLabelsOfFit : std::min(kLabelsOfFit, kLabelsOfRight / numClasses);
    processes.emplace_back(seen, numClasses, accuracy, before);
    if (err) processes.emplace_back(seen, numClasses, accuracy, kLabelsOfFit, kLabelsOfMatrix);
    const double asRight = 1 - processes[0].leastCorrelation();
    const auto classesOf = [&processes, asRight](const std::string& ofVoxel) {
      std::vector<double> q = processes[0].classesOf(ofVoxel);
      if (processes.size() == 1) return q;
      const std::vector<double> right = processes[1].classesOf(ofVoxel);
      for (std::size_t k = 0; k < q.size(); ++k) q[k] += asRight * (right[k] - q[k]);
      return q;
    };
    if (err) {
      const double always = asRight * alwaysWrong(labels.m_voxels, classesOf);
      for (LabelProcess& process : processes) process.setAlwaysWrong(always);
    }
    CalibrationFit fit;
    for (const auto& [voxel, belief] : beliefs) {
      const std::string& ofVoxel = labels.m_voxels.at(voxel);
      fit.add(belief, classesOf(ofVoxel), static_cast<double>(ofVoxel.size()));
    }
    const std::vector<double> none(hasFactors ? static_cast<std::size_t>(numClasses) : 0, 1.0);
    Calibration found = fit.fit({0.7, 0.1, none});
    const auto together = [numLabels](double had, double fits) {
      return (kLabelsBefore * had + numLabels * fits) / (kLabelsBefore + numLabels);
    };
    const auto inSteps = [&](double had, double fits) {
      return std::round(kSteps * together(had, fits)) / kSteps;
    };
    for (std::size_t k = 0; k < found.factors.size(); ++k)
      found.factors[k] = together(has.factors.empty() ? 1 : has.factors[k], found.factors[k]);
    return Calibration{inSteps(has.power, found.power), inSteps(has.shared, found.shared),
                       found.factors};
  };
}

}  // namespace semantic_octree
