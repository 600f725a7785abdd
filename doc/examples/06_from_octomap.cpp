// OctoMap's loops over leaves, searches and boxes work as they did:
//     06_from_octomap MAP.semantic OUT.bt
#include <map_operations/MapOperations.h>
#include <octomap/OcTree.h>
#include <semantic_octree/TreeFile.h>

#include <iostream>

int main(int argc, char** argv) try {
  if (argc != 3) throw std::invalid_argument("expected a map and the file to write");
  const semantic_octree::SemanticOcTree tree = semantic_octree::loadTree(argv[1]);

  double occupied = 0;  // m^3
  for (auto it = tree.begin_leafs(), end = tree.end_leafs(); it != end; ++it)
    if (tree.isNodeOccupied(*it)) occupied += it.getSize() * it.getSize() * it.getSize();
  std::cout << occupied << " m^3 are occupied\n";

  const octomap::point3d low(-2, -2, -1), high(2, 2, 1);
  std::size_t inBox = 0;
  for (auto it = tree.begin_leafs_bbx(low, high), end = tree.end_leafs_bbx(); it != end; ++it)
    ++inBox;
  std::cout << inBox << " leaves in a box around the origin\n";

  if (auto node = tree.search(tree.coordToKey(0.1, 0.1, 0.1)))  // no pointer, but used like one
    std::cout << "p(occupied) = " << node->getOccupancy() << ", a leaf: " << node->isLeaf() << "\n";

  // For what is written against octomap::OcTree: a copy of the occupancy, and back.
  const auto copy = semantic_octree::toOcTree(tree);
  copy->writeBinary(argv[2]);
  const auto back = semantic_octree::fromOcTree(*copy, tree.classes());
  std::cout << "back from OctoMap: " << back.getNumLeafNodes() << " leaves\n";
} catch (const std::exception& e) {
  std::cerr << "error: " << e.what() << "\n";
  return 1;
}
