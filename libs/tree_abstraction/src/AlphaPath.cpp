#include <tree_abstraction/AlphaPath.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace tree_abstraction {

AlphaPath::AlphaPath(std::vector<double> tau, const std::vector<double>& asked) {
  std::vector<double> wanted(asked);
  std::sort(wanted.begin(), wanted.end(), std::greater<>());
  std::sort(tau.begin(), tau.end(), std::greater<>());
  while (!tau.empty() && !(tau.back() > 0)) tau.pop_back();
  if (!tau.empty()) m_highest = tau.front();
  auto next = wanted.begin();
  for (std::size_t i = 0; i < tau.size() && next != wanted.end();) {
    std::size_t end = i + 1;
    while (end < tau.size() && isTie(tau[end - 1], tau[end])) ++end;
    const double lowest = tau[end - 1];
    if (*next >= lowest) {
      m_lowest.push_back(lowest);
      m_next.push_back(end < tau.size() ? tau[end] : 0.0);
    }
    while (next != wanted.end() && *next >= lowest) ++next;
    i = end;
  }
}

std::size_t AlphaPath::treeOf(double tau) const {
  const auto tree =
      std::lower_bound(m_lowest.begin(), m_lowest.end(), tau, std::greater<>());  // not above tau
  return static_cast<std::size_t>(tree - m_lowest.begin()) + 1;
}

double AlphaPath::highestAlpha(std::size_t k) const {
  return k == 0 ? std::numeric_limits<double>::infinity() : m_lowest.at(k - 1);
}

namespace {

constexpr std::int32_t kNone = -1;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

void requireForest(const std::vector<std::int32_t>& parents, const std::vector<double>& gains,
                   const std::vector<double>& prices) {
  if (gains.size() != parents.size() || prices.size() != parents.size())
    throw std::invalid_argument("collapseAlphas: not as many parents, gains and prices");
  for (std::size_t i = 0; i < parents.size(); ++i) {
    const bool isParent = parents[i] >= kNone && parents[i] < static_cast<std::int64_t>(i);
    if (isParent && std::isfinite(gains[i]) && prices[i] >= 0 && std::isfinite(prices[i])) continue;
    throw std::invalid_argument(
        "collapseAlphas: node " + std::to_string(i) + " has parent " + std::to_string(parents[i]) +
        ", gain " + std::to_string(gains[i]) + ", price " + std::to_string(prices[i]) +
        ", expected -1 or an index below the node's, a finite number, a finite number >= 0");
  }
}

/** Leftist heaps of bundles, largest ratio on top, over one array for all. A bundle is a node with
 * the descendants that collapse with it, under the node's index. */
class BundleHeaps {
 public:
  explicit BundleHeaps(std::size_t size) : m_ratio(size), m_links(size, Links{kNone, kNone, 1}) {}

  double& ratio(std::int32_t i) { return m_ratio[at(i)]; }

  std::int32_t merge(std::int32_t a, std::int32_t b) {
    if (a == kNone) return b;
    if (b == kNone) return a;
    if (m_ratio[at(a)] < m_ratio[at(b)]) std::swap(a, b);
    Links& top = m_links[at(a)];
    top.right = merge(top.right, b);  // as deep as the ranks: at most 2 log2(N)
    if (rank(top.left) < rank(top.right)) std::swap(top.left, top.right);
    top.rank = rank(top.right) + 1;
    return a;
  }
  std::int32_t withoutTop(std::int32_t a) {
    return merge(m_links[at(a)].left, m_links[at(a)].right);
  }

 private:
  struct Links {
    std::int32_t left, right, rank;
  };
  std::int32_t rank(std::int32_t a) const { return a == kNone ? 0 : m_links[at(a)].rank; }

  std::vector<double> m_ratio;
  std::vector<Links> m_links;
};

/** The alpha where gain - alpha * price is 0. A node without both is worth what is below it. */
double breakEven(double gain, double price) {
  if (price > 0) return gain / price;
  return gain > 0 ? kInfinity : -kInfinity;
}

}  // namespace

std::vector<double> collapseAlphas(const std::vector<std::int32_t>& parents,
                                   const std::vector<double>& gains,
                                   const std::vector<double>& prices) {
  requireForest(parents, gains, prices);
  BundleHeaps heaps(parents.size());
  std::vector<std::int32_t> below(parents.size(), kNone);  // heap of the bundles under each node
  std::vector<double> tau(parents.size()), gain = gains, price = prices;
  for (std::size_t i = parents.size(); i-- > 0;) {
    double ratio = breakEven(gain[i], price[i]);
    std::int32_t heap = below[i];
    while (heap != kNone && heaps.ratio(heap) > ratio) {
      gain[i] += gain[at(heap)];
      price[i] += price[at(heap)];
      ratio = breakEven(gain[i], price[i]);
      heap = heaps.withoutTop(heap);
    }
    tau[i] = ratio;
    if (!(ratio > 0) || parents[i] == kNone) continue;  // nothing here is ever expanded, or done
    const auto self = static_cast<std::int32_t>(i);
    heaps.ratio(self) = ratio;
    std::int32_t& above = below[at(parents[i])];
    above = heaps.merge(above, heaps.merge(heap, self));
  }
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] != kNone) tau[i] = std::min(tau[i], tau[at(parents[i])]);
  }
  return tau;
}

}  // namespace tree_abstraction
