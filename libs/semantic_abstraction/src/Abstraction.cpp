#include <semantic_octree/store/CalibrationFit.h>
#include <semantic_octree/store/TreeBuilder.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include "CompressedTree.h"

namespace semantic_octree {
namespace {

GTree* gTreeOf(const SemanticOcTree& map) { return dynamic_cast<GTree*>(MapAccess::observer(map)); }

GTree& neededGTreeOf(const SemanticOcTree& map) {
  if (GTree* const gTree = gTreeOf(map)) return *gTree;
  throw std::logic_error("the map keeps no G-values: call setAbstraction() first");
}

using IsExpanded = std::function<bool(const Node&)>;

/** Without the map's calibration, which is of voxels. */
SemanticOcTree emptyFor(const SemanticOcTree& map) {
  FilterParameters parameters = map.filterParameters();
  parameters.calibration = {};
  return {map.getResolution(), map.classes(), parameters};
}

/** p(class | occupied) as a calibration states it: K numbers, the same bits everywhere. */
std::vector<double> classesOf(const SemanticOcTree::Belief& belief, const Calibration& calibration,
                              int numClasses) {
  const float most = std::max(belief.logOdds[0], belief.rest);
  const auto odds = [&](float h) { return exactExponential(calibration.power * (h - most)); };
  std::vector<double> p(static_cast<std::size_t>(numClasses), odds(belief.rest));
  for (int i = 0; i < belief.count; ++i) p[belief.ids[i] - 1] = odds(belief.logOdds[i]);
  for (std::size_t k = 0; k < calibration.factors.size(); ++k) p[k] *= calibration.factors[k];
  const double sum = std::accumulate(p.begin(), p.end(), 0.0);
  for (double& x : p) x *= (1 - calibration.shared) / sum;
  for (int i = 0; i < belief.count; ++i) p[belief.ids[i] - 1] += calibration.shared / belief.count;
  return p;
}

/** About so many leaves are asked, and steps in which a power is told. */
constexpr std::size_t kAskedLeaves = 1 << 14;
constexpr double kPowerSteps = 256;
/** How much a cell counts beside the statement of one of its voxels. Less where classes have
 * factors: they tell what the cell would of its class. */
constexpr double kWeightOfCell = 2, kWeightBesideFactors = 1;
/** How often the search for what both are worth is halved. */
constexpr int kHalvings = 12;

/** A voxel, and its cell of the compressed map. */
struct Asked {
  Asked(const SemanticOcTree::Belief& voxel, const SemanticOcTree::Belief& ofCell,
        const Calibration& calibration, int numClasses, bool isOneVoxel)
      : cell(ofCell), told(classesOf(voxel, calibration, numClasses)) {
    likeliest = voxel.ids[0] - std::size_t{1};
    if (!calibration.factors.empty())
      likeliest = std::max_element(told.begin(), told.end()) - told.begin();
    stated = told[likeliest];
    const double besideFactors = isOneVoxel ? 0 : kWeightBesideFactors;
    const double weight = calibration.factors.empty() ? kWeightOfCell : besideFactors;
    for (std::size_t k = 0; k < told.size(); ++k)
      told[k] = exactLogarithm(told[k]) + weight * cell.logOddsOf(static_cast<ClassId>(k + 1));
    const double most = *std::max_element(told.begin(), told.end());
    for (double& x : told) x -= most;
  }
  /** p(class | occupied) as both say it. \param trust 1: as if neither repeated the other */
  std::vector<double> together(double trust) const {
    std::vector<double> p;
    for (const double x : told) p.push_back(exactExponential(trust * x));
    const double sum = std::accumulate(p.begin(), p.end(), 0.0);
    for (double& x : p) x /= sum;
    return p;
  }

  SemanticOcTree::Belief cell;
  std::vector<double> told;  ///< logarithms of both, added, less the largest
  std::size_t likeliest;     ///< the voxel's own class
  double stated;             ///< of it
};

/** What voxels state of their own classes stays, in the mean, when they hear their cells. The more
 * these are trusted, the more it becomes. \return trust */
double trustIn(const std::vector<Asked>& asked) {
  const double doubt = shareWithoutGain(kHalvings, [&](double share) {
    double gain = 0;
    for (const Asked& a : asked) gain += a.together(1 - share)[a.likeliest] - a.stated;
    return gain;
  });
  return 1 - doubt;
}

/** Mixtures state too little: voxels of a cell err in different ways, so most of them are right
 * more often than each. What a voxel is follows from its own statement and from its cell, and the
 * compressed map's power and factors make that likely. Cells of one size are trusted alike; of a
 * single voxel that hears itself, nothing but its statement is left. A map that is not calibrated
 * has compressed maps that are not. */
void calibrate(const SemanticOcTree& map, SemanticOcTree& compressed) {
  const Calibration& own = map.filterParameters().calibration;
  if (own.isIdentity()) return;
  const std::size_t oneIn = 1 + map.getNumLeafNodes() / kAskedLeaves;
  std::size_t number = 0;
  std::map<unsigned, std::vector<Asked>> byDepth;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    if (!leaf->hasClassRecord() || !map.isNodeOccupied(*leaf) || number++ % oneIn != 0) continue;
    unsigned depth = 1;
    Node cell = compressed.search(leaf.getKey(), depth);
    while (!cell.isLeaf()) cell = compressed.search(leaf.getKey(), ++depth);
    byDepth[depth].emplace_back(map.belief(*leaf), compressed.belief(cell), own, map.numClasses(),
                                depth == map.getTreeDepth());
  }
  CalibrationFit fit;
  for (const auto& [depth, asked] : byDepth) {
    const double trust = trustIn(asked);
    for (const Asked& a : asked) fit.add(a.cell, a.together(trust), 1);
  }
  if (fit.empty()) return;
  Calibration found = fit.fit({1, 0, std::vector<double>(own.factors.size(), 1.0)});
  found.power = std::round(kPowerSteps * found.power) / kPowerSteps;
  found.shared = 0;  // but for rounding
  compressed.setCalibration(found);
}

/** A map's nodes, down to the compressed tree's leaves (see TreeBuilder). */
class CompressedCursor {
 public:
  CompressedCursor(int numClasses, const IsExpanded& isExpanded, const Node& node)
      : m_numClasses(numClasses),
        m_isExpanded(isExpanded),
        m_node(node),
        m_isLeaf(!node || node.isLeaf() || !isExpanded(node)) {}
  bool known() const { return static_cast<bool>(m_node); }
  bool isLeaf() const { return m_isLeaf; }
  LeafContent content() const { return contentOf(m_node, m_numClasses); }
  CompressedCursor child(int i) const { return {m_numClasses, m_isExpanded, m_node.child(i)}; }

 private:
  int m_numClasses;
  const IsExpanded& m_isExpanded;
  Node m_node;
  bool m_isLeaf;
};

void compress(const SemanticOcTree& map, const IsExpanded& isExpanded, SemanticOcTree& compressed) {
  if (map.empty()) return;
  TreeBuilder::fill(compressed, CompressedCursor(map.numClasses(), isExpanded, map.root()),
                    TreeBuilder::Merge::Never);
  calibrate(map, compressed);
}

}  // namespace

std::optional<double> AbstractionMeasures::retention(std::size_t term) const {
  if (full.information[term] < 1e-12) return std::nullopt;
  return compressed.information[term] / full.information[term];
}

void setAbstraction(SemanticOcTree& map, const AbstractionOptions& options) {
  MapAccess::setObserver(map, std::make_unique<GTree>(options.forClasses(map.classes()),
                                                      MapAccess::filter(map), map.getResolution()));
}

void dropAbstraction(SemanticOcTree& map) { MapAccess::setObserver(map, nullptr); }

bool hasAbstraction(const SemanticOcTree& map) { return gTreeOf(map) != nullptr; }

Abstraction::Abstraction(SemanticOcTree& map) : m_map(map), m_gTree(neededGTreeOf(map)) {}

CompressedTree Abstraction::compressedTree() const { return {MapAccess::store(m_map), m_gTree}; }

const AbstractionOptions& Abstraction::options() const { return m_gTree.options(); }

int Abstraction::rootDepth() const {
  return options().frame == AbstractionOptions::Frame::Free ? m_gTree.blockDepth() : 0;
}

bool Abstraction::isExpanded(const Node& node) const { return compressedTree().isExpanded(node); }

std::vector<LeafCell> Abstraction::leaves() const {
  constexpr auto kLast = static_cast<octomap::key_type>(kNumKeys - 1);
  return leavesIn({0, 0, 0}, {kLast, kLast, kLast}, false);
}

std::vector<LeafCell> Abstraction::leavesIn(const octomap::OcTreeKey& low,
                                            const octomap::OcTreeKey& high,
                                            bool onlyOccupied) const {
  std::vector<LeafCell> leaves;
  if (m_map.empty()) return leaves;
  const VoxelIndex first(low[0], low[1], low[2]), last(high[0], high[1], high[2]);
  const auto isWanted = [&](const Node& node, const Cube& cell) {
    return (!onlyOccupied || node.getLogOdds() > 0) && (cell.lowest <= last).all() &&
           (cell.lowest + cell.edge() > first).all();
  };
  compressedTree().forEachLeaf(m_map.root(), Cube(), isWanted,
                               [&](const Node& node, const Cube& cell) {
                                 leaves.push_back({cell, node});
                               });
  return leaves;
}

double Abstraction::objective() const {
  const Slot& root = MapAccess::store(m_map).root();
  return root.isInner() ? MapAccess::store(m_map).state<InnerState>(root)->gValue : 0.0;
}

AbstractionMeasures Abstraction::measures() const {
  AbstractionMeasures m;
  const std::size_t numTerms = options().weights.terms.size();
  m.full.information.assign(numTerms, 0.0);
  m.compressed.information.assign(numTerms, 0.0);
  if (m_map.empty()) return m;
  m.objective = objective();
  for (auto* tree : {&m.full, &m.compressed}) tree->numLeaves = tree->numKnownLeaves = 1;
  const auto count = [&](tree_abstraction::TreeMeasures& tree, const PathNode& n,
                         const std::vector<double>& information) {
    tree.leafEntropy += n.price;
    for (std::size_t t = 0; t < numTerms; ++t) tree.information[t] += information[t];
    tree.numKnownLeaves += static_cast<std::size_t>(n.addedLeaves);
    tree.numLeaves += n.depth < m_gTree.blockDepth() ? static_cast<std::size_t>(n.addedLeaves) : 7;
  };
  forEachPathNode([&](const PathNode& n, const std::vector<double>& information) {
    count(m.full, n, information);
    if (n.isExpanded) count(m.compressed, n, information);
  });
  return m;
}

SemanticOcTree Abstraction::compressedMap() const {
  SemanticOcTree compressed = emptyCompressedMap();
  compressTo(compressed);
  return compressed;
}

SemanticOcTree Abstraction::emptyCompressedMap() const { return emptyFor(m_map); }

void Abstraction::compressTo(SemanticOcTree& compressed) const {
  TreeBuilder::checkTarget(compressed, emptyCompressedMap());
  const CompressedTree tree = compressedTree();
  compress(
      m_map, [&tree](const Node& node) { return tree.isExpanded(node); }, compressed);
}

void Abstraction::setAlpha(double alpha) {
  std::vector<double> weights;
  for (const auto& term : options().weights.terms) weights.push_back(term.weight);
  setWeights(weights, alpha);
}

void Abstraction::setWeights(const std::vector<double>& termWeights, double alpha) {
  AbstractionOptions changed = options();
  auto& terms = changed.weights.terms;
  if (termWeights.size() != terms.size())
    throw std::invalid_argument("abstraction: " + std::to_string(termWeights.size()) +
                                " weights, expected one for each of the " +
                                std::to_string(terms.size()) + " terms");
  for (std::size_t t = 0; t < terms.size(); ++t) terms[t].weight = termWeights[t];
  changed.weights.alpha = alpha;
  changed.forClasses(m_map.classes());  // refuses what cannot be
  GTree::Worker& worker = m_gTree.worker(0);
  m_gTree.setWeights(termWeights, alpha);
  recomputeAll(worker, MapAccess::store(m_map), MapAccess::store(m_map).root(), Cube());
}

void Abstraction::setRegions(const std::vector<Region>& regions) {
  for (const Region& region : regions) region.validate();
  const DensityField before = m_gTree.density();
  GTree::Worker& worker = m_gTree.worker(0);
  m_gTree.setRegions(regions);
  worker.recomputeWhereChanged(MapAccess::store(m_map), MapAccess::store(m_map).root(), Cube(),
                               before);
}

SemanticOcTree compressedMap(const SemanticOcTree& map, const IsExpanded& isExpanded) {
  SemanticOcTree compressed = emptyFor(map);
  compress(map, isExpanded, compressed);
  return compressed;
}

}  // namespace semantic_octree
