// SPDX-License-Identifier: BSD-3-Clause
#include "sphere_actors.h"

#include <vtkCellArray.h>
#include <vtkGlyph3DMapper.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pcl_bsh::viewer {
namespace {

/// Three great circles of radius 1: they outline a sphere from every side.
vtkSmartPointer<vtkPolyData> circles()
{
  constexpr int corners = 96;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  for (int axis = 0; axis < 3; ++axis) {
    lines->InsertNextCell(corners + 1);
    for (int i = 0; i <= corners; ++i) {
      double p[3] = {0, 0, 0};
      p[axis] = std::cos(2 * std::numbers::pi * i / corners);
      p[(axis + 1) % 3] = std::sin(2 * std::numbers::pi * i / corners);
      lines->InsertCellPoint(points->InsertNextPoint(p));
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(lines);
  return data;
}
vtkSmartPointer<vtkActor> glyphs(vtkPolyData& spheres, vtkPolyData* shape, double opacity)
{
  vtkNew<vtkGlyph3DMapper> mapper;
  mapper->SetInputData(&spheres);
  mapper->SetSourceData(shape);
  mapper->SetScaleArray("radius");
  mapper->SetScaleModeToScaleByMagnitude();
  mapper->SetScaleFactor(1.0);
  mapper->ScalarVisibilityOn();
  mapper->SetScalarModeToUsePointFieldData();
  mapper->SelectColorArray("colors");
  mapper->SetColorModeToDirectScalars();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetOpacity(opacity);
  return actor;
}

} // namespace

void addSpheres(PropGroup& group, vtkPolyData& spheres, const Eigen::Isometry3d& pose, const std::vector<Color>& colors,
                double opacity)
{
  if (spheres.GetNumberOfPoints() == 0) return;
  setColors(spheres, colors);
  const auto add = [&](vtkPolyData* shape, double how_opaque) {
    const auto actor = glyphs(spheres, shape, how_opaque);
    actor->SetUserMatrix(matrixOf(pose));
    group.add(actor);
  };
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(1.0);
  const vtkIdType count = spheres.GetNumberOfPoints();
  const int corners = count > 20'000 ? 8 : count > 500 ? 20 : 48;
  ball->SetThetaResolution(corners);
  ball->SetPhiResolution(corners);
  ball->Update();
  // The more there are, the less each may hide.
  const double crowd = std::clamp(40.0 / std::sqrt(static_cast<double>(count)), 0.15, 1.0);
  add(ball->GetOutput(), opacity * crowd);
  if (count <= 20'000) add(circles(), std::min(1.0, 0.15 + 2.5 * opacity * crowd));
}

} // namespace pcl_bsh::viewer
