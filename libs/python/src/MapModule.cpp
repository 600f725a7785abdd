#include <map_operations/MapOperations.h>
#include <pybind11/operators.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <semantic_octree/MapFollower.h>
#include <semantic_octree/TreeFile.h>
#include <strict_files/OutputFiles.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "Arguments.h"
#include "SharedMap.h"

namespace python {

using semantic_octree::InsertionOptions;
using semantic_octree::InsertionReport;
using semantic_octree::MapFollower;
using semantic_types::LabeledCloud;
namespace fs = std::filesystem;

namespace {

constexpr int kTileEdge = 8;  ///< voxels

std::shared_ptr<SharedMap> makeMap(double resolution, const py::object& classes,
                                   const py::kwargs& filter) {
  semantic_octree::FilterParameters parameters;
  setOptions(parameters, filter);
  return std::make_shared<SharedMap>(SemanticOcTree(resolution, classTableOf(classes), parameters));
}

py::dict toDict(const InsertionReport& report) {
  using namespace py::literals;
  return py::dict("points"_a = report.points, "not_finite"_a = report.skippedNotFinite,
                  "near"_a = report.skippedNear, "outside"_a = report.skippedOutside,
                  "beyond_range"_a = report.beyondRange, "hit_voxels"_a = report.hitVoxels,
                  "free_voxels"_a = report.freeVoxels);
}

py::dict insert(SharedMap& map, const py::object& points, const py::object& labels,
                const py::object& pose, double seconds, const py::kwargs& values) {
  InsertionOptions options;
  setOptions(options, values);
  LabeledCloud cloud;
  cloud.points = pointsOf(points);
  addLabels(cloud, labels, map.numClasses());
  const Eigen::Isometry3d T = poseOf(pose, "T_map_sensor");
  return toDict(
      map.write([&](SemanticOcTree& tree) { return tree.insert(cloud, T, options, seconds); }));
}

void toOctomap(const SharedMap& map, const fs::path& path, bool withColors) {
  const bool isBinary = path.extension() == ".bt";
  if (!isBinary && path.extension() != ".ot")
    throw py::value_error(path.string() + ": expected a name that ends with .bt or .ot");
  map.read([&](const SemanticOcTree& tree) {
    strict_files::StagedFile file(path);
    std::ofstream out(file.path(), std::ios::binary);
    isBinary     ? writeBinaryOcTree(out, tree)
    : withColors ? writeColorOcTree(out, tree)
                 : writeOcTree(out, tree);
    out.close();
    if (!out) throw std::runtime_error(path.string() + ": cannot be written");
    file.commit();
  });
}

std::shared_ptr<SharedMap> load(const fs::path& path) {
  const py::gil_scoped_release others;
  return std::make_shared<SharedMap>(semantic_octree::loadTree(path.string()));
}

std::shared_ptr<SharedMap> copyOf(const SharedMap& map) {
  return std::make_shared<SharedMap>(map.read([](const SemanticOcTree& tree) { return tree; }));
}

py::bytes bytesOf(const SharedMap& map) {
  return map.read([](const SemanticOcTree& tree) {
    std::ostringstream out;
    writeTree(out, tree);
    return out.str();
  });
}
std::shared_ptr<SharedMap> ofBytes(const py::bytes& bytes) {
  std::istringstream in(bytes.cast<std::string>());
  return std::make_shared<SharedMap>(semantic_octree::readTree(in));
}

/** A reader of what changes, and its map. */
class Follower {
 public:
  explicit Follower(std::shared_ptr<SharedMap> map)
      : m_map(std::move(map)),
        m_follower(m_map->write([](SemanticOcTree& tree) { return tree.follow(); })) {}

  py::tuple tiles() {
    const auto change = m_map->write([this](SemanticOcTree&) { return m_follower.tiles(); });
    py::array_t<double> corners({static_cast<py::ssize_t>(change.tiles.size()), py::ssize_t(3)});
    double* corner = corners.mutable_data();
    for (const octomap::OcTreeKey& key : change.tiles)
      for (unsigned axis = 0; axis < 3; ++axis)
        *corner++ = semantic_octree::lowerBorderOf(key[axis], m_map->resolution());
    return py::make_tuple(change.all, corners);
  }
  double tileSize() const { return kTileEdge * m_map->resolution(); }

 private:
  std::shared_ptr<SharedMap> m_map;
  MapFollower m_follower;
};

void addChanging(MapClass& map) {
  map.def(py::init(&makeMap), py::arg("resolution"), py::arg("classes"),
          R"(An empty map.

resolution: edge of a voxel, meters.
classes: a class table (a YAML file), names of the classes 1 to K, or a dict of names with
  colors (red, green, blue), each 0 to 255.
filter: options of the class filter by their names in files: accuracy, hit_probability, ...
Raises ValueError or TypeError naming the option; RuntimeError naming the file and what is wrong.)")
      .def("insert", &insert, py::arg("points"), py::arg("labels") = py::none(),
           py::arg("T_map_sensor") = py::none(), py::kw_only(), py::arg("seconds") = 0.0,
           R"(Inserts a scan. Voxels that it crosses are free, those in which points lie are hit.

points: N x 3, meters, sensor frame. Points with nan or inf, as sensors give them where there
  was no return, are skipped and counted; all others carve from the sensor on.
labels: N whole numbers 0 (no label) to K, or N x K probabilities whose rows sum to 1 (0: no
  label); None: no point has a label.
T_map_sensor: 4 x 4, pose of the sensor in the map's frame; None: the identity.
seconds: since the last scan, by which the map ages first if its classes have half-lives.
options: those of insertion by their names in files: max_range, min_range, rays, threads, ...
Returns a dict of counts: points, not_finite, near, outside, beyond_range, hit_voxels,
  free_voxels.
Arrays of any layout and real type are taken.
Raises ValueError naming the argument, the row and the value; TypeError naming an option that
  there is not. The map is then as it was. MemoryError: the map may be lost; clear() or load.)")
      .def(
          "age",
          [](SharedMap& m, double seconds) {
            m.write([&](SemanticOcTree& tree) { tree.age(seconds); });
          },
          py::arg("seconds"),
          R"(Time passes, and what has a half-life (in the class table) is forgotten.

Raises ValueError: not 0 to 1e9 seconds.)")
      .def(
          "clear", [](SharedMap& m) { m.write([](SemanticOcTree& tree) { tree.clear(); }); },
          "Removes all that is known.")
      .def(
          "follow", [](std::shared_ptr<SharedMap> m) { return Follower(std::move(m)); },
          "A new reader of what changes.");
}

void addFiles(MapClass& map) {
  map.def(
         "save",
         [](const SharedMap& m, const fs::path& path) {
           m.read([&](const SemanticOcTree& tree) { saveTree(tree, path.string()); });
         },
         py::arg("path"), R"(Saves the map (.semantic), bit for bit.

What was there stays if this fails. Raises RuntimeError naming the file and what is wrong.)")
      .def_static("load", &load, py::arg("path"), R"(The map of a file, all of it or nothing.

Raises RuntimeError naming the file and what is wrong: missing, no map, truncated, altered.)")
      .def("to_octomap", &toOctomap, py::arg("path"), py::kw_only(), py::arg("colors") = true,
           R"(Writes OctoMap's file: occupancy (.bt), or probabilities and colors of classes (.ot).

colors: False: an OcTree in .ot files, not a ColorOcTree.
Raises ValueError: another ending. RuntimeError naming the file and what is wrong.)")
      .def("copy", &copyOf, "A map of its own with the same content, bit for bit.")
      .def("__copy__", &copyOf)
      .def(
          "__deepcopy__", [](const SharedMap& m, const py::dict&) { return copyOf(m); },
          py::arg("memo"))
      .def(py::pickle(&bytesOf, &ofBytes));
}

}  // namespace

void addMap(py::module_& module, MapClass& map) {
  py::class_<Follower>(module, "Follower", R"(A reader of what changes in a map: Map.follow().

A map has any number of readers, and none sees less because of another.)")
      .def("tiles", &Follower::tiles, R"(Tiles of 8 x 8 x 8 voxels that changed since the last call.

Returns (everything, corners): corners is M x 3 float64, the lowest corner of each tile in
meters, map frame. everything is True at first, and after clear(): these are all tiles that are
known in part, and what was known before does not count.)")
      .def_property_readonly("tile_size", &Follower::tileSize, "Edge of a tile, meters.");
  addChanging(map);
  addFiles(map);
}

}  // namespace python

PYBIND11_MODULE(_semantic_octree, module) {
  using namespace python;
  py::register_local_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const std::out_of_range& e) {  // which pybind11 takes for an index
      PyErr_SetString(PyExc_ValueError, e.what());
    } catch (const py::cast_error&) {
      PyErr_SetString(PyExc_ValueError,
                      "an argument has another type, or text that is not Unicode");
    }
  });
  module.attr("__version__") = MSO_VERSION;
  MapClass map(module, "Map", R"(A semantic octree map: occupancy and classes of voxels.

Threads may share a map: who changes it is alone with it, and others go on meanwhile.)");
  addReading(map);
  addMap(module, map);
  addAbstraction(module, map);
  addPlanning(module, map);
}
