// SPDX-License-Identifier: BSD-3-Clause
// VTK: the static cell locator, and the filter for enclosed points, asked point by point.
#include "surface_peer.h"

#include <vtkCellArray.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSelectEnclosedPoints.h>
#include <vtkStaticCellLocator.h>

#include <cmath>
#include <limits>

namespace pcl_bsh::bench {
namespace {

vtkNew<vtkPolyData> polyDataOf(const MeshVertices& vertices, const MeshTriangles& triangles)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const auto& p : vertices) points->InsertNextPoint(p.data());
  vtkNew<vtkCellArray> cells;
  for (const auto& t : triangles) cells->InsertNextCell({vtkIdType{t[0]}, vtkIdType{t[1]}, vtkIdType{t[2]}});
  vtkNew<vtkPolyData> mesh;
  mesh->SetPoints(points);
  mesh->SetPolys(cells);
  return mesh;
}

class Locator final : public SurfacePeer {
public:
  Locator(const MeshVertices& vertices, const MeshTriangles& triangles)
  : SurfacePeer(vertices, triangles),
    mesh_(polyDataOf(vertices, triangles))
  {
    mesh_->BuildCells();
    locator_->SetDataSet(mesh_);
    locator_->BuildLocator();
  }

  bool flag(const double* xyz, std::size_t count, double d, std::uint8_t* out) override
  {
    for (std::size_t i = 0; i < count; ++i) out[i] = std::isinf(squaredWithin(xyz + 3 * i, d)) ? 0 : 1;
    return true;
  }

  bool distances(const double* xyz, std::size_t count, double* out) override
  {
    for (std::size_t i = 0; i < count; ++i) {
      double at[3] = {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]}, closest[3], squared = 0.0;
      vtkIdType id = 0;
      int sub = 0;
      locator_->FindClosestPoint(at, closest, cell_, id, sub, squared);
      out[i] = std::sqrt(squared);
    }
    return true;
  }

private:
  double squaredWithin(const double* p, double d)
  {
    double at[3] = {p[0], p[1], p[2]}, closest[3], squared = 0.0;
    vtkIdType id = 0;
    int sub = 0, is_inside = 0;
    const vtkIdType found = locator_->FindClosestPointWithinRadius(at, d, closest, cell_, id, sub, squared, is_inside);
    return found != 0 ? squared : std::numeric_limits<double>::infinity();
  }

  vtkNew<vtkPolyData> mesh_;
  vtkNew<vtkStaticCellLocator> locator_;
  vtkNew<vtkGenericCell> cell_;
};

class Enclosed final : public SurfacePeer {
public:
  Enclosed(const MeshVertices& vertices, const MeshTriangles& triangles)
  : SurfacePeer(vertices, triangles),
    mesh_(polyDataOf(vertices, triangles))
  {
    select_->Initialize(mesh_);
  }

  bool inside(const double* xyz, std::size_t count, std::uint8_t* out) override
  {
    for (std::size_t i = 0; i < count; ++i)
      out[i] = select_->IsInsideSurface(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]) != 0 ? 1 : 0;
    return true;
  }

private:
  vtkNew<vtkPolyData> mesh_;
  vtkNew<vtkSelectEnclosedPoints> select_;
};

} // namespace

std::unique_ptr<SurfacePeer> makeVtkLocator(const MeshVertices& vertices, const MeshTriangles& triangles)
{
  return std::make_unique<Locator>(vertices, triangles);
}

std::unique_ptr<SurfacePeer> makeVtkEnclosed(const MeshVertices& vertices, const MeshTriangles& triangles)
{
  return std::make_unique<Enclosed>(vertices, triangles);
}

} // namespace pcl_bsh::bench
