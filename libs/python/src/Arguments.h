#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <semantic_types/ClassTable.h>
#include <semantic_types/LabeledCloud.h>
#include <strict_files/OptionList.h>

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace python {

namespace py = pybind11;

/** An array of a type, in C order; one that is so already is not copied. */
template <class T>
using ArrayOf = py::array_t<T, py::array::c_style | py::array::forcecast |
                                   py::detail::npy_api::NPY_ARRAY_ALIGNED_>;

/** Rows of real numbers: an argument that is an array or can become one. */
class Rows {
 public:
  using Values = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /** \throw py::value_error naming the argument, what it is, and what was expected. */
  Rows(const py::object& argument, std::string name, py::ssize_t columns,
       std::optional<py::ssize_t> rows = {});

  py::ssize_t size() const { return m_array.shape(0); }
  Eigen::Map<const Values> values() const {
    return {m_array.data(), m_array.shape(0), m_array.shape(1)};
  }
  /** \throw py::value_error naming the row: a number in it is not finite. */
  void checkFinite() const;
  Eigen::Vector3d row(py::ssize_t row) const { return values().row(row).transpose(); }

 private:
  std::string m_name;
  ArrayOf<double> m_array;
};

/** Points as a map takes them; those that are not finite stay. \throw py::value_error as Rows */
std::vector<Eigen::Vector3f> pointsOf(const py::object& argument);
/** Three numbers that are finite. \throw py::value_error */
Eigen::Vector3d vectorOf(const py::object& argument, const std::string& name);
/** None is the identity. \throw py::value_error it is no rigid transformation. */
Eigen::Isometry3d poseOf(const py::object& argument, const std::string& name);
/** \param labels None, N class ids, or N x K probabilities; the cloud has its N points
 * \throw py::value_error naming the row and the value. */
void addLabels(semantic_types::LabeledCloud& cloud, const py::object& labels, int numClasses);

/** A file of classes, names, or names with their colors. \throw py::value_error */
semantic_types::ClassTable classTableOf(const py::object& argument);
bool isPath(const py::handle& argument);
[[noreturn]] void refuseClass(const std::string& argument, const std::string& name,
                              const semantic_types::ClassTable& classes);

/** Sets options by the names that they have in files.
 * \throw py::type_error naming one that there is not \throw py::value_error naming option and value
 */
void setAll(const strict_files::OptionList& list, const py::dict& values);
template <class T>
void setOptions(T& options, const py::dict& values) {
  strict_files::OptionList list;
  options.describe(list);
  setAll(list, values);
}

/** An array that owns the rows. */
template <class Row>
py::array_t<Row> arrayOf(std::vector<Row> rows) {
  auto owned = std::make_unique<std::vector<Row>>(std::move(rows));
  const auto size = static_cast<py::ssize_t>(owned->size());
  Row* const data = owned->data();
  const py::capsule owner(owned.release(),
                          [](void* p) { delete static_cast<std::vector<Row>*>(p); });
  return py::array_t<Row>(size, data, owner);
}

}  // namespace python
