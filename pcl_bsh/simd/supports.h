// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pcl_bsh {

/// How far a support of points at a distance d may be off, of a sphere and slabs in it: a share of their radii, and of
/// d. A direction is the sum of its parts along normals, whatever these are, and of a rest, so that only rounding and
/// what carries normals count: 2^-18 each, and some roundings of what is no longer than twice the radius.
inline constexpr float kSupportShare = 0x1p-16f;
inline constexpr float kDistanceShare = 0x1p-20f;

} // namespace pcl_bsh
