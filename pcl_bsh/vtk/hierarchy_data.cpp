// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/bounds.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/vtk/hierarchy_data.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkGlyph3D.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSphereSource.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::vtk {
namespace {

using Storage = SphereHierarchy::Storage;

vtkSmartPointer<vtkIntArray> intArray(const char* name)
{
  auto array = vtkSmartPointer<vtkIntArray>::New();
  array->SetName(name);
  return array;
}

/// One child of a node, with all that pictures ask about it.
struct Cell {
  const Node& node;
  std::uint32_t lane;
  const LocalFrame& frame;
  int voxel;
  int level;

  Point3 center() const
  {
    return {frame.origin[0] + node.x[lane] * frame.unit, frame.origin[1] + node.y[lane] * frame.unit,
            frame.origin[2] + node.z[lane] * frame.unit};
  }
  double radius() const { return node.r[lane] * frame.unit; }
};

/// Calls visit(cell) for the cells below a node that are at the level, or are leaves above it.
/// @param at the level of the node's children
template <class Visit>
void eachBelow(const Voxel& voxel, int number, std::uint32_t index, int at, int level, const Visit& visit)
{
  const Node& node = voxel.nodes[index];
  for (std::uint32_t i = 0; i < node.count; ++i) {
    if (at < level && !node.isLeaf(i))
      eachBelow(voxel, number, node.child[i], at + 1, level, visit);
    else
      visit(Cell{node, i, voxel.frame, number, at});
  }
}

/// Calls visit(cell) for each cell of the level, voxel by voxel.
template <class Visit>
void eachCell(const SphereHierarchy& hierarchy, unsigned level, const Visit& visit)
{
  const Storage& storage = hierarchy.storage();
  if (level > 0) {
    for (std::size_t v = 0; v < storage.voxel_count; ++v) {
      BuildWork unasked;
      eachBelow(storage.built(v, unasked), static_cast<int>(v), 0, 1, static_cast<int>(level), visit);
    }
    return;
  }
  for (const Node& node : storage.top)
    for (std::uint32_t i = 0; i < node.count; ++i)
      if (node.isLeaf(i)) visit(Cell{node, i, storage.frame, static_cast<int>(node.begin[i]), 0});
}

/// Boxes as lines: eight corners, twelve edges.
class Wires {
public:
  void add(const Bounds& box)
  {
    const vtkIdType first = points_->GetNumberOfPoints();
    for (unsigned corner = 0; corner < 8; ++corner)
      points_->InsertNextPoint((corner & 1 ? box.high : box.low)[0], (corner & 2 ? box.high : box.low)[1],
                               (corner & 4 ? box.high : box.low)[2]);
    for (unsigned corner = 0; corner < 8; ++corner) {
      for (unsigned axis = 1; axis < 8; axis *= 2) {
        if ((corner & axis) != 0) continue;
        const vtkIdType edge[2] = {first + corner, first + (corner | axis)};
        lines_->InsertNextCell(2, edge);
      }
    }
  }

  static constexpr int lines_of_a_box = 12;

  vtkSmartPointer<vtkPolyData> data() const
  {
    auto made = vtkSmartPointer<vtkPolyData>::New();
    made->SetPoints(points_);
    made->SetLines(lines_);
    return made;
  }

  Wires() { points_->SetDataTypeToDouble(); }

private:
  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> lines_;
};

void addForBox(vtkIntArray& array, int value)
{
  for (int i = 0; i < Wires::lines_of_a_box; ++i) array.InsertNextValue(value);
}

} // namespace

unsigned deepestLevel(const SphereHierarchy& hierarchy)
{
  hierarchy.buildAll();
  return static_cast<unsigned>(hierarchy.statistics().depth);
}

vtkSmartPointer<vtkPolyData> sphereData(const SphereHierarchy& hierarchy, unsigned level)
{
  const Storage& storage = hierarchy.storage();
  vtkNew<vtkPoints> centers;
  centers->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> radius;
  radius->SetName("radius");
  const auto levels = intArray("level"), voxel = intArray("voxel"), points = intArray("points");
  eachCell(hierarchy, level, [&](const Cell& cell) {
    centers->InsertNextPoint(cell.center().data());
    radius->InsertNextValue(cell.radius());
    levels->InsertNextValue(cell.level);
    voxel->InsertNextValue(cell.voxel);
    points->InsertNextValue(static_cast<int>(
        cell.level == 0 ? storage.voxels[static_cast<std::size_t>(cell.voxel)].count : cell.node.points(cell.lane)));
  });
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(centers);
  data->GetPointData()->AddArray(radius);
  for (vtkIntArray* array : {levels.Get(), voxel.Get(), points.Get()}) data->GetPointData()->AddArray(array);
  return data;
}

vtkSmartPointer<vtkPolyData> traceData(const std::vector<TracedSphere>& spheres)
{
  vtkNew<vtkPoints> centers;
  centers->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> radius;
  radius->SetName("radius");
  const auto level = intArray("level"), fate = intArray("fate");
  for (const TracedSphere& sphere : spheres) {
    centers->InsertNextPoint(sphere.center.data());
    radius->InsertNextValue(sphere.radius);
    level->InsertNextValue(sphere.level);
    fate->InsertNextValue(static_cast<int>(sphere.fate));
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(centers);
  data->GetPointData()->AddArray(radius);
  data->GetPointData()->AddArray(level);
  data->GetPointData()->AddArray(fate);
  return data;
}

vtkSmartPointer<vtkPolyData> sphereGlyphs(vtkPolyData& spheres, int resolution)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetRadius(1.0);
  sphere->SetThetaResolution(resolution);
  sphere->SetPhiResolution(std::max(3, resolution / 2 + 1));
  vtkNew<vtkGlyph3D> glyphs;
  glyphs->SetInputData(&spheres);
  glyphs->SetSourceConnection(sphere->GetOutputPort());
  glyphs->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "radius");
  glyphs->SetScaleModeToScaleByScalar();
  glyphs->SetScaleFactor(1.0);
  glyphs->OrientOff();
  glyphs->Update();
  return glyphs->GetOutput();
}

vtkSmartPointer<vtkPolyData> voxelBoxes(const SphereHierarchy& hierarchy)
{
  const Storage& storage = hierarchy.storage();
  Wires wires;
  const auto voxel = intArray("voxel");
  for (std::size_t v = 0; v < storage.voxel_count; ++v) {
    const Point3& middle = storage.voxels[v].frame.origin; // rounding may put single points next door
    Bounds cube;
    for (std::size_t k = 0; k < 3; ++k) {
      cube.low[k] = std::floor(middle[k] / storage.voxel_edge) * storage.voxel_edge;
      cube.high[k] = cube.low[k] + storage.voxel_edge;
    }
    wires.add(cube);
    addForBox(*voxel, static_cast<int>(v));
  }
  vtkSmartPointer<vtkPolyData> data = wires.data();
  data->GetCellData()->AddArray(voxel);
  return data;
}

vtkSmartPointer<vtkPolyData> cellBoxes(const SphereHierarchy& hierarchy, unsigned level)
{
  const Storage& storage = hierarchy.storage();
  Wires wires;
  const auto voxel = intArray("voxel"), levels = intArray("level");
  eachCell(hierarchy, level, [&](const Cell& cell) {
    Bounds box;
    if (cell.level == 0) {
      storage.forEachRecord(static_cast<std::size_t>(cell.voxel),
                            [&](std::uint32_t record) { box.add(storage.view.point(record)); });
    }
    else {
      const Voxel& of = storage.voxels[static_cast<std::size_t>(cell.voxel)];
      for (std::uint32_t i = cell.node.begin[cell.lane]; i < cell.node.begin[cell.lane + 1]; ++i)
        box.add(storage.view.point(of.records()[i]));
    }
    wires.add(box);
    addForBox(*voxel, cell.voxel);
    addForBox(*levels, cell.level);
  });
  vtkSmartPointer<vtkPolyData> data = wires.data();
  data->GetCellData()->AddArray(voxel);
  data->GetCellData()->AddArray(levels);
  return data;
}

} // namespace pcl_bsh::vtk
