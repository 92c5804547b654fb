// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/simd/roundings.h>

namespace pcl_bsh {

/// Roundings of bounds of distances between spheres, relative to the sum of their centres' distance, radii and reach.
/// The root of a squared distance has two and a half roundings and its own; radii have three. Two sums and a factor
/// follow. Proved in test/proof/distances.g.
inline constexpr int kBoundRoundings = 7;
inline constexpr float kBoundMargin = static_cast<float>(relativeError(kBoundRoundings));

} // namespace pcl_bsh
