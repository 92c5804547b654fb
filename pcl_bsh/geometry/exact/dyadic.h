// SPDX-License-Identifier: BSD-3-Clause
// Numbers of the form integer x 2^exponent: every finite double is one, and sums and products of them stay so, exactly.
#pragma once

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized" // g++ 12 mistakes what its inlining makes of cpp_int
#pragma GCC diagnostic ignored "-Warray-bounds"
#pragma GCC diagnostic ignored "-Wstringop-overflow"
#endif
#include <boost/multiprecision/cpp_int.hpp>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace pcl_bsh {

class Dyadic {
public:
  /// Stays off the heap up to 512 bits: enough for what ordinary clouds ask.
  using Integer =
      boost::multiprecision::number<boost::multiprecision::cpp_int_backend<512>, boost::multiprecision::et_off>;

  Dyadic() = default;

  /// @param value finite. Taken apart by its bits, so that denormals survive any floating-point environment.
  explicit Dyadic(double value)
  {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const auto biased = static_cast<int>((bits >> 52) & 0x7ff);
    auto mantissa = static_cast<std::int64_t>(bits & ((std::uint64_t{1} << 52) - 1));
    if (biased != 0) mantissa |= std::int64_t{1} << 52;
    if (mantissa == 0) return;
    const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa));
    mantissa >>= zeros; // short integers keep the sums of their products short
    integer_ = (bits >> 63) != 0 ? -mantissa : mantissa;
    exponent_ = std::max(biased, 1) - 1075 + zeros;
  }

  int sign() const { return integer_.sign(); }

  Dyadic& operator+=(const Dyadic& other)
  {
    return combine(other, [](Integer& x, const Integer& y) { x += y; });
  }
  Dyadic& operator-=(const Dyadic& other)
  {
    return combine(other, [](Integer& x, const Integer& y) { x -= y; });
  }

  Dyadic operator-() const
  {
    Dyadic negated = *this;
    negated.integer_.backend().negate();
    return negated;
  }

  friend Dyadic operator*(const Dyadic& x, const Dyadic& y)
  {
    Dyadic product;
    boost::multiprecision::multiply(product.integer_, x.integer_, y.integer_);
    product.exponent_ = x.exponent_ + y.exponent_;
    return product;
  }
  friend Dyadic operator+(Dyadic x, const Dyadic& y) { return std::move(x += y); }
  friend Dyadic operator-(Dyadic x, const Dyadic& y) { return std::move(x -= y); }

  /// Approximation m x 2^e with m in [1, 2) or zero and a relative error below 2^-52, whatever the magnitude.
  struct Scaled {
    double mantissa;
    int exponent;
  };

  Scaled scaled() const
  {
    if (sign() == 0) return {0.0, std::numeric_limits<int>::min() / 2}; // below every other exponent
    const Integer magnitude = abs(integer_);
    const int top = static_cast<int>(msb(magnitude));
    const int shift = std::max(top - 62, 0);
    const double head = std::ldexp(static_cast<double>(static_cast<std::int64_t>(magnitude >> shift)), shift - top);
    return {sign() < 0 ? -head : head, exponent_ + top};
  }

private:
  /// Brings both numbers to the lesser of their exponents, and combines their integers.
  template <class Operation>
  Dyadic& combine(const Dyadic& other, const Operation& operation)
  {
    if (other.sign() == 0) return *this;
    if (sign() == 0) exponent_ = other.exponent_;
    if (exponent_ < other.exponent_) {
      operation(integer_, Integer(other.integer_ << static_cast<unsigned>(other.exponent_ - exponent_)));
      return *this;
    }
    if (exponent_ > other.exponent_) integer_ <<= static_cast<unsigned>(exponent_ - other.exponent_);
    exponent_ = other.exponent_;
    operation(integer_, other.integer_);
    return *this;
  }

  Integer integer_ = 0;
  int exponent_ = 0;
};

} // namespace pcl_bsh
