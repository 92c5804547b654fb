// SPDX-License-Identifier: BSD-3-Clause
// Points of a view in registers, read as they are stored: of float32 and of float64 clouds, with the same operations.

#if defined(PCL_BSH_HIERARCHY_BUILD_POINT_READER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_HIERARCHY_BUILD_POINT_READER_INL_H_
#undef PCL_BSH_HIERARCHY_BUILD_POINT_READER_INL_H_
#else
#define PCL_BSH_HIERARCHY_BUILD_POINT_READER_INL_H_
#endif

#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/simd/quad-inl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A point of a float64 cloud, with the operations that Quad has for float32.
struct Triple {
  double v[3];

  static Triple load(const double* from) { return {{from[0], from[1], from[2]}}; }
  static Triple of(double value) { return {{value, value, value}}; }
  void store(double* to) const { std::copy_n(v, 3, to); }
  /// As Quad does: what no int32 can hold, NaN included, becomes the lowest.
  void storeTruncated(std::int32_t* to) const
  {
    for (int k = 0; k < 3; ++k)
      to[k] = std::abs(v[k]) < 0x1p31 ? static_cast<std::int32_t>(v[k]) : std::numeric_limits<std::int32_t>::min();
  }
  Triple truncated() const
  {
    return apply(*this, *this, [](double value, double) { return std::trunc(value); });
  }
  friend bool sameXyz(const Triple& a, const Triple& b) { return std::equal(a.v, a.v + 3, b.v); }
  bool finite() const { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

  template <class Operation>
  static Triple apply(const Triple& a, const Triple& b, const Operation& operation)
  {
    return {{operation(a.v[0], b.v[0]), operation(a.v[1], b.v[1]), operation(a.v[2], b.v[2])}};
  }
  friend Triple operator-(const Triple& a, const Triple& b) { return apply(a, b, std::minus<double>()); }
  friend Triple operator*(const Triple& a, const Triple& b) { return apply(a, b, std::multiplies<double>()); }
  friend Triple min(const Triple& a, const Triple& b)
  {
    return apply(a, b, [](double l, double r) { return r < l ? r : l; });
  }
  friend Triple max(const Triple& a, const Triple& b)
  {
    return apply(a, b, [](double l, double r) { return r > l ? r : l; });
  }
};

/// How a scalar type's points are held and computed with.
template <class T>
struct PointOf;
template <>
struct PointOf<float> {
  using Type = Quad;
};
template <>
struct PointOf<double> {
  using Type = Triple;
};
template <class T>
using GivenPoint = typename PointOf<T>::Type;

/// Reads points of a view as they are stored.
template <class T>
class Reader {
public:
  explicit Reader(const PointsView& view)
  : data_(static_cast<const unsigned char*>(view.data)),
    stride_(view.stride),
    offset_(view.offset)
  {
    const bool in_a_row = offset_[1] == offset_[0] + sizeof(T) && offset_[2] == offset_[0] + 2 * sizeof(T);
    const bool aligned = reinterpret_cast<std::uintptr_t>(data_) % alignof(T) == 0 && stride_ % alignof(T) == 0 &&
                         offset_[0] % alignof(T) == 0;
    // The spare lane of a Quad is read with the point; the last one must not be read beyond.
    if (in_a_row && aligned && stride_ >= 3 * sizeof(T) && view.count > 0)
      whole_ = static_cast<std::uint32_t>(view.count - 1);
  }

  GivenPoint<T> operator()(std::uint32_t record) const
  {
    if (record < whole_) return load(record);
    const unsigned char* base = data_ + stride_ * record;
    T copy[4] = {};
    for (std::size_t k = 0; k < 3; ++k) std::memcpy(copy + k, base + offset_[k], sizeof(T));
    return GivenPoint<T>::load(copy);
  }

  /// Records below this number may be read by load(), which may also read bytes behind the point.
  std::uint32_t whole() const { return whole_; }

  /// @pre record < whole()
  GivenPoint<T> load(std::uint32_t record) const
  {
    return GivenPoint<T>::load(reinterpret_cast<const T*>(data_ + stride_ * record + offset_[0]));
  }

private:
  const unsigned char* data_;
  std::size_t stride_;
  std::array<std::size_t, 3> offset_;
  std::uint32_t whole_ = 0;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
