// SPDX-License-Identifier: BSD-3-Clause
// Clouds, and what is known of their points, as VTK's data.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <cstdint>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::vtk {

/// The finite points of a view as one poly-vertex cell, in the view's scalar type. Point array `index`: the point's
/// record number, by which the functions below find its value.
vtkSmartPointer<vtkPolyData> cloudData(const PointsView& view);

/// Adds a named array to what cloudData() made. @param values one per record of the view
/// @throws std::invalid_argument naming the array when there are too few values
void addArray(vtkPolyData& cloud, const std::string& name, const std::vector<std::uint8_t>& values);
void addArray(vtkPolyData& cloud, const std::string& name, const std::vector<std::int32_t>& values);
void addArray(vtkPolyData& cloud, const std::string& name, const std::vector<float>& values);

/// The points i of a cloud's data with keep[record] != 0, with their arrays.
vtkSmartPointer<vtkPolyData> subset(vtkPolyData& cloud, const std::vector<std::uint8_t>& keep);

/// Some evenly chosen points of a cloud's data, at most so many, with their arrays. The data itself where it is small.
vtkSmartPointer<vtkPolyData> thinned(vtkPolyData& cloud, vtkIdType most);

} // namespace pcl_bsh::vtk
PCL_BSH_EXPORT_END
