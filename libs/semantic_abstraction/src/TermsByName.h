#pragma once
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_types/ClassTable.h>

#include <string>
#include <vector>

namespace semantic_octree {

/** Makes terms of the names of classes, for every form in which weights are written. All functions
 * throw std::invalid_argument saying what is wrong. */
class TermsByName {
 public:
  explicit TermsByName(const semantic_types::ClassTable& classes) : m_classes(classes) {}

  /** The class with this name, 0 for free space. */
  int idOf(const std::string& name) const;
  std::string nameOf(int id) const;
  /** Several members count as one. \param weight below 0 where they are irrelevant */
  tree_abstraction::InformationTerm term(const std::string& name,
                                         const std::vector<std::string>& members,
                                         double weight) const;
  /** Groups may bring a class in a second time, with the other sign. */
  void checkContradictions(const std::vector<tree_abstraction::InformationTerm>& terms) const;

 private:
  const semantic_types::ClassTable& m_classes;
};

}  // namespace semantic_octree
