// SPDX-License-Identifier: BSD-3-Clause
#include "points_actor.h"

#include "actors.h"
#include "far_points.h"
#include "surface_actor.h"

#include <pcl_bsh/vtk/cloud_data.h>

#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <limits>

namespace pcl_bsh::viewer {
namespace {

/// Sparse clouds need larger points to be seen as surfaces.
float sizeFor(std::size_t count)
{
  return count > 300'000 ? 1.5f : count > 30'000 ? 2.0f : 3.0f;
}

vtkSmartPointer<vtkPolyData> noPoints()
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(vtkNew<vtkPoints>());
  return data;
}

} // namespace

PointsActor::PointsActor(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& color, const Color& marked)
: points_(renderer, sizeFor(viewed.points().size()), false),
  marks_(renderer, 6.0f, true)
{
  setColor(marks_.actor(), marked);
  setPoints(viewed.points());
  if (!viewed.surface) return;
  surface_ = addSurface(viewed, renderer, color);
  points_.hide();
}

void PointsActor::setPoints(const PointsView& points)
{
  all_ = vtk::cloudData(points);
  points_.show(withoutFarPoints(*all_));
}

void PointsActor::paint(const std::vector<Color>& colors)
{
  setColors(data(), colors);
  points_.show(&data());
}

void PointsActor::paint(const Color& color, const ColorRange* heights)
{
  const double* const bounds = data().GetBounds();
  const ColorRange range = heights ? *heights : ColorRange{bounds[4], bounds[5]};
  const double height = std::max(range.high - range.low, std::numeric_limits<double>::min());
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName("colors");
  colors->SetNumberOfComponents(3);
  colors->SetNumberOfTuples(data().GetNumberOfPoints());
  for (vtkIdType i = 0; i < data().GetNumberOfPoints(); ++i) {
    double p[3];
    data().GetPoint(i, p);
    const double share = 0.55 + 0.45 * std::clamp((p[2] - range.low) / height, 0.0, 1.0);
    for (int k = 0; k < 3; ++k)
      colors->SetTypedComponent(i, k, static_cast<unsigned char>(color[static_cast<std::size_t>(k)] * share));
  }
  data().GetPointData()->SetScalars(colors);
  points_.show(&data());
}

void PointsActor::mark(const std::vector<std::uint8_t>& flags, const std::vector<Color>& colors)
{
  if (flags.empty()) {
    marks_.show(noPoints());
    return;
  }
  const auto marked = vtk::subset(data(), flags);
  marked->GetPointData()->RemoveArray("colors");
  if (!colors.empty()) setColors(*marked, colors);
  marks_.show(marked);
}

void PointsActor::place(const Eigen::Isometry3d& pose)
{
  points_.place(pose);
  marks_.place(pose);
  if (surface_) surface_->SetUserMatrix(matrixOf(pose));
}

void PointsActor::setMoving(bool moving)
{
  points_.setMoving(moving);
  marks_.setMoving(moving);
}

void PointsActor::setVisible(bool visible)
{
  points_.setVisible(visible);
  marks_.setVisible(visible);
  if (surface_) surface_->SetVisibility(visible);
}

void PointsActor::remove(vtkRenderer& renderer)
{
  points_.remove(renderer);
  marks_.remove(renderer);
  renderer.RemoveActor(surface_);
}

void PointsActor::cut(const Cut& plane)
{
  points_.cut(plane);
  marks_.cut(plane);
}

void PointsActor::offerTo(vtkPicker& points, vtkPicker& /*triangles*/) const
{
  if (surface_) return;
  for (const PointLayer* layer : {&points_, &marks_}) points.AddPickList(&layer->actor());
}

std::optional<std::uint32_t> PointsActor::partOf(const vtkProp* prop, vtkIdType id) const
{
  if (!points_.owns(prop) && !marks_.owns(prop)) return std::nullopt;
  vtkPolyData& picked = points_.owns(prop) ? data() : marked();
  if (id < 0 || id >= picked.GetNumberOfPoints()) return std::nullopt;
  return static_cast<std::uint32_t>(vtkIntArray::SafeDownCast(picked.GetPointData()->GetArray("index"))->GetValue(id));
}

} // namespace pcl_bsh::viewer
