// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/io/text/length_unit.h>

#include <optional>
#include <string_view>

namespace pcl_bsh::io {

/// The unit of x, y and z by a coordinate system as well-known text, of either version. None for angles, for a unit
/// that has no name here, and where heights have another one than places.
std::optional<LengthUnit> unitOfWkt(std::string_view text);

} // namespace pcl_bsh::io
