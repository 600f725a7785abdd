#pragma once
#include "Compressor.h"

namespace semantic_map_compress {

/** One of a solution's compressed trees. */
struct CurvePoint {
  double alpha = 0;
  std::size_t leaves = 0;  ///< known ones
  /** Share of the information of the relevant and of the irrelevant terms, by their weights. None:
   * there are no such terms. */
  std::optional<double> relevant, irrelevant;
};

/** The compressor's present tree as a point of the curve of its present weights. */
CurvePoint curvePoint(Compressor& compressor, const semantic_octree::AbstractionMeasures& measures);

/** Compressed trees of the compressor's present weights, from the blocks alone (first) to alpha = 0
 * (last), evenly spread over the logarithm of the number of leaves. */
std::vector<CurvePoint> alphaCurve(Compressor& compressor);

}  // namespace semantic_map_compress
