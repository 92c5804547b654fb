// SPDX-License-Identifier: BSD-3-Clause
// Which cell of the voxel grid a point is in.

#if defined(PCL_BSH_HIERARCHY_BUILD_CELL_NUMBERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_HIERARCHY_BUILD_CELL_NUMBERS_INL_H_
#undef PCL_BSH_HIERARCHY_BUILD_CELL_NUMBERS_INL_H_
#else
#define PCL_BSH_HIERARCHY_BUILD_CELL_NUMBERS_INL_H_
#endif

#include <pcl_bsh/hierarchy/bounds.h>
#include <pcl_bsh/hierarchy/build/morton.h>
#include <pcl_bsh/hierarchy/build/point_reader-inl.h>

#include <array>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// The cell of a point as one number: 21 bits per axis, counted from a base below the cloud. The number need only be
/// the same whenever it is computed: a point that rounding puts into the neighbouring voxel belongs to that
/// voxel, because frames are measured over points.
template <class T>
class CellNumbers {
public:
  /// @param base number 0 on each axis, in cells from the origin
  CellNumbers(double edge, const std::array<double, 3>& base)
  : inverse_(GivenPoint<T>::of(static_cast<T>(1.0 / edge))),
    base_(pointOf(base))
  {
  }

  /// The base for a cloud. @param bounds of its points, or of a sample of them
  static std::array<double, 3> baseOf(double edge, const Bounds& bounds)
  {
    std::array<double, 3> base;
    for (std::size_t k = 0; k < 3; ++k) {
      const T cell = std::floor(static_cast<T>(bounds.low[k]) * static_cast<T>(1.0 / edge)) - kMargin;
      base[k] = static_cast<double>(cell);
    }
    return base;
  }

  static GivenPoint<T> pointOf(const Point3& p)
  {
    const T copy[4] = {static_cast<T>(p[0]), static_cast<T>(p[1]), static_cast<T>(p[2]), 0};
    return GivenPoint<T>::load(copy);
  }

  /// The cell's numbers along the axes, in the point's type.
  GivenPoint<T> numbers(const GivenPoint<T>& p) const { return (p * inverse_ - base_).truncated(); }

  /// The cell's numbers packed into one; kOutsideGrid when the point is not finite or too far from the bounds to be
  /// counted.
  static std::uint64_t together(const GivenPoint<T>& numbers)
  {
    std::int32_t number[4];
    numbers.storeTruncated(number);
    const auto bits = [&](std::size_t k) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(number[k])); };
    if ((bits(0) | bits(1) | bits(2)) >> kMortonBits != 0) return kOutsideGrid;
    return bits(0) << 42 | bits(1) << 21 | bits(2);
  }

  static std::uint64_t morton(std::uint64_t cell)
  {
    return mortonCode(cell >> 42, cell >> 21 & 0x1fffff, cell & 0x1fffff);
  }

private:
  static constexpr T kMargin = 1024; // cells below the bounds: those of a sample leave some points out

  GivenPoint<T> inverse_, base_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
