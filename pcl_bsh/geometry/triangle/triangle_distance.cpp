// SPDX-License-Identifier: BSD-3-Clause
// Stages, each used only where it is sure of itself: an enclosure in double, the nearest features in numbers of twice
// the digits that know their error, and the same in integers of any length.
#include <pcl_bsh/geometry/triangle/triangle_distance.h>

#include <pcl_bsh/geometry/nearest_double.h>
#include <pcl_bsh/geometry/rounded_length.h>
#include <pcl_bsh/geometry/triangle/double_distance.h>
#include <pcl_bsh/geometry/triangle/nearest_features.h>

#include <limits>

namespace pcl_bsh {
namespace {

constexpr double kAnyLength = std::numeric_limits<double>::infinity();

TriangleDistance::Stages& orNone(TriangleDistance::Stages* stages, TriangleDistance::Stages& none)
{
  return stages ? *stages : none;
}

/// Sign of the root of a fraction less a length. @param squared >= 0
template <class Number>
int compareRoot(const Fraction<Number>& squared, const Number& length, bool& sure)
{
  if (signOf(length, sure) < 0) return 1;
  return signOf(squared.numerator - squared.denominator * (length * length), sure);
}

/// Its root, rounded to the nearest double; NaN where that is in doubt.
///
/// The quotient q of the values is corrected by what is left of the numerator, n - q d, as LongNumber has it, over d.
/// That correction is rounded by v twice, and taken over d's value, which is v of d off: 4 v of the correction; what n
/// - q d errs by stays as it is.
double nearestRoot(const Fraction<LongNumber>& squared)
{
  const LongNumber &n = squared.numerator, &d = squared.denominator;
  if (n.value() == 0.0 && n.tail() == 0.0 && n.error() == 0.0) return 0.0;
  const double quotient = n.value() / d.value();
  if (!(quotient > 0x1p-800 && quotient < 0x1p800 && d.value() > 0x1p-400 && d.value() < 0x1p400))
    return std::numeric_limits<double>::quiet_NaN();
  const LongNumber left = n - LongNumber(quotient) * d;
  const double correction = (left.value() + left.tail()) / d.value();
  const double error = 2.0 * left.error() / d.value() + 8 * kDoubleUnit * std::abs(correction);
  return roundedRoot(quotient, correction, error);
}

/// The same to within a few units of the last place; infinite or 0 where doubles have no such number.
double roughRoot(const Fraction<Dyadic>& squared)
{
  const auto n = squared.numerator.scaled(), d = squared.denominator.scaled();
  if (n.mantissa == 0.0) return 0.0;
  const int exponent = n.exponent - d.exponent, odd = exponent & 1;
  return std::ldexp(std::sqrt(std::ldexp(n.mantissa / d.mantissa, odd)), (exponent - odd) / 2);
}

} // namespace

TriangleDistance::TriangleDistance(const Eigen::Isometry3d& pose_a, const Eigen::Isometry3d& pose_b)
: points_(pose_a, pose_b)
{
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      a_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = pose_a.matrix()(i, j);
      b_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = pose_b.matrix()(i, j);
    }
  }
}

// Double ----------------------------------------------------------------------------------------------------------

TriangleDistance::Enclosure TriangleDistance::enclose(const Point3& p, const Triangle3& b) const
{
  Triangle3 seen; // from the point
  double error = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const ExactDistance::Difference z = points_.approximate(p, b[i]);
    seen[i] = {-z.vector[0], -z.vector[1], -z.vector[2]};
    error = std::max(error, z.error);
  }
  if (!isFinite(seen) || !std::isfinite(error)) return {-kAnyLength, kAnyLength};
  return distanceOfOrigin(flatten<double>(seen, error));
}

TriangleDistance::Approximate TriangleDistance::approximate(const Triangle3& a, const Triangle3& b, double reach) const
{
  // All seen from the first corner of b: those of b by way of the first of a.
  Triangle3 seen_a, seen_b;
  double error_a = 0.0, error_b = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const ExactDistance::Difference z = points_.approximate(a[i], b[0]);
    seen_a[i] = z.vector;
    error_a = std::max(error_a, z.error);
  }
  const double first = error_a;
  seen_b[0] = {0, 0, 0};
  for (std::size_t j = 1; j < 3; ++j) {
    const ExactDistance::Difference z = points_.approximate(a[0], b[j]);
    for (std::size_t k = 0; k < 3; ++k) {
      seen_b[j][k] = seen_a[0][k] - z.vector[k];
      error_b = std::max(error_b, first + z.error + 2 * kDoubleUnit * std::abs(seen_b[j][k]));
    }
  }
  const double error = error_a + error_b;
  if (!isFinite(seen_a) || !isFinite(seen_b) || !std::isfinite(error)) return {{-kAnyLength, kAnyLength}, 0x1ff, 0x3f};
  const DoubleDistance found = distanceOfTriangles(seen_a, seen_b, error, reach);
  return {found.distance, found.pairs.edges, found.pairs.faces};
}

TriangleDistance::Enclosure TriangleDistance::enclose(const Triangle3& a, const Triangle3& b) const
{
  return approximate(a, b, kAnyLength).distance;
}

int TriangleDistance::compare(const Point3& p, const Triangle3& b, double clearance, double radius,
                              Stages* stages) const
{
  Stages none, &count = orNone(stages, none);
  const double reach = clearance + radius;
  const double rounding = kFewDoubleRoundings * (std::abs(clearance) + std::abs(radius));
  const Enclosure found = enclose(p, b);
  if (found.high < reach - rounding || clearance == kAnyLength) return ++count.doubles, -1;
  if (found.low > reach + rounding) return ++count.doubles, 1;
  return settle(PointPair{p, b}, clearance, radius, count);
}

int TriangleDistance::compare(const Triangle3& a, const Triangle3& b, double clearance, Stages* stages) const
{
  Stages none, &count = orNone(stages, none);
  if (clearance == kAnyLength) return ++count.doubles, -1;
  const Enclosure found = approximate(a, b, clearance).distance;
  if (found.high < clearance) return ++count.doubles, -1;
  if (found.low > clearance) return ++count.doubles, 1;
  return settle(TrianglePair{a, b}, clearance, 0.0, count);
}

// Longer numbers --------------------------------------------------------------------------------------------------

template <class Number>
std::array<Number, 3> TriangleDistance::placed(const Pose& pose, const Point3& p) const
{
  std::array<Number, 3> at;
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = Number(pose[k][3]);
    for (std::size_t j = 0; j < 3; ++j) // upright poses are half zeros
      if (pose[k][j] != 0.0) at[k] += Number(pose[k][j]) * Number(p[j]);
  }
  return at;
}

template <class Number>
NearestFeatures<Number> TriangleDistance::nearest(const PointPair& pair) const
{
  return {placed<Number>(a_, pair.a),
          {placed<Number>(b_, pair.b[0]), placed<Number>(b_, pair.b[1]), placed<Number>(b_, pair.b[2])}};
}

template <class Number>
NearestFeatures<Number> TriangleDistance::nearest(const TrianglePair& pair) const
{
  const Approximate found = approximate(pair.a, pair.b, kAnyLength);
  return {{placed<Number>(a_, pair.a[0]), placed<Number>(a_, pair.a[1]), placed<Number>(a_, pair.a[2])},
          {placed<Number>(b_, pair.b[0]), placed<Number>(b_, pair.b[1]), placed<Number>(b_, pair.b[2])},
          {found.edges, found.faces}};
}

template <class Pair>
int TriangleDistance::settle(const Pair& pair, double clearance, double radius, Stages& stages) const
{
  if (const auto features = nearest<LongNumber>(pair); features.sure()) {
    bool sure = true;
    const int side = compareRoot(features.squared(), LongNumber(clearance) + LongNumber(radius), sure);
    if (sure) return ++stages.long_numbers, side;
  }
  bool always = true;
  ++stages.integers;
  return compareRoot(nearest<Dyadic>(pair).squared(), Dyadic(clearance) + Dyadic(radius), always);
}

template <class Pair>
int TriangleDistance::settleOrder(const Pair& first, const TriangleDistance& other, const Pair& second,
                                  Stages& stages) const
{
  const Enclosure x = enclose(first.a, first.b), y = other.enclose(second.a, second.b);
  if (x.high < y.low) return ++stages.doubles, -1;
  if (x.low > y.high) return ++stages.doubles, 1;
  if (this == &other && first.a == second.a && first.b == second.b) return ++stages.doubles, 0;
  const auto long_x = nearest<LongNumber>(first);
  if (long_x.sure()) {
    if (const auto long_y = other.nearest<LongNumber>(second); long_y.sure()) {
      bool sure = true;
      const int side = compareFractions(long_x.squared(), long_y.squared(), sure);
      if (sure) return ++stages.long_numbers, side;
    }
  }
  bool always = true;
  ++stages.integers;
  return compareFractions(nearest<Dyadic>(first).squared(), other.nearest<Dyadic>(second).squared(), always);
}

template <class Pair>
double TriangleDistance::rounded(const Pair& pair, Stages& stages) const
{
  if (const auto features = nearest<LongNumber>(pair); features.sure()) {
    const double length = nearestRoot(features.squared());
    if (!std::isnan(length)) return ++stages.long_numbers, length;
  }
  ++stages.integers;
  const auto features = nearest<Dyadic>(pair);
  if (features.squared().numerator.sign() == 0) return 0.0;
  bool always = true;
  return nearestDouble(roughRoot(features.squared()),
                       [&](const Dyadic& x) { return compareRoot(features.squared(), x, always); });
}

int TriangleDistance::compareDistances(const PointPair& first, const TriangleDistance& other, const PointPair& second,
                                       Stages* stages) const
{
  Stages none;
  return settleOrder(first, other, second, orNone(stages, none));
}

int TriangleDistance::compareDistances(const TrianglePair& first, const TriangleDistance& other,
                                       const TrianglePair& second, Stages* stages) const
{
  Stages none;
  return settleOrder(first, other, second, orNone(stages, none));
}

double TriangleDistance::distance(const Point3& p, const Triangle3& b, Stages* stages) const
{
  Stages none;
  return rounded(PointPair{p, b}, orNone(stages, none));
}

double TriangleDistance::distance(const Triangle3& a, const Triangle3& b, Stages* stages) const
{
  Stages none;
  return rounded(TrianglePair{a, b}, orNone(stages, none));
}

} // namespace pcl_bsh
