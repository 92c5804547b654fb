// SPDX-License-Identifier: BSD-3-Clause
// Which cells of a voxel's octree points are in.

#if defined(PCL_BSH_HIERARCHY_BUILD_CELL_CODES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_HIERARCHY_BUILD_CELL_CODES_INL_H_
#undef PCL_BSH_HIERARCHY_BUILD_CELL_CODES_INL_H_
#else
#define PCL_BSH_HIERARCHY_BUILD_CELL_CODES_INL_H_
#endif

#include <pcl_bsh/hierarchy/build/point_bounds-inl.h>
#include <pcl_bsh/simd/sphere_lanes-inl.h>

#include <algorithm>
#include <array>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Numbers the cells of a box along a space-filling order: each bit of a code halves the axis along which cells are
/// longest, the most significant bit first. A cube gives the Morton order; a flat box is not split through its
/// thickness.
class CellCodes {
public:
  static constexpr unsigned kMostBits = 16;     // of a code: what 65,536 cells cannot tell apart is split again
  static constexpr unsigned kMostAxisBits = 12; // of these, for one axis
  static constexpr std::size_t kBlock = 64;     // points coded at a time, at most

  CellCodes(const PointBounds& bounds, unsigned bits)
  {
    std::array<float, 3> edge = {bounds.extent(0), bounds.extent(1), bounds.extent(2)};
    std::array<unsigned, 3> axis_bits = {0, 0, 0};
    std::array<std::uint8_t, kMostBits> axis_of; // of each bit of the code, most significant first
    for (unsigned b = 0; b < bits; ++b) {
      const auto longest = static_cast<std::size_t>(std::max_element(edge.begin(), edge.end()) - edge.begin());
      if (axis_bits[longest] == kMostAxisBits) break;
      edge[longest] *= 0.5f;
      ++axis_bits[longest];
      axis_of[bits_++] = static_cast<std::uint8_t>(longest);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const auto cells = static_cast<float>(1u << axis_bits[k]);
      const float extent = bounds.extent(static_cast<int>(k));
      low_[k] = bounds.low[k];
      scale_[k] = extent > 0.0f ? std::min(cells / extent, std::numeric_limits<float>::max()) : 0.0f;
      last_[k] = cells - 1.0f;
      spread(static_cast<std::uint8_t>(k), axis_of);
    }
  }

  unsigned bits() const { return bits_; }

  /// The codes of `count` <= kBlock points; whole vectors are read. @pre the points, and what is read, are in the box
  void operator()(const PointRecord* points, std::size_t count, std::uint16_t* codes) const
  {
    const LaneTag d;
    const hn::RebindToUnsigned<LaneTag> bits;
    alignas(32) std::uint32_t cell[3][kBlock];
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      LaneVector p[3], record;
      hn::LoadInterleaved4(d, reinterpret_cast<const float*>(points + i), p[0], p[1], p[2], record);
      for (std::size_t k = 0; k < 3; ++k) {
        const LaneVector cells = hn::Mul(hn::Sub(p[k], hn::Set(d, low_[k])), hn::Set(d, scale_[k]));
        // Added to 2^23, the nearest whole number stands in the last bits.
        const LaneVector down = hn::Max(hn::Sub(hn::Min(cells, hn::Set(d, last_[k])), hn::Set(d, 0.5f)), hn::Zero(d));
        hn::Store(hn::And(hn::BitCast(bits, hn::Add(down, hn::Set(d, 0x1p23f))), hn::Set(bits, kCellMask)), bits,
                  cell[k] + i);
      }
    }
    for (std::size_t i = 0; i < count; ++i)
      codes[i] = static_cast<std::uint16_t>(spread_[0][cell[0][i]] | spread_[1][cell[1][i]] | spread_[2][cell[2][i]]);
  }

private:
  static constexpr std::uint32_t kCellMask = (1u << kMostAxisBits) - 1;

  /// spread_[axis][cell]: the code bits that the cell's number along the axis stands for.
  void spread(std::uint8_t axis, const std::array<std::uint8_t, kMostBits>& axis_of)
  {
    spread_[axis][0] = 0;
    std::size_t numbers = 1; // the table so far; each further bit of the number doubles it
    for (unsigned b = bits_; b-- > 0;) {
      if (axis_of[b] != axis) continue;
      for (std::size_t number = 0; number < numbers; ++number)
        spread_[axis][numbers + number] = static_cast<std::uint16_t>(spread_[axis][number] | 1u << (bits_ - 1 - b));
      numbers *= 2;
    }
  }

  unsigned bits_ = 0;
  float low_[3], scale_[3], last_[3];
  std::array<std::array<std::uint16_t, 1u << kMostAxisBits>, 3> spread_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
