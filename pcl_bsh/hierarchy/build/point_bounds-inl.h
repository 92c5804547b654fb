// SPDX-License-Identifier: BSD-3-Clause
// Axis-aligned bounds of points as a voxel stores them.

#if defined(PCL_BSH_HIERARCHY_BUILD_POINT_BOUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_HIERARCHY_BUILD_POINT_BOUNDS_INL_H_
#undef PCL_BSH_HIERARCHY_BUILD_POINT_BOUNDS_INL_H_
#else
#define PCL_BSH_HIERARCHY_BUILD_POINT_BOUNDS_INL_H_
#endif

#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/simd/quad-inl.h>

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// Bounds of some points. The fourth lane holds nothing.
struct PointBounds {
  alignas(16) float low[4] = {kNone, kNone, kNone, kNone};
  alignas(16) float high[4] = {-kNone, -kNone, -kNone, -kNone};
  static constexpr float kNone = std::numeric_limits<float>::infinity();

  float extent(int axis) const { return high[axis] - low[axis]; }
};

/// The point's coordinates, and its record number taken for a float.
HWY_INLINE Quad quadOf(const PointRecord& p)
{
  return Quad::load(reinterpret_cast<const float*>(&p));
}

inline PointBounds boundsOf(const PointRecord* records, std::size_t count)
{
  Quad low = quadOf(records[0]), high = low;
  for (std::size_t i = 1; i < count; ++i) {
    const Quad p = quadOf(records[i]);
    low = min(low, p);
    high = max(high, p);
  }
  PointBounds bounds;
  low.store(bounds.low);
  high.store(bounds.high);
  return bounds;
}

inline int longestAxis(const PointBounds& bounds)
{
  const int axis = bounds.extent(1) > bounds.extent(0) ? 1 : 0;
  return bounds.extent(2) > bounds.extent(axis) ? 2 : axis;
}

inline void merge(PointBounds& bounds, const PointBounds& other)
{
  min(Quad::load(bounds.low), Quad::load(other.low)).store(bounds.low);
  max(Quad::load(bounds.high), Quad::load(other.high)).store(bounds.high);
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
