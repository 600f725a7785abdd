#include <semantic_octree/store/LeafContent.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace semantic_octree {

Belief truncated(std::vector<ClassLogOdds> named, double rest, int numClasses) {
  std::sort(named.begin(), named.end(), [](const ClassLogOdds& a, const ClassLogOdds& b) {
    return a.logOdds != b.logOdds ? a.logOdds > b.logOdds : a.id < b.id;
  });
  Belief belief;
  const std::size_t kept = std::min(named.size(), belief.ids.size());
  for (; belief.count < kept; ++belief.count) {
    belief.ids[belief.count] = named[belief.count].id;
    belief.logOdds[belief.count] = onGrid(named[belief.count].logOdds);
  }
  if (named.size() > kept) {
    double odds = (numClasses - static_cast<double>(named.size())) * std::exp(rest);
    for (std::size_t i = kept; i < named.size(); ++i) odds += std::exp(named[i].logOdds);
    rest = std::log(odds / belief.unnamed(numClasses));
  }
  belief.rest = onGrid(rest);
  belief.sort();
  return belief;
}

namespace {

/** Classes of leaves with a record: p(k) = rest + named[k]. */
template <typename BeliefOf>
struct Mixture {
  BeliefOf beliefOf;  ///< of a record
  double rest;
  std::vector<double> named;

  void add(const Belief& belief, double weight) {
    const int K = static_cast<int>(named.size()) - 1;
    const auto p = belief.probabilities(K);
    rest += weight * p.rest;
    for (int i = 0; i < belief.count; ++i) named[belief.ids[i]] += weight * (p.named[i] - p.rest);
  }
  void addBelow(const Node& node, double weight) {
    if (node.isLeaf()) {
      if (node.hasClassRecord()) add(beliefOf(NodeStore::record(node)), weight);
      return;
    }
    for (int i = 0; i < 8; ++i)
      if (const Node child = node.child(i)) addBelow(child, weight / 8);
  }
};

template <typename BeliefOf>
std::vector<double> sharesOf(const Node& node, int numClasses, const BeliefOf& beliefOf) {
  Mixture<BeliefOf> mixture{beliefOf, 0, std::vector<double>(numClasses + 1, 0.0)};
  mixture.addBelow(node, 1);
  std::vector<double> shares;
  for (int k = 1; k <= numClasses; ++k)
    shares.push_back(std::max(0.0, mixture.rest + mixture.named[k]));
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  if (sum == 0) return {};
  for (double& share : shares) share /= sum;
  return shares;
}

}  // namespace

std::vector<double> classShares(const Node& node, const ClassFilter& filter) {
  return sharesOf(node, filter.numClasses(),
                  [&filter](const ClassRecord& record) { return filter.stated(record.belief()); });
}

LeafContent contentOf(const Node& node, int numClasses) {
  const float occupancy = node.getLogOdds();
  LeafContent content{toUnits(occupancy), std::nullopt};
  if (node.hasClassRecord()) {
    content.record = NodeStore::record(node);
  } else if (!node.isLeaf()) {
    const std::vector<double> shares =
        sharesOf(node, numClasses, [](const ClassRecord& record) { return record.belief(); });
    if (shares.empty()) return content;
    std::vector<ClassLogOdds> named;
    for (int k = 1; k <= numClasses; ++k)
      named.push_back(
          {occupancy + std::log(std::max(shares[k - 1], 1e-12)), static_cast<ClassId>(k)});
    content.record = ClassRecord::of(truncated(std::move(named), 0, numClasses));
  }
  return content;
}

ClassSet halfLivesBelow(const NodeStore& store, const Slot& inner, int numClasses) {
  ClassSet classes;
  const auto add = [&](Units value, const ClassRecord* record) {
    if (const auto id = decaysAs(value, record, numClasses)) classes.set(*id);
  };
  if (inner.kind == Slot::Kind::Block) {
    const Block& block = store.block(inner);
    for (VoxelBits bits = block.known; bits; bits &= bits - 1) {
      const int voxel = __builtin_ctzll(bits);
      add(block.values[voxel], block.hasRecord(voxel) ? &store.record(block, voxel) : nullptr);
    }
    return classes;
  }
  for (const Slot& child : store.octant(inner).slots) {
    if (child.isLeaf())
      add(child.value, child.kind == Slot::Kind::LeafWithRecord ? &store.record(child) : nullptr);
    if (child.isInner()) classes |= halfLivesBelow(store, child, numClasses);
  }
  return classes;
}

}  // namespace semantic_octree
