#pragma once
#include <colored_graph/CostModel.h>

#include <map>
#include <string>

namespace colored_graph {

/** In words for files and command lines: "endpoint", "sweep", "profile". */
const char* nameOf(EdgeModel model);
/** All models by their names. */
std::map<std::string, EdgeModel> edgeModels();

}  // namespace colored_graph
