#pragma once
#include <colored_graph/ClassOrder.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_types/ClassTable.h>

#include <filesystem>
#include <string>

namespace semantic_planning {

/** A compressed tree for planning with this order (over the map's class ids, 0 = unknown ground):
 * it keeps what tells the ranks apart, each from the others and from all that is forbidden.
 * \param alpha price of detail, see AbstractionWeights::alpha \param obstacles keeps what tells
 * these from air, too */
semantic_octree::AbstractionOptions abstractionFor(const colored_graph::ClassOrder& order,
                                                   double alpha = tree_abstraction::kPlanningAlpha,
                                                   bool obstacles = false);

/** One that keeps what a solution of a file of weights says (see semantic_octree::loadWeights); its
 * alpha is kPlanningAlpha if the file says none. \param solution its name; empty: the first
 * \throw std::runtime_error naming the file and what is wrong with it, or that it has no such
 * solution */
semantic_octree::AbstractionOptions abstractionOf(const std::filesystem::path& weights,
                                                  const std::string& solution,
                                                  const semantic_types::ClassTable& classes);

}  // namespace semantic_planning
