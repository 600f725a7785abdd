#include <semantic_octree/store/BlockUpdate.h>

namespace semantic_octree {

template class BlockUpdate<ClassFilter<float>>;

}  // namespace semantic_octree
