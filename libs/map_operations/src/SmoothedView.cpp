#include <map_operations/SmoothedView.h>
#include <semantic_octree/Keys.h>
#include <semantic_octree/store/CalibrationFit.h>

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

/** No neighbor tells more than odds of 25: a border of two classes may lie between. Odds of 9 where
 * classes have factors, which tell a part of it. */
constexpr double kMostOfNeighbor = 3.2, kMostBesideFactors = 2.2;  // ln 25, ln 9
/** At most about so many log-odds are kept to find out how far neighbors repeat each other. */
constexpr std::size_t kAsked = 1 << 22;
/** How often the search for that is halved. */
constexpr int kHalvings = 20;

/** Adds what a voxel tells of classes, up to a constant, and nothing below -most.
 * \return the share of it that counts */
double add(const SemanticOcTree::Belief& belief, double weight, double most,
           std::vector<double>& logs) {
  const int count = belief.count;
  const bool isRestThere = belief.unnamed(static_cast<int>(logs.size())) > 0;
  const double top = isRestThere ? std::max(belief.logOdds[0], belief.rest) : belief.logOdds[0];
  const auto told = [&](double h) { return weight * std::max(h - top, -most); };
  for (double& x : logs) x += told(belief.rest);
  for (int i = 0; i < count; ++i)
    logs[belief.ids[i] - 1] += told(belief.logOdds[i]) - told(belief.rest);
  const double last = belief.logOdds[count - 1];
  const double range = top - (isRestThere ? std::min<double>(last, belief.rest) : last);
  return range > most ? weight * most / range : weight;
}

}  // namespace

void SmoothingOptions::describe(strict_files::OptionList& list) {
  list.add("neighbor_weight", neighborWeight, "", strict_files::between(0, 1),
           "weight of each of the six neighbors in a voxel's class; its own is 1. "
           "1 is for labels of which 30 % are wrong; less keeps smaller things");
}

void SmoothingOptions::validate() const { strict_files::checkOptions(*this, "SmoothingOptions"); }

/** What a voxel and its neighbors tell together. */
struct SmoothedView::Heard {
  SemanticOcTree::Belief own;
  std::vector<double> logOdds;   ///< summed, up to a constant
  double weight = 0;             ///< summed, 1 for the voxel
  std::ptrdiff_t likeliest = 0;  ///< the class that the voxel by itself is surest of, from 0
};

SmoothedView::SmoothedView(const SemanticOcTree& map, const SmoothingOptions& options)
    : m_map(map),
      m_options(options),
      m_mostBehind(mostBehind(map.filterParameters(), map.numClasses())) {
  options.validate();
  if (options.neighborWeight > 0) m_repeated = repeatedInMap();
}

double SmoothedView::repeatedInMap() const {
  std::vector<Heard> asked;
  double own = 0;
  const std::size_t oneIn =
      1 + m_map.getNumLeafNodes() * static_cast<std::size_t>(m_map.numClasses()) / kAsked;
  std::size_t number = 0;
  for (auto leaf = m_map.begin_leafs(); leaf != m_map.end_leafs(); ++leaf) {
    if (number++ % oneIn != 0 || leaf.getDepth() != m_map.getTreeDepth()) continue;
    if (!leaf->hasClassRecord() || !m_map.isNodeOccupied(*leaf)) continue;
    const octomap::OcTreeKey key = leaf.getKey();
    const Eigen::Array3i voxel(key[0], key[1], key[2]);
    const std::vector<double> alone = stated(listen(voxel, 0), 0);
    const auto likeliest = std::max_element(alone.begin(), alone.end());
    own += *likeliest;
    asked.push_back(listen(voxel, m_options.neighborWeight));
    asked.back().likeliest = likeliest - alone.begin();
  }
  return shareWithoutGain(kHalvings, [&](double repeated) {
    double gain = -own;
    for (const Heard& heard : asked) gain += stated(heard, repeated)[heard.likeliest];
    return gain;
  });
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
  const Heard heard = listen({key[0], key[1], key[2]}, m_options.neighborWeight);
  return heard.weight > 0 ? stated(heard, m_repeated) : std::vector<double>();
}

SmoothedView::Heard SmoothedView::listen(const Eigen::Array3i& voxel, double weight) const {
  Heard heard;
  heard.logOdds.assign(static_cast<std::size_t>(m_map.numClasses()), 0.0);
  const SemanticOcTreeNode leaf = labeledLeaf(m_map, voxel);
  if (leaf) heard.weight = add(heard.own = m_map.belief(leaf), 1, HUGE_VAL, heard.logOdds);
  const bool hasFactors = !m_map.filterParameters().calibration.factors.empty();
  const double most = hasFactors ? kMostBesideFactors : kMostOfNeighbor;
  const auto end = leaf ? neighbors().begin() + kFaces : neighbors().end();
  for (auto n = neighbors().begin(); weight > 0 && n != end; ++n)
    if (const SemanticOcTreeNode next = labeledLeaf(m_map, voxel + n->offset))
      heard.weight += add(m_map.belief(next), weight * n->share, most, heard.logOdds);
  return heard;
}

std::vector<double> SmoothedView::stated(const Heard& heard, double repeated) const {
  const auto& [power, shared, factors] = m_map.filterParameters().calibration;
  const SemanticOcTree::Belief& own = heard.own;
  const double repeats = 1 + repeated * std::max(0.0, heard.weight - 1);
  // A factor says how frequent a class is, which counts once, and for what its labels are taken,
  // which each voxel's labels tell again. How much of it is which is not known: the mean of both.
  const double again = std::sqrt(std::max(1.0, heard.weight) / repeats);
  std::vector<double> p = heard.logOdds;
  const double highest = *std::max_element(p.begin(), p.end());
  double sum = 0;
  for (std::size_t k = 0; k < p.size(); ++k) {
    p[k] = std::exp(power * std::max((p[k] - highest) / repeats, -m_mostBehind));
    sum += p[k] *= factors.empty() ? 1 : std::pow(factors[k], again);
  }
  for (double& x : p) x *= (own.count > 0 ? 1 - shared : 1) / sum;
  for (int i = 0; i < own.count; ++i) p[own.ids[i] - 1] += shared / own.count;
  return p;
}

}  // namespace semantic_octree
