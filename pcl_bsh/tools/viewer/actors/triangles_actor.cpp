// SPDX-License-Identifier: BSD-3-Clause
#include "triangles_actor.h"

#include "actors.h"
#include "surface_actor.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>

namespace pcl_bsh::viewer {
namespace {

void setCellColors(vtkPolyData& data, const std::vector<Color>& colors)
{
  vtkNew<vtkUnsignedCharArray> array;
  array->SetName("colors");
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(colors.size()));
  for (std::size_t i = 0; i < colors.size(); ++i) array->SetTypedTuple(static_cast<vtkIdType>(i), colors[i].data());
  data.GetCellData()->SetScalars(array);
}

/// The flagged triangles, each with corners of its own: bounds are theirs alone.
vtkSmartPointer<vtkPolyData> someOf(vtkPolyData& data, const std::vector<std::uint8_t>& flags)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkIdList> corners;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (flags[i] == 0) continue;
    data.GetCellPoints(static_cast<vtkIdType>(i), corners);
    cells->InsertNextCell(3);
    for (vtkIdType k = 0; k < 3; ++k) cells->InsertCellPoint(points->InsertNextPoint(data.GetPoint(corners->GetId(k))));
  }
  auto some = vtkSmartPointer<vtkPolyData>::New();
  some->SetPoints(points);
  some->SetPolys(cells);
  return some;
}

} // namespace

TrianglesActor::TrianglesActor(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& color,
                               const Color& marked)
: marked_(vtkSmartPointer<vtkPolyData>::New()),
  faces_(addSurface(viewed, renderer, color)),
  outlines_(actorOf(marked_)),
  marked_color_(marked),
  colors_(viewed.parts(), color)
{
  data_ = vtkPolyDataMapper::SafeDownCast(faces_->GetMapper())->GetInput();
  faces_->PickableOn();
  outlines_->GetProperty()->SetRepresentationToWireframe();
  outlines_->GetProperty()->SetLineWidth(2.5f);
  outlines_->PickableOff();
  renderer.AddActor(outlines_);
  show();
}

void TrianglesActor::paint(const std::vector<Color>& colors)
{
  colors_ = colors;
  show();
}

void TrianglesActor::paint(const Color& color, const ColorRange* /*heights*/)
{
  paint(std::vector<Color>(colors_.size(), color));
}

void TrianglesActor::mark(const std::vector<std::uint8_t>& flags, const std::vector<Color>& colors)
{
  flags_ = flags;
  marked_colors_ = colors;
  show();
}

void TrianglesActor::show()
{
  std::vector<Color> shown = colors_, outlined;
  for (std::size_t i = 0; i < flags_.size(); ++i) {
    if (flags_[i] == 0) continue;
    shown[i] = marked_colors_.empty() ? marked_color_ : marked_colors_[i];
    outlined.push_back(shown[i]);
  }
  setCellColors(*data_, shown);
  marked_ = someOf(*data_, flags_);
  setCellColors(*marked_, outlined);
  vtkPolyDataMapper::SafeDownCast(outlines_->GetMapper())->SetInputData(marked_);
}

void TrianglesActor::place(const Eigen::Isometry3d& pose)
{
  const auto matrix = matrixOf(pose);
  faces_->SetUserMatrix(matrix);
  outlines_->SetUserMatrix(matrix);
}

void TrianglesActor::cut(const Cut& plane)
{
  viewer::cut(*faces_, plane);
  viewer::cut(*outlines_, plane);
}

void TrianglesActor::setVisible(bool visible)
{
  for (vtkActor* actor : {faces_.Get(), outlines_.Get()}) actor->SetVisibility(visible);
}

void TrianglesActor::remove(vtkRenderer& renderer)
{
  for (vtkActor* actor : {faces_.Get(), outlines_.Get()}) renderer.RemoveActor(actor);
}

void TrianglesActor::offerTo(vtkPicker& /*points*/, vtkPicker& triangles) const
{
  triangles.AddPickList(faces_);
}

std::optional<std::uint32_t> TrianglesActor::partOf(const vtkProp* prop, vtkIdType id) const
{
  if (prop != faces_.Get() || id < 0 || id >= data_->GetNumberOfCells()) return std::nullopt;
  return static_cast<std::uint32_t>(id);
}

} // namespace pcl_bsh::viewer
