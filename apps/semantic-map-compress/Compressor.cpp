#include "Compressor.h"

#include <semantic_octree/TreeFile.h>

#include <stdexcept>

namespace semantic_map_compress {

using semantic_octree::Abstraction;
using semantic_octree::AbstractionMeasures;
using semantic_octree::SemanticOcTree;

namespace {

[[noreturn]] void refuse(const Solution& solution, const std::string& what) {
  throw std::runtime_error("solution '" + solution.name + "': " + what);
}

}  // namespace

Compressor::Compressor(SemanticOcTree& map, const TermCatalog& catalog,
                       semantic_octree::AbstractionOptions space)
    : m_map(map), m_catalog(catalog), m_options(std::move(space)) {
  if (map.empty()) throw std::invalid_argument("the map is empty");
  useBatch(0);
}

void Compressor::useBatch(std::size_t b) {
  m_batch = b;
  m_options.weights.terms = m_catalog.terms(b);
  m_map.dropAbstraction();
  m_map.setAbstraction(m_options);
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
  const Abstraction::Path path = abstraction().alphaPath();
  if (wanted < path.numRoots)
    refuse(solution, std::to_string(wanted) + " leaves wanted, but the map has " +
                         std::to_string(path.numRoots) +
                         " blocks, each of which is a leaf at least (see block_size)");
  const std::size_t most = m_map.getNumLeafNodes();
  if (wanted > most)
    refuse(solution,
           std::to_string(wanted) + " leaves wanted, but the map has only " + std::to_string(most));
  return path.alphaForLeaves(wanted);
}

double Compressor::alphaForBytes(const Solution& solution, std::size_t wanted) {
  weigh(solution, 0);
  const auto trees = abstraction().alphaPath().trees;
  const auto bytesOf = [&](std::size_t k) {
    weigh(solution, trees.alpha(k));
    return semantic_octree::fileSize(abstraction().compressedMap());
  };
  const std::size_t least = bytesOf(0);
  if (least > wanted)
    refuse(solution, std::to_string(wanted) + " bytes wanted, but the smallest map takes " +
                         std::to_string(least) + " (see block_size)");
  return trees.alpha(trees.largestThat([&](std::size_t k) { return bytesOf(k) <= wanted; }));
}

}  // namespace semantic_map_compress
