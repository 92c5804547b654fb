// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/rounding.h>

#include <cmath>

namespace pcl_bsh {

/// A sum kept with its rounding errors (Ogita, Rump, Oishi: Accurate Sum and Dot Product, 2005, Dot2), and the sum of
/// the absolute terms. For up to 16 terms, each of which may be a product, the errors are summed with an error below
/// kError of the absolute sum (test/proof/compensated_sums.g). Rounding value() adds half a unit in its last place.
/// Barring underflow.
struct CompensatedSum {
  static constexpr double kError = 2 * (16 * kDoubleUnit) * (16 * kDoubleUnit);

  double sum = 0.0, errors = 0.0, absolute = 0.0;

  void add(double term)
  {
    const WithError s = twoSum(sum, term);
    sum = s.value;
    errors += s.error;
    absolute += std::abs(term);
  }

  void addProduct(double a, double b)
  {
    const WithError p = twoProduct(a, b);
    add(p.value);
    errors += p.error;
  }

  double value() const { return sum + errors; }
  double bound() const { return kDoubleUnit * std::abs(value()) + kError * absolute; }
};

} // namespace pcl_bsh
