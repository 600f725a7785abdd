#include <iostream>
#include <semantic_octree/ClassTable.h>

int main() {
  semantic_octree::ClassTable classes;
  const semantic_octree::ClassId road = classes.add("road", {128, 64, 128});
  std::cout << classes.name(road) << "\n";
}
