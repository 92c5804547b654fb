// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/python/arrays/array_layout.h>

#include <algorithm>
#include <array>
#include <vector>

namespace pcl_bsh::python {
namespace {

InvalidInput wrongType(const std::string& name, const py::dtype& type)
{
  return InvalidInput(Input::points, name,
                      "are " + nameOfType(type) + ", not float32 or float64 in this machine's order",
                      "convert them, e.g. by numpy.asarray(..., numpy.float64)");
}

/// Where coordinates lie in memory, as NumPy says it.
struct Layout {
  Scalar scalar = Scalar::float32;
  py::ssize_t count = 0;
  py::ssize_t stride = 0;
  std::array<py::ssize_t, 3> offset = {};
};

py::ssize_t widthOf(Scalar scalar)
{
  return scalar == Scalar::float32 ? sizeof(float) : sizeof(double);
}

/// Whether a PointsView can say this: rows forwards, no two coordinates over each other.
bool isDescribable(const Layout& layout)
{
  const py::ssize_t width = widthOf(layout.scalar);
  if (layout.count == 0) return false;
  if (layout.count > 1 && layout.stride < width) return false;
  std::array<py::ssize_t, 3> at = layout.offset;
  std::sort(at.begin(), at.end());
  if (at[1] - at[0] < width || at[2] - at[1] < width) return false;
  const py::ssize_t step = layout.count > 1 ? layout.stride : 0;
  const bool by_rows = layout.count == 1 || step >= at[2] - at[0] + width;
  const py::ssize_t column = (layout.count - 1) * step + width;
  return by_rows || (at[1] - at[0] >= column && at[2] - at[1] >= column);
}

/// The step from each record to the next, in the order of their indices; 0 where they have no common one.
py::ssize_t strideOf(const py::array& array)
{
  py::ssize_t count = 1, stride = array.itemsize();
  for (py::ssize_t k = array.ndim() - 1; k >= 0; --k) {
    if (array.shape(k) == 1) continue;
    if (count == 1) stride = array.strides(k);
    if (array.strides(k) != stride * count) return 0;
    count *= array.shape(k);
  }
  return stride;
}

/// Records with fields x, y, z of one type; of any shape, taken in order.
Layout layoutOfRecords(const std::string& name, const py::array& array)
{
  const py::object fields = array.dtype().attr("fields");
  Layout layout;
  std::optional<Scalar> scalar;
  for (std::size_t k = 0; k < 3; ++k) {
    const py::str axis(std::string(1, "xyz"[k]));
    if (!fields.contains(axis))
      throw InvalidInput(Input::points, name, "are records without field " + std::string(axis),
                         "give fields x, y, z, or an array of shape (n, 3)");
    const py::tuple field = fields[axis];
    const auto type = py::reinterpret_borrow<py::dtype>(field[0]);
    const std::optional<Scalar> own = scalarOf(type);
    if (!own) throw wrongType(name, type);
    if (scalar && *own != *scalar) throw wrongType(name, array.dtype());
    scalar = own;
    layout.offset[k] = field[1].cast<py::ssize_t>();
  }
  layout.scalar = *scalar;
  layout.count = array.size();
  layout.stride = strideOf(array);
  return layout;
}

Layout layoutOfRows(const std::string& name, const py::array& array)
{
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw InvalidInput(Input::points, name, "have shape " + shapeOf(array), "give an array of shape (n, 3)");
  const std::optional<Scalar> scalar = scalarOf(array.dtype());
  if (!scalar) throw wrongType(name, array.dtype());
  Layout layout{*scalar, array.shape(0), array.strides(0), {}};
  for (std::size_t k = 0; k < 3; ++k) layout.offset[k] = static_cast<py::ssize_t>(k) * array.strides(1);
  return layout;
}

Layout layoutOf(const std::string& name, const py::array& array)
{
  return array.dtype().has_fields() ? layoutOfRecords(name, array) : layoutOfRows(name, array);
}

/// The coordinates alone, row after row.
py::array copyOf(const py::array& array, Scalar scalar)
{
  const py::module_ numpy = py::module_::import("numpy");
  const py::dtype type = scalar == Scalar::float32 ? py::dtype::of<float>() : py::dtype::of<double>();
  const bool records = array.dtype().has_fields();
  py::array copy(type, std::vector<py::ssize_t>{records ? array.size() : array.shape(0), 3});
  for (py::ssize_t k = 0; k < 3; ++k) {
    const py::object column = records ? array[py::str(std::string(1, "xyz"[k]))].attr("reshape")(-1)
                                      : py::object(array[py::make_tuple(py::ellipsis(), k)]);
    copy[py::make_tuple(py::ellipsis(), k)] = column;
  }
  return copy;
}

} // namespace

std::string shapeOf(const py::array& array)
{
  return py::str(array.attr("shape"));
}

std::string nameOfType(const py::dtype& type)
{
  return py::str(py::handle(type));
}

py::array asArray(const std::string& name, const py::object& object, Input input)
{
  if (py::isinstance<py::array>(object)) {
    static const py::handle masked = py::object(py::module_::import("numpy").attr("ma").attr("MaskedArray")).release();
    if (py::isinstance(object, masked))
      throw InvalidInput(input, name, "are masked", "say what masked points are, e.g. none by .filled(numpy.nan)");
    return py::reinterpret_borrow<py::array>(object);
  }
  py::array array = py::array::ensure(object);
  if (!array) throw InvalidInput(input, name, "is no array", "give a NumPy array");
  return array;
}

std::optional<Scalar> scalarOf(const py::dtype& type)
{
  if (type.kind() != 'f' || (type.byteorder() != '=' && type.byteorder() != '|')) return std::nullopt;
  if (type.itemsize() == sizeof(float)) return Scalar::float32;
  if (type.itemsize() == sizeof(double)) return Scalar::float64;
  return std::nullopt;
}

PointsView viewOfArray(const std::string& name, py::array& array, bool copy, bool& in_place)
{
  Layout layout = layoutOf(name, array);
  in_place = !copy && isDescribable(layout);
  if (!in_place) {
    array = copyOf(array, layout.scalar);
    layout = layoutOf(name, array);
  }
  const py::ssize_t first = *std::min_element(layout.offset.begin(), layout.offset.end()); // columns may run backwards
  PointsView view;
  view.data = static_cast<const char*>(array.data()) + first;
  view.count = static_cast<std::size_t>(layout.count);
  view.stride = static_cast<std::size_t>(std::max(layout.stride, widthOf(layout.scalar)));
  for (std::size_t k = 0; k < 3; ++k) view.offset[k] = static_cast<std::size_t>(layout.offset[k] - first);
  view.scalar = layout.scalar;
  return view;
}

} // namespace pcl_bsh::python
