#include <synthetic_world/Scene.h>

#include <stdexcept>

#include "SceneBuilder.h"

namespace synthetic_world {
namespace {

struct Maker {
  const char* name;
  Scene (*make)(std::uint64_t seed, double hills);
};
constexpr Maker kMakers[] = {{"village", makeVillage}, {"park", makePark}, {"campus", makeCampus}};

}  // namespace

std::vector<std::string> sceneNames() {
  std::vector<std::string> names;
  for (const Maker& m : kMakers) names.emplace_back(m.name);
  return names;
}

Scene makeScene(const std::string& name, std::uint64_t seed, double hills) {
  if (!(hills >= 0 && hills <= 2))
    throw std::invalid_argument("scene: hills is " + std::to_string(hills) + ", 0 to 2 expected");
  std::string known;
  for (const Maker& m : kMakers) {
    if (name == m.name) return m.make(seed, hills);
    known += (known.empty() ? "" : ", ") + std::string(m.name);
  }
  throw std::invalid_argument("scene: no scene '" + name + "'; there are: " + known);
}

}  // namespace synthetic_world
