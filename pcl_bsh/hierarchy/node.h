// SPDX-License-Identifier: BSD-3-Clause
// One wide node of the sphere tree: a data sheet of up to eight children.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace pcl_bsh {

inline constexpr std::size_t kNodeChildren = 8;
inline constexpr std::size_t kMaxLeafPoints = 16;

/// Children as structure of arrays, so that one SIMD test covers them all. Spheres are in the frame of the node's voxel
/// (the cloud's own frame above the voxels) and contain their points, stored and given ones, and their balls if points
/// have radii. Children past `count` are points at infinity and lose every test.
struct alignas(32) Node {
  static constexpr std::uint32_t kLeaf = 0xffffffffu; ///< child has points, or a voxel, instead of a node

  float x[kNodeChildren], y[kNodeChildren], z[kNodeChildren], r[kNodeChildren];
  std::uint32_t begin[kNodeChildren + 1]; ///< child i spans [begin[i], begin[i + 1]): points of the voxel, or voxels
  std::uint32_t child[kNodeChildren];     ///< node of the same voxel, or kLeaf
  std::uint32_t lowest[kNodeChildren];    ///< smallest record number below the child
  std::uint32_t count;                    ///< children in use, 1..8

  bool isLeaf(std::size_t i) const noexcept { return child[i] == kLeaf; }
  std::uint32_t points(std::size_t i) const noexcept { return begin[i + 1] - begin[i]; }

  /// A leaf of more than kMaxLeafPoints points holds one place many times over; its first point, the one with the
  /// smallest record number, stands for all.
  bool isCoincident(std::size_t i) const noexcept { return points(i) > kMaxLeafPoints; }

  /// How many of a leaf's points there are to compare.
  std::uint32_t comparedPoints(std::size_t i) const noexcept { return isCoincident(i) ? 1 : points(i); }

  /// Appends a child over [from, to), which begins where the last child's range ends. @param below its node, or kLeaf
  void addChild(std::uint32_t from, std::uint32_t to, std::uint32_t below) noexcept
  {
    begin[count] = from;
    child[count] = below;
    begin[++count] = to;
  }

  /// Makes every child past `count` one that loses all tests.
  void clearUnused() noexcept
  {
    for (std::size_t i = count; i < kNodeChildren; ++i) {
      x[i] = y[i] = z[i] = std::numeric_limits<float>::max();
      r[i] = 0.0f;
      begin[i + 1] = begin[count];
      child[i] = kLeaf;
      lowest[i] = 0xffffffffu;
    }
  }
};
static_assert(sizeof(Node) == 256, "a node fills four cache lines");

/// Children of all these nodes: so many spheres they hold.
inline std::uint64_t countChildren(const std::vector<Node>& nodes) noexcept
{
  std::uint64_t count = 0;
  for (const Node& node : nodes) count += node.count;
  return count;
}

} // namespace pcl_bsh
