// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/python/arrays/array_lock.h>

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace pcl_bsh::python {
namespace {

namespace py = pybind11;

constexpr int kWriteable = py::detail::npy_api::NPY_ARRAY_WRITEABLE_;

void setWriteable(const py::array& array, bool writeable)
{
  int& flags = py::detail::array_proxy(array.ptr())->flags;
  flags = writeable ? flags | kWriteable : flags & ~kWriteable;
}

/// All locks, by what their memory belongs to. Never destroyed: locks may end after the interpreter.
auto& locksByRoot()
{
  static auto& locks = *new std::unordered_multimap<const PyObject*, ArrayLock*>;
  return locks;
}

/// The memory from the first byte of an array to behind its last.
std::pair<const char*, const char*> extentOf(const py::array& array)
{
  const auto* first = static_cast<const char*>(array.data());
  if (array.size() == 0) return {first, first};
  const char* last = first;
  for (py::ssize_t k = 0; k < array.ndim(); ++k)
    (array.strides(k) < 0 ? first : last) += (array.shape(k) - 1) * array.strides(k);
  return {first, last + array.itemsize()};
}

/// Whether two arrays have no byte in common: they lie apart, or in other parts of rows of one length. Calls no Python,
/// so that the garbage collector does not run meanwhile.
bool areApart(const py::array& a, const py::array& b)
{
  const auto [first_a, last_a] = extentOf(a);
  const auto [first_b, last_b] = extentOf(b);
  if (first_a >= last_b || first_b >= last_a) return true;
  if (a.ndim() == 0 || b.ndim() == 0 || a.strides(0) != b.strides(0) || a.strides(0) <= 0) return false;
  const py::ssize_t row = a.strides(0);
  const py::ssize_t width_a = last_a - first_a - (a.shape(0) - 1) * row;
  const py::ssize_t width_b = last_b - first_b - (b.shape(0) - 1) * row;
  const py::ssize_t offset = ((first_b - first_a) % row + row) % row;
  return offset >= width_a && offset + width_b <= row;
}

} // namespace

py::object baseOf(const py::object& object)
{
  if (py::isinstance<py::array>(object)) return py::reinterpret_borrow<py::array>(object).base();
  if (PyMemoryView_Check(object.ptr())) return py::reinterpret_borrow<py::object>(PyMemoryView_GET_BASE(object.ptr()));
  py::object base = py::getattr(object, "base", py::object()); // as NumPy's as_strided() makes it
  return base && py::isinstance<py::array>(base) ? base : py::object();
}

ArrayLock::ArrayLock(const py::array& array) : array_(array)
{
  std::vector<py::object> shown;
  const auto is_known = [&](const py::object& object) {
    return std::any_of(shown.begin(), shown.end(), [&](auto& other) { return other.is(object); });
  };
  for (py::object next = array; next && !is_known(next); next = baseOf(next)) shown.push_back(next);
  root_ = shown.back().ptr();
  for (const py::object& object : shown) {
    if (!py::isinstance<py::array>(object)) continue;
    const auto held = py::reinterpret_borrow<py::array>(object);
    if (held.writeable()) locked_.push_back(held); // else another lock cleared it, or its owner
  }
  locksByRoot().emplace(root_, this);
  for (const py::array& held : locked_) setWriteable(held, false);
}

ArrayLock::~ArrayLock()
{
  const auto [first, last] = locksByRoot().equal_range(root_);
  locksByRoot().erase(std::find_if(first, last, [&](auto& lock) { return lock.second == this; }));
  const auto [others, end] = locksByRoot().equal_range(root_);
  for (py::array& held : locked_) {
    const auto heir = std::find_if(others, end, [&](auto& lock) { return lock.second->reads(held); });
    if (heir == end)
      setWriteable(held, true);
    else if (held.ref_count() > 1) // else nobody can write to it
      heir->second->locked_.push_back(std::move(held));
  }
}

bool ArrayLock::reads(const py::array& array) const
{
  return !areApart(array_, array);
}

void ArrayLock::addReferences(std::vector<PyObject*>& references) const
{
  references.push_back(array_.ptr());
  for (const py::array& held : locked_) references.push_back(held.ptr());
}

} // namespace pcl_bsh::python
