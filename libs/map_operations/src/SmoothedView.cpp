#include <map_operations/SmoothedView.h>
#include <semantic_octree/Keys.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace semantic_octree {
namespace {

double logit(double p) { return std::log(p / (1 - p)); }

/** How far the filter lets a class fall behind the likeliest. */
double mostBehind(const FilterParameters& p, int numClasses) {
  return logit(p.maxProbability) - logit(p.minOccupancy) + std::log(numClasses);
}

struct Neighbor {
  Eigen::Array3i offset;
  double share;  ///< of the weight: 1 across a face, 1/2 an edge, 1/4 a corner
};

/** All 26, those across faces first. */
const std::vector<Neighbor>& neighbors() {
  static const std::vector<Neighbor> all = [] {
    std::vector<Neighbor> list;
    for (int i = 0; i < 27; ++i) {
      const Eigen::Array3i offset(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      const int axes = offset.abs().sum();
      if (axes > 0) list.push_back({offset, std::ldexp(1.0, 1 - axes)});
    }
    std::stable_sort(list.begin(), list.end(),
                     [](const Neighbor& a, const Neighbor& b) { return a.share > b.share; });
    return list;
  }();
  return all;
}

constexpr int kFaces = 6;

}  // namespace

void SmoothingOptions::describe(strict_files::OptionList& list) {
  list.add("neighbor_weight", neighborWeight, "", strict_files::between(0, 1),
           "what a voxel across a face tells about a voxel's class, beside 1 for itself; 0: "
           "nothing. 0.4 sees through 30 % of wrong labels, less keeps smaller things");
}

void SmoothingOptions::validate() const { strict_files::checkOptions(*this, "SmoothingOptions"); }

SmoothedView::SmoothedView(const SemanticOcTree& map, const SmoothingOptions& options)
    : m_map(map),
      m_options(options),
      m_mostBehind(mostBehind(map.filterParameters(), map.numClasses())) {
  options.validate();
}

CellState SmoothedView::query(const octomap::OcTreeKey& key) const {
  CellState state = m_map.query(key);
  const std::vector<double> p = m_options.neighborWeight > 0 ? classes(key) : std::vector<double>();
  if (p.empty()) return state;
  const auto best = std::max_element(p.begin(), p.end());
  state.likeliestClass = static_cast<ClassId>(best - p.begin() + 1);
  state.probability = state.occupancy * *best;
  return state;
}

CellState SmoothedView::query(double x, double y, double z) const {
  octomap::OcTreeKey key;
  return m_map.coordToKeyChecked(x, y, z, key) ? query(key) : CellState();
}

std::vector<double> SmoothedView::distribution(const octomap::OcTreeKey& key) const {
  const double occupancy = m_map.query(key).occupancy;
  std::vector<double> p = classes(key);
  if (p.empty()) p.assign(m_map.numClasses(), 1.0 / m_map.numClasses());
  for (double& x : p) x *= occupancy;
  p.insert(p.begin(), 1 - occupancy);
  return p;
}

std::vector<double> SmoothedView::distribution(double x, double y, double z) const {
  octomap::OcTreeKey key;
  if (!m_map.coordToKeyChecked(x, y, z, key))
    throw std::out_of_range("smoothed view: a point outside the map");
  return distribution(key);
}

std::vector<double> SmoothedView::classes(const octomap::OcTreeKey& key) const {
  std::vector<double> p = logClasses(key);
  if (p.empty()) return p;
  const double highest = *std::max_element(p.begin(), p.end());
  double sum = 0;
  for (double& x : p) sum += x = std::exp(x - highest);
  for (double& x : p) x /= sum;
  return p;
}

std::vector<double> SmoothedView::logClasses(const octomap::OcTreeKey& key) const {
  std::vector<double> logs(m_map.numClasses(), 0.0);
  const Eigen::Array3i voxel(key[0], key[1], key[2]);
  const bool own = add(voxel, 1, logs);
  double ofOthers = 0;
  if (m_options.neighborWeight > 0) {
    const auto begin = neighbors().begin(), end = own ? begin + kFaces : neighbors().end();
    for (auto n = begin; n != end; ++n)
      if (const double weight = m_options.neighborWeight * n->share;
          add(voxel + n->offset, weight, logs))
        ofOthers += weight;
  }
  if (ofOthers == 0) return own ? logs : std::vector<double>();
  const double heard = ofOthers + own;
  const double spread = std::sqrt(std::max(1.0, heard));
  const double lowest = *std::max_element(logs.begin(), logs.end()) / spread - m_mostBehind;
  for (double& x : logs) x = std::max(x / spread, lowest);
  return logs;
}

bool SmoothedView::add(const Eigen::Array3i& voxel, double weight,
                       std::vector<double>& logs) const {
  if (m_map.empty() || (voxel < 0).any() || (voxel >= kNumKeys).any()) return false;
  const SemanticOcTreeNode leaf = m_map.search(octomapKey(voxel.x(), voxel.y(), voxel.z()));
  if (!leaf || !leaf.hasClassRecord()) return false;
  const SemanticOcTree::Belief b = m_map.statedBelief(leaf);
  for (double& x : logs) x += weight * b.rest;
  for (int i = 0; i < b.count; ++i) logs[b.ids[i] - 1] += weight * (b.logOdds[i] - b.rest);
  return true;
}

}  // namespace semantic_octree
