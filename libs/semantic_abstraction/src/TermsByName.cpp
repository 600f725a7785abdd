#include "TermsByName.h"

#include <semantic_abstraction/AbstractionOptions.h>
#include <strict_files/Words.h>

#include <map>
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

}  // namespace semantic_octree
