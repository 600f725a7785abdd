#include "CellColors.h"

#include <mrpt_compat/Images.h>
#include <semantic_types/ClassTable.h>
#include <tree_abstraction/Information.h>

#include <algorithm>

namespace semantic_map {

using semantic_types::trafficLight;
using tree_abstraction::relativeEntropy;

namespace {

mrpt::img::TColor mrptColor(const semantic_types::Color& c) { return {c.r, c.g, c.b}; }

}  // namespace

CellColors::CellColors(const semantic_octree::SemanticOcTree& tree,
                       const TRenderingOptions& options)
    : m_tree(tree), m_coloring(options.coloring) {
  double x, y;
  tree.getMetricMin(x, y, m_lowest);
  tree.getMetricMax(x, y, m_highest);
  m_lowest = std::max(m_lowest, options.minHeight);
  m_highest = std::min(m_highest, options.maxHeight);
}

mrpt::img::TColor CellColors::operator()(const semantic_octree::SemanticOcTree::Node& node,
                                         double height) const {
  switch (m_coloring) {
    case TRenderingOptions::Coloring::Probability:
      return mrptColor(trafficLight(m_tree.query(node).probability));
    case TRenderingOptions::Coloring::Height: {
      const double range = std::max(m_highest - m_lowest, 1e-6);
      return mrpt_compat::colorAt(mrpt::img::cmJET,
                                  std::clamp((height - m_lowest) / range, 0.0, 1.0));
    }
    case TRenderingOptions::Coloring::Entropy:
      return mrptColor(trafficLight(1 - relativeEntropy(m_tree.distribution(node))));
    case TRenderingOptions::Coloring::Class:
      break;
  }
  return mrptColor(semantic_types::colorOf(m_tree.query(node).likeliestClass, m_tree.classes()));
}

}  // namespace semantic_map
