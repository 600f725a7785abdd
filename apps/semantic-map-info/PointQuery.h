#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <istream>
#include <ostream>
#include <string>

namespace semantic_map_info {

/** Answers each line `x y z` (meters; empty lines and what follows '#' are skipped) with, separated
 * by tabs,
 *
 *     x y z STATE ID CLASS PROBABILITY OCCUPANCY
 *
 * STATE is unknown, free or occupied; ID and CLASS are 0 and - where no class was ever seen.
 * \param name of the input, for messages
 * \throw std::runtime_error naming line and text: not three finite numbers. */
void answerPoints(const semantic_octree::SemanticOcTree& map, std::istream& in,
                  const std::string& name, std::ostream& out);

}  // namespace semantic_map_info
