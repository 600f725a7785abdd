#pragma once
#include "CompressPanel.h"

namespace semantic_map_view {

/** Once around the map while its compressed tree goes from nearly all leaves to few and back, as a
 * GIF with a scale that holds in the middle of the picture. \throw std::runtime_error naming the
 * file: it cannot be written */
void animate(ViewWindow& window, CompressPanel& panel, const std::filesystem::path& file);

}  // namespace semantic_map_view
