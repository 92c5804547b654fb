// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/hierarchy/points_view.h>

#include <string>

namespace pcl_bsh {

/// Checks that a view can be read as points. @param name what the message begins with
/// @throws std::invalid_argument naming the value: no data, too many records or indices, records or coordinates that
///   lie over each other, an index outside the view.
void checkView(const std::string& name, const PointsView& view);

/// Radii and uncertainties, of all points and of all records: finite and >= 0. @throws std::invalid_argument
void checkLengths(const std::string& name, const PointsView& view);

} // namespace pcl_bsh
