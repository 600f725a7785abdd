#include "VectorTree.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace reference {

VectorTree::VectorTree(int numClasses) : m_numClasses(numClasses) {
  if (numClasses < 0) {
    throw std::invalid_argument("VectorTree: numClasses is " + std::to_string(numClasses) +
                                ", expected 0 or more");
  }
}

VectorTree::Node VectorTree::addInner(Node parent) {
  return add({Kind::Inner, parent, 0.0, {}, {}});
}

VectorTree::Node VectorTree::addLeaf(Node parent, double weight, std::vector<double> distribution) {
  return add({Kind::Known, parent, weight, std::move(distribution), {}});
}

VectorTree::Node VectorTree::addMissing(Node parent, double weight,
                                        std::vector<double> distribution) {
  return add({Kind::Missing, parent, weight, std::move(distribution), {}});
}

VectorTree::Node VectorTree::add(Item item) {
  const auto node = static_cast<Node>(m_items.size());
  const Node parent = item.parent;
  if (parent != kNoParent &&
      (parent < 0 || parent >= node || this->item(parent).kind != Kind::Inner)) {
    throw std::invalid_argument("VectorTree: parent " + std::to_string(parent) +
                                " is not an inner node of this tree of " + std::to_string(node) +
                                " nodes");
  }
  m_items.push_back(std::move(item));
  auto& siblings =
      parent == kNoParent ? m_roots : m_items[static_cast<std::size_t>(parent)].children;
  siblings.push_back(node);
  return node;
}

double VectorTree::weight(Node leaf) const {
  if (item(leaf).kind == Kind::Inner) {
    throw std::logic_error("VectorTree: inner node " + std::to_string(leaf) + " has no children");
  }
  return item(leaf).weight;
}

}  // namespace reference
