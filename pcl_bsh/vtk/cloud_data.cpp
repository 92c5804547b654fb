// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/vtk/cloud_data.h>

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>

#include <cmath>
#include <stdexcept>

namespace pcl_bsh::vtk {
namespace {

constexpr const char* index_name = "index";

/// All points as one cell: VTK draws it in one go.
vtkSmartPointer<vtkPolyData> polyVertex(vtkPoints* points)
{
  vtkNew<vtkCellArray> vertices;
  const vtkIdType count = points->GetNumberOfPoints();
  if (count > 0) {
    vertices->InsertNextCell(static_cast<int>(count));
    for (vtkIdType i = 0; i < count; ++i) vertices->InsertCellPoint(i);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetVerts(vertices);
  return data;
}

template <class Array, class T>
void add(vtkPolyData& cloud, const std::string& name, const std::vector<T>& values)
{
  auto* const index = vtkIntArray::SafeDownCast(cloud.GetPointData()->GetArray(index_name));
  if (!index)
    throw std::invalid_argument("array " + name + ": the data has no array 'index': take it from cloudData()");
  vtkNew<Array> array;
  array->SetName(name.c_str());
  array->SetNumberOfTuples(cloud.GetNumberOfPoints());
  for (vtkIdType i = 0; i < cloud.GetNumberOfPoints(); ++i) {
    const auto record = static_cast<std::size_t>(index->GetValue(i));
    if (record >= values.size())
      throw std::invalid_argument("array " + name + ": " + counted(values.size(), "value") + ", and none for point " +
                                  std::to_string(record) + ": give one per point");
    array->SetValue(i, values[record]);
  }
  cloud.GetPointData()->AddArray(array);
}

/// These points, with their arrays.
vtkSmartPointer<vtkPolyData> picked(vtkPolyData& cloud, vtkIdList& ids)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(cloud.GetPoints()->GetDataType());
  cloud.GetPoints()->GetPoints(&ids, points);
  vtkSmartPointer<vtkPolyData> data = polyVertex(points);
  data->GetPointData()->CopyAllocate(cloud.GetPointData(), ids.GetNumberOfIds());
  for (vtkIdType i = 0; i < ids.GetNumberOfIds(); ++i)
    data->GetPointData()->CopyData(cloud.GetPointData(), ids.GetId(i), i);
  return data;
}

} // namespace

vtkSmartPointer<vtkPolyData> cloudData(const PointsView& view)
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkIntArray> index;
  index->SetName(index_name);
  points->SetDataType(view.scalar == Scalar::float32 ? VTK_FLOAT : VTK_DOUBLE);
  points->Allocate(static_cast<vtkIdType>(view.size()));
  index->Allocate(static_cast<vtkIdType>(view.size()));
  for (std::size_t i = 0; i < view.size(); ++i) {
    const Point3 p = view.point(view.record(i));
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) continue;
    points->InsertNextPoint(p.data());
    index->InsertNextValue(static_cast<int>(view.record(i)));
  }
  vtkSmartPointer<vtkPolyData> data = polyVertex(points);
  data->GetPointData()->AddArray(index);
  return data;
}

void addArray(vtkPolyData& cloud, const std::string& name, const std::vector<std::uint8_t>& values)
{
  add<vtkUnsignedCharArray>(cloud, name, values);
}
void addArray(vtkPolyData& cloud, const std::string& name, const std::vector<std::int32_t>& values)
{
  add<vtkIntArray>(cloud, name, values);
}
void addArray(vtkPolyData& cloud, const std::string& name, const std::vector<float>& values)
{
  add<vtkFloatArray>(cloud, name, values);
}

vtkSmartPointer<vtkPolyData> subset(vtkPolyData& cloud, const std::vector<std::uint8_t>& keep)
{
  auto* const index = vtkIntArray::SafeDownCast(cloud.GetPointData()->GetArray(index_name));
  if (!index) throw std::invalid_argument("subset: the data has no array 'index': take it from cloudData()");
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < cloud.GetNumberOfPoints(); ++i)
    if (keep.at(static_cast<std::size_t>(index->GetValue(i))) != 0) ids->InsertNextId(i);
  return picked(cloud, *ids);
}

vtkSmartPointer<vtkPolyData> thinned(vtkPolyData& cloud, vtkIdType most)
{
  const vtkIdType count = cloud.GetNumberOfPoints();
  if (count <= most) return &cloud;
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < most; ++i) ids->InsertNextId(i * count / most);
  return picked(cloud, *ids);
}

} // namespace pcl_bsh::vtk
