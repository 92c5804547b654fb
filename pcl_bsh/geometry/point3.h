// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace pcl_bsh {

/// Three coordinates in double: exact for float32 and float64 input alike.
using Point3 = std::array<double, 3>;

} // namespace pcl_bsh
