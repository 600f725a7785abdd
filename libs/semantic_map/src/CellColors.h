#pragma once
#include <mrpt/img/TColor.h>
#include <semantic_map/MapOptions.h>
#include <semantic_octree/SemanticOcTree.h>

namespace semantic_map {

/** Colors of occupied cells in a scene. */
class CellColors {
 public:
  CellColors(const semantic_octree::SemanticOcTree& tree, const TRenderingOptions& options);
  /** \param height of the cell's center, m */
  mrpt::img::TColor operator()(const semantic_octree::SemanticOcTree::Node& node,
                               double height) const;

 private:
  const semantic_octree::SemanticOcTree& m_tree;
  TRenderingOptions::Coloring m_coloring;
  double m_lowest = 0, m_highest = 0;
};

}  // namespace semantic_map
