#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <strict_files/TextFile.h>

#include <iosfwd>
#include <vector>

namespace semantic_map_info {

/** Answers each line `x y z` (meters) with, separated by tabs,
 *
 *     x y z STATE ID CLASS PROBABILITY OCCUPANCY
 *
 * STATE is unknown, free or occupied; ID and CLASS are 0 and - where no class was ever seen.
 * \throw std::runtime_error naming file and line: not three finite numbers. */
void answerPoints(const semantic_octree::SemanticOcTree& map,
                  const std::vector<strict_files::TextLine>& points, std::ostream& out);

}  // namespace semantic_map_info
