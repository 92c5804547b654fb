// SPDX-License-Identifier: BSD-3-Clause
// Triangles as VTK's data.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <cstdint>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::vtk {

/// A cell per triangle, in float64. Points are the view's records in their order.
/// @throws std::invalid_argument when a triangle names a record that is not in the view
vtkSmartPointer<vtkPolyData> surfaceData(const PointsView& vertices, const std::vector<Triangle>& triangles);

/// Adds a named array of the cells to what surfaceData() made. @param values one per triangle
/// @throws std::invalid_argument naming the array when there is another number of values
void addTriangleArray(vtkPolyData& surface, const std::string& name, const std::vector<std::uint8_t>& values);
void addTriangleArray(vtkPolyData& surface, const std::string& name, const std::vector<std::int32_t>& values);
void addTriangleArray(vtkPolyData& surface, const std::string& name, const std::vector<float>& values);

} // namespace pcl_bsh::vtk
PCL_BSH_EXPORT_END
