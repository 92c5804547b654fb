// SPDX-License-Identifier: BSD-3-Clause
// roundedLength() of a leaf's points at once, where the processor multiplies and adds in one rounding.

#if defined(PCL_BSH_DISTANCES_ROUNDED_LENGTHS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_ROUNDED_LENGTHS_INL_H_
#undef PCL_BSH_DISTANCES_ROUNDED_LENGTHS_INL_H_
#else
#define PCL_BSH_DISTANCES_ROUNDED_LENGTHS_INL_H_
#endif

#include <pcl_bsh/geometry/rounded_length.h>
#include <pcl_bsh/simd/point_lanes-inl.h>

#include <Eigen/Geometry>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

/// Pairs of points as they were given, axis by axis.
struct GivenPairs {
  alignas(64) double p[3][kLeafPoints];
  alignas(64) double q[3][kLeafPoints];
};

/// |(p - q) + shift| of the first `count` pairs, and those that fill the last vector, each as roundedLength() has it
/// without radii; NaN where doubles are in doubt, or where the instruction set has no such arithmetic.
/// @param shift between the clouds, along each axis, with its rounding error
HWY_INLINE void roundedLengths(const GivenPairs& pairs, std::size_t count, const std::array<WithError, 3>& shift,
                               double* lengths)
{
#if HWY_NATIVE_FMA
  const hn::CappedTag<double, kLanes> d;
  using Vector = hn::Vec<decltype(d)>;
  const auto add = [](Vector a, Vector b, Vector& error) {
    const Vector sum = hn::Add(a, b), b_part = hn::Sub(sum, a);
    error = hn::Add(hn::Sub(a, hn::Sub(sum, b_part)), hn::Sub(b, b_part));
    return sum;
  };
  const Vector unit = hn::Set(d, kDoubleUnit);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    Vector high = hn::Zero(d), low = hn::Zero(d), size_of_low = hn::Zero(d), error = hn::Zero(d);
    for (std::size_t k = 0; k < 3; ++k) {
      Vector between_error, sum_error;
      const Vector between = add(hn::Load(d, pairs.p[k] + i), hn::Neg(hn::Load(d, pairs.q[k] + i)), between_error);
      const Vector value = add(between, hn::Set(d, shift[k].value), sum_error);
      const Vector tail = hn::Add(hn::Add(between_error, hn::Set(d, shift[k].error)), sum_error);
      const Vector errors =
          hn::Add(hn::Add(hn::Abs(between_error), hn::Set(d, std::abs(shift[k].error))), hn::Abs(sum_error));
      const Vector square = hn::Mul(value, value), square_error = hn::MulSub(value, value, square);
      const Vector mixed = hn::Mul(hn::Add(hn::Add(value, value), tail), tail);
      Vector rounding;
      high = add(high, square, rounding);
      low = hn::Add(low, hn::Add(rounding, hn::Add(square_error, mixed)));
      size_of_low = hn::Add(size_of_low, hn::Add(hn::Abs(rounding), hn::Add(hn::Abs(square_error), hn::Abs(mixed))));
      // Of the tail, four units of `errors`; of `mixed`, as much: twice that pays for both, and for squares.
      error =
          hn::Add(error, hn::Mul(hn::Add(hn::Abs(value), errors), hn::Mul(errors, hn::Mul(hn::Set(d, 32.0), unit))));
    }
    const auto in_range = hn::And(hn::And(hn::Gt(high, hn::Set(d, 0x1p-900)), hn::Lt(high, hn::Set(d, 0x1p900))),
                                  hn::Lt(size_of_low, hn::Mul(high, hn::Set(d, 0x1p-50))));
    error = hn::Add(hn::Add(error, error), hn::Mul(size_of_low, hn::Mul(hn::Set(d, 16.0), unit)));
    error = hn::Add(error, hn::Set(d, 0x1p-1000));
    const Vector root = hn::Sqrt(high);
    const Vector correction = hn::Div(hn::Add(hn::NegMulAdd(root, root, high), low), hn::Add(root, root));
    error = hn::Add(hn::Div(error, root), hn::Mul(root, hn::Set(d, 0x1p-100)));
    error = hn::Add(error, hn::Mul(hn::Abs(correction), hn::Mul(hn::Set(d, 4.0), unit)));
    Vector rest;
    const Vector rounded = add(root, correction, rest);
    const auto sure = hn::And(in_range, hn::And(hn::Eq(hn::Add(rounded, hn::Add(rest, error)), rounded),
                                                hn::Eq(hn::Add(rounded, hn::Sub(rest, error)), rounded)));
    hn::StoreU(hn::IfThenElse(sure, rounded, hn::Set(d, std::numeric_limits<double>::quiet_NaN())), d, lengths + i);
  }
#else
  (void)pairs, (void)count, (void)shift;
  std::fill(lengths, lengths + kLeafPoints, std::numeric_limits<double>::quiet_NaN());
#endif
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
