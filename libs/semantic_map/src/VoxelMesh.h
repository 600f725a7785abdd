#pragma once
#include <mrpt/opengl/TTriangle.h>

#include <vector>

#include "MapCells.h"

namespace semantic_map {

/** The faces of the cells that are not hidden by a neighbor, two triangles each, in the classes'
 * colors: light from above, corners and creases darker. */
std::vector<mrpt::opengl::TTriangle> meshOf(const semantic_octree::SemanticOcTree& tree,
                                            const MapCells& map);

}  // namespace semantic_map
