// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/vtk/surface_data.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <stdexcept>

namespace pcl_bsh::vtk {
namespace {

template <class Array, class T>
void addToCells(vtkPolyData& surface, const std::string& name, const std::vector<T>& values)
{
  if (values.size() != static_cast<std::size_t>(surface.GetNumberOfCells()))
    throw std::invalid_argument("array " + name + ": " + counted(values.size(), "value") + " for " +
                                counted(static_cast<std::uint64_t>(surface.GetNumberOfCells()), "triangle") +
                                ": give one per triangle");
  vtkNew<Array> array;
  array->SetName(name.c_str());
  array->SetNumberOfTuples(surface.GetNumberOfCells());
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  surface.GetCellData()->AddArray(array);
}

} // namespace

vtkSmartPointer<vtkPolyData> surfaceData(const PointsView& vertices, const std::vector<Triangle>& triangles)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(vertices.count));
  for (std::uint32_t i = 0; i < vertices.count; ++i)
    points->SetPoint(static_cast<vtkIdType>(i), vertices.point(i).data());
  vtkNew<vtkCellArray> cells;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    cells->InsertNextCell(3);
    for (const std::uint32_t record : triangles[t]) {
      if (record >= vertices.count)
        throw std::invalid_argument("triangle " + std::to_string(t) + ": names vertex " + std::to_string(record) +
                                    " of " + std::to_string(vertices.count));
      cells->InsertCellPoint(record);
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(cells);
  return data;
}

void addTriangleArray(vtkPolyData& surface, const std::string& name, const std::vector<std::uint8_t>& values)
{
  addToCells<vtkUnsignedCharArray>(surface, name, values);
}
void addTriangleArray(vtkPolyData& surface, const std::string& name, const std::vector<std::int32_t>& values)
{
  addToCells<vtkIntArray>(surface, name, values);
}
void addTriangleArray(vtkPolyData& surface, const std::string& name, const std::vector<float>& values)
{
  addToCells<vtkFloatArray>(surface, name, values);
}

} // namespace pcl_bsh::vtk
