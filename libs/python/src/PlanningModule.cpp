#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_planning/planner/OrderFile.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <filesystem>
#include <iomanip>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "Arguments.h"
#include "SharedMap.h"

namespace python {

using colored_graph::ClassOrder;
using semantic_planning::PathPoint;
using semantic_planning::PlannerOptions;
using semantic_planning::PlanResult;
using semantic_planning::SemanticPlanner;
using semantic_planning::VehicleOptions;
using semantic_types::ClassTable;
namespace fs = std::filesystem;

namespace {

colored_graph::GraphClass groundNamed(const py::handle& name, const ClassTable& classes) {
  const auto text = py::str(name).cast<std::string>();
  if (const auto id = classes.find(text)) return *id;
  if (text == semantic_planning::kUnknownGround) return semantic_types::kNoClass;
  refuseClass("order", text, classes);
}

std::string nameOfGround(std::size_t id, const ClassTable& classes) {
  return id == 0 ? semantic_planning::kUnknownGround
                 : classes.name(static_cast<semantic_types::ClassId>(id));
}

ClassOrder orderOf(const py::object& argument, const std::optional<std::vector<double>>& rates,
                   const ClassTable& classes) {
  if (isPath(argument)) {
    const ClassOrder order = semantic_planning::loadClassOrder(argument.cast<fs::path>(), classes);
    return rates ? order.withRates(*rates) : order;
  }
  if (!py::isinstance<py::sequence>(argument))
    throw py::value_error("order: expected a file, or a list of names from best to worst");
  std::vector<std::vector<colored_graph::GraphClass>> ranks;
  for (const py::handle& rank : argument) {
    ranks.emplace_back();
    const bool isOne = py::isinstance<py::str>(rank);
    for (const py::handle& name :
         isOne ? py::make_tuple(rank) : py::tuple(py::reinterpret_borrow<py::object>(rank)))
      ranks.back().push_back(groundNamed(name, classes));
  }
  const ClassOrder order(classes.size() + 1, ranks);
  return rates ? order.withRates(*rates) : order;
}

VehicleOptions vehicleOf(const py::object& argument) {
  VehicleOptions vehicle;
  if (argument.is_none()) return vehicle;
  if (isPath(argument)) return semantic_planning::loadVehicle(argument.cast<fs::path>());
  if (!py::isinstance<py::dict>(argument))
    throw py::value_error("vehicle: expected a file, or a dict of its measures");
  py::dict values(argument.attr("copy")());
  const py::object corners = values.attr("pop")("footprint", py::none());
  setOptions(vehicle, values);
  if (corners.is_none()) return vehicle;
  const Rows rows(corners, "footprint", 2);
  std::vector<Eigen::Vector2d> points;
  for (py::ssize_t i = 0; i < rows.size(); ++i)
    points.emplace_back(rows.values()(i, 0), rows.values()(i, 1));
  vehicle.footprint = semantic_planning::Footprint(points);
  return vehicle;
}

mrpt::math::TPose2D poseInPlane(const py::object& argument, const std::string& name) {
  const Eigen::Vector3d pose = vectorOf(argument, name);
  return {pose.x(), pose.y(), pose.z()};
}

/** A plan, and the names of the classes in it. */
struct Plan {
  PlanResult result;
  ClassTable classes;

  py::array_t<PathPoint> path() const { return arrayOf(result.path); }
  std::map<std::string, double> lengthPerClass() const {
    std::map<std::string, double> lengths;
    for (std::size_t id = 0; id < result.lengthPerClass.size(); ++id)
      lengths[nameOfGround(id, classes)] = result.lengthPerClass[id];
    return lengths;
  }
  std::string text() const {
    std::ostringstream text;
    text << std::fixed << std::setprecision(1);
    if (!result.found()) {
      text << "<Plan: no path: " << result.reason;
    } else {
      text << "<Plan of " << result.length << " m, price " << result.price << " m";
      const char* before = ": ";
      for (const auto& [name, length] : lengthPerClass())
        if (length > 0) text << std::exchange(before, ", ") << length << " m " << name;
    }
    return text.str() + ">";
  }
};

class Planner {
 public:
  Planner(std::shared_ptr<SharedMap> map, const ClassOrder& order, const PlannerOptions& options)
      : m_map(std::move(map)), m_planner(m_map->write([&](SemanticOcTree& tree) {
          if (semantic_planning::isOfTree(options.roadmap.kind) && !hasAbstraction(tree)) {
            setAbstraction(tree, semantic_planning::abstractionFor(order));
            ++m_map->numAbstractions;
          }
          return SemanticPlanner(tree, order, options);
        })) {}

  Plan plan(const py::object& start, const py::object& goal, std::optional<double> startZ,
            std::optional<double> goalZ) {
    const auto from = poseInPlane(start, "start"), to = poseInPlane(goal, "goal");
    return {m_map->write([&](SemanticOcTree&) { return m_planner.plan(from, to, startZ, goalZ); }),
            m_map->classes()};
  }
  Plan replan(const py::object& start, std::optional<double> startZ) {
    const auto from = poseInPlane(start, "start");
    return {m_map->write([&](SemanticOcTree&) {
              m_planner.update();
              return m_planner.replan(from, startZ);
            }),
            m_map->classes()};
  }

 private:
  std::shared_ptr<SharedMap> m_map;
  SemanticPlanner m_planner;
};

std::unique_ptr<Planner> plannerOf(std::shared_ptr<SharedMap> map, const py::object& order,
                                   const py::object& vehicle,
                                   const std::optional<std::vector<double>>& rates,
                                   const py::kwargs& values) {
  PlannerOptions options;
  options.shorten = true;
  setOptions(options, values);
  options.vehicle = vehicleOf(vehicle);
  const ClassOrder ranks = orderOf(order, rates, map->classes());
  return std::make_unique<Planner>(std::move(map), ranks, options);
}

Plan plan(std::shared_ptr<SharedMap> map, const py::object& start, const py::object& goal,
          const py::object& order, const py::object& vehicle,
          const std::optional<std::vector<double>>& rates, std::optional<double> startZ,
          std::optional<double> goalZ, const py::kwargs& values) {
  return plannerOf(std::move(map), order, vehicle, rates, values)->plan(start, goal, startZ, goalZ);
}

}  // namespace

void addPlanning(py::module_& module, MapClass& map) {
  PYBIND11_NUMPY_DTYPE_EX(PathPoint, x, "x", y, "y", z, "z", heading, "heading", curvature,
                          "curvature", forward, "forward", classId, "class", arcLength,
                          "arc_length");
  const auto none = [](const char* name) { return py::arg(name) = py::none(); };
  py::class_<Plan>(module, "Plan", "A path, or why there is none. True if there is one.")
      .def_property_readonly(
          "found", [](const Plan& p) { return p.result.found(); }, "Whether there is a path.")
      .def("__bool__", [](const Plan& p) { return p.result.found(); })
      .def("__repr__", &Plan::text)
      .def_property_readonly(
          "status", [](const Plan& p) { return nameOf(p.result.status); },
          "In a word or two: \"found\", \"start off ground\", ...")
      .def_property_readonly(
          "reason", [](const Plan& p) { return p.result.reason; },
          "A sentence with the numbers; empty if found.")
      .def_property_readonly("path", &Plan::path,
                             R"(The path: a structured array, points at most half a voxel apart.

x, y, z: meters, map frame. heading: radians. curvature: 1/m, positive to the left. forward:
bool. class: id of the worst under the wheels, 0: unknown. arc_length: meters from the start.)")
      .def_property_readonly(
          "length", [](const Plan& p) { return p.result.length; }, "Meters.")
      .def_property_readonly(
          "price", [](const Plan& p) { return p.result.price; },
          "Meters: driving, and each rank's rate for each of its meters.")
      .def_property_readonly("length_per_class", &Plan::lengthPerClass,
                             "Meters by the names of classes; \"unknown\" is ground without one.");
  py::class_<Planner>(module, "Planner", R"(Plans again and again over a map: Map.planner().

What does not depend on start and goal is kept until the map changes there.)")
      .def("plan", &Planner::plan, py::arg("start"), py::arg("goal"), py::kw_only(),
           none("start_z"), none("goal_z"),
           R"(A path over the map as it was when the planner was made, or at the last replan().

start, goal: x, y (meters, map frame) and heading (radians). start_z, goal_z: meters, which of
several levels is meant; None: the lowest.)")
      .def("replan", &Planner::replan, py::arg("start"), py::kw_only(), none("start_z"),
           R"(The best path to the same goal over the map as it is now.

start: x, y, heading, where the vehicle is. What it has of a path is kept if it is free and no
other one costs 0.5 m less.
Raises RuntimeError: nothing was planned before.)");
  map.def("planner", &plannerOf, py::arg("order"), none("vehicle"), py::kw_only(), none("rates"),
          R"(Plans paths that put classes before length.

order: a file (YAML), or names of classes from best to worst, some of which may be lists of names
  that share a rank; "unknown" is ground without a class. Others are forbidden.
vehicle: a file (YAML) or a dict: footprint (corners, N x 2, meters), height, turning_radius,
  clearance, step_height, max_slope, ... ; None: a robot of 0.8 m x 0.6 m.
rates: of all ranks but the best: so many meters more of driving a meter of it is worth avoiding.
options: those of the planner by their names in files.
Raises ValueError or TypeError naming what is wrong; RuntimeError naming the file.)")
      .def("plan", &plan, py::arg("start"), py::arg("goal"), py::arg("order"), none("vehicle"),
           py::kw_only(), none("rates"), none("start_z"), none("goal_z"),
           "Plans once: as planner(order, vehicle, ...).plan(start, goal, ...).");
}

}  // namespace python
