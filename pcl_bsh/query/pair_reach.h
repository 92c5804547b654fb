// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/query/reach.h>
#include <pcl_bsh/query/record_distance.h>
#include <pcl_bsh/query/result.h>

#include <cmath>
#include <utility>

namespace pcl_bsh {

/// How far apart the points, or triangles, of a pair may be measured, radii included, to be within the clearance at the
/// places that are asked about.
class PairReach {
public:
  PairReach(const PointsView& a, const PointsView& b, double clearance, MeantPlaces places,
            const PatchSpacings& patches_of_b = {})
  : a_(a),
    b_(b),
    clearance_(clearance),
    places_(places),
    patches_(patches_of_b)
  {
  }

  bool areMeasured() const { return places_ == MeantPlaces::measured; }

  /// Whether all pairs share one reach, apart from their radii.
  bool isOne() const { return areMeasured() || !(a_.uncertainties || b_.uncertainties || patches_.spacings); }

  /// Whether a pair is within its reach. @param distance between records of a and of b
  bool holds(const RecordDistance& distance, PointPair pair) const
  {
    return (areMeasured() ? distance.compare(pair, clearance_) : distance.compare(pair, of(pair))) <= 0;
  }

  /// Bounds of the reach, whichever places are meant, without the radii, uncertainties and spacings of single records.
  double leastInCommon() const { return clearance_ - a_.uncertainty - b_.uncertainty; }
  double mostInCommon() const { return clearance_ + a_.uncertainty + b_.uncertainty; }

  /// Prefetches what will be read soon of a record: records in the order of a tree are anywhere in the caller's arrays.
  void prefetchOfA(std::uint32_t record) const { prefetch(a_, record); }
  void prefetchOfB(std::uint32_t record) const { prefetch(b_, record); }

  /// Returns bounds of a pair's reach that hold in spite of rounding, the lesser one first.
  std::pair<double, double> around(PointPair pair) const
  {
    double sum = 0.0, magnitude = 0.0;
    for (const double term : of(pair)) {
      sum += term;
      magnitude += std::abs(term);
    }
    return {sum - kDoubleMargin * magnitude, sum + kDoubleMargin * magnitude};
  }

  /// Returns the reach of a pair as terms, whose exact sum it is.
  RecordDistance::Sum of(PointPair pair) const
  {
    const double sign = areMeasured() ? 0.0 : places_ == MeantPlaces::certain ? -1.0 : 1.0;
    return {clearance_,
            a_.ownRadius(pair.a),
            b_.ownRadius(pair.b),
            sign * a_.uncertainty,
            sign * b_.uncertainty,
            sign * a_.ownUncertainty(pair.a),
            sign * b_.ownUncertainty(pair.b),
            patches_.spacings ? 0.5 * static_cast<double>(patches_.spacings[pair.b]) : 0.0};
  }

private:
  static void prefetch(const PointsView& view, std::uint32_t record)
  {
    if (view.uncertainties) __builtin_prefetch(view.uncertainties + record);
  }

  const PointsView& a_;
  const PointsView& b_;
  const double clearance_;
  const MeantPlaces places_;
  const PatchSpacings patches_;
};

} // namespace pcl_bsh
