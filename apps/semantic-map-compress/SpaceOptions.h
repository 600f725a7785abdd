#pragma once
#include <semantic_octree/AbstractionOptions.h>
#include <strict_files/StrictYaml.h>

namespace semantic_map_compress {

/** Keys of a weights file about blocks, unknown space and regions. */
const std::set<std::string>& spaceKeys();

/** Reads them from the file's root. \throw std::runtime_error naming file, line, key and value. */
semantic_octree::AbstractionOptions readSpace(const strict_files::StrictYaml& yaml);

}  // namespace semantic_map_compress
