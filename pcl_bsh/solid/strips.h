// SPDX-License-Identifier: BSD-3-Clause
// A tree of strips across the ray, over triangles that are long for their column: a ray in the column is compared with
// few of them.
#pragma once

#include <pcl_bsh/geometry/triangle/triangle3.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace pcl_bsh {

/// Strips over the shadows of triangles along the last axis. A strip lies between two parallel lines. A needle is in a
/// narrow one, however it lies; so are neighbours among needles that meet at one end or lie side by side.
class Strips {
public:
  /// @param first, last numbers of the triangles; brought into the tree's order @param seen the corners of one
  Strips(std::uint32_t* first, std::uint32_t* last, const std::function<Triangle3(std::uint32_t)>& seen);

  /// Appends the triangles whose shadows may be within `error` of a place, per axis; perhaps others.
  /// @param first numbers of the triangles, as the constructor left them
  void collect(const std::uint32_t* first, const Point3& at, double error, std::vector<std::uint32_t>& found) const;

  std::size_t bytes() const noexcept { return strips_.capacity() * sizeof(Strip); }

private:
  /// low <= x normal[0] + y normal[1] <= high, of all corners below it.
  struct Strip {
    float normal[2], low, high;

    bool holds(const Point3& at, double error) const noexcept;
  };

  struct Level {
    std::uint32_t begin, count;
  };

  std::uint32_t count_; ///< triangles
  std::vector<Level> levels_;
  std::vector<Strip> strips_;
};

} // namespace pcl_bsh
