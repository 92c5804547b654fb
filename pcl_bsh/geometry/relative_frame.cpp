// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/relative_frame.h>

#include <pcl_bsh/geometry/exact/compensated_sum.h>
#include <pcl_bsh/geometry/rounding.h>

#include <algorithm>
#include <limits>

namespace pcl_bsh {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Of nearly rigid rotations R, S, whose rows and columns are of length 1 within 1e-6. An entry of R'S sums three
// products, rounded three times each, of absolute sum 1.000002 at most: it errs by less than 4 v. A row sum of |R'R -
// I| has three such errors, and its own roundings: less than 16 v.
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

/// How far a frame's box reaches. Its squares are in range.
double cornerOf(const LocalFrame& frame)
{
  const auto& [x, y, z] = frame.reach;
  return std::sqrt(x * x + y * y + z * z);
}

} // namespace

RelativeRotation::RelativeRotation(const Eigen::Isometry3d& pose_a, const Eigen::Isometry3d& pose_b)
{
  const Eigen::Matrix3d ra = pose_a.linear(), rb = pose_b.linear();
  matrix = rb.transpose() * ra;
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
  const auto &ra = pose_a.linear(), &rb = pose_b.linear();
  const double scale = a.unit / b.unit;

  // The vector between the origins, whose terms may be millions of times larger than it.
  std::array<double, 3> between, between_bound;
  for (int i = 0; i < 3; ++i) {
    CompensatedSum sum;
    for (int j = 0; j < 3; ++j) {
      // Upright poses are half zeros.
      if (ra(i, j) != 0.0) sum.addProduct(ra(i, j), a.origin[static_cast<unsigned>(j)]);
      if (rb(i, j) != 0.0) sum.addProduct(-rb(i, j), b.origin[static_cast<unsigned>(j)]);
    }
    sum.add(pose_a.translation()(i));
    sum.add(-pose_b.translation()(i));
    between[static_cast<unsigned>(i)] = sum.value() / b.unit;
    between_bound[static_cast<unsigned>(i)] = sum.bound() / b.unit;
  }

  double squared = 0.0;
  bool overflows = false;
  bool in_range = b.unit >= 0x1p-900 && a.unit >= 0x1p-900 && b.unit <= 0x1p900 && a.unit <= 0x1p900;
  for (unsigned i = 0; i < 3; ++i) {
    double value = 0.0, absolute = 0.0, inherited = 0.0;
    for (unsigned k = 0; k < 3; ++k) {
      const double r = rb(k, i);
      value += r * between[k];
      absolute += std::abs(r * between[k]);
      inherited += std::abs(r) * between_bound[k];
    }
    g_exact[i] = value;
    g[i] = roundToFloat(value);

    double moved = 0.0, slack = 0.0, misturned = 0.0; // sums of |M_ij| reach_a_j, |M_ij| slack_a_j; error of M x
    for (unsigned j = 0; j < 3; ++j) {
      const double entry = rotation.matrix(i, j) * scale;
      m[3 * i + j] = roundToFloat(entry);
      overflows = overflows || !(std::abs(entry) < kLargestCarried); // however short what it is multiplied with
      moved += std::abs(entry) * a.reach[j];
      slack += std::abs(entry) * a.slack(static_cast<int>(j));
      misturned += 2 * kRotationError * scale * a.reach[j]; // twice: what follows from it is of second order
    }
    const double skewed = skew_ * (b.reach[0] + b.reach[1] + b.reach[2]);
    const double evaluated = kFewDoubleRoundings * (absolute + moved) + inherited + misturned + skewed;
    const double carried = kCarriedShiftError * std::abs(value) + kCarriedProductError * moved;
    const double float_error = slack + (1.0 + skew_) * b.slack(static_cast<int>(i)) + carried + evaluated;
    squared += float_error * float_error;
    in_range = in_range && inFloatRange(value) && inFloatRange(moved) && inFloatRange(b.reach[i]);
    overflows = overflows || !(std::abs(value) + moved < kLargestCarried);
  }
  float_error_ = std::sqrt(squared) * (1.0 + 2 * kFewDoubleRoundings) + kSmallestLength;
  if (!(float_error_ < kInfinity)) { // NaN where a zero met an overflown bound: then nothing is known, and all is near
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
