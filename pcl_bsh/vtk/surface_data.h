// SPDX-License-Identifier: BSD-3-Clause
// Triangles as VTK's data.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/surface/surface_cover.h>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::vtk {

/// A cell per triangle, in float64. Points are the view's records in their order.
/// @throws std::invalid_argument when a triangle names a record that is not in the view
vtkSmartPointer<vtkPolyData> surfaceData(const PointsView& vertices, const std::vector<Triangle>& triangles);

} // namespace pcl_bsh::vtk
PCL_BSH_EXPORT_END
