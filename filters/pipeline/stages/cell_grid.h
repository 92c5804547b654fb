// SPDX-License-Identifier: BSD-3-Clause
// The cubes of a grid, numbered with 64 bits: pcl::VoxelGrid's 32 overflow in big scenes, and it returns its input
// then.
#pragma once

#include <pcl_bsh/filters/pipeline/option_type.h>
#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace pcl_bsh::pipeline {

using Cell = std::array<std::int64_t, 3>;

/// Which cell a point lies in. For float32 points, PCL's own float arithmetic, so that cells are PCL's to the last bit,
/// as long as float can count them; otherwise double.
class CellGrid {
public:
  /// @throws std::invalid_argument when even double cannot count the cells from the origin to the points
  CellGrid(const PointsView& points, const Numbers<3>& edge);

  Cell cellOf(const Point3& finite_point) const;
  Point3 centreOf(const Cell& cell) const;

  /// Cells that hold the least and the greatest coordinates; of no finite points, both 0.
  const Cell& least() const { return least_; }
  const Cell& most() const { return most_; }

private:
  Numbers<3> edge_;
  bool in_float_;
  Cell least_ = {0, 0, 0};
  Cell most_ = {0, 0, 0};
};

/// A point's record and the number of its cell, in two halves: without padding, a fourth less memory.
struct CellEntry {
  std::uint32_t low;
  std::uint32_t high;
  std::uint32_t record;

  std::uint64_t cell() const { return std::uint64_t{high} << 32 | low; }
};

/// The finite points by cell, x growing fastest and z slowest; those of one cell in any order.
/// @throws std::invalid_argument when the cells are too many for 64 bits
std::vector<CellEntry> sortIntoCells(const PointsView& points, const CellGrid& grid);

/// How many cells hold something.
std::size_t countCells(const std::vector<CellEntry>& sorted);

/// Calls `use` with the records of each cell in turn, in ascending order.
void forEachCell(const std::vector<CellEntry>& sorted,
                 const std::function<void(const std::vector<std::uint32_t>&)>& use);

} // namespace pcl_bsh::pipeline
