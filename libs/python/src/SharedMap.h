#pragma once
#include <pybind11/pybind11.h>
#include <semantic_octree/SemanticOcTree.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <utility>
#include <vector>

namespace python {

namespace py = pybind11;
using semantic_octree::SemanticOcTree;

/** A map that threads of Python's share: who changes it is alone with it. */
class SharedMap {
 public:
  explicit SharedMap(SemanticOcTree map) : m_map(std::move(map)) {}

  /** Calls use(map) while other threads of Python's run on; it must touch nothing of theirs. */
  template <class F>
  auto read(const F& use) const {
    const py::gil_scoped_release others;
    const std::shared_lock<std::shared_mutex> lock(m_mutex);
    return use(m_map);
  }
  template <class F>
  auto write(const F& use) {
    const py::gil_scoped_release others;
    const std::lock_guard<std::shared_mutex> lock(m_mutex);
    return use(m_map);
  }
  bool operator==(const SharedMap& o) const {
    if (this == &o) return true;
    const py::gil_scoped_release others;
    std::shared_lock<std::shared_mutex> mine(m_mutex, std::defer_lock),
        theirs(o.m_mutex, std::defer_lock);
    std::lock(mine, theirs);
    return m_map == o.m_map;
  }

  // What does not change.
  double resolution() const { return m_map.getResolution(); }
  int numClasses() const { return m_map.numClasses(); }
  const semantic_types::ClassTable& classes() const { return m_map.classes(); }

  /** How many abstractions the map was given so far. */
  std::size_t numAbstractions = 0;

 private:
  mutable std::shared_mutex m_mutex;
  SemanticOcTree m_map;
};

// Rows of structured arrays. Classes are those that the record names, likeliest first, 0 where
// there are none; probabilities are among free space and all classes.

struct CellRow {
  bool known;
  float occupancy;
  std::array<std::uint8_t, 3> classes;
  std::array<float, 3> probabilities;
};
struct LeafRow {
  std::array<double, 3> center;
  double size;
  float occupancy;
  std::array<std::uint8_t, 3> classes;
  std::array<float, 3> probabilities;
};
struct HitRow {
  bool hit;
  std::array<double, 3> center;
  double distance;
  float occupancy;
  std::array<std::uint8_t, 3> classes;
  std::array<float, 3> probabilities;
};

/** What is known of a leaf. */
template <class Row>
void describe(const SemanticOcTree& map, const semantic_octree::SemanticOcTreeNode& leaf,
              Row& row) {
  row.occupancy = static_cast<float>(leaf.getOccupancy());
  if (!leaf.hasClassRecord()) return;
  const auto belief = map.statedBelief(leaf);
  const auto p = belief.probabilities(map.numClasses());
  row.classes = belief.ids;
  for (std::size_t i = 0; i < row.probabilities.size(); ++i)
    row.probabilities[i] = static_cast<float>(p.named[i]);
}

/** All leaves, or those with voxels in a box (meters). */
std::vector<LeafRow> leavesOf(const SemanticOcTree& map);
std::vector<LeafRow> leavesOf(const SemanticOcTree& map, const Eigen::Vector3d& low,
                              const Eigen::Vector3d& high);

using MapClass = py::class_<SharedMap, std::shared_ptr<SharedMap>>;
void addReading(MapClass& map);
void addMap(py::module_& module, MapClass& map);
void addAbstraction(py::module_& module, MapClass& map);
void addPlanning(py::module_& module, MapClass& map);

}  // namespace python
