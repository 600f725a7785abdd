#include "AlphaCurve.h"

#include <semantic_abstraction/AlphaTrees.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace semantic_map_compress {

using semantic_octree::AbstractionMeasures;
using tree_abstraction::AbstractionWeights;

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

/** Weights of the terms of one sign, made positive; the others' are 0. */
std::vector<double> weightsOfSign(const AbstractionWeights& weights, double sign) {
  std::vector<double> ofSign;
  for (const auto& term : weights.terms) ofSign.push_back(std::max(0.0, sign * term.weight));
  return ofSign;
}

std::optional<double> share(double kept, double full) {
  if (full < 1e-12) return std::nullopt;
  return kept / full;
}

/** Share of what terms of one sign tell. */
std::optional<double> share(const AbstractionMeasures& m, const std::vector<double>& weights) {
  const auto sum = [&](const std::vector<double>& information) {
    return std::inner_product(weights.begin(), weights.end(), information.begin(), 0.0);
  };
  return share(sum(m.compressed.information), sum(m.full.information));
}

}  // namespace

CurvePoint curvePoint(Compressor& compressor, const AbstractionMeasures& m) {
  const AbstractionWeights& weights = compressor.abstraction().options().weights;
  return {weights.alpha, m.compressed.numKnownLeaves, share(m, weightsOfSign(weights, 1)),
          share(m, weightsOfSign(weights, -1))};
}

std::vector<CurvePoint> alphaCurve(Compressor& compressor) {
  const semantic_octree::Abstraction present = compressor.abstraction();
  const semantic_octree::AlphaTrees trees(present);
  std::vector<double> leaves;
  for (std::size_t k = 0; k < trees.numTrees(); ++k) leaves.push_back(trees.tree(k).leaves);
  std::vector<CurvePoint> curve;
  for (const std::size_t k : spread(leaves)) {
    const semantic_octree::AddedToTree& tree = trees.tree(k);
    curve.push_back({trees.alpha(k), static_cast<std::size_t>(tree.leaves),
                     share(tree.relevant, trees.full().relevant),
                     share(tree.irrelevant, trees.full().irrelevant)});
  }
  return curve;
}

}  // namespace semantic_map_compress
