// SPDX-License-Identifier: BSD-3-Clause
// Tells whether points, or other numbers, are still those that a hierarchy was built from.
#pragma once

#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace pcl_bsh {

/// One step of a checksum: for each word a bijection of the sum, so that no change of one word goes unnoticed.
inline std::uint64_t mixed(std::uint64_t sum, std::uint64_t word)
{
  constexpr std::uint64_t golden = 0x9e3779b97f4a7c15; // odd
  sum = (sum ^ word) * golden;
  return sum ^ sum >> 32; // products carry upward only: a sign that flips twice would cancel out
}

template <typename Bits>
std::uint64_t checksumOfBits(const PointsView& view)
{
  std::uint64_t sum = view.count;
  const auto [x, y, z] = view.offset;
  const auto* record = static_cast<const unsigned char*>(view.data);
  for (std::size_t i = 0; i < view.count; ++i, record += view.stride) {
    const auto bits = [record](std::size_t offset) {
      Bits word;
      std::memcpy(&word, record + offset, sizeof word);
      return std::uint64_t{word};
    };
    if constexpr (sizeof(Bits) == 4) {
      sum = mixed(sum, bits(y) << 32 | bits(x));
    }
    else {
      sum = mixed(mixed(sum, bits(x)), bits(y));
    }
    sum = mixed(sum, bits(z));
  }
  return sum;
}

/// Checksum of all coordinates and their order, as they are written; for triangles, of the vertices and the corners.
/// Bytes between them may change.
inline std::uint64_t checksumOf(const PointsView& view)
{
  if (view.triangles) {
    std::uint64_t sum = checksumOf(view.triangles->vertices);
    for (std::size_t i = 0; i < view.triangles->count; ++i) {
      const auto [a, b, c] = view.triangles->cornersOf(static_cast<std::uint32_t>(i));
      sum = mixed(mixed(sum, std::uint64_t{a} << 32 | b), c);
    }
    return sum;
  }
  return view.scalar == Scalar::float32 ? checksumOfBits<std::uint32_t>(view) : checksumOfBits<std::uint64_t>(view);
}

} // namespace pcl_bsh
