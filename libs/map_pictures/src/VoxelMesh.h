#pragma once
#include <mrpt_compat/Drawing.h>

#include "MapCells.h"

namespace map_pictures {

/** The faces of a map's cells that are not hidden by a neighbor (map frame, m), in the classes'
 * colors (gray: none), with light from above, corners and creases darker. */
mrpt_compat::drawing::CSetOfTriangles::Ptr meshOf(const semantic_octree::SemanticOcTree& tree,
                                                  const MapCells& map);

}  // namespace map_pictures
