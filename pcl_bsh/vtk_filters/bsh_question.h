// SPDX-License-Identifier: BSD-3-Clause
// What a filter is asked: both inputs as the core sees them. Not installed.
#pragma once

#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/vtk_filters/kept_hierarchy.h>
#include <pcl_bsh/vtk_filters/vtkBSHFilter.h>

#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>

#include <functional>
#include <optional>
#include <vector>

struct vtkBSHFilter::Question {
  const pcl_bsh::SphereHierarchy& cloud;
  const pcl_bsh::SphereHierarchy& obstacle;
  const pcl_bsh::vtk::KeptHierarchy& kept_obstacle;
  bool is_surface = false;
  Eigen::Isometry3d pose;                              ///< of the obstacle, or of the frame of its poses
  std::optional<std::vector<Eigen::Isometry3d>> poses; ///< in the cloud's frame
  std::function<bool(double)> progress;
};

namespace pcl_bsh::vtk {

/// Adds a point array. @param value of each point's number
template <class Array, class Value>
void addPointArray(vtkPolyData& data, const char* name, const Value& value)
{
  const auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfTuples(data.GetNumberOfPoints());
  for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i) array->SetValue(i, value(static_cast<std::size_t>(i)));
  data.GetPointData()->AddArray(array);
}

} // namespace pcl_bsh::vtk
