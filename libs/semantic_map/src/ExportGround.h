#pragma once
#include <semantic_map/MapFiles.h>

#include "ExportColumns.h"

namespace semantic_map {

/** The ground under each column. */
struct ExportGround {
  /** Height of its voxel's center, m, 32 bit float; NaN where it is not known. */
  cv::Mat height;
  /** Log-odds of the ground's voxel where it was seen in this very column, else 0. */
  cv::Mat seen;
};

/** Whether a leaf is occupied and of one of these classes (any, if there are none). */
bool isOccupiedBy(const std::vector<semantic_types::ClassId>& classes,
                  const semantic_octree::SemanticOcTree& tree,
                  const semantic_octree::SemanticOcTree::Node& leaf);

ExportGround groundOf(const semantic_octree::SemanticOcTree& tree, const ExportColumns& columns,
                      const GridOptions& options);

}  // namespace semantic_map
