#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "Compression.h"

namespace semantic_map_compress {

/** Everything about all solutions, informations in bits. */
nlohmann::ordered_json toJson(const FullMap& map, const TermCatalog& catalog,
                              const semantic_octree::AbstractionOptions& space,
                              const std::vector<Compression>& compressions,
                              const StageTimer& times);

/** One line a solution; the first line names the columns. */
std::string toCsv(const TermCatalog& catalog, const std::vector<Compression>& compressions);

}  // namespace semantic_map_compress
