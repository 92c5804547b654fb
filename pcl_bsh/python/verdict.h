// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/query/result.h>

#include <pybind11/pybind11.h>

namespace pcl_bsh::python {

/// The member of pcl_bsh.Verdict, an enum.IntEnum: flags in arrays are compared with it as numbers.
pybind11::object verdictOf(Verdict verdict);

} // namespace pcl_bsh::python
