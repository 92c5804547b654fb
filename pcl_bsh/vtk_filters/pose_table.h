// SPDX-License-Identifier: BSD-3-Clause
// Poses as VTK's tables. Not installed.
#pragma once

#include <Eigen/Geometry>

#include <vtkMatrix4x4.h>
#include <vtkTable.h>

#include <string>
#include <vector>

namespace pcl_bsh::vtk {

/// A pose of each row: 12, 16 or 8 columns of numbers, as files of poses have them (io/poses/pose_file.h).
/// @throws std::invalid_argument naming the row or the column
std::vector<Eigen::Isometry3d> posesOf(vtkTable& table, std::vector<std::string>& warnings);

/// The matrix as a pose. A matrix that is rigid within few printed digits becomes the nearest rigid one. Whether it is
/// rigid is for the query to judge. @param matrix null: the identity
Eigen::Isometry3d poseOf(vtkMatrix4x4* matrix, std::vector<std::string>& warnings);

} // namespace pcl_bsh::vtk
