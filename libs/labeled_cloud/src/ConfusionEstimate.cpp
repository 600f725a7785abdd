#include <labeled_cloud/ConfusionEstimate.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace labeled_cloud {

using semantic_types::ClassId;
using semantic_types::kNoClass;
using semantic_types::LabeledCloud;

namespace {

/** As for what labels of one scan say of each other (semantic_octree::LabelAgreement). */
constexpr double kLabelsBefore = 1000;
constexpr int kSteps = 15;

using Table = std::vector<std::vector<double>>;

/** How often each class is true, over all voxels, and then has which label. */
struct Expectation {
  Table counts;
  std::vector<double> shares;
};

/** Divides by the sum. */
void normalize(std::vector<double>& values) {
  const double all = std::accumulate(values.begin(), values.end(), 0.0);
  for (double& value : values) value /= all;
}

/** ln p(label | class), ln p(class) */
Expectation logarithmsOf(Expectation e) {
  e.counts.push_back(std::move(e.shares));
  for (auto& row : e.counts) {
    normalize(row);
    for (double& x : row) x = std::log(x);
  }
  e.shares = std::move(e.counts.back());
  e.counts.pop_back();
  return e;
}

/** Adds voxels with these labels. \param known logarithms */
void expect(const std::string& labels, double voxels, const Expectation& known, Expectation& e) {
  std::vector<double> p = known.shares;
  const auto column = [](char label) { return static_cast<ClassId>(label) - 1; };
  for (std::size_t k = 0; k < p.size(); ++k)
    for (const char label : labels) p[k] += known.counts[k][column(label)];
  const double best = *std::max_element(p.begin(), p.end());
  for (double& x : p) x = std::exp(x - best);
  normalize(p);
  for (std::size_t k = 0; k < p.size(); ++k) {
    e.shares[k] += voxels * p[k];
    for (const char label : labels) e.counts[k][column(label)] += voxels * p[k];
  }
}

ClassId mostFrequent(std::vector<ClassId>& labels) {
  std::sort(labels.begin(), labels.end());
  ClassId best = kNoClass;
  std::ptrdiff_t most = 0;
  for (auto i = labels.begin(); i != labels.end();) {
    const auto next = std::upper_bound(i, labels.end(), *i);
    if (next - i > most) most = next - i, best = *i;
    i = next;
  }
  return best;
}

}  // namespace

std::size_t ConfusionEstimate::Hash::operator()(const Eigen::Vector3i& voxel) const {
  std::size_t hash = 0;
  for (const int x : voxel) hash = (hash ^ static_cast<std::uint32_t>(x)) * 0x9e3779b97f4a7c15u;
  return hash ^ hash >> 32;
}

void ConfusionEstimate::add(const LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor,
                            double least, double most) {
  std::unordered_map<Eigen::Vector3i, std::vector<ClassId>, Hash> scan;
  for (std::size_t i = 0; i < cloud.classes.size(); ++i) {
    const double range = cloud.points[i].norm();
    if (cloud.classes[i] == kNoClass || !(range >= least && range <= most)) continue;
    const Eigen::Vector3d p = T_map_sensor * cloud.points[i].cast<double>() / m_voxelSize;
    scan[p.array().floor().cast<int>()].push_back(cloud.classes[i]);
  }
  for (auto& [voxel, labels] : scan)
    m_voxels[voxel].push_back(static_cast<char>(mostFrequent(labels)));
}

std::vector<std::vector<double>> ConfusionEstimate::counts(double accuracy) const {
  std::map<Labels, double> voxels;  // those with the same labels are alike, and there are few kinds
  for (auto [voxel, labels] : m_voxels) {
    std::sort(labels.begin(), labels.end());
    if (labels.size() > 1) ++voxels[labels];
  }
  const auto K = static_cast<std::size_t>(m_numClasses);
  const double wrong = (1 - accuracy) / (m_numClasses - 1);
  Table before(K, std::vector<double>(K, kLabelsBefore * wrong));
  for (std::size_t k = 0; k < K; ++k) before[k][k] = kLabelsBefore * accuracy;
  Expectation e{before, std::vector<double>(K, 1.0)};
  for (int step = 0; step < kSteps; ++step) {
    const Expectation known = logarithmsOf(std::move(e));
    e = {before, std::vector<double>(K, 1.0)};
    for (const auto& [labels, number] : voxels) expect(labels, number, known, e);
  }
  return e.counts;
}

}  // namespace labeled_cloud
