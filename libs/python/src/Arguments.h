#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <semantic_types/ClassTable.h>
#include <semantic_types/LabeledCloud.h>
#include <strict_files/OptionList.h>

#include <Eigen/Geometry>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace python {

namespace py = pybind11;

/** Numbers of a numpy array that stay where they are, of any layout. */
template <class T>
struct ArrayView {
  const char* data;
  py::ssize_t rows, rowStride, columnStride;

  T operator()(py::ssize_t row, py::ssize_t column) const {
    T value;  // which need not be aligned
    std::memcpy(&value, data + row * rowStride + column * columnStride, sizeof(T));
    return value;
  }
};

/** Rows of real numbers: an argument that is an array or can become one. Floats and doubles of the
 * machine's byte order are not copied. */
class Rows {
 public:
  /** \throw py::value_error naming the argument, what it is, and what was expected. */
  Rows(const py::object& argument, std::string name, py::ssize_t columns,
       std::optional<py::ssize_t> rows = {});

  py::ssize_t size() const { return m_array.shape(0); }
  /** Calls use(an ArrayView). */
  template <class F>
  auto visit(const F& use) const {
    return m_areFloats ? use(view<float>()) : use(view<double>());
  }
  /** \throw py::value_error naming the row: a number in it is not finite. */
  void checkFinite() const;
  Eigen::Vector3d row(py::ssize_t row) const {
    return visit(
        [row](const auto& at) { return Eigen::Vector3d(at(row, 0), at(row, 1), at(row, 2)); });
  }

 private:
  template <class T>
  ArrayView<T> view() const {
    return {static_cast<const char*>(m_array.data()), size(), m_array.strides(0),
            m_array.strides(1)};
  }

  std::string m_name;
  py::array m_array;
  bool m_areFloats;
};

/** Points as a map takes them; those that are not finite stay. */
std::vector<Eigen::Vector3f> pointsOf(const Rows& rows);
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
