#include <map_view/LiveCompression.h>

#include <map_view/CellSource.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/TreeFile.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace map_view {

using semantic_octree::Abstraction;
using semantic_octree::AlphaTrees;
using semantic_octree::TermCatalog;
using tree_abstraction::AbstractionWeights;
using tree_abstraction::InformationTerm;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::int32_t kNone = -1;

/** Below that there is nothing to retain, nats. */
constexpr double kNothing = 1e-12;

/** A cube in one number. */
std::uint64_t packed(const Cube& cube) {
  return std::uint64_t(cube.lowest.x()) | std::uint64_t(cube.lowest.y()) << 16 |
         std::uint64_t(cube.lowest.z()) << 32 | std::uint64_t(cube.depth) << 48;
}

/** In the order in which semantic-map-compress has them, so that sums round alike; the map keeps
 * G-values with them. */
AbstractionOptions withAllTerms(SemanticOcTree& map, const AbstractionOptions& solution) {
  if (map.empty()) throw std::invalid_argument("the map is empty");
  AbstractionOptions all = solution.forClasses(map.classes());
  for (const InformationTerm& term : LiveCompression::allClasses(map).weights.terms) {
    const auto same = [&](const InformationTerm& t) { return t.groups == term.groups; };
    if (std::none_of(all.weights.terms.begin(), all.weights.terms.end(), same))
      all.weights.terms.push_back({term.name, 0, term.groups});
  }
  all.weights.terms = TermCatalog(map.classes(), {all}).terms(all);
  setAbstraction(map, all);
  return all;
}

}  // namespace

AbstractionOptions LiveCompression::allClasses(const SemanticOcTree& map,
                                               AbstractionOptions options) {
  std::vector<bool> occurs(std::size_t(map.numClasses()) + 1, false);
  forEachOccupiedLeaf(
      map, [&](const ViewCell& leaf) { occurs[map.query(leaf.node).likeliestClass] = true; });
  options.name = "view";
  for (int id = 1; id <= map.numClasses(); ++id)
    if (occurs[std::size_t(id)])
      options.weights.terms.push_back(
          {map.classes().name(static_cast<semantic_types::ClassId>(id)), 1, {{id}}});
  return options;
}

LiveCompression::LiveCompression(SemanticOcTree& map, const AbstractionOptions& solution)
    : m_classes(map.classes()),
      m_options(withAllTerms(map, solution)),
      m_numRoots(map.getNumLeafNodes()) {
  readNodes(map);
  dropAbstraction(map);
  change(m_options.weights);
  findAlphas();
}

void LiveCompression::readNodes(SemanticOcTree& map) {
  const std::size_t nodes = map.size() - map.getNumLeafNodes();
  m_information.reserve(nodes * numTerms());
  m_end.reserve(nodes);
  std::array<Index, semantic_octree::kTreeDepth> lastAtDepth{};
  std::array<std::int32_t, semantic_octree::kTreeDepth> chargedAtDepth{};
  int depthBefore = -1;
  const auto endAbove = [&](int depth) {  // subtrees that the next node is not in
    for (int d = depthBefore; d >= depth; --d)
      m_end[std::size_t(lastAtDepth[std::size_t(d)])] = size();
  };
  Abstraction(map).forEachPathNode([&](const Abstraction::PathNode& n, const auto& information) {
    endAbove(n.depth);
    const auto depth = std::size_t(n.depth);
    lastAtDepth[depth] = size(), depthBefore = n.depth;
    chargedAtDepth[depth] = kNone;
    if (!n.isFree) {
      chargedAtDepth[depth] = static_cast<std::int32_t>(m_charged.size());
      m_charged.push_back(size());
      m_parents.push_back(depth == 0 ? kNone : chargedAtDepth[depth - 1]);
      m_shares.push_back(n.share);
      m_prices.push_back(n.price);
      m_numRoots -= std::size_t(n.addedLeaves);
    }
    m_end.push_back(0);
    m_places.push_back(packed(n));
    m_addedLeaves.push_back(n.isFree ? 0 : n.addedLeaves);
    m_information.insert(m_information.end(), information.begin(), information.end());
  });
  endAbove(0);
  m_alphas.assign(m_end.size(), kInfinity);
}

Cube LiveCompression::cube(Index node) const {
  const std::uint64_t place = m_places[std::size_t(node)];
  const auto key = [place](int shift) { return int(place >> shift & 0xffff); };
  return {{key(0), key(16), key(32)}, key(48)};
}

void LiveCompression::findAlphas() {
  m_gains.clear();
  for (const Index node : m_charged) {
    double gain = 0;
    for (std::size_t t = 0; t < numTerms(); ++t) gain += weight(t) * information(node, t);
    m_gains.push_back(gain);
  }
  const auto alphas = tree_abstraction::collapseAlphas(m_parents, m_gains, m_prices);
  for (std::size_t i = 0; i < alphas.size(); ++i) m_alphas[std::size_t(m_charged[i])] = alphas[i];
  m_retained.clear();
}

void LiveCompression::change(const AbstractionWeights& weights) {
  AbstractionOptions changed = m_options;
  changed.weights = weights;
  m_options = changed.forClasses(m_classes);
  m_threshold = alpha() + m_options.weights.eps();
  m_retained.clear();
}

void LiveCompression::setWeight(std::size_t term, double weight) {
  AbstractionWeights weights = m_options.weights;
  weights.terms.at(term).weight = weight;
  change(weights);
  findAlphas();
}

void LiveCompression::setAlpha(double alpha) {
  AbstractionWeights weights = m_options.weights;
  weights.alpha = alpha;
  change(weights);
}

AlphaTrees LiveCompression::trees() const {
  return AlphaTrees([this](const AlphaTrees::Visit& visit) -> semantic_octree::AddedToTree {
    for (const Index node : m_charged)
      visit(alphaOf(node), {m_addedLeaves[std::size_t(node)], 0, 0});
    return {double(m_numRoots), 0, 0};
  });
}

void LiveCompression::setLeaves(std::size_t wanted) {
  const AlphaTrees trees = this->trees();
  const auto least = static_cast<std::size_t>(trees.tree(0).leaves),
             most = static_cast<std::size_t>(trees.full().leaves);
  setAlpha(trees.alphaForLeaves(std::clamp(wanted, least, most)));
}

void LiveCompression::setBytes(const SemanticOcTree& map, std::size_t wanted) {
  setAlpha(trees().largestThat([&](double alpha) {
    setAlpha(alpha);
    return semantic_octree::fileSize(compressedMap(map)) <= wanted;
  }));
}

SemanticOcTree LiveCompression::compressedMap(const SemanticOcTree& map) const {
  Index next = 0;
  return semantic_octree::compressedMap(map, [&](const semantic_octree::SemanticOcTreeNode&) {
    const Index node = next;
    next = isExpanded(node) ? node + 1 : end(node);
    return isExpanded(node);
  });
}

std::size_t LiveCompression::numLeaves() const {
  double leaves = double(m_numRoots);
  for (Index node = 0; node < size(); ++node)
    if (isExpanded(node)) leaves += m_addedLeaves[std::size_t(node)];
  return static_cast<std::size_t>(leaves);
}

double LiveCompression::lowestAlpha() const {
  double lowest = kInfinity;
  for (const double alpha : m_alphas)
    if (alpha > m_options.weights.eps()) lowest = std::min(lowest, alpha);
  return std::isfinite(lowest) ? lowest : alpha();
}

double LiveCompression::highestAlpha() const {
  double highest = 0;
  for (const double alpha : m_alphas)
    if (std::isfinite(alpha)) highest = std::max(highest, alpha);
  return highest > 0 ? highest : alpha();
}

std::vector<std::optional<double>> LiveCompression::retained() const {
  std::vector<double> all(numTerms(), 0.0), kept(numTerms(), 0.0);
  for (Index node = 0; node < size(); ++node)
    for (std::size_t t = 0; t < numTerms(); ++t) {
      all[t] += information(node, t);
      if (isExpanded(node)) kept[t] += information(node, t);
    }
  std::vector<std::optional<double>> shares(numTerms());
  for (std::size_t t = 0; t < numTerms(); ++t)
    if (all[t] >= kNothing) shares[t] = kept[t] / all[t];
  return shares;
}

std::vector<float> LiveCompression::retainedInBlocks() const {
  std::vector<float> shares(m_end.size(), 1.f);
  for (std::size_t i = 0; i < m_charged.size();) {
    const Index block = m_charged[i], end = this->end(block);
    double all = 0, kept = 0;
    for (; i < m_charged.size() && m_charged[i] < end; ++i) {
      double relevant = 0;
      for (std::size_t t = 0; t < numTerms(); ++t)
        relevant += std::max(0.0, weight(t)) * information(m_charged[i], t);
      all += relevant;
      if (isExpanded(m_charged[i])) kept += relevant;
    }
    if (all >= kNothing) std::fill(shares.begin() + block, shares.begin() + end, float(kept / all));
  }
  return shares;
}

float LiveCompression::retainedAround(Index node) const {
  if (m_retained.empty()) m_retained = retainedInBlocks();
  return m_retained.empty() ? 1.f : m_retained[std::size_t(node)];
}

std::vector<std::size_t> LiveCompression::chargedAround(const Eigen::Array3i& key) const {
  std::vector<std::size_t> found;
  for (Index node = 0, end = size(); node < end;) {
    if (!cube(node).contains(key)) {
      node = m_end[std::size_t(node)];  // over its subtree
      continue;
    }
    const auto place = std::lower_bound(m_charged.begin(), m_charged.end(), node);
    if (place != m_charged.end() && *place == node)
      found.push_back(std::size_t(place - m_charged.begin()));
    end = m_end[std::size_t(node)];
    ++node;
  }
  return found;
}

std::vector<LiveCompression::Balance> LiveCompression::balancesAround(
    const Eigen::Array3i& key) const {
  const std::vector<std::size_t> around = chargedAround(key);
  if (around.empty()) return {};
  // What the children's G-values sum up to, times p(n), for the largest node and all below it,
  // children before parents.
  const std::size_t first = around.front();
  const auto end =
      std::lower_bound(m_charged.begin(), m_charged.end(), m_end[std::size_t(m_charged[first])]);
  std::vector<double> ofChildren(std::size_t(end - m_charged.begin()) - first, 0.0);
  const auto valueOf = [&](std::size_t i) {
    return std::max(0.0, m_gains[i] - alpha() * m_prices[i] + ofChildren[i - first]);
  };
  for (std::size_t i = first + ofChildren.size() - 1; i > first; --i)
    ofChildren[std::size_t(m_parents[i]) - first] += valueOf(i);

  std::vector<Balance> balances;
  for (const std::size_t i : around) {
    const double unit = m_shares[i] > 0 ? 1 / m_shares[i] : 0;
    Balance balance = {
        m_charged[i],     {}, unit * m_gains[i], unit * m_prices[i], unit * ofChildren[i - first],
        unit * valueOf(i)};
    for (std::size_t t = 0; t < numTerms(); ++t)
      balance.divergences.push_back(unit * information(m_charged[i], t));
    balances.push_back(std::move(balance));
  }
  return balances;
}

std::vector<KeyBox> LiveCompression::takeChange() {
  std::vector<KeyBox> boxes;
  const bool isFirst = m_toldExpanded.empty();
  m_toldExpanded.resize(std::size_t(size()), false);
  if (isFirst && size() > 0) boxes.push_back(KeyBox::of(cube(0)));
  Index inBox = isFirst ? size() : 0;  // the last box's nodes end there
  for (Index node = 0; node < size(); ++node) {
    char& told = m_toldExpanded[std::size_t(node)];
    if (bool(told) == isExpanded(node)) continue;
    told = isExpanded(node);
    if (node < inBox) continue;
    boxes.push_back(KeyBox::of(cube(node)));
    inBox = end(node);
  }
  return boxes;
}

AbstractionOptions LiveCompression::solution() const {
  AbstractionOptions solution = m_options;
  solution.weights.terms.clear();
  for (const InformationTerm& term : terms())
    if (term.weight != 0) solution.weights.terms.push_back(term);
  return solution;
}

using semantic_octree::Region;
using semantic_types::ClassTable;
using strict_files::textOf;

namespace {

class Writer {
 public:
  explicit Writer(const ClassTable& classes) : m_classes(classes) {}

  std::string write(AbstractionOptions solution) {
    const std::vector<InformationTerm>& terms = solution.weights.terms;
    m_out << YAML::BeginMap;
    pair("name", solution.name);
    addTerms("relevant", 1, terms);
    addTerms("irrelevant", -1, terms);
    for (const InformationTerm& term : terms)
      if (term.weight > 0 && isWhole(term)) pair("everything", textOf(term.weight));
    strict_files::OptionList list;
    solution.describe(list);
    for (const char* name : {"alpha", "block_size", "unknown"}) pair(name, list.find(name)->text());
    addRegions(solution.regions);
    m_out << YAML::EndMap;
    return std::string(m_out.c_str()) + "\n";
  }

 private:
  void pair(const std::string& key, const std::string& value) {
    m_out << YAML::Key << key << YAML::Value << value;
  }
  bool isWhole(const InformationTerm& term) const {
    return term.groups.size() == std::size_t(m_classes.size()) + 1;
  }
  std::string nameOf(int id) const {
    return id == 0 ? semantic_octree::kFreeSpace
                   : m_classes.name(static_cast<semantic_types::ClassId>(id));
  }

  void addTerms(const char* key, int sign, const std::vector<InformationTerm>& terms) {
    bool begun = false;
    for (const InformationTerm& term : terms) {
      if (!(term.weight * sign > 0) || (isWhole(term) && sign > 0)) continue;
      if (term.groups.size() != 1)
        throw std::invalid_argument("'" + term.name + "' cannot be written as a weight");
      if (!begun) m_out << YAML::Key << key << YAML::Value << YAML::BeginMap;
      begun = true;
      addTerm(term, textOf(std::fabs(term.weight)));
    }
    if (begun) m_out << YAML::EndMap;
  }

  void addTerm(const InformationTerm& term, const std::string& weight) {
    if (term.groups[0].size() == 1) return pair(nameOf(term.groups[0][0]), weight);
    m_out << YAML::Key << term.name << YAML::Value << YAML::BeginMap << YAML::Key << "classes"
          << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const int id : term.groups[0]) m_out << nameOf(id);
    m_out << YAML::EndSeq;
    pair("weight", weight);
    m_out << YAML::EndMap;
  }

  void addRegions(const std::vector<Region>& regions) {
    if (regions.empty()) return;
    m_out << YAML::Key << "regions" << YAML::Value << YAML::BeginSeq;
    for (const Region& region : regions) m_out << region.text();
    m_out << YAML::EndSeq;
  }

  const ClassTable& m_classes;
  YAML::Emitter m_out;
};

}  // namespace

std::string weightsText(const AbstractionOptions& solution, const ClassTable& classes) {
  bool weighs = false;
  for (const InformationTerm& term : solution.weights.terms) weighs = weighs || term.weight != 0;
  if (!weighs) throw std::invalid_argument("no class has a weight: there is nothing to save");
  return Writer(classes).write(solution);
}

}  // namespace map_view
