#pragma once
#include <filesystem>

#include "Compression.h"

namespace semantic_map_compress {

// Figures about all solutions, drawn with gnuplot into a PNG file.
// All: \throw std::runtime_error as drawWithGnuplot().

/** Share of the information kept, per class and solution; below, the share of leaves. Classes that
 * the map does not show are left out. */
void drawRetained(const FullMap& map, const std::vector<Compression>& compressions,
                  const TermCatalog& catalog, const std::filesystem::path& file);

/** Information kept over the number of leaves, for all alphas; the chosen one is marked. */
void drawCurves(const std::vector<Compression>& compressions, const std::filesystem::path& file);

}  // namespace semantic_map_compress
