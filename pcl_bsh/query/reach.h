// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/hierarchy/uncertainty_range.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pcl_bsh {

/// The places of uncertain points that a question means.
enum class MeantPlaces : std::uint8_t {
  measured, ///< are they within the clearance as they were measured?
  certain,  ///< are they wherever they truly are, within their uncertainties?
  possible, ///< may they be?
  either,   ///< certain and possible at once, in a search that tells them apart
  covered,  ///< may the first be within the clearance of the other's patch of surface?
};

/// How far the samples of a surface are apart at each of its records: nothing, or a float each.
struct PatchSpacings {
  PatchSpacings() = default;
  PatchSpacings(const float* of_records, std::size_t count) : spacings(of_records)
  {
    if (!of_records || count == 0) return;
    const auto [smallest, largest] = std::minmax_element(of_records, of_records + count);
    least = static_cast<double>(*smallest);
    most = static_cast<double>(*largest);
  }

  const float* spacings = nullptr;
  double least = 0.0, most = 0.0;
};

/// How far a pair may be apart, less its radii: the clearance, less the uncertainties of both points for a certain
/// answer, plus them for a possible one. It is in [least, most] for all pairs.
struct Reach {
  Reach(double clearance, const UncertaintyRange& a, const UncertaintyRange& b, MeantPlaces places,
        const PatchSpacings& patches = {})
  : least(clearance),
    most(clearance)
  {
    if (places == MeantPlaces::measured) return;
    const double low = down(a.least + b.least), high = up(a.most + b.most);
    least = down(places == MeantPlaces::certain ? clearance - high : clearance + low);
    most = up(places == MeantPlaces::certain ? clearance - low : clearance + high);
    if (places != MeantPlaces::covered) return;
    least = down(least + patches.least / 2);
    most = up(most + patches.most / 2);
  }

  /// Returns the greatest distance at which spheres, radii not included, may hold points within the reach.
  double length() const { return std::max(0.0, most); }

  double least; ///< below 0 where no pair without radii may be near enough
  double most;

private:
  static double down(double x) { return std::nextafter(x, -std::numeric_limits<double>::infinity()); }
  static double up(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()); }
};

} // namespace pcl_bsh
