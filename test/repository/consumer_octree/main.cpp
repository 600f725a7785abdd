// A map of one beam: what it meets is a tree.
#include <semantic_octree/SemanticOcTree.h>

#include <iostream>

int main() {
  semantic_types::ClassTable classes;
  const semantic_types::ClassId tree = classes.add("tree", {40, 140, 60});
  semantic_octree::SemanticOcTree map(0.1, classes);
  semantic_types::LabeledCloud cloud;
  cloud.points = {{2, 0, 0}};
  cloud.classes = {tree};
  map.insert(cloud, Eigen::Isometry3d::Identity());
  const semantic_octree::CellState cell = map.query(2, 0, 0);
  std::cout << "p(occupied) = " << cell.occupancy << "\n";
  return cell.likeliestClass == tree ? 0 : 1;
}
