#pragma once
#include "NodeStore.h"

namespace semantic_octree {

class AbstractionUpkeep {
 public:
  void recompute(NodeStore&, Node&, int) const {}
};

}  // namespace semantic_octree
