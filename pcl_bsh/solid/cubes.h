// SPDX-License-Identifier: BSD-3-Clause
// A coarse grid of cubes over the box of a mesh. Cubes that the surface may meet are marked; it surely meets no others.
#pragma once

#include <pcl_bsh/geometry/triangle/triangle3.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_bsh {

class Cubes {
public:
  Cubes() = default; ///< none: nothing is clear

  /// @param low, high of all triangles
  Cubes(const Point3& low, const Point3& high);

  /// Marks the cubes that a triangle may meet. Once many long triangles were marked, those with nearly equal corners
  /// are marked once, and somewhat wider. @param triangle finite, within the box
  void mark(const Triangle3& triangle);

  /// Whether surely no triangle meets the cube of the places within `reach` of `at`, per axis. False where the cube is
  /// too large to tell at little cost.
  bool areClear(const Point3& at, double reach) const noexcept;

  std::size_t bytes() const noexcept
  {
    return marked_.capacity() * sizeof(std::uint64_t) + lately_.capacity() * sizeof(Rough);
  }

private:
  static constexpr std::size_t kCubes = 64; ///< along each axis: a word is a row of cubes

  /// Which part of which cube each corner of a triangle is in.
  using Rough = std::array<std::uint32_t, 3>;

  std::uint32_t cubeOf(double x, std::size_t axis) const noexcept;
  Rough roughOf(const Triangle3& triangle) const noexcept;
  bool wasMarked(const Triangle3& triangle);
  void mark(const Triangle3& triangle, double pad);

  Point3 low_ = {}, high_ = {};
  Point3 per_ = {}; ///< cubes for each unit
  std::vector<std::uint64_t> marked_;
  std::size_t long_ones_ = 0; ///< triangles that meet several cubes
  std::vector<Rough> lately_; ///< of long ones that were marked, once they are many
};

} // namespace pcl_bsh
