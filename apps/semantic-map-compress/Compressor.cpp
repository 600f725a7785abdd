#include "Compressor.h"

#include <semantic_abstraction/AlphaTrees.h>
#include <semantic_octree/TreeFile.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace semantic_map_compress {

using semantic_octree::Abstraction;
using semantic_octree::AbstractionMeasures;
using semantic_octree::AlphaTrees;
using semantic_octree::SemanticOcTree;
using semantic_octree::StoredMap;
using tree_abstraction::AbstractionWeights;

namespace {

[[noreturn]] void refuse(const AbstractionOptions& solution, const std::string& what) {
  throw std::runtime_error("solution '" + solution.name + "': " + what);
}

}  // namespace

Compressor::Compressor(SemanticOcTree& map, const TermCatalog& catalog, AbstractionOptions ofAll,
                       std::optional<semantic_octree::MapFolderOptions> tiles,
                       std::filesystem::path scratch)
    : m_map(map), m_catalog(catalog), m_tiles(std::move(tiles)), m_scratch(std::move(scratch)) {
  if (map.empty()) throw std::invalid_argument("the map is empty");
  ofAll.weights.alpha = tree_abstraction::kAlpha;  // until a solution is weighed
  ofAll.weights.terms = catalog.terms({});
  setAbstraction(m_map, ofAll);
}

void Compressor::weigh(const AbstractionOptions& solution, double alpha) {
  abstraction().setWeights(m_catalog.weights(solution), alpha);
}

std::vector<KeptInformation> Compressor::kept(const AbstractionMeasures& measures) const {
  std::vector<KeptInformation> kept(m_catalog.size());
  for (std::size_t i = 0; i < kept.size(); ++i)
    kept[m_catalog.order()[i]] = {measures.full.information[i], measures.compressed.information[i],
                                  measures.retention(i)};
  return kept;
}

double Compressor::alphaFor(const AbstractionOptions& solution, const Target& target) {
  if (target.leaves) return alphaForLeaves(solution, *target.leaves);
  if (target.share) {
    weigh(solution, 0);
    const double all = static_cast<double>(abstraction().measures().full.numKnownLeaves);
    return alphaForLeaves(solution, static_cast<std::size_t>(*target.share * all));
  }
  if (target.bytes) return alphaForBytes(solution, *target.bytes);
  if (target.alpha) return *target.alpha;
  if (std::isnan(solution.weights.alpha))
    refuse(solution, "no alpha: expected `alpha`, --alpha, --leaves (such as 10%) or --bytes");
  return solution.weights.alpha;
}

double Compressor::alphaForLeaves(const AbstractionOptions& solution, std::size_t wanted) {
  weigh(solution, 0);
  const Abstraction present = abstraction();
  try {
    return AlphaTrees(present).alphaForLeaves(wanted);
  } catch (const std::invalid_argument& e) {
    refuse(solution, e.what());
  }
}

double Compressor::alphaForBytes(const AbstractionOptions& solution, std::size_t wanted) {
  weigh(solution, 0);
  const Abstraction present = abstraction();
  const AlphaTrees trees(present);
  const auto bytesOf = [&](double alpha) {
    weigh(solution, alpha);
    return semantic_octree::fileSize(compressed()->tree());
  };
  const std::size_t least = bytesOf(trees.alpha(0));
  if (least > wanted)
    refuse(solution, std::to_string(wanted) + " bytes wanted, but the smallest map takes " +
                         std::to_string(least) + " (see block_size)");
  return trees.largestThat([&](double alpha) { return bytesOf(alpha) <= wanted; });
}

std::unique_ptr<StoredMap> Compressor::compressed() {
  std::filesystem::remove_all(m_scratch);
  SemanticOcTree empty = abstraction().emptyCompressedMap();
  auto map = m_tiles ? std::make_unique<StoredMap>(std::move(empty), m_scratch, *m_tiles)
                     : std::make_unique<StoredMap>(std::move(empty));
  abstraction().compressTo(map->tree());
  return map;
}

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
