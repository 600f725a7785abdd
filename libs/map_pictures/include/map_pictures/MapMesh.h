#pragma once
#include <map_pictures/MapPictures.h>
#include <mrpt_compat/Drawing.h>

namespace map_pictures {

/** A map for MRPT's scenes and windows: the faces of its occupied cells that are not hidden by a
 * neighbor (map frame, m), in the classes' colors (gray: none), with light from above, corners and
 * creases darker. Fewer triangles than CSemanticOctoMap::getVisualizationInto() draws.
 * \param style its heights and occupancy
 * \throw std::invalid_argument as PictureStyle::validate(). */
mrpt_compat::drawing::CSetOfTriangles::Ptr meshOf(const semantic_octree::SemanticOcTree& tree,
                                                  const PictureStyle& style);

}  // namespace map_pictures
