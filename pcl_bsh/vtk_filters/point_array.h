// SPDX-License-Identifier: BSD-3-Clause
// Not installed.
#pragma once

#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <cstddef>
#include <vector>

namespace pcl_bsh::vtk {

/// Adds a point array. @param value called with the number of a point, returns its value
template <class Array, class Value>
void addPointArray(vtkPolyData& data, const char* name, const Value& value)
{
  const auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfTuples(data.GetNumberOfPoints());
  for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i) array->SetValue(i, value(static_cast<std::size_t>(i)));
  data.GetPointData()->AddArray(array);
}

/// Adds an array from a vector that has a value for each point.
template <class Array, class T>
void addPointArray(vtkPolyData& data, const char* name, const std::vector<T>& values)
{
  addPointArray<Array>(data, name, [&](std::size_t i) { return values[i]; });
}

} // namespace pcl_bsh::vtk
