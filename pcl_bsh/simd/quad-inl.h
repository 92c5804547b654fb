// SPDX-License-Identifier: BSD-3-Clause
// Four floats as one value: a point's x, y, z and a lane to spare.

#if defined(PCL_BSH_SIMD_QUAD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_SIMD_QUAD_INL_H_
#undef PCL_BSH_SIMD_QUAD_INL_H_
#else
#define PCL_BSH_SIMD_QUAD_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

class Quad {
public:
  static HWY_INLINE Quad load(const float* from)
  {
    Quad q;
    for (std::size_t i = 0; i < kVectors; ++i) q.v_[i] = hn::LoadU(Tag(), from + i * kStep);
    return q;
  }

  static HWY_INLINE Quad of(float value)
  {
    Quad q;
    for (std::size_t i = 0; i < kVectors; ++i) q.v_[i] = hn::Set(Tag(), value);
    return q;
  }

  HWY_INLINE void store(float* to) const
  {
    for (std::size_t i = 0; i < kVectors; ++i) hn::StoreU(v_[i], Tag(), to + i * kStep);
  }

  /// Whole numbers, truncated towards zero. Lanes that are far from the range of int32 hold anything.
  HWY_INLINE Quad truncated() const
  {
    Quad q;
    for (std::size_t i = 0; i < kVectors; ++i) q.v_[i] = hn::Trunc(v_[i]);
    return q;
  }

  /// Truncated towards zero. Numbers outside int32 become its lowest or highest, NaN a negative one.
  HWY_INLINE void storeTruncated(std::int32_t* to) const
  {
    const hn::RebindToSigned<Tag> d;
    for (std::size_t i = 0; i < kVectors; ++i) {
      const auto nan = hn::BitCast(d, hn::VecFromMask(Tag(), hn::IsNaN(v_[i]))); // which ARM converts to 0
      hn::StoreU(hn::Or(hn::ConvertTo(d, v_[i]), nan), d, to + i * kStep);
    }
  }

  /// Whether x, y and z are the same, and none is NaN.
  friend HWY_INLINE bool sameXyz(const Quad& a, const Quad& b)
  {
    return everyXyz([&](std::size_t i) { return hn::Eq(a.v_[i], b.v_[i]); });
  }

  /// Whether x, y and z are finite.
  HWY_INLINE bool finite() const
  {
    return everyXyz(
        [&](std::size_t i) { return hn::Le(hn::Abs(v_[i]), hn::Set(Tag(), std::numeric_limits<float>::max())); });
  }

  friend HWY_INLINE Quad operator-(const Quad& a, const Quad& b)
  {
    Quad q;
    for (std::size_t i = 0; i < kVectors; ++i) q.v_[i] = hn::Sub(a.v_[i], b.v_[i]);
    return q;
  }

  friend HWY_INLINE Quad operator*(const Quad& a, const Quad& b)
  {
    Quad q;
    for (std::size_t i = 0; i < kVectors; ++i) q.v_[i] = hn::Mul(a.v_[i], b.v_[i]);
    return q;
  }

  friend HWY_INLINE Quad min(const Quad& a, const Quad& b)
  {
    Quad q;
    for (std::size_t i = 0; i < kVectors; ++i) q.v_[i] = hn::Min(a.v_[i], b.v_[i]);
    return q;
  }

  friend HWY_INLINE Quad max(const Quad& a, const Quad& b)
  {
    Quad q;
    for (std::size_t i = 0; i < kVectors; ++i) q.v_[i] = hn::Max(a.v_[i], b.v_[i]);
    return q;
  }

private:
  using Tag = hn::CappedTag<float, 4>;
  static constexpr std::size_t kStep = hn::MaxLanes(Tag());
  static constexpr std::size_t kVectors = 4 / kStep;

  /// Whether mask_of(i), over the i-th vector, holds for the lanes of x, y and z.
  template <class MaskOf>
  static HWY_INLINE bool everyXyz(const MaskOf& mask_of)
  {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < kVectors; ++i) {
      std::uint8_t mask[8] = {};
      hn::StoreMaskBits(Tag(), mask_of(i), mask);
      bits |= static_cast<std::uint32_t>(mask[0]) << (i * kStep);
    }
    return (bits & 7) == 7;
  }

  hn::Vec<Tag> v_[kVectors];
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
