// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/relative_frame.h>

#include <pcl_bsh/geometry/exact/compensated_sum.h>
#include <pcl_bsh/geometry/rounding.h>

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/geometry/relative_frame.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef PCL_BSH_GEOMETRY_RELATIVE_FRAME_ONCE
#define PCL_BSH_GEOMETRY_RELATIVE_FRAME_ONCE
namespace pcl_bsh {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// R and S are nearly rigid rotations: rows and columns have length 1 within 1e-6. An entry of R'S sums three products,
// rounded three times each, of absolute sum 1.000002 at most: it errs by less than 4 v. A row sum of |R'R - I| has
// three such errors, and its own roundings: less than 16 v.
constexpr double kRotationError = 4 * kDoubleUnit;
constexpr double kGramError = 32 * kDoubleUnit;

double normOfSums(const std::array<double, 9>& m)
{
  double largest = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    largest = std::max(largest, std::abs(m[3 * i]) + std::abs(m[3 * i + 1]) + std::abs(m[3 * i + 2]));
  return largest;
}

/// M'M, so that the square root of its largest row sum bounds the spectral norm of M.
std::array<double, 9> gram(const Eigen::Matrix3d& m)
{
  const Eigen::Matrix3d product = m.transpose() * m;
  return {product(0, 0), product(0, 1), product(0, 2), product(1, 0), product(1, 1),
          product(1, 2), product(2, 0), product(2, 1), product(2, 2)};
}

/// Inputs for a frame's three axes, side by side; the fourth lane is unused.
struct FrameAxes {
  alignas(32) double shift[4];      ///< g
  alignas(32) double error[4];      ///< bound of the error of float coordinates
  alignas(32) double moved[4];      ///< largest distance of carried points of a from a's carried origin
  alignas(32) double entries[3][4]; ///< columns of M
};

/// The distance of a frame's farthest corner from its origin, in units. The squares are in the range of double.
double cornerOf(const LocalFrame& frame)
{
  const auto& [x, y, z] = frame.reach;
  return std::sqrt(x * x + y * y + z * z);
}

} // namespace
} // namespace pcl_bsh
#endif

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

namespace {

using AxesTag = hn::CappedTag<double, 4>;
using AxesVector = hn::Vec<AxesTag>;

/// x y - product, exactly.
AxesVector productError(AxesTag d, AxesVector x, AxesVector y, AxesVector product)
{
#if HWY_NATIVE_FMA
  static_cast<void>(d);
  return hn::MulSub(x, y, product);
#else
  alignas(32) double xs[4], ys[4], products[4];
  hn::Store(x, d, xs);
  hn::Store(y, d, ys);
  hn::Store(product, d, products);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) products[i] = std::fma(xs[i], ys[i], -products[i]);
  return hn::Load(d, products);
#endif
}

/// A CompensatedSum of each axis.
struct AxesSum {
  HWY_INLINE AxesSum() : sum(hn::Zero(d)), errors(sum), absolute(sum) {}

  HWY_INLINE void add(AxesVector term)
  {
    const AxesVector next = hn::Add(sum, term), part = hn::Sub(next, sum);
    errors = hn::Add(errors, hn::Add(hn::Sub(sum, hn::Sub(next, part)), hn::Sub(term, part)));
    sum = next;
    absolute = hn::Add(absolute, hn::Abs(term));
  }

  HWY_INLINE void addProduct(AxesVector x, double y)
  {
    const AxesVector factor = hn::Set(d, y), product = hn::Mul(x, factor);
    add(product);
    errors = hn::Add(errors, productError(d, x, factor, product));
  }

  const AxesTag d;
  AxesVector sum, errors, absolute;
};

} // namespace

void axesOnTarget(const LocalFrame& a, const Eigen::Isometry3d& pose_a, const LocalFrame& b,
                  const Eigen::Isometry3d& pose_b, const RelativeRotation& rotation, FrameAxes& axes)
{
  const AxesTag d;
  const double *const of_a = pose_a.matrix().data(), *const of_b = pose_b.matrix().data(); // columns of four
  // The vector between the origins, whose terms may be millions of times larger than it.
  alignas(32) double between[4], between_bound[4];
  for (std::size_t i = 0; i < 4; i += hn::Lanes(d)) {
    AxesSum sum;
    for (std::size_t j = 0; j < 3; ++j) {
      sum.addProduct(hn::LoadU(d, of_a + 4 * j + i), a.origin[j]);
      sum.addProduct(hn::Neg(hn::LoadU(d, of_b + 4 * j + i)), b.origin[j]);
    }
    sum.add(hn::LoadU(d, of_a + 12 + i));
    sum.add(hn::Neg(hn::LoadU(d, of_b + 12 + i)));
    const AxesVector value = hn::Add(sum.sum, sum.errors), unit = hn::Set(d, b.unit);
    const AxesVector bound = hn::Add(hn::Mul(hn::Set(d, kDoubleUnit), hn::Abs(value)),
                                     hn::Mul(hn::Set(d, CompensatedSum::kError), sum.absolute));
    hn::Store(hn::Div(value, unit), d, between + i);
    hn::Store(hn::Div(bound, unit), d, between_bound + i);
  }

  const double scale = a.unit / b.unit;
  double misturned = 0.0; // error of M x, doubled to cover effects of second order
  for (std::size_t j = 0; j < 3; ++j) misturned += 2 * kRotationError * scale * a.reach[j];
  const double skewed = rotation.skew * (b.reach[0] + b.reach[1] + b.reach[2]);
  alignas(32) const double slack_of_b[4] = {b.slack(0), b.slack(1), b.slack(2), 0.0};
  for (std::size_t i = 0; i < 4; i += hn::Lanes(d)) {
    AxesVector value = hn::Zero(d), absolute = hn::Zero(d), inherited = hn::Zero(d);
    for (std::size_t k = 0; k < 3; ++k) {
      const AxesVector r = hn::LoadU(d, rotation.back_turns.data() + 4 * k + i);
      const AxesVector term = hn::Mul(r, hn::Set(d, between[k]));
      value = hn::Add(value, term);
      absolute = hn::Add(absolute, hn::Abs(term));
      inherited = hn::Add(inherited, hn::Mul(hn::Abs(r), hn::Set(d, between_bound[k])));
    }
    AxesVector moved = hn::Zero(d), slack = hn::Zero(d); // sums of |M_ij| reach_a_j, |M_ij| slack_a_j
    for (std::size_t j = 0; j < 3; ++j) {
      const AxesVector entry = hn::Mul(hn::LoadU(d, rotation.columns.data() + 4 * j + i), hn::Set(d, scale));
      hn::Store(entry, d, axes.entries[j] + i);
      moved = hn::Add(moved, hn::Mul(hn::Abs(entry), hn::Set(d, a.reach[j])));
      slack = hn::Add(slack, hn::Mul(hn::Abs(entry), hn::Set(d, a.slack(static_cast<int>(j)))));
    }
    const AxesVector rounded = hn::Mul(hn::Set(d, kFewDoubleRoundings), hn::Add(absolute, moved));
    const AxesVector evaluated =
        hn::Add(hn::Add(hn::Add(rounded, inherited), hn::Set(d, misturned)), hn::Set(d, skewed));
    const AxesVector carried = hn::Add(hn::Mul(hn::Set(d, kCarriedShiftError), hn::Abs(value)),
                                       hn::Mul(hn::Set(d, kCarriedProductError), moved));
    const AxesVector stored = hn::Add(slack, hn::Mul(hn::Set(d, 1.0 + rotation.skew), hn::Load(d, slack_of_b + i)));
    hn::Store(value, d, axes.shift + i);
    hn::Store(moved, d, axes.moved + i);
    hn::Store(hn::Add(hn::Add(stored, carried), evaluated), d, axes.error + i);
  }
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(axesOnTarget);

RelativeRotation::RelativeRotation(const Eigen::Isometry3d& pose_a, const Eigen::Isometry3d& pose_b)
{
  const Eigen::Matrix3d ra = pose_a.linear(), rb = pose_b.linear();
  matrix = rb.transpose() * ra;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      columns[static_cast<std::size_t>(4 * j + i)] = matrix(i, j);
      back_turns[static_cast<std::size_t>(4 * j + i)] = rb(j, i);
    }
  }
  if (rb != Eigen::Matrix3d::Identity()) {
    const Eigen::Matrix3d excess = rb.transpose() * rb - Eigen::Matrix3d::Identity();
    skew = excess.cwiseAbs().rowwise().sum().maxCoeff() + kGramError;
  }
  if (matrix != Eigen::Matrix3d::Identity() || skew != 0.0)
    stretch = std::sqrt(normOfSums(gram(matrix))) * (1.0 + kDoubleMargin);
}

RelativeFrame::RelativeFrame(const LocalFrame& a, const Eigen::Isometry3d& pose_a, const LocalFrame& b,
                             const Eigen::Isometry3d& pose_b, const RelativeRotation& rotation)
: unit_b_(b.unit),
  skew_(rotation.skew)
{
  const double scale = a.unit / b.unit;
  FrameAxes axes;
  HWY_DYNAMIC_DISPATCH(axesOnTarget)(a, pose_a, b, pose_b, rotation, axes);
  double squared = 0.0;
  bool overflows = false;
  bool in_range = b.unit >= 0x1p-900 && a.unit >= 0x1p-900 && b.unit <= 0x1p900 && a.unit <= 0x1p900;
  for (unsigned i = 0; i < 3; ++i) {
    g_exact[i] = axes.shift[i];
    g[i] = roundToFloat(axes.shift[i]);
    for (unsigned j = 0; j < 3; ++j) {
      const double entry = axes.entries[j][i];
      m[3 * i + j] = roundToFloat(entry);
      overflows = overflows || !(std::abs(entry) < kLargestCarried); // even if it multiplies a small coordinate
    }
    squared += axes.error[i] * axes.error[i];
    in_range = in_range && inFloatRange(axes.shift[i]) && inFloatRange(axes.moved[i]) && inFloatRange(b.reach[i]);
    overflows = overflows || !(std::abs(axes.shift[i]) + axes.moved[i] < kLargestCarried);
  }
  float_error_ = std::sqrt(squared) * (1.0 + 2 * kFewDoubleRoundings) + kSmallestLength;
  if (!(float_error_ < kInfinity)) { // NaN from 0 times infinity: nothing is known, all counts as near
    float_error_ = kInfinity;
    in_range = false;
    g.fill(0.0f);
  }
  prune_error_ = overflows ? kInfinity : float_error_;
  error = in_range && !overflows ? float_error_ : kInfinity;

  stretch_a = roundUp(rotation.stretch * scale);
  stretch_b = roundUp(1.0 + skew_);
  span_ = stretch_a * cornerOf(a) + stretch_b * cornerOf(b);
}

bool RelativeFrame::separates(double clearance) const noexcept
{
  const double distance = std::hypot(g_exact[0], g_exact[1], g_exact[2]);
  const double reach = span_ + clearance / unit_b_ * (1.0 + skew_) + float_error_;
  return distance < kInfinity && distance * (1.0 - kDoubleMargin) > reach * (1.0 + kDoubleMargin);
}

DistanceBand RelativeFrame::band(double clearance) const noexcept
{
  return skewedBand(clearance / unit_b_, error, skew_);
}

DistanceBand RelativeFrame::band(double clearance, double more_error, double more_share) const noexcept
{
  constexpr double of_second_order = 1.0 + 0x1p-16; // shares are below 2^-18, together
  return skewedBand(clearance / unit_b_, (error + more_error) * of_second_order,
                    (skew_ + more_share) * of_second_order);
}

float RelativeFrame::pruneReach(double clearance) const noexcept
{
  // At least kSmallestLength, so that the cast errs by u at most; the factor rounds outward again.
  return static_cast<float>(clearance / unit_b_ * (1.0 + skew_) + prune_error_) * (1.0f + kReachMargin);
}

float RelativeFrame::bluntRadius() const noexcept
{
  return static_cast<float>(16 * float_error_);
}

float RelativeFrame::acceptReach(double clearance) const noexcept
{
  const double reach = clearance / unit_b_ * (1.0 - skew_) - float_error_;
  return reach > kSmallestLength && error < kInfinity ? static_cast<float>(reach) * (1.0f - kReachMargin) : -1.0f;
}

} // namespace pcl_bsh
#endif
