// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

namespace pcl_bsh::robots {

/// Poses are rigid within this.
inline constexpr double kRigid = 1e-12;

/// Factor of bounds that are made once or are sums of a few terms. Pays for their rounding, and for rotations that are
/// rigid only within kRigid.
inline constexpr double kOutward = 1.0 + 1e-9;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

} // namespace pcl_bsh::robots
