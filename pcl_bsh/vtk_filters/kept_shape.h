// SPDX-License-Identifier: BSD-3-Clause
// An input of a VTK filter as a Shape, which is kept from one execution to the next. Not installed.
#pragma once

#include <pcl_bsh/question/shape.h>

#include <vtkDataArray.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::vtk {

/// Points as an array of records. Float and double arrays are seen in place, and kept alive; others are copied to
/// doubles, and `copied` becomes true.
PointsView viewOf(vtkPolyData& data, bool& copied);

/// Whether the data has lines, polygons or strips.
bool isSurface(vtkPolyData& data);

/// A shape that is made anew only when the points (and for a surface the cells) have changed, by a checksum of their
/// numbers. This holds also where data was changed without a call of Modified(). Its hierarchies are kept as long.
class KeptShape {
public:
  explicit KeptShape(std::string name) : name_(std::move(name)) {}

  /// The shape of all points; cells do not count.
  Shape& ofPoints(vtkPolyData& data);

  /// The shape of the triangles of all cells, vertices and lines too. @throws InvalidInput, as viewOf() does for
  /// triangles
  Shape& ofSurface(vtkPolyData& data);

  /// For a surface, the cell of each triangle.
  const std::vector<std::uint32_t>& cells() const noexcept { return cells_; }

  std::size_t made() const noexcept { return made_; } ///< shapes so far

private:
  /// Whether the shape was made of these numbers. If not, remembers the numbers, and drops the shape.
  bool isOf(const PointsView& view, bool copied, std::uint64_t checksum, bool surface);
  Shape& keep(Shape shape);

  std::string name_;
  Shape shape_;       ///< of `points_`, or of their cells
  PointsView points_; ///< the owner keeps the memory, so that its address is not used for other points
  bool copied_ = false;
  std::uint64_t checksum_ = 0;
  bool surface_ = false;
  std::vector<std::uint32_t> cells_;
  std::size_t made_ = 0;
};

} // namespace pcl_bsh::vtk
