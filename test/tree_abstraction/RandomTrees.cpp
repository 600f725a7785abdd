#include "RandomTrees.h"

#include <tree_abstraction/Information.h>

#include <algorithm>
#include <cmath>

namespace random_trees {
namespace {

using reference::Forest;

/** What the leaves right below an inner node of a tie-rich tree are. */
enum class Pattern { AllFree, AllOne, ByTurns, OddOneOut, Random };

double probabilityOfOne(Pattern pattern, int sibling, Engine& random) {
  switch (pattern) {
    case Pattern::AllFree:
      return 0.0;
    case Pattern::AllOne:
      return 1.0;
    case Pattern::ByTurns:
      return sibling % 2;
    case Pattern::OddOneOut:
      return sibling == 0 ? 1.0 : 0.0;
    default:
      return 0.5 * uniformInt(random, 0, 2);
  }
}

/** One random tree on its way. */
class Grower {
 public:
  Grower(const Shape& shape, Engine& random) : m_shape(shape), m_random(random) {}

  Forest grow() {
    for (int i = 0; i < m_shape.numRoots; ++i) {
      addSubtree(m_shape.depth, 1.0, Forest::kNoParent, Pattern::Random, i);
    }
    return m_tree;
  }

 private:
  void addSubtree(int depth, double volume, std::int32_t parent, Pattern pattern, int sibling) {
    const bool isRoot = depth == m_shape.depth;
    const bool splits = depth > 0 && (isRoot || uniform(m_random) < m_shape.splitProbability);
    if (!splits) return addLeaf(volume, parent, pattern, sibling);
    const auto node = m_tree.addInner(parent);
    const int arity = uniformInt(m_random, m_shape.minArity, m_shape.maxArity);
    const auto own = m_shape.tieRich ? static_cast<Pattern>(uniformInt(m_random, 0, 4)) : pattern;
    for (int i = 0; i < arity; ++i) addSubtree(depth - 1, volume / arity, node, own, i);
  }
  void addLeaf(double volume, std::int32_t parent, Pattern pattern, int sibling) {
    const auto size = static_cast<std::size_t>(m_shape.numClasses) + 1;
    if (uniform(m_random) < m_shape.missingProbability) {
      const double weight = volume * uniformInt(m_random, 0, 1);
      const double p = 1.0 / static_cast<double>(size);
      m_tree.addMissing(parent, weight, std::vector<double>(size, p));
    } else if (m_shape.tieRich) {
      const double one = probabilityOfOne(pattern, sibling, m_random);
      m_tree.addLeaf(parent, volume, {1.0 - one, one});
    } else {
      const double weight = volume * (0.2 + uniform(m_random));
      m_tree.addLeaf(parent, weight, makeDistribution(size, m_random));
    }
  }

  const Shape& m_shape;
  Engine& m_random;
  Forest m_tree;
};

double binaryEntropy(double p) {
  const double both[] = {p, 1 - p};
  return tree_abstraction::entropy(both, 2);
}

/** A split costs as much as one odd child tells, or half of what a half-and-half node tells, or
 * nothing. */
tree_abstraction::AbstractionWeights makeTieRichWeights(double arity, Engine& random) {
  using tree_abstraction::relevant;
  switch (uniformInt(random, 0, 2)) {
    case 0:
      return {{relevant("one", std::log(arity) / binaryEntropy(1 / arity), {1})}, 1};
    case 1:
      return {{relevant("one", 2 * std::log2(arity), {1})}, 1};
    default:
      return {{relevant("one", 1, {1})}, 0};
  }
}

bool hasWeight(const Forest& tree) {
  return std::any_of(tree.nodes.begin(), tree.nodes.end(),
                     [](const Forest::Node& node) { return node.weight > 0; });
}

}  // namespace

double uniform(Engine& random) { return static_cast<double>(random() >> 1) / 2147483648.0; }

int uniformInt(Engine& random, int low, int high) {
  return low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1));
}

std::vector<double> makeDistribution(std::size_t size, Engine& random) {
  std::vector<double> p(size);
  double sum = 0;
  for (double& x : p) sum += x = uniform(random) < 0.25 ? 0.0 : -std::log(1.0 - uniform(random));
  if (sum == 0) {
    p[0] = sum = 1;
  }
  for (double& x : p) x /= sum;
  return p;
}

Forest makeTree(const Shape& shape, Engine& random) {
  for (;;) {
    auto tree = Grower(shape, random).grow();
    if (hasWeight(tree)) return tree;
  }
}

tree_abstraction::AbstractionWeights makeWeights(const Shape& shape, Engine& random) {
  using namespace tree_abstraction;
  using namespace reference;
  if (shape.tieRich) return makeTieRichWeights(shape.maxArity, random);
  AbstractionWeights weights{{relevant("one", 1.0 + uniform(random), {1})}, 0.0};
  if (shape.numClasses > 1) weights.terms.push_back(irrelevant("two", 0.5 * uniform(random), {2}));
  if (shape.numClasses > 2) weights.terms.push_back({"parts", 0.5, {{1, 2}, {3}}});
  weights.alpha = 0.15 * uniform(random);
  return weights;
}

}  // namespace random_trees
