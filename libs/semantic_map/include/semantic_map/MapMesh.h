#pragma once
#include <mrpt/opengl/CSetOfTriangles.h>
#include <semantic_map/MapPictures.h>

namespace semantic_map {

/** A map for MRPT's scenes and windows: the faces of its occupied cells that are not hidden by a
 * neighbor (map frame, m), in the classes' colors (gray: none), with light from above, corners and
 * creases darker. Fewer triangles than CSemanticOctoMap::getVisualizationInto() draws.
 * \param style its heights and occupancy
 * \throw std::invalid_argument as PictureStyle::validate(). */
mrpt::opengl::CSetOfTriangles::Ptr meshOf(const semantic_octree::SemanticOcTree& tree,
                                          const PictureStyle& style);

}  // namespace semantic_map
