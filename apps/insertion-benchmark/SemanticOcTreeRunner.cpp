#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/SemanticOcTree.h>

#include "Runner.h"

namespace insertion_benchmark {
namespace {

using semantic_octree::SemanticOcTree;

class OurRunner : public Runner {
 public:
  OurRunner(const Scene& scene, const Settings& settings, bool withAbstraction)
      : m_scene(scene), m_map(settings.resolution, classes(scene.numClasses)) {
    m_options.maxRange = settings.maxRange;
    m_options.rays = settings.rays;
    m_options.threads = settings.threads;
    if (withAbstraction) setAbstraction(m_map, abstraction(settings.terms, scene.numClasses));
  }
  void insert(std::size_t scan) override {
    m_map.insert(m_scene.scans[scan].cloud, m_scene.scans[scan].T_map_sensor, m_options);
  }

 private:
  static semantic_types::ClassTable classes(int numClasses) {
    semantic_types::ClassTable table;
    for (int id = 1; id <= numClasses; ++id) table.add("class " + std::to_string(id), {});
    return table;
  }
  /** Every other class is relevant, the others between are not. */
  static semantic_octree::AbstractionOptions abstraction(int terms, int numClasses) {
    semantic_octree::AbstractionOptions options;
    for (int i = 0; i < std::min(terms, numClasses); ++i) {
      const std::string name = "class " + std::to_string(i + 1);
      options.weights.terms.push_back(i % 2 == 0
                                          ? tree_abstraction::relevant(name, 1.0, {i + 1})
                                          : tree_abstraction::irrelevant(name, 0.3, {i + 1}));
    }
    return options;
  }

  const Scene& m_scene;
  SemanticOcTree m_map;
  semantic_octree::InsertionOptions m_options;
};

}  // namespace

std::unique_ptr<Runner> semanticOcTree(const Scene& scene, const Settings& settings) {
  return std::make_unique<OurRunner>(scene, settings, false);
}

std::unique_ptr<Runner> semanticOcTreeWithAbstraction(const Scene& scene,
                                                      const Settings& settings) {
  return std::make_unique<OurRunner>(scene, settings, true);
}

}  // namespace insertion_benchmark
