#include <map_operations/Calibrator.h>
#include <semantic_octree/store/CalibrationFit.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

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
/** Labels of a voxel that are too few to outvote each other. */
constexpr std::size_t kFew = 2;
constexpr double kSteps = 256;
/** Log-odds (ln 25) of two classes from which on a voxel is of one of them. */
constexpr double kOfOne = 3.2;
/** Edge of a place in voxels (2^3): what errs there may err together. */
constexpr int kBitsOfPlace = 3;
/** So many labels of a voxel, from the second on, are asked whether factors make them likelier. */
constexpr std::size_t kAskedLabels = 8;

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

/** A voxel's labels, and what the map believes of it. */
struct Seen {
  std::uint64_t voxel;
  std::string labels;
  SemanticOcTree::Belief belief;  ///< if it is occupied
  bool isOccupied;
  bool isAtBorder;  ///< its first two labels differ, and both lie beside

  /** The cube of voxels in which it lies. */
  std::uint64_t place() const {
    constexpr std::uint64_t kRest = (1 << kBitsOfPlace) - 1;
    return voxel & ~(kRest << 32 | kRest << 16 | kRest);
  }
  int half() const { return static_cast<int>(place() * 0x9e3779b97f4a7c15u >> 63); }
};

struct Found {
  Calibration calibration;
  LabelProcess process;  ///< with factors, the one that takes labels for right at first
};

/** Finds what makes likely what labels say, from the voxels of one half of the places, or all. */
class Finder {
 public:
  Finder(int numClasses, double accuracy) : m_numClasses(numClasses), m_accuracy(accuracy) {}

  Found find(const std::vector<Seen>& voxels, bool hasFactors, int half = kAll) const {
    const auto isAsked = [half](const Seen& s) { return half == kAll || s.half() == half; };
    LabeledVoxels again;
    for (const Seen& s : voxels)
      if (isAsked(s) && s.labels.size() > 1) ++again[s.labels];
    std::vector<LabelProcess> processes;
    processes.emplace_back(again, m_numClasses, m_accuracy, kLabelsOfFit);
    if (hasFactors)
      processes.emplace_back(again, m_numClasses, m_accuracy, kLabelsOfFit, kLabelsOfMatrix);
    const double asRight = hasFactors ? 1 - processes[0].leastCorrelation() : 0;
    CalibrationFit fit;
    for (const Seen& s : voxels) {
      if (!isAsked(s) || !s.isOccupied) continue;
      std::vector<double> q = processes[0].classesOf(s.labels);
      if (hasFactors) {
        const std::vector<double> right = processes[1].classesOf(s.labels);
        for (std::size_t k = 0; k < q.size(); ++k) q[k] += asRight * (right[k] - q[k]);
      }
      fit.add(s.belief, q, static_cast<double>(s.labels.size()));
    }
    const std::vector<double> none(hasFactors ? static_cast<std::size_t>(m_numClasses) : 0, 1.0);
    return {fit.fit({0.7, 0.1, none}), processes.back()};
  }
  /** Whether factors that one half of the places finds make labels of the other half likelier,
   * away from borders: all labels, and those of voxels whose labels before differ, which right
   * ones do at borders alone. */
  bool factorsHelp(const std::vector<Seen>& voxels) const {
    Gain ofAll, whereTheyDiffer;
    for (const int half : {0, 1}) {
      const Found with = find(voxels, true, half), without = find(voxels, false, half);
      std::map<std::string, double> known;
      for (const Seen& s : voxels) {
        if (s.half() == half || s.isAtBorder) continue;
        const std::size_t alike =
            std::min(s.labels.find_first_not_of(s.labels[0]), s.labels.size());
        for (std::size_t n = 2; n <= std::min(s.labels.size(), kAskedLabels + 1); ++n) {
          const auto [told, isNew] = known.try_emplace(s.labels.substr(0, n));
          if (isNew) told->second = gain(told->first, with, without.calibration);
          ofAll.add(s.place(), told->second);
          if (n > alike + 1) whereTheyDiffer.add(s.place(), told->second);
        }
      }
    }
    return ofAll.isSure() && whereTheyDiffer.isSure();
  }

 private:
  static constexpr int kAll = -1;
  /** A sum over places, which err each by itself. */
  class Gain {
   public:
    void add(std::uint64_t place, double gain) { m_ofPlaces[place] += gain; }
    /** Whether it is more than its standard error. */
    bool isSure() const {
      double sum = 0, squares = 0;
      for (const auto& [place, gain] : m_ofPlaces) sum += gain, squares += gain * gain;
      return sum > 0 && sum * sum > squares;
    }

   private:
    std::map<std::uint64_t, double> m_ofPlaces;
  };

  /** How much more likely a voxel's last label is with factors, given those before it: ln p / q. */
  double gain(const std::string& labels, const Found& with, const Calibration& without) const {
    const std::string before = labels.substr(0, labels.size() - 1);
    const double p = with.process.ofLast(labels, stated(before, with.calibration));
    return exactLogarithm(p / with.process.ofLast(labels, stated(before, without)));
  }
  /** What a map states whose voxel got these labels, one of each scan. */
  std::vector<double> stated(const std::string& labels, const Calibration& calibration) const {
    const auto& [power, shared, factors] = calibration;
    std::vector<double> votes(static_cast<std::size_t>(m_numClasses)), p(votes.size());
    for (const char label : labels) ++votes[static_cast<unsigned char>(label) - std::size_t{1}];
    const double most = *std::max_element(votes.begin(), votes.end()),
                 odds = exactLogarithm(m_accuracy * (m_numClasses - 1) / (1 - m_accuracy));
    double sum = 0, named = 0;
    for (std::size_t k = 0; k < p.size(); ++k) {
      p[k] = exactExponential(power * odds * (votes[k] - most));
      sum += p[k] *= factors.empty() ? 1 : factors[k];
      named += votes[k] > 0;
    }
    for (std::size_t k = 0; k < p.size(); ++k)
      p[k] = (1 - shared) / sum * p[k] + (votes[k] > 0 ? shared / named : 0);
    return p;
  }

  int m_numClasses;
  double m_accuracy;
};

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

std::vector<std::vector<double>> Calibrator::confusion(double accuracy) const {
  return LabelProcess(seenAgain(), m_numClasses, accuracy, kLabelsOfMatrix).counts();
}

std::function<Calibration()> Calibrator::fitLater(const SemanticOcTree& map) const {
  const Calibration has = map.filterParameters().calibration;
  std::size_t numLabels = 0;
  std::vector<Seen> voxels;
  for (const auto& [voxel, labels] : m_voxels) {
    numLabels += labels.size() - std::min(kFew, labels.size());
    const octomap::OcTreeKey key = keyOf(voxel);
    const SemanticOcTreeNode leaf = map.search(key);
    const bool isThere = leaf && leaf.hasClassRecord() && leaf.getLogOdds() > 0;
    voxels.push_back({voxel, labels, isThere ? map.belief(leaf) : SemanticOcTree::Belief(), isThere,
                      labels.size() > 1 && labels[0] != labels[1] &&
                          isAtBorder(map, key, labels[0], labels[1])});
  }
  const auto isOccupied = [](const Seen& s) { return s.isOccupied; };
  if (numLabels == 0 || std::none_of(voxels.begin(), voxels.end(), isOccupied))
    return [has] { return has; };
  const FilterParameters& parameters = map.filterParameters();
  return [has, numLabels, voxels = std::move(voxels), wasTold = !parameters.classPrior.empty(),
          finder = Finder(m_numClasses, parameters.accuracy)]() mutable {
    std::sort(voxels.begin(), voxels.end(),
              [](const Seen& a, const Seen& b) { return a.voxel < b.voxel; });
    const bool hasFactors = !wasTold && (!has.factors.empty() || finder.factorsHelp(voxels));
    Calibration found = finder.find(voxels, hasFactors).calibration;
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
