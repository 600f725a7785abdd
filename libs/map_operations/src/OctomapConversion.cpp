#include <map_operations/OctomapConversion.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <semantic_octree/store/TreeBuilder.h>
#include <semantic_types/ClassColors.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace semantic_octree {
namespace {

using semantic_types::Color;

/** One of OctoMap's trees with the nodes of ours: only a derived class can set the root. */
template <class Tree, class NodeOfTree>
class Copy : public Tree {
 public:
  explicit Copy(const SemanticOcTree& source) : Tree(source.getResolution()), m_source(source) {
    if (source.empty()) return;
    this->root = new NodeOfTree();
    this->tree_size = 1;
    this->size_changed = true;
    copyNode(source.root(), *this->root);
  }

 private:
  void copyNode(const Node& from, NodeOfTree& to) {
    const float least = std::nextafter(0.f, -1.f);
    to.setLogOdds(from.getLogOdds() == 0 ? least : from.getLogOdds());
    if (from.isLeaf()) return paint(from, to);
    for (int i = 0; i < 8; ++i)
      if (const Node child = from.child(i))
        copyNode(child, *this->createNodeChild(&to, static_cast<unsigned>(i)));
  }

  void paint(const Node& from, octomap::ColorOcTreeNode& to) {
    if (!m_source.isNodeOccupied(from)) return;
    const Color color = colorOf(m_source.query(from).likeliestClass, m_source.classes());
    to.setColor(color.r, color.g, color.b);
  }
  void paint(const Node&, octomap::OcTreeNode&) {}

  const SemanticOcTree& m_source;
};

/** What a leaf of OctoMap's becomes. */
class Import {
 public:
  Import(const ClassTable& classes, const FilterParameters& filter)
      : m_classes(classes), m_filter(classes.size(), filter), m_accuracy(filter.accuracy) {}

  LeafContent operator()(const octomap::OcTreeNode& leaf) const {
    return {toUnits(onGrid(m_filter.limitedOccupancy(leaf.getLogOdds()))), {}};
  }
  LeafContent operator()(const octomap::ColorOcTreeNode& leaf) const {
    LeafContent content = (*this)(static_cast<const octomap::OcTreeNode&>(leaf));
    const ClassId id = content.value > 0 ? classOf(leaf.getColor()) : kNoClass;
    if (id == kNoClass) return content;
    Belief belief = m_filter.uniform(fromUnits(content.value));
    belief.count = 1;
    belief.ids[0] = id;
    belief.logOdds[0] = onGrid(fromUnits(content.value) + std::log(m_accuracy));
    belief.rest = onGrid(fromUnits(content.value) +
                         std::log((1 - m_accuracy) / std::max(1, m_classes.size() - 1)));
    m_filter.limit(belief);
    return {toUnits(m_filter.occupancyOf(belief)), ClassRecord::of(belief)};
  }

 private:
  ClassId classOf(const octomap::ColorOcTreeNode::Color& color) const {
    for (int id = 1; id <= m_classes.size(); ++id) {
      const Color& c = m_classes.color(static_cast<ClassId>(id));
      if (c.r == color.r && c.g == color.g && c.b == color.b) return static_cast<ClassId>(id);
    }
    return kNoClass;
  }

  const ClassTable& m_classes;
  ClassFilter<float> m_filter;
  double m_accuracy;
};

template <class Tree, class NodeOfTree>
class OctomapCursor {
 public:
  OctomapCursor(const Tree& map, const Import& import, const NodeOfTree* node)
      : m_map(map), m_import(import), m_node(node) {}

  bool known() const { return m_node; }
  bool isLeaf() const { return !m_map.nodeHasChildren(m_node); }
  LeafContent content() const { return m_import(*m_node); }
  OctomapCursor child(int i) const {
    const NodeOfTree* node = m_node;
    if (!isLeaf())
      node = m_map.nodeChildExists(m_node, i) ? m_map.getNodeChild(m_node, i) : nullptr;
    return {m_map, m_import, node};
  }

 private:
  const Tree& m_map;
  const Import& m_import;
  const NodeOfTree* m_node;
};

template <class Tree>
SemanticOcTree imported(const Tree& map, const ClassTable& classes,
                        const FilterParameters& filter) {
  if (map.getTreeDepth() != kTreeDepth)
    throw std::invalid_argument("importing an octree: " + std::to_string(map.getTreeDepth()) +
                                " levels, expected 16");
  SemanticOcTree result(map.getResolution(), classes, filter);
  const Import import(classes, filter);
  TreeBuilder::fill(result, OctomapCursor(map, import, map.getRoot()));
  return result;
}

}  // namespace

std::unique_ptr<octomap::OcTree> toOcTree(const SemanticOcTree& map) {
  return std::make_unique<Copy<octomap::OcTree, octomap::OcTreeNode>>(map);
}

std::unique_ptr<octomap::ColorOcTree> toColorOcTree(const SemanticOcTree& map) {
  auto copy = std::make_unique<Copy<octomap::ColorOcTree, octomap::ColorOcTreeNode>>(map);
  if (!map.empty()) copy->updateInnerOccupancy();  // and colors
  return copy;
}

SemanticOcTree fromOcTree(const octomap::OcTree& map, const ClassTable& classes,
                          const FilterParameters& filter) {
  return imported(map, classes, filter);
}

SemanticOcTree fromColorOcTree(const octomap::ColorOcTree& map, const ClassTable& classes,
                               const FilterParameters& filter) {
  return imported(map, classes, filter);
}

}  // namespace semantic_octree
