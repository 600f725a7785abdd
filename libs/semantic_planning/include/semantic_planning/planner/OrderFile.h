#pragma once
#include <colored_graph/ClassOrder.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_types/ClassTable.h>

#include <filesystem>

namespace semantic_planning {

/** Name of ground whose class is not known, in files. Its class id is semantic_types::kNoClass. */
constexpr const char* kUnknownGround = "unknown";

/** Reads an order of classes:
 *
 *     best_to_worst:            # classes that are not named are forbidden
 *       - [road, lane-marking]  # several classes may share a rank
 *       - sidewalk
 *       - unknown               # ground of unknown class
 *     rates: [4, 12]            # of all ranks but the best: so many meters more of driving a meter
 *                               # is worth avoiding; inf: any number. Without: 4, 12, 36, 108, ...
 *
 * \return over the map's class ids 0..K, 0 = unknown ground.
 * \throw std::runtime_error naming file, line and value: unreadable, YAML syntax, unknown or
 * repeated key, a class that is unknown or named twice, more than 16 ranks, rates that
 * ClassOrder::withRates() refuses. */
colored_graph::ClassOrder loadClassOrder(const std::filesystem::path& file,
                                         const semantic_types::ClassTable& classes);

/** A compressed tree for planning with this order over the map's class ids, 0 = unknown ground. It
 * tells the ranks apart, from each other and from what is forbidden. */
semantic_octree::AbstractionOptions abstractionFor(const colored_graph::ClassOrder& order);

}  // namespace semantic_planning
