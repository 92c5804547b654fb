// SPDX-License-Identifier: BSD-3-Clause
// The path of a moving cloud as VTK's data.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <Eigen/Geometry>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::vtk {

/// The poses' images of one point of the model, joined by a line. Point arrays: `pose` (its number), `time` (seconds
/// where given, else the pose's number). @param times empty, or one per pose
/// @throws std::invalid_argument when there is another number of times
vtkSmartPointer<vtkPolyData> pathData(const std::vector<Eigen::Isometry3d>& poses,
                                      const std::vector<double>& times = {}, const Point3& point = {0, 0, 0});

} // namespace pcl_bsh::vtk
PCL_BSH_EXPORT_END
