// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/exact/dyadic.h>
#include <pcl_bsh/geometry/exact/long_number.h>
#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/geometry/triangle/vector3.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace pcl_bsh {

/// The plane through a place with an exact normal, which may have any length except 0.
class ExactPlane {
public:
  ExactPlane(const Point3& at, const Vector3<Dyadic>& normal) : at_(at), normal_(normal)
  {
    const Dyadic::Scaled scaled[3] = {normal[0].scaled(), normal[1].scaled(), normal[2].scaled()};
    exponent_ = std::max({scaled[0].exponent, scaled[1].exponent, scaled[2].exponent});
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& [mantissa, exponent] = scaled[k];
      const bool is_rough = exponent - exponent_ > -500 && std::abs(exponent) < 500; // others might vanish
      rough_[k] = mantissa == 0.0 ? 0.0
                  : is_rough      ? std::ldexp(mantissa, exponent - exponent_)
                                  : std::numeric_limits<double>::quiet_NaN();
      const auto partOf = [](const Dyadic& x) { return std::ldexp(x.scaled().mantissa, x.scaled().exponent); };
      longer_[k] = LongNumber(rough_[k]);
      if (mantissa == 0.0 || !is_rough) continue;
      const Dyadic left = normal[k] - Dyadic(partOf(normal[k]));
      const double tail = left.sign() == 0 ? 0.0 : std::ldexp(partOf(left), -exponent_);
      longer_[k] = {rough_[k], tail, left.sign() == 0 ? 0.0 : 2 * kDoubleUnit * std::abs(tail) + 0x1p-1000};
    }
    length_ = std::sqrt(rough_[0] * rough_[0] + rough_[1] * rough_[1] + rough_[2] * rough_[2]);
  }

  /// A height is a distance from the plane times length(). The given normal has the length 2^exponent() length().
  int exponent() const { return exponent_; }
  double length() const { return length_; }

  /// At least the height of a finite place beyond the plane, by double arithmetic; NaN where that cannot tell.
  double heightAtMost(const Point3& place) const
  {
    double sum = 0.0, terms = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double term = rough_[k] * (place[k] - at_[k]);
      sum += term;
      terms += std::abs(term);
    }
    return sum + kFewDoubleRoundings * terms + 0x1p-900;
  }

  /// The height of a place beyond the plane, negative on the other side, with its error.
  LongNumber height(const Point3& place) const
  {
    LongNumber sum;
    for (std::size_t k = 0; k < 3; ++k) sum += longer_[k] * (LongNumber(place[k]) - LongNumber(at_[k]));
    return sum;
  }

  /// Whether a finite place is on the side that the normal points to (1), on the other (-1), or in the plane (0).
  int side(const Point3& place) const
  {
    // Each term errs by 4 v of itself, 2 v of which are the normal's, and their sum by 2 v of all of them.
    double sum = 0.0, terms = 0.0, least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      if (rough_[k] == 0.0 || place[k] == at_[k]) continue;
      const double term = rough_[k] * (place[k] - at_[k]);
      sum += term;
      terms += std::abs(term);
      least = std::min(least, std::abs(term));
    }
    if (least == std::numeric_limits<double>::infinity() && terms == 0.0) return 0;
    if (std::abs(sum) > kFewDoubleRoundings * terms && least > 0x1p-900 && std::isfinite(sum))
      return sum > 0.0 ? 1 : -1;
    Dyadic exact;
    for (std::size_t k = 0; k < 3; ++k) exact += normal_[k] * (Dyadic(place[k]) - Dyadic(at_[k]));
    return exact.sign();
  }

private:
  Point3 at_;
  Vector3<Dyadic> normal_;
  int exponent_ = 0;
  Point3 rough_;               ///< the normal over 2^exponent_; NaN where that is out of range
  Vector3<LongNumber> longer_; ///< the same, with more digits
  double length_ = 0.0;        ///< of rough_
};

} // namespace pcl_bsh
