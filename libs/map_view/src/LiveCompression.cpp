#include <map_view/LiveCompression.h>

#include <map_view/CellSource.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/TreeFile.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace map_view {

using semantic_octree::TermCatalog;
using tree_abstraction::AbstractionWeights;
using tree_abstraction::InformationTerm;

namespace {

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
  all.weights.terms = TermCatalog(map.classes(), {all}).weighedTerms(all, 0);
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
    : m_numClasses(map.numClasses()), m_options(withAllTerms(map, solution)), m_tree(map) {
  dropAbstraction(map);
  change(m_options.weights);
  findAlphas();
}

void LiveCompression::findAlphas() {
  std::vector<double> weights;
  for (const InformationTerm& term : terms()) weights.push_back(term.weight);
  m_tree.setWeights(weights);
  m_retained.clear();
}

void LiveCompression::change(const AbstractionWeights& weights) {
  weights.validate(m_numClasses);
  m_options.weights = weights;
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

void LiveCompression::setLeaves(std::size_t wanted) {
  const semantic_octree::AlphaTrees trees = m_tree.trees();
  const auto least = static_cast<std::size_t>(trees.tree(0).leaves),
             most = static_cast<std::size_t>(trees.full().leaves);
  setAlpha(trees.alphaForLeaves(std::clamp(wanted, least, most)));
}

void LiveCompression::setBytes(const SemanticOcTree& map, std::size_t wanted) {
  setAlpha(m_tree.trees().largestThat([&](double alpha) {
    setAlpha(alpha);
    return semantic_octree::fileSize(compressedMap(map)) <= wanted;
  }));
}

SemanticOcTree LiveCompression::compressedMap(const SemanticOcTree& map) const {
  InformationTree::Index next = 0;
  return semantic_octree::compressedMap(map, [&](const semantic_octree::SemanticOcTreeNode&) {
    const InformationTree::Index node = next;
    next = isExpanded(node) ? node + 1 : m_tree.end(node);
    return isExpanded(node);
  });
}

float LiveCompression::retainedAround(InformationTree::Index node) const {
  if (m_retained.empty()) m_retained = m_tree.retainedInBlocks(m_threshold);
  return m_retained.empty() ? 1.f : m_retained[std::size_t(node)];
}

double LiveCompression::lowestAlpha() const {
  const double lowest = m_tree.lowestAlpha(m_options.weights.eps());
  return lowest > m_options.weights.eps() ? lowest : alpha();
}

double LiveCompression::highestAlpha() const {
  const double highest = m_tree.highestAlpha();
  return highest > 0 ? highest : alpha();
}

std::vector<KeyBox> LiveCompression::takeChange() {
  std::vector<KeyBox> boxes;
  const bool isFirst = m_toldExpanded.empty();
  m_toldExpanded.resize(std::size_t(m_tree.size()), false);
  if (isFirst && m_tree.size() > 0) boxes.push_back(KeyBox::of(m_tree.cube(0)));
  InformationTree::Index inBox = isFirst ? m_tree.size() : 0;  // the last box's nodes end there
  for (InformationTree::Index node = 0; node < m_tree.size(); ++node) {
    char& told = m_toldExpanded[std::size_t(node)];
    if (bool(told) == isExpanded(node)) continue;
    told = isExpanded(node);
    if (node < inBox) continue;
    boxes.push_back(KeyBox::of(m_tree.cube(node)));
    inBox = m_tree.end(node);
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
