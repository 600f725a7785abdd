#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <strict_files/TextFile.h>

#include <nlohmann/json.hpp>
#include <vector>

namespace semantic_map_info {

/** What the map knows at each line `x y z` (meters), in the order of the lines. An answer has x, y,
 * z, state (unknown, free or occupied), class id and name (0 and "-" where no class was ever seen),
 * probability and occupancy. A distribution, if asked for, has free space and the classes that are
 * not 0 in six digits, and nothing where nothing is known.
 * \throw std::runtime_error naming file and line: not three finite numbers. */
nlohmann::ordered_json answersAt(const semantic_octree::SemanticOcTree& map,
                                 const std::vector<strict_files::TextLine>& lines,
                                 bool distribution);

/** Answers as text, a line each, separated by tabs; lines of distributions begin with a tab. */
std::string textOfAnswers(const nlohmann::ordered_json& answers);

}  // namespace semantic_map_info
