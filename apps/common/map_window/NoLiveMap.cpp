#include <stdexcept>

#include "LiveMap.h"

namespace map_window {

std::unique_ptr<LiveMap> LiveMap::open(const std::string&, const semantic_octree::SemanticOcTree&,
                                       const Beginning&) {
  throw std::runtime_error("--live: this program was built without windows");
}

}  // namespace map_window
