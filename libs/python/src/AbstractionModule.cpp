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
using tree_abstraction::InformationTerm;
namespace fs = std::filesystem;

namespace {

int classNamed(const py::handle& name, const ClassTable& classes) {
  const auto text = py::str(name).cast<std::string>();
  if (const auto id = classes.find(text)) return *id;
  if (text == semantic_octree::kFreeSpace) return 0;
  refuseClass("weights", text, classes);
}

InformationTerm termOf(const py::handle& key, double weight, const ClassTable& classes) {
  const bool isGroup = py::isinstance<py::tuple>(key);
  std::vector<int> ids;
  std::string name;
  for (const py::handle& part : isGroup ? key.cast<py::tuple>() : py::make_tuple(key)) {
    ids.push_back(classNamed(part, classes));
    name += (name.empty() ? "" : "+") + py::str(part).cast<std::string>();
  }
  return {name, weight, {ids}};
}

AbstractionOptions optionsOf(const py::object& weights, const std::string& solution,
                             const ClassTable& classes) {
  AbstractionOptions options;
  if (isPath(weights)) {
    const auto file = semantic_octree::loadWeights(weights.cast<fs::path>(), classes);
    options = file.space;
    options.weights.terms = file.solution(solution).terms;
    options.weights.alpha = file.solution(solution).alpha.value_or(tree_abstraction::kAlpha);
  } else if (py::isinstance<py::dict>(weights)) {
    for (const auto& [key, weight] : weights.cast<py::dict>()) {
      if (!PyNumber_Check(weight.ptr()))
        throw py::value_error("weights: " + py::repr(weight).cast<std::string>() + " is no number");
      options.weights.terms.push_back(
          termOf(key, py::float_(py::reinterpret_borrow<py::object>(weight)), classes));
    }
  } else {
    throw py::value_error("weights: expected a file, or a dict of numbers by class");
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
  std::string text() const {
    return m_map->write([&](SemanticOcTree& tree) -> std::string {
      if (m_map->numAbstractions != m_number) return "<Abstraction that another one replaced>";
      const Abstraction abstraction(tree);
      const auto& weights = abstraction.options().weights;
      std::string text = "<Abstraction: " + std::to_string(abstraction.leaves().size()) + " of " +
                         std::to_string(tree.getNumLeafNodes()) + " leaves, alpha " +
                         strict_files::textOf(weights.alpha);
      for (const auto& term : weights.terms)
        text += ", " + term.name + " " + strict_files::textOf(term.weight);
      return text + ">";
    });
  }

 private:
  std::shared_ptr<SharedMap> m_map;
  std::size_t m_number = 0;
};

MapAbstraction abstractionOf(std::shared_ptr<SharedMap> map, const py::object& weights,
                             const std::string& solution, const py::kwargs& space) {
  AbstractionOptions options = optionsOf(weights, solution, map->classes());
  setOptions<semantic_octree::AbstractionSpace>(options, space);
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
      .def_property_readonly("alpha", &MapAbstraction::alpha, "Price of detail.")
      .def("__repr__", &MapAbstraction::text);
  map.def("abstraction", &abstractionOf, py::arg("weights"), py::kw_only(),
          py::arg("solution") = "",
          R"(Keeps from now on what the optimal abstraction needs.

weights: a dict from classes to numbers, positive: worth keeping, negative: worth dropping; a
  tuple of names counts as one class, "free_space" is one, too. Or a file of weights (YAML).
solution: which one of the file; empty: the first.
options: unknown, block_size, as in files.
Raises ValueError naming class and value, TypeError naming an option that there is not,
  RuntimeError naming the file and what is wrong.)");
}

}  // namespace python
