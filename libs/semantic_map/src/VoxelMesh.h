#pragma once
#include <semantic_map/MapMesh.h>

#include "MapCells.h"

namespace semantic_map {

/** The mesh of some cells of a map, as meshOf() of a style. */
mrpt::opengl::CSetOfTriangles::Ptr meshOf(const semantic_octree::SemanticOcTree& tree,
                                          const MapCells& map);

}  // namespace semantic_map
