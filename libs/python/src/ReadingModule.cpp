#include <pybind11/operators.h>
#include <pybind11/stl.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "Arguments.h"
#include "SharedMap.h"

namespace python {

using semantic_octree::kKeyOfOrigin;

namespace {

/** None: nobody looked there, or it is outside of the map. */
semantic_octree::SemanticOcTreeNode nodeAt(const SemanticOcTree& tree, const Eigen::Vector3d& p) {
  octomap::OcTreeKey key;
  if (!tree.coordToKeyChecked(p.x(), p.y(), p.z(), key)) return {};
  return tree.search(key);
}

py::array_t<CellRow> query(const SharedMap& map, const py::object& points) {
  const Rows rows(points, "points", 3);
  rows.checkFinite();
  py::array_t<CellRow> result(rows.size());
  CellRow* cells = result.mutable_data();
  map.read([&](const SemanticOcTree& tree) {
    for (py::ssize_t i = 0; i < rows.size(); ++i) {
      CellRow& cell = cells[i] = CellRow{false, 0.5F, {}, {}};
      const auto node = nodeAt(tree, rows.row(i));
      if ((cell.known = static_cast<bool>(node))) describe(tree, node, cell);
    }
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
    for (py::ssize_t i = 0; i < rows.size(); ++i) {
      const auto node = nodeAt(tree, rows.row(i));
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
  if ((from.array() > to.array()).any()) {
    std::ostringstream text;
    text << "low (" << from.transpose() << ") is above high (" << to.transpose() << ")";
    throw py::value_error(text.str());
  }
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

std::string summaryOf(const SharedMap& map) {
  const auto meters = [](double m) { return strict_files::textOf(std::round(1e3 * m) / 1e3); };
  return map.read([meters](const SemanticOcTree& tree) {
    std::string classes;
    constexpr int kShown = 3;
    for (int id = 1; id <= std::min(tree.numClasses(), kShown); ++id)
      classes +=
          (id > 1 ? ", " : "") + tree.classes().name(static_cast<semantic_types::ClassId>(id));
    if (tree.numClasses() > kShown) classes += ", ...";
    std::string text = "<Map: voxels of " + strict_files::textOf(tree.getResolution()) + " m, " +
                       std::to_string(tree.numClasses()) +
                       (tree.numClasses() == 1 ? " class (" : " classes (") + classes + "), ";
    if (tree.empty()) return text + "empty>";
    Eigen::Array3d low, high;
    tree.getMetricMin(low.x(), low.y(), low.z());
    tree.getMetricMax(high.x(), high.y(), high.z());
    text += std::to_string(tree.getNumLeafNodes()) + " leaves, " +
            strict_files::sizeText(tree.memoryUsage());
    for (int i = 0; i < 3; ++i)
      text += std::string(", ") + "xyz"[i] + " " + meters(low[i]) + " to " + meters(high[i]);
    return text + " m>";
  });
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

void addQueries(MapClass& map) {
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
Raises ValueError naming the row.)");
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

void addReading(MapClass& map) {
  PYBIND11_NUMPY_DTYPE(CellRow, known, occupancy, classes, probabilities);
  PYBIND11_NUMPY_DTYPE(LeafRow, center, size, occupancy, classes, probabilities);
  PYBIND11_NUMPY_DTYPE(HitRow, hit, center, distance, occupancy, classes, probabilities);
  addQueries(map);
  map.def("bounds", &bounds, R"(Lowest and highest corner of all known cells, meters, map frame.

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
      .def("__repr__", &summaryOf);
  map.attr("__hash__") = py::none();
}

}  // namespace python
