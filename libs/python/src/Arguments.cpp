#include "Arguments.h"

#include <pybind11/stl/filesystem.h>
#include <strict_files/Memory.h>
#include <strict_files/Words.h>

#include <cstdint>
#include <stdexcept>

namespace python {

using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::LabeledCloud;

namespace {

std::string shapeOf(const py::array& array) {
  return py::str(array.attr("shape")).cast<std::string>();
}
std::string typeOf(const py::array& array) { return py::str(array.dtype()).cast<std::string>(); }

py::array arrayOfArgument(const py::object& argument, const std::string& name) {
  py::array array = py::array::ensure(argument);
  if (array) return array;
  PyErr_Clear();
  throw py::value_error(name + ": expected an array, got " +
                        py::str(py::type::handle_of(argument)).cast<std::string>());
}

[[noreturn]] void refuse(const std::string& name, py::ssize_t row, const std::string& value,
                         const std::string& expected) {
  throw py::value_error(name + ": " + value + " in row " + std::to_string(row) + ", expected " +
                        expected);
}

/** An array of rows of real numbers. \throw py::value_error as Rows */
py::array rowsOf(const py::object& argument, const std::string& name, py::ssize_t columns,
                 std::optional<py::ssize_t> rows = {}) {
  const py::array array = arrayOfArgument(argument, name);
  const bool fits = array.ndim() == 2 && array.shape(1) == columns &&
                    array.shape(0) == rows.value_or(array.shape(0));
  if (!fits || std::string("fiu").find(array.dtype().kind()) == std::string::npos)
    throw py::value_error(name + ": expected " + (rows ? std::to_string(*rows) : "N") + " x " +
                          std::to_string(columns) + " real numbers, got " + typeOf(array) +
                          " of shape " + shapeOf(array));
  constexpr std::size_t kBytes = 64;  // of what becomes of a row
  if (static_cast<std::size_t>(array.shape(0)) > strict_files::availableMemory() / kBytes)
    throw py::value_error(name + ": " + std::to_string(array.shape(0)) +
                          " rows are more than memory holds");
  return array;
}

/** \param Whole the widest type of the labels' kind */
template <class Whole>
std::vector<ClassId> idsOf(const py::array& labels, int numClasses) {
  const ArrayOf<Whole> array(labels);
  std::vector<ClassId> ids;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const Whole label = array.data()[i];
    if (static_cast<std::uint64_t>(label) > static_cast<std::uint64_t>(numClasses))
      refuse("labels", i, std::to_string(label), "0 (none) to " + std::to_string(numClasses));
    ids.push_back(static_cast<ClassId>(label));
  }
  return ids;
}

std::vector<float> probabilitiesOf(const Rows& rows) {
  constexpr double kRounding = 0.01;  // of half floats
  const auto values = rows.values();
  for (py::ssize_t i = 0; i < values.rows(); ++i) {
    for (const double q : values.row(i))
      if (!(q >= 0 && q <= 1)) refuse("labels", i, std::to_string(q), "probabilities, 0 to 1");
    const double sum = values.row(i).sum();
    if (sum != 0 && std::fabs(sum - 1) > kRounding)
      refuse("labels", i, "a sum of " + std::to_string(sum), "1, or 0 for no label");
  }
  return {values.data(), values.data() + values.size()};
}

/** Unlike each other, and the same for the same number. */
semantic_types::Color colorOfNumber(int number) {
  const double hue = std::fmod(number * 0.6180339887498949, 1.0);
  const py::tuple rgb = py::module_::import("colorsys").attr("hsv_to_rgb")(hue, 0.7, 0.9);
  const auto byte = [&](int i) { return static_cast<std::uint8_t>(255 * rgb[i].cast<double>()); };
  return {byte(0), byte(1), byte(2)};
}

semantic_types::Color colorOfArgument(const py::handle& argument, const std::string& name) {
  try {
    const auto rgb = argument.cast<std::tuple<std::uint8_t, std::uint8_t, std::uint8_t>>();
    return {std::get<0>(rgb), std::get<1>(rgb), std::get<2>(rgb)};
  } catch (const py::cast_error&) {
    throw py::value_error("classes: the color of '" + name +
                          "' is no (red, green, blue), each 0 to 255");
  }
}

std::string nameOf(const py::handle& argument) {
  if (py::isinstance<py::str>(argument)) return argument.cast<std::string>();
  throw py::value_error("classes: " + py::repr(argument).cast<std::string>() +
                        " is no name of a class");
}

/** A value as files have it. */
std::string textOf(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (value.is_none()) return "none";
  if (!py::isinstance<py::tuple>(value) && !py::isinstance<py::list>(value))
    return py::str(value).cast<std::string>();
  std::string text;
  for (const py::handle& part : value) text += (text.empty() ? "" : ", ") + textOf(part);
  return text;
}

}  // namespace

Rows::Rows(const py::object& argument, std::string name, py::ssize_t columns,
           std::optional<py::ssize_t> rows)
    : m_name(std::move(name)), m_array(rowsOf(argument, m_name, columns, rows)) {}

void Rows::checkFinite() const {
  const auto all = values();
  for (py::ssize_t i = 0; i < all.rows(); ++i)
    for (const double number : all.row(i))
      if (!std::isfinite(number))
        refuse(m_name, i, std::to_string(number), "numbers that are finite");
}

std::vector<Eigen::Vector3f> pointsOf(const py::object& argument) {
  using Floats = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
  const py::array array = rowsOf(argument, "points", 3);
  std::vector<Eigen::Vector3f> points(static_cast<std::size_t>(array.shape(0)));
  Eigen::Map<Floats> all(points.empty() ? nullptr : points[0].data(), array.shape(0), 3);
  if (py::isinstance<py::array_t<float>>(array))
    all = Eigen::Map<const Floats>(ArrayOf<float>(array).data(), array.shape(0), 3);
  else
    all = Rows(array, "points", 3).values().cast<float>();
  return points;
}

Eigen::Vector3d vectorOf(const py::object& argument, const std::string& name) {
  const py::array array = arrayOfArgument(argument, name);
  if (array.ndim() != 1 || array.shape(0) != 3)
    throw py::value_error(name + ": expected 3 numbers, got an array of shape " + shapeOf(array));
  const Rows rows(py::make_tuple(array), name, 3);
  rows.checkFinite();
  return rows.row(0);
}

Eigen::Isometry3d poseOf(const py::object& argument, const std::string& name) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  if (argument.is_none()) return T;
  const Rows rows(argument, name, 4, 4);
  rows.checkFinite();
  T.matrix() = rows.values();
  const Eigen::Matrix3d R = T.linear();
  if (T.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    throw py::value_error(name + ": its last row is not 0 0 0 1");
  constexpr double kRounding = 1e-3;  // of floats that were multiplied often
  if (!(R.transpose() * R).isIdentity(kRounding) || R.determinant() < 0)
    throw py::value_error(name + ": its upper left 3 x 3 numbers are no rotation");
  return T;
}

void addLabels(LabeledCloud& cloud, const py::object& argument, int numClasses) {
  if (argument.is_none()) return;
  const py::array labels = arrayOfArgument(argument, "labels");
  const char kind = labels.dtype().kind();
  const bool areIds = labels.ndim() == 1 && (kind == 'i' || kind == 'u');
  const bool areSoft = labels.ndim() == 2 && kind == 'f' && labels.shape(1) == numClasses;
  if ((!areIds && !areSoft) || labels.shape(0) != static_cast<py::ssize_t>(cloud.size()))
    throw py::value_error("labels: expected " + std::to_string(cloud.size()) +
                          " whole numbers, or as many rows of " + std::to_string(numClasses) +
                          " probabilities, got " + typeOf(labels) + " of shape " + shapeOf(labels));
  if (areSoft)
    cloud.probabilities = probabilitiesOf(Rows(labels, "labels", numClasses));
  else
    cloud.classes = kind == 'u' ? idsOf<std::uint64_t>(labels, numClasses)
                                : idsOf<std::int64_t>(labels, numClasses);
}

bool isPath(const py::handle& argument) {
  return py::isinstance<py::str>(argument) || py::hasattr(argument, "__fspath__");
}

void refuseClass(const std::string& argument, const std::string& name, const ClassTable& classes) {
  std::vector<std::string> known;
  for (int id = 1; id <= classes.size(); ++id)
    known.push_back(classes.name(static_cast<ClassId>(id)));
  throw py::value_error(argument + ": the map has no class '" + name + "'" +
                        strict_files::didYouMean(name, known));
}

ClassTable classTableOf(const py::object& argument) {
  if (isPath(argument))
    return semantic_types::loadClassTable(argument.cast<std::filesystem::path>());
  ClassTable table;
  if (py::isinstance<py::dict>(argument)) {
    for (const auto& [name, color] : argument.cast<py::dict>())
      table.add(nameOf(name), colorOfArgument(color, nameOf(name)));
  } else if (py::isinstance<py::sequence>(argument)) {
    for (const py::handle& name : argument) table.add(nameOf(name), colorOfNumber(table.size()));
  } else {
    throw py::value_error("classes: expected a file, names, or a dict of colors by name");
  }
  return table;
}

void setAll(const strict_files::OptionList& list, const py::dict& values) {
  for (const auto& [key, value] : values) {
    const auto name = key.cast<std::string>();
    const strict_files::Option* option = list.find(name);
    if (!option) throw py::type_error(strict_files::unknownWord("option", name, list.names()));
    try {
      option->set(textOf(value));
    } catch (const std::invalid_argument& e) {
      throw py::value_error(name + " " + e.what());
    }
  }
}

}  // namespace python
