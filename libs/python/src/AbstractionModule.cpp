#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <semantic_abstraction/AlphaTrees.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "Arguments.h"
#include "SharedMap.h"

namespace python {

using semantic_octree::Abstraction;
using semantic_octree::AbstractionOptions;
using semantic_types::ClassTable;
namespace fs = std::filesystem;

namespace {

/** A term by a class, or by a tuple of them. */
void addTerm(AbstractionOptions& options, const py::handle& key, double weight,
             const ClassTable& classes) {
  const bool isGroup = py::isinstance<py::tuple>(key);
  std::vector<std::string> members;
  for (const py::handle& part : isGroup ? key.cast<py::tuple>() : py::make_tuple(key))
    members.push_back(py::str(part).cast<std::string>());
  std::string name;
  for (const std::string& member : members) name += (name.empty() ? "" : "+") + member;
  options.add(classes, name, members, weight);
}

AbstractionOptions optionsOf(const py::object& weights, const std::string& solution,
                             const ClassTable& classes) {
  if (isPath(weights))
    return semantic_octree::loadSolution(weights.cast<fs::path>(), solution, classes);
  if (!py::isinstance<py::dict>(weights))
    throw py::value_error("weights: expected a file, or a dict of numbers by class");
  AbstractionOptions options;
  for (const auto& [key, weight] : weights.cast<py::dict>()) {
    if (!PyNumber_Check(weight.ptr()))
      throw py::value_error("weights: " + py::repr(weight).cast<std::string>() + " is no number");
    addTerm(options, key, py::float_(py::reinterpret_borrow<py::object>(weight)), classes);
  }
  return options;
}

/** A map's abstraction, as long as the map is given no other. */
class MapAbstraction {
 private:
  template <class F>
  auto with(const F& use) {
    return m_map->write([&](SemanticOcTree& tree) {
      if (m_map->numAbstractions != m_number)
        throw std::runtime_error("the map has been given another abstraction since");
      Abstraction abstraction(tree);
      return use(abstraction);
    });
  }
  template <class F>
  auto withAlpha(std::optional<double> alpha, std::optional<std::size_t> leaves, const F& use) {
    if (alpha && leaves) throw py::value_error("alpha, leaves: expected one of them, or none");
    return with([&](Abstraction& abstraction) {
      if (leaves) alpha = semantic_octree::AlphaTrees(abstraction).alphaForLeaves(double(*leaves));
      if (alpha) abstraction.setAlpha(*alpha);
      return use(abstraction);
    });
  }

 public:
  MapAbstraction(std::shared_ptr<SharedMap> map, const AbstractionOptions& options)
      : m_map(std::move(map)) {
    m_number = m_map->write([&](SemanticOcTree& tree) {
      setAbstraction(tree, options);
      return ++m_map->numAbstractions;
    });
  }

  py::array_t<LeafRow> leaves(std::optional<double> alpha, std::optional<std::size_t> leaves) {
    return arrayOf(withAlpha(alpha, leaves, [](const Abstraction& abstraction) {
      return leavesOf(abstraction.compressedMap());
    }));
  }
  std::shared_ptr<SharedMap> compressed(std::optional<double> alpha,
                                        std::optional<std::size_t> leaves) {
    return std::make_shared<SharedMap>(withAlpha(
        alpha, leaves, [](const Abstraction& abstraction) { return abstraction.compressedMap(); }));
  }
  std::map<std::string, std::optional<double>> retention() {
    return with([](Abstraction& abstraction) {
      const auto measures = abstraction.measures();
      std::map<std::string, std::optional<double>> kept;
      const auto& terms = abstraction.options().weights.terms;
      for (std::size_t i = 0; i < terms.size(); ++i) kept[terms[i].name] = measures.retention(i);
      return kept;
    });
  }
  double alpha() {
    return with([](Abstraction& abstraction) { return abstraction.options().weights.alpha; });
  }

 private:
  std::shared_ptr<SharedMap> m_map;
  std::size_t m_number = 0;
};

MapAbstraction abstractionOf(std::shared_ptr<SharedMap> map, const py::object& weights,
                             const std::string& solution, const py::kwargs& more) {
  AbstractionOptions options = optionsOf(weights, solution, map->classes());
  setOptions(options, more);
  return {std::move(map), options};
}

}  // namespace

void addAbstraction(py::module_& module, MapClass& map) {
  const auto alpha = py::arg("alpha") = py::none();
  const auto leaves = py::arg("leaves") = py::none();
  py::class_<MapAbstraction>(
      module, "Abstraction",
      R"(The optimal abstraction of a map, of Map.abstraction(): which leaves tell most.

Insertions keep it up to date. It holds until the map is given another one; then all that is here
raises RuntimeError.)")
      .def("leaves", &MapAbstraction::leaves, py::kw_only(), alpha, leaves,
           R"(The leaves of the compressed tree.

alpha: price of detail, nats per nat; larger is coarser. leaves: the largest optimal tree with at
most that many known leaves. None of them: as before.
Returns a structured array as Map.leaves() does; occupancy is that of the most occupied voxel.
Raises ValueError: both, a negative alpha, or fewer leaves than there are blocks.)")
      .def("map", &MapAbstraction::compressed, py::kw_only(), alpha, leaves,
           "The compressed tree as a map of its own; arguments as for leaves().")
      .def("retention", &MapAbstraction::retention,
           R"(Share of each term's information that the compressed tree keeps, by its name.

None where there is none to keep.)")
      .def_property_readonly("alpha", &MapAbstraction::alpha, "Price of detail.");
  map.def("abstraction", &abstractionOf, py::arg("weights"), py::kw_only(),
          py::arg("solution") = "",
          R"(Keeps from now on what the optimal abstraction needs.

weights: a dict from classes to numbers, positive: worth keeping, negative: worth dropping; a
  tuple of names counts as one class, "free_space" is one, too. Or a file of weights (YAML).
solution: which one of the file; empty: the first.
options: alpha, block_size, unknown, regions and all others of [abstraction] in .ini files.
Raises ValueError naming class and value, TypeError naming an option that there is not,
  RuntimeError naming the file and what is wrong.)");
}

}  // namespace python
