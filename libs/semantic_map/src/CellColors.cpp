#include "CellColors.h"

#include <mrpt_compat/Colors.h>
#include <semantic_types/ClassColors.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace semantic_map {

namespace {

/** Red (0) over yellow to green (1). */
mrpt::img::TColor trafficLight(double value) {
  const double v = std::clamp(value, 0.0, 1.0);
  return mrpt::img::TColor(255 * std::min(1.0, 2 - 2 * v), 255 * std::min(1.0, 2 * v), 0);
}

/** Entropy of a distribution relative to that of the uniform one, 0 to 1. */
double relativeEntropy(const std::vector<double>& probabilities) {
  double entropy = 0;
  for (const double p : probabilities)
    if (p > 0) entropy -= p * std::log(p);
  return entropy / std::log(double(probabilities.size()));
}

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
      return trafficLight(m_tree.query(node).probability);
    case TRenderingOptions::Coloring::Height: {
      const double range = std::max(m_highest - m_lowest, 1e-6);
      return mrpt_compat::colorAt(mrpt::img::cmJET,
                                  std::clamp((height - m_lowest) / range, 0.0, 1.0));
    }
    case TRenderingOptions::Coloring::Entropy:
      return trafficLight(1 - relativeEntropy(m_tree.distribution(node)));
    case TRenderingOptions::Coloring::Class:
      break;
  }
  const auto c = colorOf(m_tree.query(node).likeliestClass, m_tree.classes());
  return {c.r, c.g, c.b};
}

}  // namespace semantic_map
