#include "AlphaCurve.h"

#include <algorithm>
#include <cmath>

namespace semantic_map_compress {

using semantic_octree::Abstraction;
using semantic_octree::AbstractionMeasures;

namespace {

constexpr int kPoints = 20;

/** Indices of trees whose numbers of leaves are spread evenly; ascending, first and last are in. */
std::vector<std::size_t> spread(const std::vector<double>& leaves) {
  std::vector<std::size_t> trees;
  const double low = std::log(leaves.front()), high = std::log(leaves.back());
  for (int i = 0; i < kPoints; ++i) {
    const double wanted = std::exp(low + (high - low) * i / (kPoints - 1));
    const auto next = std::upper_bound(leaves.begin(), leaves.end(), wanted * (1 + 1e-9));
    trees.push_back(static_cast<std::size_t>(std::max<long>(next - leaves.begin(), 1) - 1));
  }
  trees.back() = leaves.size() - 1;
  trees.erase(std::unique(trees.begin(), trees.end()), trees.end());
  return trees;
}

/** Share of what terms of one sign tell. */
std::optional<double> share(const AbstractionMeasures& m,
                            const tree_abstraction::AbstractionWeights& weights, double sign) {
  double full = 0, kept = 0;
  for (std::size_t t = 0; t < weights.terms.size(); ++t) {
    const double weight = std::max(0.0, sign * weights.terms[t].weight);
    full += weight * m.full.information[t];
    kept += weight * m.compressed.information[t];
  }
  if (full < 1e-12) return std::nullopt;
  return kept / full;
}

}  // namespace

CurvePoint curvePoint(Compressor& compressor, const AbstractionMeasures& m) {
  const auto& weights = compressor.abstraction().options().weights;
  return {weights.alpha, m.compressed.numKnownLeaves, share(m, weights, 1), share(m, weights, -1)};
}

std::vector<CurvePoint> alphaCurve(Compressor& compressor, const Solution& solution) {
  compressor.weigh(solution, 0);
  Abstraction abstraction = compressor.abstraction();
  const Abstraction::Path path = abstraction.alphaPath();
  const auto base = static_cast<double>(path.numRoots);
  std::vector<CurvePoint> curve;
  for (const std::size_t k : spread(path.trees.totals(path.addedLeaves, base))) {
    abstraction.setAlpha(path.trees.alpha(k));
    curve.push_back(curvePoint(compressor, abstraction.measures()));
  }
  return curve;
}

}  // namespace semantic_map_compress
