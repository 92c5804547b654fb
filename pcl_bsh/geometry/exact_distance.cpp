// SPDX-License-Identifier: BSD-3-Clause
// Stages, each used only where it is sure of itself: an enclosure in double, one with compensated sums, an expansion
// when the coordinate differences are doubles, integers of any length.
#include <pcl_bsh/geometry/exact_distance.h>

#include <pcl_bsh/geometry/exact/compensated_sum.h>
#include <pcl_bsh/geometry/exact/dyadic.h>
#include <pcl_bsh/geometry/exact/expansion.h>
#include <pcl_bsh/geometry/exact/nearest_double.h>
#include <pcl_bsh/geometry/exact/rough_root_less.h>
#include <pcl_bsh/geometry/exact/rounded_length.h>

#include <limits>

namespace pcl_bsh {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

constexpr double kUnderflow = 0x1p-500; ///< as a length: squares of less than 2^-537 vanish

/// Whether the squares of these, and the errors of the squares, are clear of underflow and overflow.
bool safelySquared(const Point3& values)
{
  for (const double value : values) {
    const double magnitude = std::abs(value);
    if (magnitude != 0.0 && !(magnitude > 0x1p-450 && magnitude < 0x1p500)) return false;
  }
  return true;
}

/// Sign of |x|^2 - |y|^2, for values that are safelySquared().
int compareSquares(const Point3& x, const Point3& y)
{
  Expansion<12> difference;
  for (std::size_t k = 0; k < 3; ++k) {
    if (x[k] != 0.0) difference.add(twoProduct(x[k], x[k]));
    if (y[k] != 0.0) difference.add(twoProduct(-y[k], y[k]));
  }
  return difference.sign();
}

Dyadic square(const Dyadic& x)
{
  return x * x;
}

/// Sign of sqrt(squared) - y.
int compareRoot(const Dyadic& squared, const Dyadic& y)
{
  return y.sign() < 0 ? 1 : (squared - square(y)).sign();
}

/// Sign of sqrt(x) + shift - sqrt(y).
int compareShiftedRoots(const Dyadic& x, const Dyadic& shift, const Dyadic& y)
{
  if (shift.sign() < 0) return -compareShiftedRoots(y, -shift, x);
  // Both sides are >= 0, so their squares compare alike: x + shift^2 - y + 2 shift sqrt(x).
  const Dyadic rational = x + square(shift) - y;
  const Dyadic irrational_squared = Dyadic(4.0) * square(shift) * x;
  return rational.sign() >= 0 ? (rational + irrational_squared).sign() : (irrational_squared - square(rational)).sign();
}

} // namespace

ExactDistance::ExactDistance(const Eigen::Isometry3d& pose_a, const Eigen::Isometry3d& pose_b)
: translations_only_(pose_a.linear() == Eigen::Matrix3d::Identity() && pose_b.linear() == Eigen::Matrix3d::Identity())
{
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      a_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = pose_a.matrix()(i, j);
      b_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = pose_b.matrix()(i, j);
    }
  }
}

int ExactDistance::compare(const Point3& p, const Point3& q, double clearance, double radius_p, double radius_q) const
{
  // Two sums, rounded relative to what they add up, which may be of either sign.
  const double reach = clearance + radius_p + radius_q;
  const double rounding = kFewDoubleRoundings * (std::abs(clearance) + std::abs(radius_p) + std::abs(radius_q));
  const auto side = [reach, rounding](const Enclosure& distance) {
    return distance.high < reach - rounding ? -1 : distance.low > reach + rounding ? 1 : 0;
  };
  if (const int found = side(enclose(p, q)); found != 0) return found;
  if (!translations_only_)
    if (const int found = side(encloseClosely(p, q)); found != 0) return found;

  if (clearance == kUnbounded) return -1;
  Point3 difference;
  if (radius_p == 0.0 && radius_q == 0.0 && exactDifference(p, q, difference)) {
    const Point3 length = {clearance, 0.0, 0.0};
    if (safelySquared(length)) return compareSquares(difference, length);
  }
  return compareRoot(squaredDistance(p, q), Dyadic(clearance) + Dyadic(radius_p) + Dyadic(radius_q));
}

int ExactDistance::compare(const Point3& p, const Point3& q, const Sum& reach) const
{
  // Seven sums, rounded relative to what they add up, which may be of either sign.
  double sum = 0.0, magnitude = 0.0;
  for (const double term : reach) {
    sum += term;
    magnitude += std::abs(term);
  }
  const double rounding = 2 * kFewDoubleRoundings * magnitude;
  const auto side = [sum, rounding](const Enclosure& distance) {
    return distance.high < sum - rounding ? -1 : distance.low > sum + rounding ? 1 : 0;
  };
  if (const int found = side(enclose(p, q)); found != 0) return found;
  if (!translations_only_)
    if (const int found = side(encloseClosely(p, q)); found != 0) return found;
  Dyadic exact;
  for (const double term : reach) exact += Dyadic(term);
  return compareRoot(squaredDistance(p, q), exact);
}

int ExactDistance::compareGaps(const Pair& first, const ExactDistance& other, const Pair& second) const
{
  const double first_radii = first.radius_p + first.radius_q;
  const double second_radii = second.radius_p + second.radius_q;
  const Enclosure first_distance = enclose(first.p, first.q);
  const Enclosure second_distance = other.enclose(second.p, second.q);
  const double slack = kFewDoubleRoundings * (first_distance.high + second_distance.high + first_radii + second_radii);
  if (first_distance.high - first_radii + slack < second_distance.low - second_radii) return -1;
  if (second_distance.high - second_radii + slack < first_distance.low - first_radii) return 1;
  // Scans have points twice, and then ties everywhere.
  if (this == &other && first.p == second.p && first.q == second.q && first.radius_p == second.radius_p &&
      first.radius_q == second.radius_q)
    return 0;

  Point3 x, y;
  if (first_radii == 0.0 && second_radii == 0.0 && exactDifference(first.p, first.q, x) &&
      other.exactDifference(second.p, second.q, y)) {
    return compareSquares(x, y);
  }
  const Dyadic shift =
      Dyadic(second.radius_p) + Dyadic(second.radius_q) - Dyadic(first.radius_p) - Dyadic(first.radius_q);
  return compareShiftedRoots(squaredDistance(first.p, first.q), shift, other.squaredDistance(second.p, second.q));
}

double ExactDistance::gap(const Pair& pair) const
{
  const double quick = roundedLength(difference(pair.p, pair.q), pair.radius_p, pair.radius_q);
  if (!std::isnan(quick)) return quick;
  const Dyadic squared = squaredDistance(pair.p, pair.q);
  const Dyadic radii = Dyadic(pair.radius_p) + Dyadic(pair.radius_q);
  if (compareRoot(squared, radii) == 0) return 0.0;

  return nearestDouble(roughRootLess(squared, Dyadic(1.0), radii),
                       [&](const Dyadic& x) { return compareRoot(squared, radii + x); });
}

ExactDistance::Enclosure ExactDistance::enclose(const Point3& p, const Point3& q) const
{
  const Difference z = approximate(p, q);
  const double distance = std::sqrt(z.vector[0] * z.vector[0] + z.vector[1] * z.vector[1] + z.vector[2] * z.vector[2]);
  const double error = translations_only_ ? kFewDoubleRoundings * distance + z.error : z.error;
  if (!std::isfinite(distance + error)) return {-kUnbounded, kUnbounded};
  return {distance - error, distance + error};
}

/// Double arithmetic with its error. A coordinate sums eight terms, each rounded at most five times, so it errs by less
/// than 5.01 v of their absolute sum. The absolute sum of all coordinates' terms is also >= the distance. kTermsError
/// of it covers the coordinates, the squares, the root, its own summation and the last subtraction. kUnderflow covers
/// underflow.
ExactDistance::Difference ExactDistance::approximate(const Point3& p, const Point3& q) const
{
  if (translations_only_) return approximateTranslated(p, q);
  Difference z;
  double terms = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double a[] = {a_[k][0] * p[0], a_[k][1] * p[1], a_[k][2] * p[2], a_[k][3]};
    const double b[] = {b_[k][0] * q[0], b_[k][1] * q[1], b_[k][2] * q[2], b_[k][3]};
    z.vector[k] = (a[0] + a[1] + a[2] + a[3]) - (b[0] + b[1] + b[2] + b[3]);
    for (const double term : a) terms += std::abs(term);
    for (const double term : b) terms += std::abs(term);
  }
  z.error = kTermsError * terms + kUnderflow;
  return z;
}

/// Without rotations, (p - q) + (t_a - t_b): the errors of these three sums are known, so that points of any scale are
/// told apart wherever they lie. Twice the errors pay for their own summation. The norm of the sums is rounded by 2.5 v
/// of itself, the last subtraction by one more.
ExactDistance::Difference ExactDistance::approximateTranslated(const Point3& p, const Point3& q) const
{
  Difference z;
  double errors = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const WithError between = twoSum(p[k], -q[k]);
    const WithError shift = twoSum(a_[k][3], -b_[k][3]);
    const WithError difference = twoSum(between.value, shift.value);
    z.vector[k] = difference.value;
    errors += std::abs(between.error) + std::abs(shift.error) + std::abs(difference.error);
  }
  z.error = 2.0 * errors + kUnderflow;
  return z;
}

/// Compensated sums, for points so far from the origin that double arithmetic cannot tell them apart. A coordinate errs
/// by v of itself and CompensatedSum::kError of its terms; norm, root and last subtraction by 3.5 v more.
ExactDistance::Enclosure ExactDistance::encloseClosely(const Point3& p, const Point3& q) const
{
  double squared = 0.0;
  double terms = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    CompensatedSum sum;
    sum.add(a_[k][3]);
    sum.add(-b_[k][3]);
    for (std::size_t j = 0; j < 3; ++j) {
      sum.addProduct(a_[k][j], p[j]);
      sum.addProduct(-b_[k][j], q[j]);
    }
    squared += sum.value() * sum.value();
    terms += sum.absolute;
  }
  if (!std::isfinite(squared + terms)) return {-kUnbounded, kUnbounded};
  const double distance = std::sqrt(squared);
  const double error = kFewDoubleRoundings * distance + CompensatedSum::kError * terms + kUnderflow;
  return {distance - error, distance + error};
}

/// T_a p - T_b q with its rounding errors: translated as in approximateTranslated(), posed as in encloseClosely().
std::array<LongCoordinate, 3> ExactDistance::difference(const Point3& p, const Point3& q) const
{
  std::array<LongCoordinate, 3> vector;
  for (std::size_t k = 0; k < 3; ++k) {
    LongCoordinate& c = vector[k];
    if (translations_only_) {
      const WithError between = twoSum(p[k], -q[k]);
      const WithError shift = twoSum(a_[k][3], -b_[k][3]);
      const WithError sum = twoSum(between.value, shift.value);
      c = {sum.value, between.error + shift.error + sum.error,
           4 * kDoubleUnit * (std::abs(between.error) + std::abs(shift.error) + std::abs(sum.error))};
      continue;
    }
    CompensatedSum sum;
    sum.add(a_[k][3]);
    sum.add(-b_[k][3]);
    for (std::size_t j = 0; j < 3; ++j) {
      sum.addProduct(a_[k][j], p[j]);
      sum.addProduct(-b_[k][j], q[j]);
    }
    // Where terms cancel, the errors may be as large as the sum. So the two are normalised: a large tail would leave
    // roundedLength() in doubt.
    const WithError normal = twoSum(sum.sum, sum.errors);
    c = {normal.value, normal.error, CompensatedSum::kError * sum.absolute + kUnderflow};
  }
  return vector;
}

/// T_a p - T_b q when its three coordinates are doubles, found without rounding, and safelySquared().
bool ExactDistance::exactDifference(const Point3& p, const Point3& q, Point3& difference) const
{
  if (!translations_only_) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const WithError moved_p = twoSum(p[k], a_[k][3]);
    const WithError moved_q = twoSum(q[k], b_[k][3]);
    const WithError sum = twoSum(moved_p.value, -moved_q.value);
    // Written so that the NaN of an overflow is refused as well.
    if (!(moved_p.error == 0.0 && moved_q.error == 0.0 && sum.error == 0.0)) return false;
    difference[k] = sum.value;
  }
  return safelySquared(difference);
}

Dyadic ExactDistance::squaredDistance(const Point3& p, const Point3& q) const
{
  Dyadic squared;
  for (std::size_t k = 0; k < 3; ++k) {
    Dyadic difference = Dyadic(a_[k][3]) - Dyadic(b_[k][3]);
    for (std::size_t j = 0; j < 3; ++j) {
      difference += Dyadic(a_[k][j]) * Dyadic(p[j]);
      difference += Dyadic(-b_[k][j]) * Dyadic(q[j]);
    }
    squared += square(difference);
  }
  return squared;
}

} // namespace pcl_bsh
