#include <map_view/LiveCompression.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace map_view {

using semantic_octree::Abstraction;
using semantic_octree::TermCatalog;
using tree_abstraction::InformationTerm;

namespace {

constexpr double kAlpha = 0.002;

/** Of a class variable, in which free space and the classes are told apart. */
bool sameGroups(const InformationTerm& a, const InformationTerm& b) { return a.groups == b.groups; }

}  // namespace

Solution LiveCompression::allClasses(const SemanticOcTree& map) {
  std::vector<bool> occurs(std::size_t(map.numClasses()) + 1, false);
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf)
    if (map.isNodeOccupied(*leaf)) occurs[map.query(*leaf).likeliestClass] = true;
  Solution solution;
  solution.name = "view";
  solution.alpha = kAlpha;
  for (int id = 1; id <= map.numClasses(); ++id)
    if (occurs[std::size_t(id)])
      solution.terms.push_back(
          {map.classes().name(static_cast<semantic_types::ClassId>(id)), 1, {{id}}});
  return solution;
}

/** In the order in which semantic-map-compress has them, so that sums round alike. */
std::vector<InformationTerm> LiveCompression::termsOf(SemanticOcTree& map, const Solution& solution,
                                                      const AbstractionOptions& space) {
  if (map.empty()) throw std::invalid_argument("the map is empty");
  Solution all = solution;
  for (const InformationTerm& term : allClasses(map).terms) {
    const auto same = [&](const InformationTerm& t) { return sameGroups(t, term); };
    if (std::none_of(all.terms.begin(), all.terms.end(), same))
      all.terms.push_back({term.name, 0, term.groups});
  }
  const TermCatalog catalog(map.classes(), {all});
  AbstractionOptions options = space;
  options.weights.terms = catalog.terms(0);
  const std::vector<double> weights = catalog.weights(all, 0);
  for (std::size_t t = 0; t < weights.size(); ++t) options.weights.terms[t].weight = weights[t];
  options.weights.alpha = solution.alpha.value_or(kAlpha);
  map.setAbstraction(options);
  return options.weights.terms;
}

LiveCompression::LiveCompression(SemanticOcTree& map, const Solution& solution,
                                 const AbstractionOptions& space)
    : m_map(map),
      m_space(space),
      m_alpha(solution.alpha.value_or(kAlpha)),
      m_name(solution.name),
      m_terms(termsOf(map, solution, space)),
      m_abstraction(map) {
  findPath();
}

std::vector<double> LiveCompression::weights() const {
  std::vector<double> weights;
  for (const InformationTerm& term : m_terms) weights.push_back(term.weight);
  return weights;
}

void LiveCompression::findPath() {
  m_path.emplace(m_abstraction.alphaPath());
  m_leavesOfTree = m_path->trees.totals(m_path->addedLeaves, double(m_path->numRoots));
  m_measures.reset();
}

void LiveCompression::setWeight(std::size_t term, double weight) {
  const double before = m_terms.at(term).weight;
  m_terms[term].weight = weight;
  try {
    m_abstraction.setWeights(weights(), m_alpha);
  } catch (const std::invalid_argument&) {
    m_terms[term].weight = before;
    throw;
  }
  findPath();
}

void LiveCompression::setAlpha(double alpha) {
  m_abstraction.setAlpha(alpha);
  m_alpha = alpha;
  m_measures.reset();
}

void LiveCompression::setLeaves(std::size_t wanted) {
  const auto most = static_cast<std::size_t>(m_leavesOfTree.back());
  setAlpha(m_path->alphaForLeaves(std::clamp(wanted, m_path->numRoots, most)));
}

double LiveCompression::lowestAlpha() const {
  const auto& trees = m_path->trees;
  return trees.numTrees() < 2 ? m_alpha : trees.lowestAlpha(trees.numTrees() - 2);
}

double LiveCompression::highestAlpha() const {
  for (std::size_t k = 0; k < m_path->trees.numTrees(); ++k)
    if (std::isfinite(m_path->trees.lowestAlpha(k)) && m_path->trees.lowestAlpha(k) > 0)
      return m_path->trees.lowestAlpha(k);
  return m_alpha;
}

/** The first tree, from the roots on, that reaches down to alpha. */
std::size_t LiveCompression::numLeaves() const {
  std::size_t low = 0, high = m_path->trees.numTrees() - 1;
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (m_path->trees.lowestAlpha(middle) <= m_alpha)
      high = middle;
    else
      low = middle + 1;
  }
  return static_cast<std::size_t>(m_leavesOfTree[low]);
}

const semantic_octree::AbstractionMeasures& LiveCompression::measures() const {
  if (!m_measures) m_measures = m_abstraction.measures();
  return *m_measures;
}

Solution LiveCompression::solution() const {
  Solution solution;
  solution.name = m_name;
  solution.alpha = m_alpha;
  for (const InformationTerm& term : m_terms)
    if (term.weight != 0) solution.terms.push_back(term);
  return solution;
}

}  // namespace map_view
