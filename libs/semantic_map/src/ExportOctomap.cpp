#include <map_operations/MapOperations.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <semantic_map/MapFiles.h>
#include <strict_files/TextFile.h>

#include <iomanip>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>

namespace semantic_map {

using semantic_octree::SemanticOcTree;

namespace {

/** OctoMap's own functions print what they do. */
void writeHeader(std::ostream& out, const std::string& firstLine,
                 const octomap::AbstractOcTree& tree) {
  const strict_files::ClassicNumbers classic(out);
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
  writeFull(out, *toColorOcTree(tree));
}

void writeOcTree(std::ostream& out, const SemanticOcTree& tree) { writeFull(out, *toOcTree(tree)); }

void writeBinaryOcTree(std::ostream& out, const SemanticOcTree& tree) {
  const auto copy = toOcTree(tree);
  copy->toMaxLikelihood();
  copy->prune();
  writeHeader(out, "# Octomap OcTree binary file", *copy);
  if (!tree.empty()) copy->writeBinaryData(out);
  if (!out) throw std::runtime_error("cannot write the octree");
}

}  // namespace semantic_map
