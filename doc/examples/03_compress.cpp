// Compresses a map to a number of leaves, of which those are kept that tell most about a class:
//     03_compress MAP.semantic CLASS LEAVES OUTPUT.semantic
#include <semantic_abstraction/AlphaTrees.h>
#include <semantic_octree/TreeFile.h>

#include <cstdlib>
#include <iostream>

int main(int argc, char** argv) try {
  if (argc != 5) throw std::invalid_argument("expected a map, a class, leaves and an output");
  semantic_octree::SemanticOcTree map = semantic_octree::loadTree(argv[1]);
  const auto relevant = map.classes().find(argv[2]);
  if (!relevant) throw std::invalid_argument("the map has no class " + std::string(argv[2]));

  semantic_octree::AbstractionOptions options;
  options.weights.terms = {tree_abstraction::relevant(argv[2], 1.0, {*relevant})};
  setAbstraction(map, options);

  // All optimal trees are known at once, by the price of detail; the largest one that fits is ours.
  semantic_octree::Abstraction abstraction(map);
  const semantic_octree::AlphaTrees trees(abstraction);
  abstraction.setAlpha(trees.alphaForLeaves(std::strtoul(argv[3], nullptr, 10)));
  const semantic_octree::SemanticOcTree compressed = abstraction.compressedMap();

  std::cout << compressed.getNumLeafNodes() << " of " << map.getNumLeafNodes() << " leaves keep "
            << 100 * abstraction.measures().retention(0).value_or(1) << " % of what is known about "
            << argv[2] << "\n";
  semantic_octree::saveTree(compressed, argv[4]);
} catch (const std::exception& e) {
  std::cerr << "error: " << e.what() << "\n";
  return 1;
}
