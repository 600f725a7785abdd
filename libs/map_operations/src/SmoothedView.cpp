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

/** A leaf that holds a voxel in which labels were seen, or none. */
SemanticOcTreeNode labeledLeaf(const SemanticOcTree& map, const Eigen::Array3i& voxel) {
  if (map.empty() || (voxel < 0).any() || (voxel >= kNumKeys).any()) return {};
  const SemanticOcTreeNode leaf = map.search(octomapKey(voxel.x(), voxel.y(), voxel.z()));
  return leaf && leaf.hasClassRecord() ? leaf : SemanticOcTreeNode();
}

/** So many pairs count as seen that tell the same, and about so many leaves are looked at. */
constexpr double kPairsBefore = 20;
constexpr std::size_t kMostLeaves = 1 << 18;

/** Neighbors across a face often agree on the likeliest class, and name a second one. \return the
 * share of such pairs whose second classes are the same */
double shareRepeated(const SemanticOcTree& map) {
  double pairs = kPairsBefore, same = kPairsBefore;
  const std::size_t oneIn = 1 + map.getNumLeafNodes() / kMostLeaves;
  std::size_t number = 0;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    if (number++ % oneIn != 0 || leaf.getDepth() != map.getTreeDepth()) continue;
    if (!leaf->hasClassRecord() || !map.isNodeOccupied(*leaf)) continue;
    const SemanticOcTree::Belief own = map.belief(*leaf);
    const octomap::OcTreeKey key = leaf.getKey();
    for (int face = 0; own.count > 1 && face < kFaces; ++face) {
      const SemanticOcTreeNode next = labeledLeaf(
          map, Eigen::Array3i(key[0], key[1], key[2]) + neighbors()[std::size_t(face)].offset);
      if (!next || !map.isNodeOccupied(next)) continue;
      const SemanticOcTree::Belief other = map.belief(next);
      if (other.count < 2 || other.ids[0] != own.ids[0]) continue;
      ++pairs;
      same += other.ids[1] == own.ids[1];
    }
  }
  return same / pairs;
}

void add(const SemanticOcTree::Belief& belief, double weight, std::vector<double>& logs) {
  for (double& x : logs) x += weight * belief.rest;
  for (int i = 0; i < belief.count; ++i)
    logs[belief.ids[i] - 1] += weight * (belief.logOdds[i] - belief.rest);
}

}  // namespace

void SmoothingOptions::describe(strict_files::OptionList& list) {
  list.add("neighbor_weight", neighborWeight, "", strict_files::between(0, 1),
           "how much a voxel across a face counts for a voxel's class, beside 1 for itself; 0: "
           "nothing. 0.4 sees through 30 % of wrong labels, less keeps smaller things");
}

void SmoothingOptions::validate() const { strict_files::checkOptions(*this, "SmoothingOptions"); }

SmoothedView::SmoothedView(const SemanticOcTree& map, const SmoothingOptions& options)
    : m_map(map),
      m_options(options),
      m_mostBehind(mostBehind(map.filterParameters(), map.numClasses())) {
  options.validate();
  if (options.neighborWeight > 0) m_repeated = shareRepeated(map);
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
  std::vector<double> p(m_map.numClasses(), 0.0);
  const Eigen::Array3i voxel(key[0], key[1], key[2]);
  const SemanticOcTreeNode leaf = labeledLeaf(m_map, voxel);
  const SemanticOcTree::Belief own = leaf ? m_map.belief(leaf) : SemanticOcTree::Belief();
  double heard = leaf ? 1 : 0;
  if (leaf) add(own, 1, p);
  const auto end = leaf ? neighbors().begin() + kFaces : neighbors().end();
  for (auto n = neighbors().begin(); m_options.neighborWeight > 0 && n != end; ++n)
    if (const SemanticOcTreeNode next = labeledLeaf(m_map, voxel + n->offset)) {
      const double weight = m_options.neighborWeight * n->share;
      add(m_map.belief(next), weight, p);
      heard += weight;
    }
  if (heard == 0) return {};
  const auto [power, shared] = m_map.filterParameters().calibration;
  const double repeats = 1 + m_repeated * std::max(0.0, heard - 1);
  const double highest = *std::max_element(p.begin(), p.end());
  double sum = 0;
  for (double& x : p) sum += x = std::exp(power * std::max((x - highest) / repeats, -m_mostBehind));
  for (double& x : p) x *= (own.count > 0 ? 1 - shared : 1) / sum;
  for (int i = 0; i < own.count; ++i) p[own.ids[i] - 1] += shared / own.count;
  return p;
}

}  // namespace semantic_octree
