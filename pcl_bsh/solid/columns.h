// SPDX-License-Identifier: BSD-3-Clause
// Finds the triangles that a ray along an axis may meet, by a grid of columns over their shadows, finer where they
// crowd. Triangles that are long for a column are in strips, large ones that lie alike in bundles.
//
// A point's winding number needs the triangles of its own column only. Beside the grid stands a coarse one of cubes
// that tells where the surface surely is not.
#pragma once

#include <pcl_bsh/base/large_array.h>
#include <pcl_bsh/geometry/triangle/triangle3.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/solid/bundles.h>
#include <pcl_bsh/solid/cubes.h>
#include <pcl_bsh/solid/strips.h>
#include <pcl_bsh/solid/upward_ray.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh {

/// Places are seen from `origin()`, with the ray's axis last: seen(q)[k] = q[axes()[k]] - origin()[axes()[k]]. error()
/// covers the rounding.
class Columns {
public:
  /// Makes columns of the finite triangles. The axis is the one along which the shadows of their boxes overlap least.
  explicit Columns(const TrianglesView& triangles);

  /// Whether there is no finite triangle.
  bool empty() const noexcept { return boxes_.empty() || !(low_[0] <= high_[0]); }

  const Point3& origin() const noexcept { return origin_; }
  const std::array<std::size_t, 3>& axes() const noexcept { return axes_; }
  double error() const noexcept { return error_; } ///< per axis, of a corner as seen()

  Point3 seen(const Point3& q) const noexcept
  {
    return {q[axes_[0]] - origin_[axes_[0]], q[axes_[1]] - origin_[axes_[1]], q[axes_[2]] - origin_[axes_[2]]};
  }

  /// A triangle's box, as seen, rounded outward. Being above a place decides many crossings.
  const FloatBox& box(std::uint32_t triangle) const noexcept { return boxes_[triangle]; }

  Triangle3 seenTriangle(std::uint32_t triangle) const noexcept
  {
    const Triangle3 t = view_.triangle(triangle);
    return {seen(t[0]), seen(t[1]), seen(t[2])};
  }

  /// Triangles, each once.
  struct Range {
    const std::uint32_t *first, *last;
    int turns = 0;             ///< how often the ray surely crosses triangles not in the range, fronts less backs
    std::uint64_t bundles = 0; ///< how many bundles were looked at
    const std::uint32_t* begin() const noexcept { return first; }
    const std::uint32_t* end() const noexcept { return last; }
    std::size_t size() const noexcept { return static_cast<std::size_t>(last - first); }
  };

  /// Returns all triangles that a ray from a place within `error` of `at`, per axis, may meet or begin on; perhaps
  /// others. Triangles of bundles that it surely crosses are left out, and counted in `turns`.
  /// @param several memory of the range where it is of several columns, of strips or of bundles
  Range above(const Point3& at, double error, std::vector<std::uint32_t>& several) const;

  /// Returns all triangles that may come within `error` of the line along the ray's axis through a place; perhaps
  /// others.
  Range along(const Point3& at, double error, std::vector<std::uint32_t>& several) const
  {
    return bundles_ ? Range{entries_.begin(), entries_.end()} : above(at, error, several);
  }

  /// Whether all places within `reach` of `at`, per axis, are outside of the box of all triangles.
  bool isBeyond(const Point3& at, double reach) const noexcept
  {
    for (std::size_t k = 0; k < 3; ++k)
      if (at[k] + reach < low_[k] || at[k] - reach > high_[k]) return true;
    return false;
  }

  /// Whether surely no triangle meets the cube of the places within `reach` of `at`, per axis. False where the cube is
  /// too large to tell at little cost.
  bool isClear(const Point3& at, double reach) const noexcept { return cubes_.areClear(at, reach); }

  std::size_t bytes() const noexcept;

private:
  /// Columns in rows, over [x, x + columns / per_x].
  struct Grid {
    double x, y, per_x, per_y; ///< its corner, and columns for each unit
    double pad;                ///< a triangle is also in the columns that it misses by no more
    std::uint32_t columns, rows;
    std::uint32_t first; ///< cell of the first column
  };

  /// A range of entries_, or a finer grid, or strips.
  struct Cell {
    static constexpr std::uint32_t kGrid = ~std::uint32_t{0}, kStrips = kGrid - 1;
    std::uint32_t begin, end; ///< of entries_; or kGrid or kStrips, and the number of the grid or the strips
  };

  /// Strips of a column. Its entries are in the order of the strips.
  struct Stripped {
    std::uint32_t begin;
    Strips strips;
  };

  struct Shadows;
  Shadows shadowsWithin(const Point3& low, const Point3& high, const Range& triangles) const;
  bool makeGrid(const Point3& low, const Point3& high, const Range& triangles, const Shadows& shadows, bool finer);
  template <class Visit>
  void forEachCell(const Grid& grid, std::uint32_t triangle, const Visit& visit) const;
  void refine();
  Cell inStrips(std::uint32_t begin, std::uint32_t count);
  bool makeStrips(const Range& triangles, double most);
  bool makeBundles(const Range& triangles, double most);
  template <class Look>
  void sample(const Look& look) const;
  void collect(std::uint32_t grid, const Point3& at, double error, std::vector<std::uint32_t>& found) const;

  TrianglesView view_;
  Point3 origin_ = {};
  std::array<std::size_t, 3> axes_ = {0, 1, 2};
  double error_ = 0.0;
  Point3 low_, high_; ///< of all triangles, as seen, rounded outward
  LargeArray<FloatBox> boxes_;
  std::vector<Grid> grids_;
  LargeArray<Cell> cells_;
  LargeArray<std::uint32_t> entries_;
  std::vector<Stripped> stripped_;
  std::optional<Bundles> bundles_; ///< of all entries, in place of all grids
  Cubes cubes_;
};

} // namespace pcl_bsh
