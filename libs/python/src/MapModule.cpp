#include <map_operations/MapOperations.h>
#include <pybind11/operators.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <semantic_octree/MapFollower.h>
#include <semantic_octree/TreeFile.h>
#include <strict_files/OutputFiles.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "Arguments.h"
#include "SharedMap.h"

namespace python {

using semantic_octree::InsertionOptions;
using semantic_octree::InsertionReport;
using semantic_octree::kKeyOfOrigin;
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
  cloud.points = pointsOf(Rows(points, "points", 3));
  addLabels(cloud, labels, map.numClasses());
  const Eigen::Isometry3d T = poseOf(pose, "T_map_sensor");
  return toDict(
      map.write([&](SemanticOcTree& tree) { return tree.insert(cloud, T, options, seconds); }));
}

py::array_t<CellRow> query(const SharedMap& map, const py::object& points) {
  const Rows rows(points, "points", 3);
  rows.checkFinite();
  py::array_t<CellRow> result(rows.size());
  CellRow* cells = result.mutable_data();
  map.read([&](const SemanticOcTree& tree) {
    rows.visit([&](const auto& at) {
      octomap::OcTreeKey key;
      for (py::ssize_t i = 0; i < at.rows; ++i) {
        CellRow& cell = cells[i] = CellRow{false, 0.5F, {}, {}};
        if (!tree.coordToKeyChecked(at(i, 0), at(i, 1), at(i, 2), key)) continue;
        const auto node = tree.search(key);
        if ((cell.known = static_cast<bool>(node))) describe(tree, node, cell);
      }
    });
  });
  return result;
}

py::array_t<double> distributions(const SharedMap& map, const py::object& points) {
  const Rows rows(points, "points", 3);
  rows.checkFinite();
  const py::ssize_t width = map.numClasses() + 1;
  py::array_t<double> result({rows.size(), width});
  double* numbers = result.mutable_data();
  std::fill_n(numbers, rows.size() * width, std::nan(""));
  map.read([&](const SemanticOcTree& tree) {
    octomap::OcTreeKey key;
    for (py::ssize_t i = 0; i < rows.size(); ++i) {
      const Eigen::Vector3d p = rows.row(i);
      if (!tree.coordToKeyChecked(p.x(), p.y(), p.z(), key)) continue;
      const auto node = tree.search(key);
      if (!node) continue;
      const std::vector<double> distribution = tree.distribution(node);
      std::copy(distribution.begin(), distribution.end(), numbers + i * width);
    }
  });
  return result;
}

octomap::point3d pointOf(const Eigen::Vector3d& v) {
  const Eigen::Vector3f p = v.cast<float>();
  return {p.x(), p.y(), p.z()};
}

void checkDirections(const Rows& directions) {
  for (py::ssize_t i = 0; i < directions.size(); ++i)
    if (directions.row(i).isZero(0))
      throw py::value_error("directions: all 0 in row " + std::to_string(i));
}

py::array_t<HitRow> castRays(const SharedMap& map, const py::object& originArgument,
                             const py::object& directionArgument, double maxRange,
                             bool ignoreUnknown) {
  const Rows origins(originArgument, "origins", 3), directions(directionArgument, "directions", 3);
  if (origins.size() != directions.size())
    throw py::value_error("directions: " + std::to_string(directions.size()) + " rows for " +
                          std::to_string(origins.size()) + " origins");
  if (!(maxRange >= 0)) throw py::value_error("max_range: expected 0 (no limit) or more");
  origins.checkFinite();
  directions.checkFinite();
  checkDirections(directions);
  py::array_t<HitRow> result(origins.size());
  HitRow* rows = result.mutable_data();
  map.read([&](const SemanticOcTree& tree) {
    for (py::ssize_t i = 0; i < origins.size(); ++i) {
      HitRow& row = rows[i] = HitRow{false, {}, 0, 0.5F, {}, {}};
      const Eigen::Vector3d origin = origins.row(i);
      const auto hit = tree.castRay(pointOf(origin), pointOf(directions.row(i).stableNormalized()),
                                    std::isinf(maxRange) ? 0 : maxRange, ignoreUnknown);
      if (!(row.hit = hit.has_value())) continue;
      const Eigen::Vector3d center(hit->center.x(), hit->center.y(), hit->center.z());
      Eigen::Map<Eigen::Vector3d>(row.center.data()) = center;
      row.distance = (center - origin).norm();
      describe(tree, tree.search(hit->key), row);
    }
  });
  return result;
}

template <class Iterator>
std::vector<LeafRow> rowsFrom(const SemanticOcTree& map, Iterator leaf, std::size_t expected) {
  std::vector<LeafRow> rows;
  rows.reserve(expected);
  for (; leaf != map.end_leafs(); ++leaf) {
    rows.push_back({{leaf.getX(), leaf.getY(), leaf.getZ()}, leaf.getSize(), 0.5F, {}, {}});
    describe(map, *leaf, rows.back());
  }
  return rows;
}

py::array_t<LeafRow> leaves(const SharedMap& map, const py::object& low, const py::object& high) {
  if (low.is_none() && high.is_none())
    return arrayOf(map.read([](const SemanticOcTree& tree) { return leavesOf(tree); }));
  if (low.is_none() || high.is_none()) throw py::value_error("low, high: both are needed, or none");
  const Eigen::Vector3d from = vectorOf(low, "low"), to = vectorOf(high, "high");
  if ((from.array() > to.array()).any()) throw py::value_error("low: it is above high");
  return arrayOf(map.read([&](const SemanticOcTree& tree) { return leavesOf(tree, from, to); }));
}

py::object bounds(const SharedMap& map) {
  Eigen::Vector3d low, high;
  const bool isEmpty = map.read([&](const SemanticOcTree& tree) {
    tree.getMetricMin(low.x(), low.y(), low.z());
    tree.getMetricMax(high.x(), high.y(), high.z());
    return tree.empty();
  });
  if (isEmpty) return py::none();
  return py::make_tuple(py::array_t<double>(3, low.data()), py::array_t<double>(3, high.data()));
}

py::array_t<std::uint8_t> colors(const SharedMap& map) {
  py::array_t<std::uint8_t> result({map.numClasses() + 1, 3});
  auto at = result.mutable_unchecked<2>();
  for (int id = 0; id <= map.numClasses(); ++id) {
    const auto color = colorOf(static_cast<semantic_types::ClassId>(id), map.classes());
    at(id, 0) = color.r, at(id, 1) = color.g, at(id, 2) = color.b;
  }
  return result;
}

std::vector<std::string> names(const SharedMap& map) {
  std::vector<std::string> names;
  for (int id = 1; id <= map.numClasses(); ++id)
    names.push_back(map.classes().name(static_cast<semantic_types::ClassId>(id)));
  return names;
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

void addReading(MapClass& map) {
  map.def("query", &query, py::arg("points"), R"(What the map knows about places.

points: N x 3, meters, map frame.
Returns a structured array of N rows:
  known          bool; False: nobody looked there, or it is outside of the map
  occupancy      float32, p(occupied); 0.5 where unknown
  classes        3 x uint8, ids of the likeliest classes first, 0: none
  probabilities  3 x float32, p(class) of these, among free space and all classes
Raises ValueError naming the row: another shape or type, a number that is not finite.)")
      .def("distributions", &distributions, py::arg("points"),
           R"(The class distributions of places.

points: N x 3, meters, map frame.
Returns N x (K + 1) float64: p(free space), p(class 1), ..., p(class K); nan where unknown.
Raises ValueError as query().)")
      .def("leaves", &leaves, py::arg("low") = py::none(), py::arg("high") = py::none(),
           R"(The leaves of the tree, or those with voxels in a box.

low, high: corners of the box, 3 numbers each, meters, map frame; None: all leaves.
Returns a structured array: center (3 x float64, meters, map frame), size (float64, edge in
meters), and occupancy, classes, probabilities as query() has them.
Raises ValueError: only one corner, or low above high.)")
      .def("cast_rays", &castRays, py::arg("origins"), py::arg("directions"),
           py::arg("max_range") = 0.0, py::arg("ignore_unknown") = true,
           R"(The first occupied voxels along rays.

origins, directions: N x 3 each, meters, map frame; directions of any length but 0.
max_range: meters from the origin to the voxel's center; 0: no limit.
ignore_unknown: whether rays go on in unknown space.
Returns a structured array of N rows: hit (bool), center (3 x float64, of the voxel), distance
(float64, meters from the origin to that center), and occupancy, classes, probabilities as
query() has them.
Raises ValueError naming the row.)")
      .def("bounds", &bounds, R"(Lowest and highest corner of all known cells, meters, map frame.

Returns two arrays of 3 float64; None if the map is empty.)")
      .def_property_readonly("resolution", &SharedMap::resolution, "Edge of a voxel, meters.")
      .def_property_readonly("classes", &names, "The names of the classes 1 to K.")
      .def_property_readonly("colors", &colors,
                             "(K + 1) x 3 uint8: red, green, blue; [0] is the gray of no class.")
      .def_property_readonly(
          "memory",
          [](const SharedMap& m) {
            return m.read([](const SemanticOcTree& tree) { return tree.memoryUsage(); });
          },
          "Bytes of nodes and class records.")
      .def("__len__",
           [](const SharedMap& m) {
             return m.read([](const SemanticOcTree& tree) { return tree.getNumLeafNodes(); });
           })
      .def(py::self == py::self)
      .def("__repr__", [](const SharedMap& m) {
        return "<semantic_octree.Map of " + std::to_string(m.numClasses()) +
               " classes, voxels of " + strict_files::textOf(m.resolution()) + " m>";
      });
  map.attr("__hash__") = py::none();
}

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
Arrays of any layout and real type are taken; only those that are neither float32 nor float64
  are converted first.
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

std::vector<LeafRow> leavesOf(const SemanticOcTree& map) {
  return rowsFrom(map, map.begin_leafs(), map.getNumLeafNodes());
}

std::vector<LeafRow> leavesOf(const SemanticOcTree& map, const Eigen::Vector3d& low,
                              const Eigen::Vector3d& high) {
  const auto keyOf = [&](const Eigen::Vector3d& corner) {
    const Eigen::Array3d voxels = (corner.array() * (1 / map.getResolution()))
                                      .floor()
                                      .max(-kKeyOfOrigin)
                                      .min(kKeyOfOrigin - 1);
    const Eigen::Array3i key = voxels.cast<int>() + kKeyOfOrigin;
    return semantic_octree::octomapKey(key.x(), key.y(), key.z());
  };
  return rowsFrom(map, map.begin_leafs_bbx(keyOf(low), keyOf(high)), 0);
}

void addMap(py::module_& module, MapClass& map) {
  PYBIND11_NUMPY_DTYPE(CellRow, known, occupancy, classes, probabilities);
  PYBIND11_NUMPY_DTYPE(LeafRow, center, size, occupancy, classes, probabilities);
  PYBIND11_NUMPY_DTYPE(HitRow, hit, center, distance, occupancy, classes, probabilities);
  py::class_<Follower>(module, "Follower", R"(A reader of what changes in a map: Map.follow().

A map has any number of readers, and none sees less because of another.)")
      .def("tiles", &Follower::tiles, R"(Tiles of 8 x 8 x 8 voxels that changed since the last call.

Returns (everything, corners): corners is M x 3 float64, the lowest corner of each tile in
meters, map frame. everything is True at first, and after clear(): these are all tiles that are
known in part, and what was known before does not count.)")
      .def_property_readonly("tile_size", &Follower::tileSize, "Edge of a tile, meters.");
  addChanging(map);
  addReading(map);
  addFiles(map);
}

}  // namespace python

PYBIND11_MODULE(_semantic_octree, module) {
  using namespace python;
  py::register_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const std::out_of_range& e) {  // which pybind11 takes for an index
      PyErr_SetString(PyExc_ValueError, e.what());
    }
  });
  module.attr("__version__") = MSO_VERSION;
  MapClass map(module, "Map", R"(A semantic octree map: occupancy and classes of voxels.

Threads may share a map: who changes it is alone with it, and others go on meanwhile.)");
  addMap(module, map);
  addAbstraction(module, map);
  addPlanning(module, map);
}
