#include <map_operations/MapOperations.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <semantic_octree/store/TreeBuilder.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/TextFile.h>

#include <cmath>
#include <iomanip>
#include <limits>
#include <ostream>
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

/** The class that a node's color names. */
ClassId classOf(const octomap::ColorOcTreeNode& node, const ClassTable& classes) {
  const octomap::ColorOcTreeNode::Color& c = node.getColor();
  return node.isColorSet() ? classes.find(Color{c.r, c.g, c.b}).value_or(kNoClass) : kNoClass;
}
ClassId classOf(const octomap::OcTreeNode&, const ClassTable&) { return kNoClass; }

template <class Tree>
class OctomapCursor {
 public:
  using NodeOfTree = typename Tree::NodeType;

  OctomapCursor(const Tree& map, const ClassTable& classes, const ClassFilter& filter,
                const NodeOfTree* node)
      : m_map(map), m_classes(classes), m_filter(filter), m_node(node) {}

  bool known() const { return m_node; }
  bool isLeaf() const { return !m_map.nodeHasChildren(m_node); }
  LeafContent content() const {
    const float occupancy = onGrid(m_filter.limitedOccupancy(m_node->getLogOdds()));
    const ClassId id = classOf(*m_node, m_classes);
    if (id == kNoClass || occupancy <= 0) return {toUnits(occupancy), {}};
    // One label, which leaves the occupancy as it is, within the limits.
    auto belief = m_filter.uniform(occupancy);
    m_filter.hit(belief, id);
    const float surplus = m_filter.occupancyOf(belief) - occupancy;
    for (int i = 0; i < belief.count; ++i) belief.logOdds[i] -= surplus;
    belief.rest -= surplus;
    m_filter.limit(belief);
    return {toUnits(m_filter.occupancyOf(belief)), ClassRecord::of(belief)};
  }
  OctomapCursor child(int i) const {
    const NodeOfTree* node = m_node;
    if (!isLeaf())
      node = m_map.nodeChildExists(m_node, i) ? m_map.getNodeChild(m_node, i) : nullptr;
    return {m_map, m_classes, m_filter, node};
  }

 private:
  const Tree& m_map;
  const ClassTable& m_classes;
  const ClassFilter& m_filter;
  const NodeOfTree* m_node;
};

template <class Tree>
SemanticOcTree imported(const Tree& map, const ClassTable& classes,
                        const FilterParameters& filter) {
  if (map.getTreeDepth() != kTreeDepth)
    throw std::invalid_argument("importing an octree: " + std::to_string(map.getTreeDepth()) +
                                " levels, expected 16");
  SemanticOcTree result(map.getResolution(), classes, filter);
  const ClassFilter limits(classes.size(), filter);
  TreeBuilder::fill(result, OctomapCursor<Tree>(map, classes, limits, map.getRoot()));
  return result;
}

/** \param classes comments name them, by which readers know what colors mean */
void writeHeader(std::ostream& out, const std::string& firstLine,
                 const octomap::AbstractOcTree& tree, const ClassTable& classes = {}) {
  const strict_files::ClassicNumbers classic(out);
  out << firstLine << "\nid " << tree.getTreeType() << "\nsize " << tree.size() << "\nres "
      << std::setprecision(std::numeric_limits<double>::digits10) << tree.getResolution() << '\n';
  for (int id = 1; id <= classes.size(); ++id) {
    const Color c = classes.color(static_cast<ClassId>(id));
    out << "# class " << int{c.r} << ' ' << int{c.g} << ' ' << int{c.b} << ' '
        << classes.name(static_cast<ClassId>(id)) << '\n';
  }
  out << "data\n";
}

void checkWritten(const std::ostream& out) {
  if (!out) throw std::runtime_error("cannot write the octree");
}

template <class Tree>
void writeFull(std::ostream& out, const Tree& tree, const ClassTable& classes = {}) {
  writeHeader(out, "# Octomap OcTree file", tree, classes);
  tree.writeData(out);
  checkWritten(out);
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

void writeColorOcTree(std::ostream& out, const SemanticOcTree& map) {
  writeFull(out, *toColorOcTree(map), map.classes());
}

void writeOcTree(std::ostream& out, const SemanticOcTree& map) { writeFull(out, *toOcTree(map)); }

void writeBinaryOcTree(std::ostream& out, const SemanticOcTree& map) {
  const auto copy = toOcTree(map);
  copy->toMaxLikelihood();
  copy->prune();
  writeHeader(out, "# Octomap OcTree binary file", *copy);
  if (!map.empty()) copy->writeBinaryData(out);
  checkWritten(out);
}

SemanticOcTree fromOcTree(const octomap::OcTree& map, const ClassTable& classes,
                          const FilterParameters& filter) {
  return imported(map, classes, filter);
}

SemanticOcTree fromOcTree(const octomap::ColorOcTree& map, const ClassTable& classes,
                          const FilterParameters& filter) {
  return imported(map, classes, filter);
}

}  // namespace semantic_octree
