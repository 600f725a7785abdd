#pragma once
#include <semantic_types/ClassTable.h>
#include <strict_files/StrictYaml.h>

#include <vector>

namespace labeled_cloud {

/** Keys of a file about a classifier that namedClasses() reads. */
inline const std::set<std::string> kNamedClassesKeys = {"classes", "fold"};

/** A classifier's classes in its own order, as ids of the table: `classes` is the list of their
 * names, and `fold` says what those are called that the table calls otherwise (or `no_class`).
 * \throw std::runtime_error naming file, line and a name that is not in the table. */
std::vector<semantic_types::ClassId> namedClasses(const strict_files::StrictYaml& yaml,
                                                  const semantic_types::ClassTable& table);

}  // namespace labeled_cloud
