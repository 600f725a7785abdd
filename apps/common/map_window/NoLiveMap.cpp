#include <cstdlib>
#include <stdexcept>

#include "LiveMap.h"

namespace map_window {

class LiveMap::Window {};

LiveMap::LiveMap(const std::string&, const semantic_octree::SemanticOcTree&, const Beginning&) {
  throw std::runtime_error("--live: this program was built without windows");
}
LiveMap::~LiveMap() = default;

// Nobody has an object.
mrpt_compat::drawing::CSetOfObjects& LiveMap::marks() { std::abort(); }
void LiveMap::say(const std::vector<std::string>&) {}
void LiveMap::showPicture(const mrpt::img::CImage&) {}
void LiveMap::changed(const Eigen::AlignedBox3d&) {}
bool LiveMap::isOpen() const { return false; }
void LiveMap::stopWhen(const std::function<bool()>&) {}
void LiveMap::pause() {}
void LiveMap::show(double) {}
void LiveMap::stay() {}

}  // namespace map_window
