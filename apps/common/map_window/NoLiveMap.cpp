#include <stdexcept>

#include "LiveMap.h"

namespace map_window {

class LiveMap::Window {};

LiveMap::LiveMap(const std::string&, const semantic_octree::SemanticOcTree&) {
  throw std::runtime_error("--live: this program was built without windows");
}
LiveMap::~LiveMap() = default;

}  // namespace map_window
