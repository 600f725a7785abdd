#pragma once
#include <colored_graph/CostModel.h>

#include <utility>
#include <vector>

namespace colored_graph {

/** In words for files and command lines: "endpoint", "sweep", "profile". */
const std::vector<std::pair<const char*, EdgeModel>>& choicesOf(EdgeModel);
const char* nameOf(EdgeModel model);
/** "count", "length". */
const std::vector<std::pair<const char*, CostKind>>& choicesOf(CostKind);

}  // namespace colored_graph
