#include "Compressor.h"

#include <semantic_abstraction/AlphaTrees.h>
#include <semantic_octree/TreeFile.h>

#include <stdexcept>

namespace semantic_map_compress {

using semantic_octree::Abstraction;
using semantic_octree::AbstractionMeasures;
using semantic_octree::AlphaTrees;
using semantic_octree::SemanticOcTree;
using semantic_octree::StoredMap;

namespace {

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
  try {
    return AlphaTrees(present).alphaForLeaves(wanted);
  } catch (const std::invalid_argument& e) {
    refuse(solution, e.what());
  }
}

double Compressor::alphaForBytes(const Solution& solution, std::size_t wanted) {
  weigh(solution, 0);
  const Abstraction present = abstraction();
  const AlphaTrees trees(present);
  const auto bytesOf = [&](double alpha) {
    weigh(solution, alpha);
    return semantic_octree::fileSize(Compressed(*this).map());
  };
  const std::size_t least = bytesOf(trees.alpha(0));
  if (least > wanted)
    refuse(solution, std::to_string(wanted) + " bytes wanted, but the smallest map takes " +
                         std::to_string(least) + " (see block_size)");
  return trees.largestThat([&](double alpha) { return bytesOf(alpha) <= wanted; });
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
