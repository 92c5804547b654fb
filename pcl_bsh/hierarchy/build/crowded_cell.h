// SPDX-License-Identifier: BSD-3-Clause
// Cells so crowded that a voxel's float coordinates hardly tell their points apart: many points of one place, or clouds
// of several scales, such as powers of two down to the smallest. They are ordered by the coordinates as given.
#pragma once

#include <pcl_bsh/hierarchy/storage.h>

namespace pcl_bsh {

/// A cell is crowded when it holds more points than a leaf and is smaller than this times its voxel's reach.
inline constexpr double kCrowdedExtent = 0x1p-18;

/// Orders points [begin, end) of a voxel by median splits of the coordinates as given, and appends the nodes above
/// them. Points of one place (and radius) share a leaf, however many they are, the smallest record number first.
/// @return the index of the node above them all.
std::uint32_t growCrowdedCell(const PointsView& view, PointRecord* points, std::uint32_t begin, std::uint32_t end,
                              std::vector<Node>& nodes);

/// For a voxel with crowded cells: the spheres of small children, around the points as given; of child i of node n at
/// [kNodeChildren * n + i].
std::vector<GivenSphere> givenSpheres(const Voxel& voxel, const PointsView& view);

/// The sphere of a child in the cloud's own frame: as given where that is known or quickly found, else as stored.
GivenSphere givenSphereOf(const PointsView& view, const Voxel& voxel, const Node& node, std::uint32_t child);

/// The sphere of a child in the cloud's own frame, as stored.
GivenSphere storedSphere(const LocalFrame& frame, const Node& node, std::uint32_t child);

} // namespace pcl_bsh
