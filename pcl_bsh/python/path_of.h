// SPDX-License-Identifier: BSD-3-Clause
// Names of files among arguments.
#pragma once

#include <pcl_bsh/python/typed.h>

#include <string>

namespace pcl_bsh::python {

/// A text, or what os.fspath() takes.
inline std::string pathOf(const PathLike& path)
{
  return py::module_::import("os").attr("fsdecode")(path).cast<std::string>();
}

} // namespace pcl_bsh::python
