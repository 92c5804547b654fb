// SPDX-License-Identifier: BSD-3-Clause
// Which voxel a point is in, and what is known of a voxel while points are counted.

#if defined(PCL_BSH_HIERARCHY_VOXEL_BINS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_HIERARCHY_VOXEL_BINS_INL_H_
#undef PCL_BSH_HIERARCHY_VOXEL_BINS_INL_H_
#else
#define PCL_BSH_HIERARCHY_VOXEL_BINS_INL_H_
#endif

#include <pcl_bsh/hierarchy/morton.h>
#include <pcl_bsh/hierarchy/point_reader-inl.h>
#include <pcl_bsh/hierarchy/point_runs.h>
#include <pcl_bsh/hierarchy/voxel_edge.h>

#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

/// Points of the same voxel, as one chunk of the cloud has them.
template <class T>
struct Bin {
  std::uint64_t cell = 0;
  std::uint32_t count = 0;
  std::uint32_t voxel = 0; ///< its number, known after merging
  std::uint32_t first = 0; ///< place in the voxel of this chunk's first point, likewise
  alignas(16) T low[4];
  alignas(16) T high[4];

  Bin()
  {
    std::fill(low, low + 4, std::numeric_limits<T>::infinity());
    std::fill(high, high + 4, -std::numeric_limits<T>::infinity());
  }

  void add(const Point<T>& p) { add(p, p, 1); }

  /// `more` points between two corners.
  void add(const Point<T>& lowest, const Point<T>& highest, std::uint32_t more)
  {
    count += more;
    min(Point<T>::load(low), lowest).store(low);
    max(Point<T>::load(high), highest).store(high);
  }
};

/// Which cell of the grid a point is in, as one number: 21 bits per axis, counted from the lowest cell. Deterministic
/// is all it needs to be: a point that rounding puts into the neighbouring voxel belongs to that, for frames follow
/// points.
template <class T>
class CellNumbers {
public:
  CellNumbers(double edge, const Bounds& bounds)
  : inverse_(Point<T>::of(static_cast<T>(1.0 / edge))),
    base_(Point<T>::of(0))
  {
    T base[4] = {};
    for (std::size_t k = 0; k < 3; ++k)
      base[k] = std::floor(static_cast<T>(bounds.low[k]) * static_cast<T>(1.0 / edge)) - kMargin;
    base_ = Point<T>::load(base);
  }

  /// The cell's numbers along the axes, in the point's type.
  Point<T> numbers(const Point<T>& p) const { return (p * inverse_ - base_).truncated(); }

  /// The same as one number; kOutside when the point is not finite or too far from the bounds to be counted.
  static std::uint64_t together(const Point<T>& numbers)
  {
    std::int32_t number[4];
    numbers.storeTruncated(number);
    const auto bits = [&](std::size_t k) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(number[k])); };
    if ((bits(0) | bits(1) | bits(2)) >> kMortonBits != 0) return kOutside;
    return bits(0) << 42 | bits(1) << 21 | bits(2);
  }

  static constexpr std::uint64_t kOutside = ~std::uint64_t{0};

  /// Number 0 on each axis, in cells from the origin.
  std::array<double, 3> base() const
  {
    T base[4];
    base_.store(base);
    return {static_cast<double>(base[0]), static_cast<double>(base[1]), static_cast<double>(base[2])};
  }

  static std::uint64_t morton(std::uint64_t cell)
  {
    return mortonCode(cell >> 42, cell >> 21 & 0x1fffff, cell & 0x1fffff);
  }

private:
  static constexpr T kMargin = 1024; // cells below the bounds: those of a sample leave some points out

  Point<T> inverse_, base_;
};

/// Finds or adds the bin of a cell: open addressing, doubled when half full.
template <class T>
class BinTable {
public:
  BinTable() : slots_(1024, kNoBin) {}

  std::uint32_t find(std::uint64_t cell)
  {
    for (std::size_t i = hash(cell);; i = (i + 1) & (slots_.size() - 1)) {
      if (slots_[i] == kNoBin) return add(cell, i);
      if (bins[slots_[i]].cell == cell) return slots_[i];
    }
  }

  std::vector<Bin<T>> bins;

private:
  /// Of 32 bits, for there are fewer slots than 2^32.
  std::size_t hash(std::uint64_t cell) const { return (cell * 0x9e3779b97f4a7c15u >> 32) & (slots_.size() - 1); }

  std::uint32_t add(std::uint64_t cell, std::size_t slot)
  {
    const auto bin = static_cast<std::uint32_t>(bins.size());
    bins.emplace_back();
    bins.back().cell = cell;
    slots_[slot] = bin;
    if (2 * bins.size() > slots_.size()) grow();
    return bin;
  }

  void grow()
  {
    slots_.assign(2 * slots_.size(), kNoBin);
    for (std::uint32_t bin = 0; bin < bins.size(); ++bin) {
      std::size_t i = hash(bins[bin].cell);
      while (slots_[i] != kNoBin) i = (i + 1) & (slots_.size() - 1);
      slots_[i] = bin;
    }
  }

  std::vector<std::uint32_t> slots_;
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
