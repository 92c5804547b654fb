// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/distance_band.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {

/// Returns the uncertainties of a built voxel; null where points have no uncertainties of their own.
inline const OwnUncertainties* ownUncertainties(const SphereHierarchy::Storage& storage, std::size_t voxel)
{
  Voxel& of = storage.voxels[voxel];
  return storage.view.uncertainties ? of.own_uncertainties.of(of, storage.view) : nullptr;
}

/// Thresholds of distances between points of two voxels, without the points' own uncertainties. They are in the frame
/// and the unit of b's voxel, rounded to the safe side. Own uncertainties are subtracted from the thresholds of certain
/// collisions, and added to those of possible ones. `scale_up` or `scale_down` rounds them to the safe side, too.
struct UncertainReach {
  float sure;                 ///< points as near collide for certain
  float maybe;                ///< points as near may collide
  float sure_near;            ///< nothing in spheres farther apart collides for certain
  float near;                 ///< nothing in spheres farther apart may collide
  float sure_miss, miss;      ///< sure_near and near, for points
  float scale_up, scale_down; ///< factors from the clouds' unit to b's, with the poses' skew
  float most_of_b = 0.0f;     ///< greatest own uncertainty of b's points, in its unit
  float magnitude = 0.0f;     ///< of the terms of sums of these, b's own uncertainties included
  const OwnUncertainties* of_b = nullptr;

  /// @param error of distances of points, in b's unit; may be infinite
  /// @param skew as RelativeFrame has it @param unit of b
  /// @param least, most reach of all pairs, without own uncertainties, in the clouds' unit; `least` may be below 0
  /// @param b_most greatest own uncertainty of b's points, in the clouds' unit
  /// @param of_spheres reach of spheres where a length or a unit is out of the range of floats
  UncertainReach(double error, double skew, double unit, double least, double most, double b_most, float of_spheres)
  : sure(-kNever),
    maybe(-kNever),
    sure_near(of_spheres),
    near(of_spheres),
    sure_miss(kNever),
    miss(kNever),
    scale_up(0.0f),
    scale_down(0.0f)
  {
    b_most /= unit;
    const double size = std::max(std::abs(least), most) / unit + b_most + error;
    if (!inFloatRange(size) || !inFloatRange(unit) || !inFloatRange(1.0 / unit)) return; // pairs are decided one by one
    const double room = kDoubleMargin * size + kSmallestLength;                          // for all roundings here
    scale_up = roundUp((1.0 + skew) / unit * (1.0 + kDoubleMargin));
    scale_down = roundDown((1.0 - skew) / unit * (1.0 - kDoubleMargin));
    const double blur = b_most * (static_cast<double>(scale_up - scale_down) * unit);
    const auto low = [&](double d) { return d / unit * (d < 0.0 ? 1.0 + skew : 1.0 - skew) - error - room; };
    const auto high = [&](double d) { return d / unit * (d < 0.0 ? 1.0 - skew : 1.0 + skew) + error + room; };
    most_of_b = roundUp(b_most);
    sure = roundDown(low(least));
    maybe = roundDown(low(most) - blur);
    sure_near = roundUp(high(least));
    near = miss = roundUp(high(most));
    sure_miss = roundUp(high(least) + blur);
    magnitude = roundUp(size + blur + room);
  }

private:
  static constexpr float kNever = std::numeric_limits<float>::infinity();
};

} // namespace pcl_bsh
