// SPDX-License-Identifier: BSD-3-Clause
// Collision flags as a field of the cloud, beside all it had.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pcl_bsh {

/// The field that holds collision flags: UINT8, 1 = collides.
inline constexpr const char* collision_field_name = "collision";

/// A copy of the cloud with one more UINT8 field at the end of each record; every other byte is kept. A UINT8 field of
/// that name which is there already takes the new values instead.
/// @param values one per point
/// @throws std::invalid_argument naming what is wrong: a cloud that viewOf() refuses, a number of values that is not
/// the
///   number of points, a field of that name but of another type
pcl::PCLPointCloud2 withField(const pcl::PCLPointCloud2& cloud, const std::string& name,
                              const std::vector<std::uint8_t>& values);

} // namespace pcl_bsh
