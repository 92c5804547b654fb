// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/vtk/path_data.h>

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <stdexcept>
#include <string>

namespace pcl_bsh::vtk {

vtkSmartPointer<vtkPolyData> pathData(const std::vector<Eigen::Isometry3d>& poses, const std::vector<double>& times,
                                      const Point3& point)
{
  if (!times.empty() && times.size() != poses.size())
    throw std::invalid_argument("times: " + std::to_string(times.size()) + " for " + counted(poses.size(), "pose") +
                                ": give one per pose, or none");
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> line;
  vtkNew<vtkIntArray> pose;
  pose->SetName("pose");
  vtkNew<vtkDoubleArray> time;
  time->SetName("time");
  if (!poses.empty()) line->InsertNextCell(static_cast<int>(poses.size()));
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Eigen::Vector3d at = poses[k] * Eigen::Vector3d(point[0], point[1], point[2]);
    line->InsertCellPoint(points->InsertNextPoint(at.data()));
    pose->InsertNextValue(static_cast<int>(k));
    time->InsertNextValue(times.empty() ? static_cast<double>(k) : times[k]);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(line);
  data->GetPointData()->AddArray(pose);
  data->GetPointData()->AddArray(time);
  return data;
}

} // namespace pcl_bsh::vtk
