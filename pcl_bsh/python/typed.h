// SPDX-License-Identifier: BSD-3-Clause
// Python objects whose types the module's signatures name. The package's stubs are made from these signatures.
#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstddef>
#include <string>

namespace pcl_bsh::python {

namespace py = pybind11;
using namespace pybind11::literals;

template <std::size_t size>
struct TypeText {
  constexpr TypeText(const char (&text)[size]) { std::copy_n(text, size, chars); }
  char chars[size] = {};
};

inline bool isAny(py::handle /*object*/)
{
  return true;
}

/// Any Python object, of a type that signatures name.
/// @tparam type in the words of Python's typing, and of numpy.typing as npt
/// @tparam accepts whether an overload with this parameter takes an argument
template <TypeText type, bool (*accepts)(py::handle) = isAny>
class As : public py::object {
public:
  using py::object::object;
  As() = default;
  As(const py::object& any) : py::object(any) {}
  static bool check_(py::handle object) { return accepts(object); }
};

using ArrayLike = As<"npt.ArrayLike">;
using OptionalArray = As<"Optional[npt.ArrayLike]">;
using PoseLike = As<"Optional[npt.ArrayLike]">;
using PoseUncertaintyLike = As<"Union[None, str, npt.ArrayLike]">;
using AccuracyLike = As<"Union[None, str, Accuracy]">;
using ProgressLike = As<"Optional[Callable[[float], Any]]">;
using PathLike = As<"Union[str, os.PathLike[str]]">;
using Records = As<"npt.NDArray[np.void]">;

/// The path in a text, or in anything that os.fspath() takes.
inline std::string pathOf(const PathLike& path)
{
  return py::module_::import("os").attr("fsdecode")(path).cast<std::string>();
}

} // namespace pcl_bsh::python

template <pcl_bsh::python::TypeText text, bool (*accepts)(pybind11::handle)>
struct pybind11::detail::handle_type_name<pcl_bsh::python::As<text, accepts>> {
  static constexpr auto name = const_name(text.chars);
};
