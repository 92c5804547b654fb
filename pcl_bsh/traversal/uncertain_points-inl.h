// SPDX-License-Identifier: BSD-3-Clause
// Compares uncertain points of two leaves by float bounds that count the uncertainties of both points.

#if defined(PCL_BSH_TRAVERSAL_UNCERTAIN_POINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAVERSAL_UNCERTAIN_POINTS_INL_H_
#undef PCL_BSH_TRAVERSAL_UNCERTAIN_POINTS_INL_H_
#else
#define PCL_BSH_TRAVERSAL_UNCERTAIN_POINTS_INL_H_
#endif

#include <pcl_bsh/traversal/leaf_pair-inl.h>
#include <pcl_bsh/traversal/uncertain_reach.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// Margin for float sums of up to four roundings, relative to the sum of their terms: 4 u of its 8 u.
inline constexpr float kSumMargin = kReachMargin;

/// Margin for distances of nearestWithLengths(). The root of a squared distance, a product and a sum err by 6 u of
/// their terms. The other point's length counts three times, and thresholds err by 4 u: less than 23 u of its 32 u.
inline constexpr float kLengthsMargin = 4 * kSumMargin;

/// Thresholds for each point of a leaf. A longer distance is that of another point plus its uncertainty, a shorter one
/// is less its uncertainty: nearestWithLengths() returns the least of both.
struct UncertainPoints {
  alignas(64) float sure[kLeafPoints];      ///< longer ones up to it: collides for certain
  alignas(64) float maybe[kLeafPoints];     ///< shorter ones up to it: may collide
  alignas(64) float sure_miss[kLeafPoints]; ///< longer ones beyond it: not certain to collide
  alignas(64) float miss[kLeafPoints];      ///< shorter ones beyond it: free

  UncertainPoints(const UncertainReach& reach, const float* own)
  {
    for (std::size_t i = 0; i < kLeafPoints; ++i) {
      const float least = own[i] * reach.scale_down, most = own[i] * reach.scale_up;
      const float slack = (most + reach.magnitude) * kLengthsMargin;
      sure[i] = reach.sure - most - slack;
      maybe[i] = reach.maybe + least - slack;
      sure_miss[i] = reach.sure_miss - least + slack;
      miss[i] = reach.miss + most + slack;
    }
  }
};

/// Returns the uncertainties of a leaf's points, sixteen to be read; zeros where points have no uncertainties of their
/// own.
inline const float* ownOf(const OwnUncertainties* own, const LeafRange& leaf)
{
  alignas(64) static constexpr float kNone[kLeafPoints] = {};
  return own ? own->points.get() + leaf.begin : kNone;
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
