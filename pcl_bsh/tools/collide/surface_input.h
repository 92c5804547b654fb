// SPDX-License-Identifier: BSD-3-Clause
// An input with faces: what is compared are balls that cover its triangles, and what is flagged are the triangles.
#pragma once

#include "options.h"

#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/surface/triangle_answers.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <functional>

namespace pcl_bsh::cli {

/// The cover of a mesh, triangles apart, to the tolerance of the settings or the usual one for this clearance.
/// @param progress as SurfaceRequest has it
/// @param warnings what users should know of the cover is appended, a line each
/// @throws files::FileError naming the file where it cannot be covered
SurfaceCover coverInput(const std::filesystem::path& file, const PointsView& vertices,
                        const std::vector<Triangle>& triangles, const io::SurfaceSettings& settings, double clearance,
                        const std::function<bool(double)>& progress, std::vector<std::string>& warnings);

/// Refuses what is told of points alone: lists of clashes, distances of all, fields of sigmas; and outputs that cannot
/// hold triangles. @throws std::invalid_argument, files::FileError
void requireForSurface(const CollideOptions& options);

/// The mesh with what was found as properties of its faces, or the triangles that are kept.
/// @return how many triangles were written
std::size_t writeSurface(const CollideOptions& options, io::Mesh mesh, const io::Viewpoint& viewpoint,
                         const TrajectoryResult& found);

} // namespace pcl_bsh::cli
