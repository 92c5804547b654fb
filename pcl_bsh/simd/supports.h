// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pcl_bsh {

/// Error of the support of a sphere and slabs in it, towards a place at a distance d: a share of the radii, and one of
/// d. A direction is the sum of its components along normals and of a rest, for any normals, so only rounding and the
/// carried normals err. They err by 2^-18 each, and by some roundings of a length of at most twice the radius.
inline constexpr float kSupportShare = 0x1p-16f;
inline constexpr float kDistanceShare = 0x1p-20f;

} // namespace pcl_bsh
