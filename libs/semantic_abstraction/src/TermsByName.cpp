#include "TermsByName.h"

#include <semantic_abstraction/AbstractionOptions.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>

namespace semantic_octree {

using semantic_types::ClassId;
using tree_abstraction::InformationTerm;

int TermsByName::idOf(const std::string& name) const {
  if (const auto id = m_classes.find(name)) return *id;
  if (name == kFreeSpace) return 0;
  std::vector<std::string> known = {kFreeSpace};
  for (int id = 1; id <= m_classes.size(); ++id) known.push_back(nameOf(id));
  throw std::invalid_argument("unknown class '" + name + "'; known are " +
                              strict_files::joined(known) + strict_files::didYouMean(name, known));
}

std::string TermsByName::nameOf(int id) const {
  return id == 0 ? kFreeSpace : m_classes.name(static_cast<ClassId>(id));
}

InformationTerm TermsByName::term(const std::string& name, const std::vector<std::string>& members,
                                  double weight) const {
  std::set<int> ids;
  for (const std::string& member : members)
    if (!ids.insert(idOf(member)).second)
      throw std::invalid_argument("'" + member + "' twice in '" + name + "'");
  return {name, weight, {{ids.begin(), ids.end()}}};
}

void TermsByName::checkContradictions(const std::vector<InformationTerm>& terms) const {
  std::map<int, const InformationTerm*> relevant;
  for (const InformationTerm& term : terms)
    if (term.groups.size() == 1 && term.weight > 0)
      for (const int id : term.groups.front()) relevant[id] = &term;
  for (const InformationTerm& term : terms) {
    if (term.groups.size() != 1 || !(term.weight < 0)) continue;
    for (const int id : term.groups.front())
      if (relevant.count(id))
        throw std::invalid_argument("class '" + nameOf(id) + "' is both relevant ('" +
                                    relevant[id]->name + "') and irrelevant ('" + term.name + "')");
  }
}

std::vector<double> TermsByName::prior(
    const std::vector<std::pair<std::string, double>>& given) const {
  if (given.empty()) return {};
  std::vector<double> prior(std::size_t(m_classes.size()) + 1, -1);
  double sum = 0;
  for (const auto& [name, probability] : given) {
    double& place = prior[std::size_t(idOf(name))];
    if (place >= 0) throw std::invalid_argument("'" + name + "' twice");
    sum += place = probability;
  }
  const auto others = std::count(prior.begin(), prior.end(), -1.0);
  if (sum > 1 + 1e-9 || (others == 0 && sum < 1 - 1e-9))
    throw std::invalid_argument("probabilities sum to " + strict_files::textOf(sum) +
                                ", expected 1");
  std::replace(prior.begin(), prior.end(), -1.0,
               std::max(0.0, 1 - sum) / static_cast<double>(std::max<std::ptrdiff_t>(others, 1)));
  return prior;
}

}  // namespace semantic_octree
