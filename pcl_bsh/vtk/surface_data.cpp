// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk/surface_data.h>

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>

#include <stdexcept>
#include <string>

namespace pcl_bsh::vtk {

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

} // namespace pcl_bsh::vtk
