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

template <class T>
bool isNative(const py::array& array) {
  return array.dtype().is(py::dtype::of<T>()) || array.dtype().equal(py::dtype::of<T>());
}

/** \param Whole the widest type of the labels' kind */
template <class Whole>
std::vector<ClassId> idsOf(const py::array& labels, int numClasses) {
  const bool areBytes = isNative<ClassId>(labels);
  const py::array array = areBytes ? labels : py::array(py::array_t<Whole>::ensure(labels));
  std::vector<ClassId> ids(static_cast<std::size_t>(array.shape(0)));
  const auto read = [&](const auto& at) {
    for (py::ssize_t i = 0; i < at.rows; ++i) {
      const auto label = at(i, 0);
      if (!(label >= 0 && label <= static_cast<Whole>(numClasses)))
        refuse("labels", i, std::to_string(label), "0 (none) to " + std::to_string(numClasses));
      ids[static_cast<std::size_t>(i)] = static_cast<ClassId>(label);
    }
  };
  const auto* data = static_cast<const char*>(array.data());
  if (areBytes)
    read(ArrayView<ClassId>{data, array.shape(0), array.strides(0), 0});
  else
    read(ArrayView<Whole>{data, array.shape(0), array.strides(0), 0});
  return ids;
}

std::vector<float> probabilitiesOf(const Rows& rows, int numClasses) {
  constexpr double kRounding = 0.01;  // of half floats
  std::vector<float> probabilities;
  probabilities.reserve(static_cast<std::size_t>(rows.size() * numClasses));
  rows.visit([&](const auto& at) {
    for (py::ssize_t i = 0; i < at.rows; ++i) {
      double sum = 0;
      for (int k = 0; k < numClasses; ++k) {
        const double q = at(i, k);
        if (!(q >= 0 && q <= 1)) refuse("labels", i, std::to_string(q), "probabilities, 0 to 1");
        probabilities.push_back(static_cast<float>(q));
        sum += q;
      }
      if (sum != 0 && std::fabs(sum - 1) > kRounding)
        refuse("labels", i, "a sum of " + std::to_string(sum), "1, or 0 for no label");
    }
  });
  return probabilities;
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
    : m_name(std::move(name)), m_array(arrayOfArgument(argument, m_name)) {
  const bool fits = m_array.ndim() == 2 && m_array.shape(1) == columns &&
                    m_array.shape(0) == rows.value_or(m_array.shape(0));
  if (!fits || std::string("fiu").find(m_array.dtype().kind()) == std::string::npos)
    throw py::value_error(m_name + ": expected " + (rows ? std::to_string(*rows) : "N") + " x " +
                          std::to_string(columns) + " real numbers, got " + typeOf(m_array) +
                          " of shape " + shapeOf(m_array));
  constexpr std::size_t kBytes = 64;  // of what becomes of a row
  if (static_cast<std::size_t>(m_array.shape(0)) > strict_files::availableMemory() / kBytes)
    throw py::value_error(m_name + ": " + std::to_string(m_array.shape(0)) +
                          " rows are more than memory holds");
  m_areFloats = isNative<float>(m_array);
  if (!m_areFloats && !isNative<double>(m_array)) m_array = py::array_t<double>::ensure(m_array);
}

void Rows::checkFinite() const {
  const py::ssize_t columns = m_array.shape(1);
  visit([&](const auto& at) {
    for (py::ssize_t i = 0; i < at.rows; ++i)
      for (py::ssize_t j = 0; j < columns; ++j)
        if (!std::isfinite(at(i, j)))
          refuse(m_name, i, std::to_string(at(i, j)), "numbers that are finite");
  });
}

std::vector<Eigen::Vector3f> pointsOf(const Rows& rows) {
  std::vector<Eigen::Vector3f> points(static_cast<std::size_t>(rows.size()));
  rows.visit([&](const auto& at) {
    for (py::ssize_t i = 0; i < at.rows; ++i)
      points[static_cast<std::size_t>(i)] = {
          static_cast<float>(at(i, 0)), static_cast<float>(at(i, 1)), static_cast<float>(at(i, 2))};
  });
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
  rows.visit([&T](const auto& at) {
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) T.matrix()(i, j) = at(i, j);
  });
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
    cloud.probabilities = probabilitiesOf(Rows(labels, "labels", numClasses), numClasses);
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
