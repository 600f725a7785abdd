#include "LeafObjective.h"

#include <cmath>
#include <stdexcept>

using semantic_octree::Abstraction;

namespace {

double xLogX(double x) { return x > 0 ? x * std::log(x) : 0; }

}  // namespace

LeafObjective::LeafObjective(semantic_octree::SemanticOcTree& map)
    : m_map(map),
      m_compressed(Abstraction(map).compressedMap()),
      m_options(Abstraction(map).options()) {
  m_blockDepth = 0;
  while (m_map.getNodeSize(m_blockDepth) > m_options.blockSize * 1.000001) ++m_blockDepth;
  visitFrame(m_map.root(), m_compressed.root(), 0);
  normalize();
}

void LeafObjective::visitFrame(const Node& node, const Node& compressed, unsigned depth) {
  if (depth == m_blockDepth) {
    m_blocks.push_back(add(node, compressed, depth));
    return;
  }
  if (node.isLeaf() || compressed.isLeaf())
    throw std::logic_error("a leaf above the blocks: not made for that");
  for (int i = 0; i < 8; ++i)
    if (node.child(i)) visitFrame(node.child(i), compressed.child(i), depth + 1);
}

std::size_t LeafObjective::add(const Node& node, const Node& compressed, unsigned depth) {
  Item item;
  item.weight = std::pow(8.0, -static_cast<double>(depth - m_blockDepth));
  const auto& terms = m_options.weights.terms;
  item.probabilities.assign(terms.size(), 0.0);
  if (node && node.isLeaf()) {
    const std::vector<double> p = m_map.distribution(node);
    for (std::size_t t = 0; t < terms.size(); ++t)
      for (const int id : terms[t].groups.front())
        item.probabilities[t] += p[static_cast<std::size_t>(id)];
  } else if (node) {
    item.isExpanded = compressed && !compressed.isLeaf();
    for (int i = 0; i < 8; ++i) {
      const Node child = node.child(i);
      const Node same = child && item.isExpanded ? compressed.child(i) : Node();
      item.children.push_back(add(child, same, depth + 1));
      for (std::size_t t = 0; t < terms.size(); ++t)
        item.probabilities[t] += m_items[item.children.back()].probabilities[t] / 8;
    }
  }
  m_items.push_back(std::move(item));
  return m_items.size() - 1;
}

void LeafObjective::normalize() {
  for (Item& item : m_items) item.weight /= static_cast<double>(m_blocks.size());
}

double LeafObjective::asLeaf(const Item& item) const {
  // J = sum_t w_t (const - sum p h) - alpha (-sum p ln p)
  double sum = m_options.weights.alpha * xLogX(item.weight);
  for (std::size_t t = 0; t < item.probabilities.size(); ++t) {
    const double p = item.probabilities[t];
    sum += m_options.weights.terms[t].weight * item.weight * (xLogX(p) + xLogX(1 - p));
  }
  return sum;
}

double LeafObjective::below(std::size_t index,
                            const std::function<bool(std::size_t)>& isExpanded) const {
  const Item& item = m_items[index];
  if (item.children.empty() || !isExpanded(index)) return asLeaf(item);
  double sum = 0;
  for (const std::size_t child : item.children) sum += below(child, isExpanded);
  return sum;
}

double LeafObjective::objective(const std::function<bool(std::size_t)>& isExpanded) const {
  double sum = 0;
  for (const std::size_t block : m_blocks) sum += below(block, isExpanded) - asLeaf(m_items[block]);
  return sum;
}
