// SPDX-License-Identifier: BSD-3-Clause
// Doubles that know how far off they may be: quick, and enough for signs that are not close.
#pragma once

#include <pcl_bsh/geometry/rounding.h>

#include <cmath>

namespace pcl_bsh {

/// value, within `error`. Each operation adds its rounding, v of what it rounds; kDoubleMargin pays for the arithmetic
/// of errors, and 2^-1000 for underflow. Where something overflows, the sign is unknown.
class RoughNumber {
public:
  constexpr RoughNumber() = default;
  constexpr explicit RoughNumber(double value) : value_(value) {}
  constexpr RoughNumber(double value, double error) : value_(value), error_(error) {}

  double value() const noexcept { return value_; }
  double error() const noexcept { return error_; }

  /// Negative, 0 or positive; `sure` becomes false where that is not known. @return 0 where it is not known
  int sign(bool& sure) const noexcept
  {
    if (std::abs(value_) > error_ && std::isfinite(value_)) return value_ > 0.0 ? 1 : -1;
    if (!(value_ == 0.0 && error_ == 0.0)) sure = false;
    return 0;
  }

  friend RoughNumber operator-(const RoughNumber& x) noexcept { return {-x.value_, x.error_}; }
  friend RoughNumber operator+(const RoughNumber& x, const RoughNumber& y) noexcept
  {
    const double sum = x.value_ + y.value_;
    return {sum, (x.error_ + y.error_ + kDoubleUnit * std::abs(sum)) * (1.0 + kDoubleMargin)};
  }
  friend RoughNumber operator-(const RoughNumber& x, const RoughNumber& y) noexcept { return x + -y; }
  friend RoughNumber operator*(const RoughNumber& x, const RoughNumber& y) noexcept
  {
    const double product = x.value_ * y.value_;
    const double error = std::abs(x.value_) * y.error_ + std::abs(y.value_) * x.error_ + x.error_ * y.error_;
    return {product, (error + kDoubleUnit * std::abs(product)) * (1.0 + kDoubleMargin) + 0x1p-1000};
  }

private:
  double value_ = 0.0, error_ = 0.0;
};

} // namespace pcl_bsh
