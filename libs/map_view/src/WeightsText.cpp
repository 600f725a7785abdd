#include <map_view/LiveCompression.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <stdexcept>

namespace map_view {

using semantic_octree::AbstractionOptions;
using semantic_octree::Region;
using semantic_types::ClassTable;
using strict_files::textOf;
using tree_abstraction::InformationTerm;

namespace {

class Writer {
 public:
  explicit Writer(const ClassTable& classes) : m_classes(classes) {}

  std::string write(const semantic_octree::Solution& solution, AbstractionOptions space) {
    m_out << YAML::BeginMap;
    pair("name", solution.name);
    addTerms("relevant", 1, solution.terms);
    addTerms("irrelevant", -1, solution.terms);
    for (const InformationTerm& term : solution.terms)
      if (term.weight > 0 && isWhole(term)) pair("everything", textOf(term.weight));
    if (solution.alpha) pair("alpha", textOf(*solution.alpha));
    strict_files::OptionList list;
    static_cast<semantic_octree::AbstractionSpace&>(space).describe(list);
    for (const strict_files::Option& option : list.options()) pair(option.name, option.text());
    addRegions(space.regions);
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

std::string weightsText(const semantic_octree::Solution& solution, const AbstractionOptions& space,
                        const ClassTable& classes) {
  bool weighs = false;
  for (const InformationTerm& term : solution.terms) weighs = weighs || term.weight != 0;
  if (!weighs) throw std::invalid_argument("no class has a weight: there is nothing to save");
  return Writer(classes).write(solution, space);
}

}  // namespace map_view
