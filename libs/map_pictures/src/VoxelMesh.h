#pragma once
#include <map_pictures/MapMesh.h>

#include "MapCells.h"

namespace map_pictures {

/** The mesh of some cells of a map, as meshOf() of a style. */
mrpt_compat::drawing::CSetOfTriangles::Ptr meshOf(const semantic_octree::SemanticOcTree& tree,
                                                  const MapCells& map);

}  // namespace map_pictures
