#include "BreadthFirstTree.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace reference {
namespace {

[[noreturn]] void reject(std::size_t n, const std::string& what) {
  throw std::invalid_argument("leaf " + std::to_string(n) + " (breadth first): " + what);
}

void requireDistribution(std::size_t n, const std::vector<double>& p, int numClasses) {
  const std::size_t expected = static_cast<std::size_t>(numClasses) + 1;
  if (p.size() != expected) {
    reject(n, "distribution of " + std::to_string(p.size()) + " classes, expected " +
                  std::to_string(expected));
  }
  double sum = 0;
  for (std::size_t id = 0; id < p.size(); ++id) {
    if (!(p[id] >= 0)) {
      reject(n, "probability of class " + std::to_string(id) + " is " + std::to_string(p[id]));
    }
    sum += p[id];
  }
  constexpr double kTolerance = 1e-9;
  if (!(std::abs(sum - 1.0) <= kTolerance)) {
    reject(n, "probabilities sum to " + std::to_string(sum) + ", expected 1");
  }
}

}  // namespace

void shares(const double* weights, std::size_t n, std::vector<double>& pi) {
  pi.assign(weights, weights + n);
  const double sum = pairwiseSum(n, [=](std::size_t i) { return weights[i]; });
  for (double& share : pi) share = sum > 0 ? share / sum : 1.0 / static_cast<double>(n);
}

double BreadthFirstTree::totalWeight() const {
  return pairwiseSum(numRoots, [this](std::size_t i) { return weight[i]; });
}

void BreadthFirstTree::append(std::int32_t parentIndex, bool isKnown) {
  parent.push_back(parentIndex);
  firstChild.push_back(0);
  numChildren.push_back(0);
  known.push_back(isKnown);
  weight.push_back(0.0);
  rows.resize(rows.size() + rowWidth, 0.0);
}

void BreadthFirstTree::setLeaf(std::size_t n, double leafWeight,
                               const std::vector<double>& distribution, const TermRows& terms) {
  if (!(std::isfinite(leafWeight) && leafWeight >= 0)) {
    reject(n, "weight is " + std::to_string(leafWeight) + ", expected a finite number >= 0");
  }
  requireDistribution(n, distribution, terms.numClasses());
  weight[n] = leafWeight;
  terms.project(distribution.data(), rows.data() + n * rowWidth);
}

void BreadthFirstTree::aggregate() {
  std::vector<double> pi;
  for (std::size_t n = size(); n-- > 0;) {
    if (isLeaf(n)) continue;
    const auto first = static_cast<std::size_t>(firstChild[n]);
    const auto count = static_cast<std::size_t>(numChildren[n]);
    const double* w = weight.data() + first;
    weight[n] = pairwiseSum(count, [w](std::size_t i) { return w[i]; });
    shares(w, count, pi);
    mixRows(pi.data(), row(first), count, rowWidth, rows.data() + n * rowWidth);
    for (std::size_t i = 0; i < count; ++i) known[n] |= known[first + i];
  }
}

}  // namespace reference
