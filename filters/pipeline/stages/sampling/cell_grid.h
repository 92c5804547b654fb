// SPDX-License-Identifier: BSD-3-Clause
// The cubes of a grid, numbered with 64 bits: pcl::VoxelGrid's 32 overflow in big scenes, and it returns its input
// then.
#pragma once

#include <pcl_bsh/filters/pipeline/option_type.h>
#include <pcl_bsh/filters/pipeline/stage.h>
#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <array>
#include <cstdint>
#include <functional>
#include <variant>
#include <vector>

namespace pcl_bsh::pipeline {

using Cell = std::array<std::int64_t, 3>;

/// Which cell a point lies in. For float32 points, PCL's own float arithmetic, so that cells are PCL's to the last bit,
/// as long as float can count them; otherwise double.
class CellGrid {
public:
  /// @param option the stage's option that gives the edge, for errors
  /// @throws OptionError when even double cannot count the cells from the origin to the points
  CellGrid(const PointsView& points, const Numbers<3>& edge, std::string option);

  Cell cellOf(const Point3& finite_point) const;
  Point3 centreOf(const Cell& cell) const;

  /// Cells that hold the least and the greatest coordinates; of no finite points, both 0.
  const Cell& least() const { return least_; }
  const Cell& most() const { return most_; }

  /// @throws OptionError about the edge
  [[noreturn]] void refuse(const std::string& wrong) const { throw OptionError(option_, wrong); }

private:
  Numbers<3> edge_;
  std::string option_;
  bool in_float_;
  Cell least_ = {0, 0, 0};
  Cell most_ = {0, 0, 0};
};

/// The finite points by cell. For a cloud of many points this is the largest part of a stage's memory beside the cloud,
/// so its entries are as narrow as the number of cells allows.
class SortedCells {
public:
  /// @throws OptionError when the cells are too many for 64 bits
  SortedCells(const PointsView& points, const CellGrid& grid);

  /// How many cells hold something.
  std::size_t count() const;

  /// Calls `use` with the records of each cell in turn, in ascending order; of the cells, x grows fastest and z
  /// slowest.
  void forEach(const std::function<void(const std::vector<std::uint32_t>&)>& use) const;

private:
  /// A point's record and the number of its cell.
  struct NarrowEntry {
    std::uint32_t number;
    std::uint32_t record;

    NarrowEntry() = default;
    NarrowEntry(std::uint64_t cell, std::uint32_t i) : number(static_cast<std::uint32_t>(cell)), record(i) {}
    std::uint64_t cell() const { return number; }
  };

  /// In two halves: without padding, a fourth less memory.
  struct WideEntry {
    std::uint32_t low;
    std::uint32_t high;
    std::uint32_t record;

    WideEntry() = default;
    WideEntry(std::uint64_t cell, std::uint32_t i)
    : low(static_cast<std::uint32_t>(cell)),
      high(static_cast<std::uint32_t>(cell >> 32)),
      record(i)
    {
    }
    std::uint64_t cell() const { return std::uint64_t{high} << 32 | low; }
  };

  std::variant<std::vector<NarrowEntry>, std::vector<WideEntry>> entries_;
};

} // namespace pcl_bsh::pipeline
