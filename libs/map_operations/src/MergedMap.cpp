#include <map_operations/MapOperations.h>
#include <semantic_octree/store/TreeBuilder.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace semantic_octree {
namespace {

struct Sum {
  const std::vector<const SemanticOcTree*>& maps;
  ClassFilter filter;
  Limits limits;

  int numClasses() const { return filter.numClasses(); }
};

/** A cube in all maps: a leaf stands for all that is below it, null is unknown. */
class MergeCursor {
 public:
  MergeCursor(const Sum& sum, std::vector<Node> nodes) : m_sum(sum), m_nodes(std::move(nodes)) {}

  bool known() const {
    return std::any_of(m_nodes.begin(), m_nodes.end(),
                       [](const Node& n) { return static_cast<bool>(n); });
  }
  bool isLeaf() const {
    return std::all_of(m_nodes.begin(), m_nodes.end(),
                       [](const Node& n) { return !n || n.isLeaf(); });
  }
  MergeCursor child(int i) const {
    std::vector<Node> children = m_nodes;
    for (Node& node : children)
      if (node && !node.isLeaf()) node = node.child(i);
    return {m_sum, std::move(children)};
  }
  LeafContent content() const {
    const bool anyRecord = std::any_of(m_nodes.begin(), m_nodes.end(),
                                       [](const Node& n) { return n && n.hasClassRecord(); });
    return anyRecord ? sumOfRecords() : sumOfOccupancies();
  }

 private:
  LeafContent sumOfOccupancies() const {
    double sum = 0;
    for (const Node& node : m_nodes)
      if (node) sum += node.getLogOdds();
    const float value = static_cast<float>(sum);
    return {toUnits(m_sum.limits == Limits::Apply ? m_sum.filter.limitedOccupancy(value) : value),
            {}};
  }

  LeafContent sumOfRecords() const {
    std::vector<Belief> beliefs;
    for (std::size_t i = 0; i < m_nodes.size(); ++i)
      if (m_nodes[i]) beliefs.push_back(m_sum.maps[i]->belief(m_nodes[i]));
    std::vector<ClassLogOdds> named;
    for (const ClassId id : namesIn(beliefs))
      named.push_back({total(beliefs, [id](const Belief& b) { return b.logOddsOf(id); }), id});
    const double rest = total(beliefs, [](const Belief& b) { return b.rest; });
    Belief belief = truncated(std::move(named), rest, m_sum.numClasses());
    if (m_sum.limits == Limits::Apply)
      m_sum.filter.limit(belief);
    else
      lowerIntoRange(belief);
    return {toUnits(m_sum.filter.occupancyOf(belief)), ClassRecord::of(belief)};
  }

  /** All alike, so that what is likelier stays so. */
  void lowerIntoRange(Belief& b) const {
    float highest = b.unnamed(m_sum.numClasses()) > 0 ? b.rest : b.logOdds[0];
    for (int i = 0; i < b.count; ++i) highest = std::max(highest, b.logOdds[i]);
    const float excess = std::max(0.f, highest - fromUnits(INT16_MAX));
    for (int i = 0; i < b.count; ++i) b.logOdds[i] -= excess;
    b.rest -= excess;
  }

  static std::vector<ClassId> namesIn(const std::vector<Belief>& beliefs) {
    std::vector<ClassId> names;
    for (const Belief& b : beliefs)
      names.insert(names.end(), b.ids.begin(), b.ids.begin() + b.count);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
  }

  /** Sum of log-odds, less the prior's that is in all but one. */
  template <typename F>
  double total(const std::vector<Belief>& beliefs, const F& logOdds) const {
    const double prior = m_sum.filter.uniform(0).rest;
    double sum = prior;
    for (const Belief& b : beliefs) sum += logOdds(b) - prior;
    return sum;
  }

  const Sum& m_sum;
  std::vector<Node> m_nodes;
};

void checkAlike(const std::vector<const SemanticOcTree*>& maps) {
  if (maps.empty()) throw std::invalid_argument("merging: no maps");
  const SemanticOcTree& first = *maps.front();
  for (std::size_t i = 1; i < maps.size(); ++i) {
    const auto differ = [i](const std::string& what) {
      throw std::invalid_argument("merging: map " + std::to_string(i + 1) + " has " + what +
                                  " than map 1");
    };
    if (maps[i]->getResolution() != first.getResolution())
      differ("another resolution (" + std::to_string(maps[i]->getResolution()) + " m instead of " +
             std::to_string(first.getResolution()) + " m)");
    if (maps[i]->classes() != first.classes()) differ("another class table");
    if (!(maps[i]->filterParameters() == first.filterParameters()))
      differ("other filter parameters");
  }
}

/** The sum's clock is that of the newest map. */
SemanticOcTree emptySumOf(const std::vector<const SemanticOcTree*>& maps) {
  const auto isEarlier = [](const auto* a, const auto* b) { return a->clock() < b->clock(); };
  SemanticOcTree sum = emptyLike(**std::max_element(maps.begin(), maps.end(), isEarlier));
  sum.setPruning(maps.front()->pruning());
  return sum;
}

/** A map without labels, of which there is nothing to calibrate. */
bool saysNothingOfClasses(const SemanticOcTree* map) {
  if (!map->filterParameters().calibration.isIdentity()) return false;
  auto leaf = map->begin_leafs();
  while (leaf != map->end_leafs() && !leaf->hasClassRecord()) ++leaf;
  return leaf == map->end_leafs();
}

/** The lowest power, the largest share, and the factors next to 1: the same however sums are
 * grouped. */
Calibration mostCautious(std::vector<const SemanticOcTree*> maps) {
  maps.erase(std::remove_if(maps.begin(), maps.end(), saysNothingOfClasses), maps.end());
  if (maps.empty()) return {};
  Calibration calibration{1, 0, maps.front()->filterParameters().calibration.factors};
  std::vector<double>& factors = calibration.factors;
  for (const SemanticOcTree* map : maps) {
    const Calibration& own = map->filterParameters().calibration;
    calibration.power = std::min(calibration.power, own.power);
    calibration.shared = std::max(calibration.shared, own.shared);
    if (own.factors.empty()) factors.clear();
    for (std::size_t k = 0; k < factors.size(); ++k)
      factors[k] = std::max(std::min(factors[k], std::max(own.factors[k], 1.0)),
                            std::min(own.factors[k], 1.0));
  }
  return calibration;
}

}  // namespace

SemanticOcTree merged(const std::vector<const SemanticOcTree*>& maps, Limits limits) {
  checkAlike(maps);
  SemanticOcTree sum = emptySumOf(maps);
  mergeTo(sum, maps, limits);
  return sum;
}

void mergeTo(SemanticOcTree& sum, const std::vector<const SemanticOcTree*>& maps, Limits limits) {
  checkAlike(maps);
  TreeBuilder::checkTarget(sum, emptySumOf(maps));
  const Sum context{maps, {sum.numClasses(), sum.filterParameters()}, limits};
  std::vector<Node> roots;
  for (const SemanticOcTree* map : maps) roots.push_back(map->root());
  TreeBuilder::fill(sum, MergeCursor(context, std::move(roots)));
  sum.setCalibration(mostCautious(maps));
}

}  // namespace semantic_octree
