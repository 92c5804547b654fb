// SPDX-License-Identifier: BSD-3-Clause
// roundedLength() of a leaf's points at once, where the processor multiplies and adds in one rounding.

#if defined(PCL_BSH_DISTANCES_ROUNDED_LENGTHS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_ROUNDED_LENGTHS_INL_H_
#undef PCL_BSH_DISTANCES_ROUNDED_LENGTHS_INL_H_
#else
#define PCL_BSH_DISTANCES_ROUNDED_LENGTHS_INL_H_
#endif

#include <pcl_bsh/geometry/exact/rounded_length.h>
#include <pcl_bsh/simd/point_lanes-inl.h>

#include <Eigen/Geometry>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// Pairs of points as they were given, axis by axis.
struct GivenPairs {
  alignas(64) double p[3][kLeafPoints];
  alignas(64) double q[3][kLeafPoints];
};

#if HWY_NATIVE_FMA
using DoubleTag = hn::CappedTag<double, kLanes>;
using DoubleVector = hn::Vec<DoubleTag>;

/// The rounded sum; `error` is what it lacks.
HWY_INLINE DoubleVector twoSums(DoubleVector a, DoubleVector b, DoubleVector& error)
{
  const DoubleVector sum = hn::Add(a, b), b_part = hn::Sub(sum, a);
  error = hn::Add(hn::Sub(a, hn::Sub(sum, b_part)), hn::Sub(b, b_part));
  return sum;
}

/// root + correction, within kLengthDoubt * root where it is known.
struct LongLengths {
  DoubleVector root, correction;
  hn::Mask<DoubleTag> known;
};

/// |(p - q) + shift| of the pairs from i on, as many as a vector has.
///
/// A coordinate is value + tail, up to the rounding of the tail; `errors` is the absolute sum of its terms. The square
/// of a value is two doubles, and what the tail adds to it is `mixed`, at most `most_mixed`. The sum of the squares is
/// high and its rounding errors; all that is of low order is added up in `low`, and its absolute sum in `size_of_low`.
/// high - root^2 is a double.
HWY_INLINE LongLengths longLengths(const GivenPairs& pairs, std::size_t i, const std::array<WithError, 3>& shift)
{
  const DoubleTag d;
  using Vector = DoubleVector;
  Vector high = hn::Zero(d), low = hn::Zero(d), size_of_low = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    Vector between_error, sum_error;
    const Vector between = twoSums(hn::Load(d, pairs.p[k] + i), hn::Neg(hn::Load(d, pairs.q[k] + i)), between_error);
    const Vector value = twoSums(between, hn::Set(d, shift[k].value), sum_error);
    const Vector tail = hn::Add(hn::Add(between_error, hn::Set(d, shift[k].error)), sum_error);
    const Vector errors =
        hn::Add(hn::Add(hn::Abs(between_error), hn::Set(d, std::abs(shift[k].error))), hn::Abs(sum_error));
    const Vector square = hn::Mul(value, value), square_error = hn::MulSub(value, value, square);
    const Vector mixed = hn::Mul(hn::Add(hn::Add(value, value), tail), tail);
    const Vector length = hn::Add(hn::Abs(value), errors), most_mixed = hn::Mul(hn::Add(length, length), errors);
    Vector rounding;
    high = twoSums(high, square, rounding);
    low = hn::Add(low, hn::Add(rounding, hn::Add(square_error, mixed)));
    size_of_low = hn::Add(size_of_low, hn::Add(hn::Abs(rounding), hn::Add(hn::Abs(square_error), most_mixed)));
  }
  // Products that underflow are below 2^-1000, beside squares of 2^-900.
  const auto known = hn::And(hn::And(hn::Gt(high, hn::Set(d, 0x1p-900)), hn::Lt(high, hn::Set(d, 0x1p900))),
                             hn::Lt(size_of_low, hn::Mul(high, hn::Set(d, kMostLowOrder))));
  const Vector root = hn::Sqrt(high);
  return {root, hn::Div(hn::Add(hn::NegMulAdd(root, root, high), low), hn::Add(root, root)), known};
}
#endif

/// |(p - q) + shift| of the first `count` pairs, and those that fill the last vector, each as roundedLength() has it
/// without radii; NaN where doubles are in doubt, or where the instruction set has no such arithmetic.
/// @param shift between the clouds, along each axis, with its rounding error
HWY_INLINE void roundedLengths(const GivenPairs& pairs, std::size_t count, const std::array<WithError, 3>& shift,
                               double* lengths)
{
#if HWY_NATIVE_FMA
  const DoubleTag d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const LongLengths found = longLengths(pairs, i, shift);
    const DoubleVector doubt = hn::Mul(found.root, hn::Set(d, kLengthDoubt));
    DoubleVector rest;
    const DoubleVector rounded = twoSums(found.root, found.correction, rest);
    const auto sure = hn::And(found.known, hn::And(hn::Eq(hn::Add(rounded, hn::Add(rest, doubt)), rounded),
                                                   hn::Eq(hn::Add(rounded, hn::Sub(rest, doubt)), rounded)));
    hn::StoreU(hn::IfThenElse(sure, rounded, hn::Set(d, std::numeric_limits<double>::quiet_NaN())), d, lengths + i);
  }
#else
  (void)pairs, (void)count, (void)shift;
  std::fill(lengths, lengths + kLeafPoints, std::numeric_limits<double>::quiet_NaN());
#endif
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
