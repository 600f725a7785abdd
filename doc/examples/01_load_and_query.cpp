// Loads a map and says what is at a place, and what a beam from there to the ground would meet:
//     01_load_and_query MAP.semantic X Y Z
#include <semantic_octree/TreeFile.h>

#include <cstdlib>
#include <iostream>

using semantic_octree::CellState;

int main(int argc, char** argv) try {
  if (argc != 5) throw std::invalid_argument("expected a map and x, y, z in meters");
  const double x = std::atof(argv[2]), y = std::atof(argv[3]), z = std::atof(argv[4]);

  const semantic_octree::SemanticOcTree map = semantic_octree::loadTree(argv[1]);
  std::cout << map.getNumLeafNodes() << " leaves, " << map.numClasses() << " classes\n";

  const CellState here = map.query(x, y, z);
  if (here.status == CellState::Status::Unknown) {
    std::cout << "nobody looked there\n";
  } else {
    std::cout << "occupied with probability " << here.occupancy << "\n";
  }

  const auto hit = map.castRay(octomap::point3d(x, y, z), {0, 0, -1}, 20);
  if (!hit) {
    std::cout << "nothing below\n";
  } else if (map.classes().contains(hit->state.likeliestClass)) {  // a class was seen there
    std::cout << "below, at " << hit->center.z()
              << " m: " << map.classes().name(hit->state.likeliestClass)
              << ", p = " << hit->state.probability << "\n";
  }
} catch (const std::exception& e) {
  std::cerr << "error: " << e.what() << "\n";
  return 1;
}
