// SPDX-License-Identifier: BSD-3-Clause
// Counts the points of a stream in cells, which are fine where points are dense. Groups the cells into tiles of at most
// a given number of points.
#pragma once

#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/site/making/tile_partition.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_bsh::site {

/// Eight octrees, one for each combination of the coordinates' signs. Their cells are the voxels of one grid: edges are
/// powers of two, and the origin is a corner. Points are counted, not held. A cell is divided once it has counted 1/64
/// of a tile's points; its parts count all points from then on. So a few ten thousand cells describe any cloud.
class DensityTree {
public:
  explicit DensityTree(std::uint64_t tile_points);

  /// Counts a finite point.
  void add(const Point3& point);

  /// Divides the space into tiles of neighbouring cells. No tile can have more than tile_points of the points counted,
  /// except a cell in which all points are at (almost) one place. To be called once.
  /// @return the number of tiles
  std::uint32_t plan();

  /// After plan(): the tile of a point, counted or not. Takes about no time for a point near the last one.
  std::uint32_t tileOf(const Point3& point);

  /// After plan(): all that tileOf() needs, as numbers that a file can hold.
  std::vector<std::uint32_t> planned() const;

  /// Returns the tree that planned() has described. @throws std::invalid_argument for other numbers
  static DensityTree fromPlanned(const std::vector<std::uint32_t>& numbers);

  /// Memory that it takes.
  std::size_t bytes() const noexcept { return cells_.capacity() * sizeof(Cell); }

private:
  static constexpr std::uint32_t none = 0xffffffffu;

  /// Coordinates are magnitudes: the signs chose the octree.
  struct Cell {
    std::array<std::uint32_t, 8> part = {none, none, none, none, none, none, none, none};
    std::uint64_t own = 0; ///< counted here
    Point3 low = {}, high = {};
    std::uint32_t tile = none; ///< after plan(), of a cell that is not divided
    bool is_divided = false;   ///< after plan(): has parts of several tiles
  };

  struct Place {
    std::uint32_t cell;
    Point3 corner; ///< the one next to the origin
    double edge;
  };

  struct Octree {
    std::uint32_t root = none;
    int exponent = 0; ///< the root's edge is 2 to that
    Place last = {none, {}, 0.0};
  };

  struct Undivided {
    std::vector<std::uint32_t> cells;
    std::vector<CountedVoxel> voxels; ///< of these cells
    std::vector<DividedVoxel> above;
  };

  std::uint32_t addCell();
  Octree& octreeOf(const Point3& point, Point3& magnitudes);
  void grow(Octree& tree, const Point3& magnitudes);
  static std::size_t partOf(const Place& place, const Point3& magnitudes);
  Place step(const Place& place, std::size_t part);
  void divide(const Place& place);
  void collect(std::size_t octant, const Place& place, std::uint32_t above, std::uint64_t most_above, Undivided& all);
  void simplify(std::uint32_t number);

  std::uint64_t tile_points_, most_in_cell_;
  std::vector<Cell> cells_;
  std::array<Octree, 8> octrees_;
  std::uint32_t tiles_ = 0;
};

} // namespace pcl_bsh::site
