#include "CellColors.h"

#include <mrpt/img/color_maps.h>

#include <algorithm>

namespace semantic_map {

using semantic_octree::ClassId;
using semantic_octree::ClassTable;
using semantic_octree::Color;

Color classColor(const ClassTable& classes, ClassId id) {
  return id == semantic_octree::kNoClass ? kColorWithoutClass : classes.color(id);
}

CellColors::CellColors(const semantic_octree::SemanticOcTree& tree,
                       const TRenderingOptions& options)
    : m_classes(tree.classes()), m_coloring(options.coloring) {
  double x, y;
  tree.getMetricMin(x, y, m_lowest);
  tree.getMetricMax(x, y, m_highest);
  m_lowest = std::max(m_lowest, options.minHeight);
  m_highest = std::min(m_highest, options.maxHeight);
}

mrpt::img::TColor CellColors::operator()(const semantic_octree::CellState& state,
                                         double height) const {
  switch (m_coloring) {
    case TRenderingOptions::Coloring::Probability: {
      const double p = std::clamp(state.probability, 0.0, 1.0);
      return mrpt::img::TColor(255 * std::min(1.0, 2 - 2 * p), 255 * std::min(1.0, 2 * p), 0);
    }
    case TRenderingOptions::Coloring::Height: {
      const double range = std::max(m_highest - m_lowest, 1e-6);
      return mrpt::img::colormap(mrpt::img::cmJET,
                                 std::clamp((height - m_lowest) / range, 0.0, 1.0));
    }
    case TRenderingOptions::Coloring::Class:
      break;
  }
  const Color c = classColor(m_classes, state.likeliestClass);
  return {c.r, c.g, c.b};
}

}  // namespace semantic_map
