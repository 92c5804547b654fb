// SPDX-License-Identifier: BSD-3-Clause
// Numbers of about twice a double's digits, with a bound of their error. Results that need no rounding are exact.
#pragma once

#include <pcl_bsh/geometry/rounding.h>

#include <cmath>

namespace pcl_bsh {

/// value + tail, within `error`. Sums and products add the terms that they drop to the error, so small integers and
/// their like stay exact, with an error of 0. Needs round-to-nearest. Overflow makes the sign unknown.
///
/// Error bound: a sum drops two terms that it knows. A product drops the product of the tails and rounds four terms of
/// low order, each by v of their absolute sum at most; kDoubleMargin pays for the arithmetic of errors. Underflow costs
/// less than kVanishing, which is added where it may occur: in products below 2^-900, of tails, and of errors.
class LongNumber {
public:
  constexpr LongNumber() = default;
  constexpr explicit LongNumber(double value) : value_(value) {}
  constexpr LongNumber(double value, double tail, double error) : value_(value), tail_(tail), error_(error) {}

  double value() const noexcept { return value_; }
  double tail() const noexcept { return tail_; }
  double error() const noexcept { return error_; }
  bool isZero() const noexcept { return value_ == 0.0 && tail_ == 0.0 && error_ == 0.0; } ///< surely

  /// Negative, 0 or positive; `sure` becomes false where that is not known. @return 0 where it is not known
  int sign(bool& sure) const noexcept
  {
    if (std::abs(value_) > (error_ + std::abs(tail_)) * (1.0 + kDoubleMargin) && std::isfinite(value_))
      return value_ > 0.0 ? 1 : -1;
    if (!isZero()) sure = false;
    return 0;
  }

  friend LongNumber operator-(const LongNumber& x) noexcept { return {-x.value_, -x.tail_, x.error_}; }
  friend LongNumber operator+(const LongNumber& x, const LongNumber& y) noexcept
  {
    const WithError values = twoSum(x.value_, y.value_), tails = twoSum(x.tail_, y.tail_);
    const WithError low = twoSum(values.error, tails.value);
    const WithError sum = twoSum(values.value, low.value);
    const double dropped = std::abs(low.error) + std::abs(tails.error);
    return {sum.value, sum.error, (x.error_ + y.error_ + dropped) * (1.0 + kDoubleMargin)};
  }
  friend LongNumber operator-(const LongNumber& x, const LongNumber& y) noexcept { return x + -y; }
  friend LongNumber operator*(const LongNumber& x, const LongNumber& y) noexcept
  {
    if (x.isZero() || y.isZero()) return {};
    const WithError product = twoProduct(x.value_, y.value_);
    double error = 0.0;
    WithError sum = product;
    if (x.tail_ != 0.0 || y.tail_ != 0.0) {
      const double first = x.value_ * y.tail_, second = x.tail_ * y.value_;
      sum = twoSum(product.value, product.error + (first + second));
      error = 4 * kDoubleUnit * (std::abs(product.error) + std::abs(first) + std::abs(second)) +
              std::abs(x.tail_ * y.tail_) + kVanishing;
    }
    if (x.error_ != 0.0 || y.error_ != 0.0)
      error += (std::abs(x.value_) + std::abs(x.tail_) + x.error_) * y.error_ +
               (std::abs(y.value_) + std::abs(y.tail_)) * x.error_ + kVanishing;
    if (std::abs(product.value) < 0x1p-900 && x.value_ != 0.0 && y.value_ != 0.0) error += kVanishing;
    return {sum.value, sum.error, error * (1.0 + kDoubleMargin)};
  }
  LongNumber& operator+=(const LongNumber& other) noexcept { return *this = *this + other; }

private:
  static constexpr double kVanishing = 0x1p-960;

  double value_ = 0.0, tail_ = 0.0, error_ = 0.0;
};

} // namespace pcl_bsh
