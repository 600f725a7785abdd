#include "Compressor.h"

#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/TreeFile.h>

#include <stdexcept>

#include "AlphaBins.h"

namespace semantic_map_compress {

using semantic_octree::Abstraction;
using semantic_octree::AbstractionMeasures;
using semantic_octree::SemanticOcTree;
using semantic_octree::StoredMap;

namespace {

/** The last number for which it is true, as it is for `first`, and not for `end`, by bisection. */
template <typename F>
std::size_t lastThat(const F& f, std::size_t first, std::size_t end) {
  while (end - first > 1) {
    const std::size_t middle = first + (end - first) / 2;
    (f(middle) ? first : end) = middle;
  }
  return first;
}

[[noreturn]] void refuse(const Solution& solution, const std::string& what) {
  throw std::runtime_error("solution '" + solution.name + "': " + what);
}

}  // namespace

Compressor::Compressor(SemanticOcTree& map, const TermCatalog& catalog,
                       semantic_octree::AbstractionOptions space, CompressedPlace place)
    : m_map(map), m_catalog(catalog), m_options(std::move(space)), m_place(std::move(place)) {
  if (map.empty()) throw std::invalid_argument("the map is empty");
  useBatch(0);
}

void Compressor::useBatch(std::size_t b) {
  m_batch = b;
  m_options.weights.terms = m_catalog.terms(b);
  dropAbstraction(m_map);
  setAbstraction(m_map, m_options);
}

void Compressor::weigh(const Solution& solution, double alpha) {
  abstraction().setWeights(m_catalog.weights(solution, m_batch), alpha);
}

void Compressor::addKept(const AbstractionMeasures& measures,
                         std::vector<KeptInformation>& kept) const {
  kept.resize(m_catalog.size());
  const auto& batch = m_catalog.batch(m_batch);
  for (std::size_t i = 0; i < batch.size(); ++i)
    kept[batch[i]] = {measures.full.information[i], measures.compressed.information[i],
                      measures.retention(i)};
}

double Compressor::alphaFor(const Solution& solution, const Target& target) {
  if (target.leaves) return alphaForLeaves(solution, *target.leaves);
  if (target.bytes) return alphaForBytes(solution, *target.bytes);
  if (target.alpha) return *target.alpha;
  if (!solution.alpha) refuse(solution, "no alpha: expected `alpha`, --alpha, --leaves or --bytes");
  return *solution.alpha;
}

double Compressor::alphaForLeaves(const Solution& solution, std::size_t wanted) {
  weigh(solution, 0);
  const Abstraction present = abstraction();
  const AlphaBins bins(present);
  if (static_cast<double>(wanted) < bins.tree(0).leaves)
    refuse(solution, std::to_string(wanted) + " leaves wanted, but the map has " +
                         std::to_string(static_cast<std::size_t>(bins.tree(0).leaves)) +
                         " blocks, each of which is a leaf at least (see block_size)");
  const std::size_t most = m_map.getNumLeafNodes();
  if (wanted > most)
    refuse(solution,
           std::to_string(wanted) + " leaves wanted, but the map has only " + std::to_string(most));
  const auto fits = [&](std::size_t k) {
    return bins.tree(k).leaves <= static_cast<double>(wanted);
  };
  const std::size_t k = lastThat(fits, 0, bins.numTrees());
  if (k + 1 == bins.numTrees()) return bins.alpha(k);
  const AlphaBins::Path path = bins.within(k);
  const double more = static_cast<double>(wanted) - bins.tree(k).leaves;
  return path.trees.alpha(path.trees.largestWithin(more, path.addedLeaves, 0));
}

double Compressor::alphaForBytes(const Solution& solution, std::size_t wanted) {
  weigh(solution, 0);
  const Abstraction present = abstraction();
  const AlphaBins bins(present);
  const auto bytesOf = [&](double alpha) {
    weigh(solution, alpha);
    return semantic_octree::fileSize(Compressed(*this).map());
  };
  const std::size_t least = bytesOf(bins.alpha(0));
  if (least > wanted)
    refuse(solution, std::to_string(wanted) + " bytes wanted, but the smallest map takes " +
                         std::to_string(least) + " (see block_size)");
  const std::size_t k =
      lastThat([&](std::size_t i) { return bytesOf(bins.alpha(i)) <= wanted; }, 0, bins.numTrees());
  if (k + 1 == bins.numTrees()) return bins.alpha(k);
  const AlphaBins::Path path = bins.within(k);
  return path.trees.alpha(
      lastThat([&](std::size_t i) { return bytesOf(path.trees.alpha(i)) <= wanted; }, path.first,
               path.last));
}

Compressed::Compressed(Compressor& compressor)
    : m_folder(compressor.m_place.scratch),
      m_map(compressor.m_place.tiles ? StoredMap(compressor.abstraction().emptyCompressedMap(),
                                                 m_folder, *compressor.m_place.tiles)
                                     : StoredMap(compressor.abstraction().emptyCompressedMap())) {
  compressor.abstraction().compressTo(m_map.tree());
}

Compressed::~Compressed() {
  std::error_code ignored;
  std::filesystem::remove_all(m_folder, ignored);
}

}  // namespace semantic_map_compress
