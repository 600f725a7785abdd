#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <semantic_map/ExportOctomap.h>
#include <semantic_types/ClassColors.h>

#include <cmath>
#include <iomanip>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>

namespace semantic_map {

using semantic_octree::SemanticOcTree;

namespace {

/** One of OctoMap's trees with the nodes of ours: only a derived class can set the root. */
template <class Tree, class NodeOfTree>
class Copy : public Tree {
 public:
  explicit Copy(const SemanticOcTree& source) : Tree(source.getResolution()), m_source(source) {
    if (source.empty()) return;
    this->root = new NodeOfTree();
    this->tree_size = 1;
    this->size_changed = true;
    copyNode(*source.root(), *this->root);
  }

 private:
  void copyNode(const SemanticOcTree::Node& from, NodeOfTree& to) {
    const float least = std::nextafter(0.f, -1.f);
    to.setLogOdds(from.getLogOdds() == 0 ? least : from.getLogOdds());
    if (from.isLeaf()) return paint(from, to);
    for (unsigned i = 0; i < 8; ++i)
      if (m_source.nodeChildExists(&from, i))
        copyNode(*m_source.getNodeChild(&from, i), *this->createNodeChild(&to, i));
  }

  void paint(const SemanticOcTree::Node& from, octomap::ColorOcTreeNode& to) {
    if (from.getLogOdds() <= 0) return;
    const auto color = colorOf(m_source.query(from).likeliestClass, m_source.classes());
    to.setColor(color.r, color.g, color.b);
  }
  void paint(const SemanticOcTree::Node&, octomap::OcTreeNode&) {}

  const SemanticOcTree& m_source;
};

/** OctoMap's own functions print what they do. */
void writeHeader(std::ostream& out, const std::string& firstLine,
                 const octomap::AbstractOcTree& tree) {
  out << firstLine << "\nid " << tree.getTreeType() << "\nsize " << tree.size() << "\nres "
      << std::setprecision(std::numeric_limits<double>::digits10) << tree.getResolution()
      << "\ndata\n";
}

template <class Tree>
void writeFull(std::ostream& out, const Tree& tree) {
  writeHeader(out, "# Octomap OcTree file", tree);
  tree.writeData(out);
  if (!out) throw std::runtime_error("cannot write the octree");
}

}  // namespace

void writeColorOcTree(std::ostream& out, const SemanticOcTree& tree) {
  Copy<octomap::ColorOcTree, octomap::ColorOcTreeNode> copy(tree);
  if (!tree.empty()) copy.updateInnerOccupancy();  // and colors
  writeFull(out, copy);
}

void writeOcTree(std::ostream& out, const SemanticOcTree& tree) {
  writeFull(out, Copy<octomap::OcTree, octomap::OcTreeNode>(tree));
}

void writeBinaryOcTree(std::ostream& out, const SemanticOcTree& tree) {
  Copy<octomap::OcTree, octomap::OcTreeNode> copy(tree);
  copy.toMaxLikelihood();
  copy.prune();
  writeHeader(out, "# Octomap OcTree binary file", copy);
  if (!tree.empty()) copy.writeBinaryData(out);
  if (!out) throw std::runtime_error("cannot write the octree");
}

}  // namespace semantic_map
