// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_actor.h"

#include "actors.h"

#include <pcl_bsh/vtk/cloud_data.h>

#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh::view {
namespace {

constexpr vtkIdType points_while_moving = 300'000;

vtkIntArray& recordsOf(vtkPolyData& data)
{
  return *vtkIntArray::SafeDownCast(data.GetPointData()->GetArray("index"));
}

vtkUnsignedCharArray& colorsOf(vtkPolyData& data)
{
  return *vtkUnsignedCharArray::SafeDownCast(data.GetPointData()->GetScalars());
}

Color bytes(const double* color)
{
  return {static_cast<unsigned char>(std::lround(255 * color[0])),
          static_cast<unsigned char>(std::lround(255 * color[1])),
          static_cast<unsigned char>(std::lround(255 * color[2]))};
}

void setData(vtkActor& actor, vtkPolyData* data)
{
  vtkPolyDataMapper::SafeDownCast(actor.GetMapper())->SetInputData(data);
}
} // namespace

CloudActor::CloudActor(const PointsView& points, vtkRenderer& renderer, const Color& marked)
: data_(vtk::cloudData(points)),
  marked_(vtkSmartPointer<vtkPolyData>::New()),
  points_(actorOf(data_)),
  marks_(actorOf(marked_))
{
  // Sparse clouds need larger points to be seen as surfaces.
  const vtkIdType count = data_->GetNumberOfPoints();
  points_->GetProperty()->SetPointSize(count > 300'000 ? 1.5f : count > 30'000 ? 2.0f : 3.0f);
  marks_->GetProperty()->SetPointSize(6.0f);
  setColor(*marks_, marked);
  marks_->GetMapper()->SetRelativeCoincidentTopologyPointOffsetParameter(-8.0); // before the same points, dimmed
  renderer.AddActor(points_);
  renderer.AddActor(marks_);
}

void CloudActor::setPoints(const PointsView& points)
{
  data_ = vtk::cloudData(points);
  few_ = nullptr;
  setData(*points_, data_);
}

void CloudActor::paint(const std::vector<Color>& colors)
{
  setColors(*data_, colors);
  few_ = nullptr;
}

void CloudActor::paint(const Color& color)
{
  const double* const bounds = data_->GetBounds();
  const double low = bounds[4], height = std::max(bounds[5] - bounds[4], std::numeric_limits<double>::min());
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName("colors");
  colors->SetNumberOfComponents(3);
  colors->SetNumberOfTuples(data_->GetNumberOfPoints());
  for (vtkIdType i = 0; i < data_->GetNumberOfPoints(); ++i) {
    double p[3];
    data_->GetPoint(i, p);
    const double share = 0.55 + 0.45 * (p[2] - low) / height;
    for (int k = 0; k < 3; ++k)
      colors->SetTypedComponent(i, k, static_cast<unsigned char>(color[static_cast<std::size_t>(k)] * share));
  }
  data_->GetPointData()->SetScalars(colors);
  few_ = nullptr;
}

void CloudActor::mark(const std::vector<std::uint8_t>& flags, const std::vector<Color>& colors)
{
  few_ = nullptr;
  marked_ = flags.empty() ? vtkSmartPointer<vtkPolyData>::New() : vtk::subset(*data_, flags);
  if (flags.empty()) marked_->SetPoints(vtkNew<vtkPoints>());
  marked_->GetPointData()->SetActiveScalars(nullptr);
  marked_->GetPointData()->RemoveArray("colors");
  if (!colors.empty() && !flags.empty()) setColors(*marked_, colors);
  setData(*marks_, marked_);

  // The same points among all others: what is marked must not shine through its mark in another colour.
  if (flags.empty()) return;
  const Color mark = bytes(marks_->GetProperty()->GetColor());
  vtkIntArray& records = recordsOf(*data_);
  vtkUnsignedCharArray& shown = colorsOf(*data_);
  for (vtkIdType i = 0; i < data_->GetNumberOfPoints(); ++i) {
    const auto record = static_cast<std::size_t>(records.GetValue(i));
    if (flags[record] != 0) shown.SetTypedTuple(i, colors.empty() ? mark.data() : colors[record].data());
  }
  shown.Modified();
}

void CloudActor::place(const Eigen::Isometry3d& pose)
{
  const auto matrix = matrixOf(pose);
  points_->SetUserMatrix(matrix);
  marks_->SetUserMatrix(matrix);
}

void CloudActor::setMoving(bool moving)
{
  if (moving && !few_) {
    few_ = vtk::thinned(*data_, points_while_moving);
    few_->GetPointData()->SetActiveScalars("colors");
  }
  setData(*points_, moving ? few_ : data_);
}
std::optional<std::uint32_t> CloudActor::recordOf(const vtkProp* prop, vtkIdType id) const
{
  if (prop != points_.Get() && prop != marks_.Get()) return std::nullopt;
  vtkPolyData& data =
      *vtkPolyData::SafeDownCast((prop == marks_.Get() ? marks_ : points_)->GetMapper()->GetInputDataObject(0, 0));
  if (id < 0 || id >= data.GetNumberOfPoints()) return std::nullopt;
  return static_cast<std::uint32_t>(recordsOf(data).GetValue(id));
}

} // namespace pcl_bsh::view
