// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk_filters/kept_shape.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/hierarchy/points_checksum.h>
#include <pcl_bsh/hierarchy/polygon_triangles.h>

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkPoints.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::vtk {
namespace {

/// Triangles of all cells, and the cell of each.
struct CellTriangles {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> cells;
};

/// Visits each cell in the order in which vtkPolyData numbers them: vertices, lines, polygons, strips.
/// @param visit gets the kind (0 to 3), the number of the cell, its corners and how many they are
template <class Visit>
void visitCells(vtkPolyData& data, const Visit& visit)
{
  vtkIdType number = 0;
  vtkCellArray* const kinds[] = {data.GetVerts(), data.GetLines(), data.GetPolys(), data.GetStrips()};
  for (int kind = 0; kind < 4; ++kind) {
    if (!kinds[kind]) continue;
    const auto each = vtkSmartPointer<vtkCellArrayIterator>::Take(kinds[kind]->NewIterator());
    for (each->GoToFirstCell(); !each->IsDoneWithTraversal(); each->GoToNextCell()) {
      vtkIdType count = 0;
      const vtkIdType* corners = nullptr;
      each->GetCurrentCell(count, corners);
      visit(kind, number++, corners, count);
    }
  }
}

std::uint32_t recordOf(vtkIdType corner, vtkIdType cell, std::size_t points)
{
  if (static_cast<std::size_t>(corner) >= points) // negative ones are large
    throw InvalidInput(Input::surface, "cell " + std::to_string(cell),
                       "names point " + std::to_string(corner) + " of " + std::to_string(points),
                       "leave the cell out, or mend the mesh");
  return static_cast<std::uint32_t>(corner);
}

std::uint64_t checksumOfCells(vtkPolyData& data)
{
  std::uint64_t sum = 0;
  visitCells(data, [&](int kind, vtkIdType, const vtkIdType* corners, vtkIdType count) {
    sum = mixed(sum, static_cast<std::uint64_t>(count) << 2 | static_cast<std::uint64_t>(kind));
    for (vtkIdType i = 0; i < count; ++i) sum = mixed(sum, static_cast<std::uint64_t>(corners[i]));
  });
  return sum;
}

CellTriangles trianglesOf(vtkPolyData& data, const PointsView& view)
{
  CellTriangles found;
  std::vector<std::uint32_t> records;
  visitCells(data, [&](int kind, vtkIdType cell, const vtkIdType* corners, vtkIdType count) {
    records.clear();
    for (vtkIdType i = 0; i < count; ++i) records.push_back(recordOf(corners[i], cell, view.count));
    const std::size_t n = records.size();
    switch (kind) {
    case 0: // a point is a triangle without extent
      for (const std::uint32_t p : records) found.triangles.push_back({p, p, p});
      break;
    case 1: // a segment, too
      for (std::size_t i = 0; i + 1 < n; ++i) found.triangles.push_back({records[i], records[i + 1], records[i + 1]});
      break;
    case 2: // PCL's and VTK's polygons may have any number of corners
      if (n == 1) found.triangles.push_back({records[0], records[0], records[0]});
      if (n == 2) found.triangles.push_back({records[0], records[1], records[1]});
      if (n > 2) addTriangles(view, records.data(), n, found.triangles);
      break;
    default:
      for (std::size_t i = 0; i + 2 < n; ++i) // every other one is turned over, so that all face one side
        found.triangles.push_back({records[i + i % 2], records[i + 1 - i % 2], records[i + 2]});
    }
    found.cells.resize(found.triangles.size(), static_cast<std::uint32_t>(cell));
  });
  return found;
}

} // namespace

PointsView viewOf(vtkPolyData& data, bool& copied)
{
  vtkPoints* const points = data.GetPoints();
  const auto count = static_cast<std::size_t>(points ? points->GetNumberOfPoints() : 0);
  if (count == 0) return {};
  vtkSmartPointer<vtkDataArray> array = points->GetData();
  if (!vtkFloatArray::SafeDownCast(array) && !vtkDoubleArray::SafeDownCast(array)) {
    const auto copy = vtkSmartPointer<vtkDoubleArray>::New();
    copy->DeepCopy(array);
    array = copy;
    copied = true;
  }
  PointsView view;
  if (auto* const floats = vtkFloatArray::SafeDownCast(array))
    view = pcl_bsh::viewOf(floats->GetPointer(0), count);
  else
    view = pcl_bsh::viewOf(vtkDoubleArray::SafeDownCast(array)->GetPointer(0), count);
  view.owner = std::shared_ptr<const void>(array.GetPointer(), [array](const void*) {});
  return view;
}

bool isSurface(vtkPolyData& data)
{
  return data.GetNumberOfLines() + data.GetNumberOfPolys() + data.GetNumberOfStrips() > 0;
}

bool KeptShape::isOf(const PointsView& view, bool copied, std::uint64_t checksum, bool surface)
{
  // A hierarchy refers to the memory of its points. So equal numbers at another address are other points, unless both
  // are copies of ours.
  const bool same_memory = view.data == points_.data || (copied && copied_);
  const bool same_points = view.count == points_.count && view.scalar == points_.scalar && same_memory;
  if (shape_ && same_points && checksum == checksum_ && surface == surface_) return true;
  shape_ = Shape();
  points_ = view;
  copied_ = copied;
  checksum_ = checksum;
  surface_ = surface;
  return false;
}

Shape& KeptShape::keep(Shape shape)
{
  shape_ = std::move(shape);
  ++made_;
  return shape_;
}

Shape& KeptShape::ofPoints(vtkPolyData& data)
{
  bool copied = false;
  const PointsView view = viewOf(data, copied);
  return isOf(view, copied, checksumOf(view), false) ? shape_ : keep({name_, view});
}

Shape& KeptShape::ofSurface(vtkPolyData& data)
{
  bool copied = false;
  const PointsView view = viewOf(data, copied);
  if (isOf(view, copied, mixed(checksumOf(view), checksumOfCells(data)), true)) return shape_;
  CellTriangles found = trianglesOf(data, view);
  cells_ = std::move(found.cells);
  const auto triangles = std::make_shared<const std::vector<Triangle>>(std::move(found.triangles));
  return keep({name_, pcl_bsh::viewOf(pcl_bsh::trianglesOf(view, triangles))});
}

} // namespace pcl_bsh::vtk
