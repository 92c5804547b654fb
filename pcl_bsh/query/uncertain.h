// SPDX-License-Identifier: BSD-3-Clause
// Points that may be elsewhere than they were measured: one search for what may collide, one for what does for certain.
#pragma once

#include <pcl_bsh/query/accuracy.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/reach.h>
#include <pcl_bsh/query/result.h>

#include <cstddef>
#include <vector>

namespace pcl_bsh {

inline bool areUncertain(const Placed& a, const Placed& b)
{
  return a.hierarchy().view().isUncertain() || b.hierarchy().view().isUncertain();
}

/// Returns the places to mean in a search for what collides for certain, and in one for what may collide: the measured
/// places if no point is uncertain.
inline MeantPlaces certainPlaces(const Placed& a, const Placed& b)
{
  return areUncertain(a, b) ? MeantPlaces::certain : MeantPlaces::measured;
}
inline MeantPlaces possiblePlaces(const Placed& a, const Placed& b)
{
  return areUncertain(a, b) ? MeantPlaces::possible : MeantPlaces::measured;
}

/// The budget of each of the two searches.
inline Accuracy halfOf(Accuracy accuracy)
{
  if (accuracy.mode == Accuracy::Mode::node_pairs || accuracy.mode == Accuracy::Mode::time) accuracy.value /= 2;
  return accuracy;
}

/// Points that may collide are undecided, unless they do for certain.
/// @param flags of points that may collide; become the verdicts. @param certain of points that collide for certain.
/// @param colliding, undecided become the numbers of these points
inline void withhold(std::vector<Verdict>& flags, const std::vector<Verdict>& certain, std::size_t& colliding,
                     std::size_t& undecided)
{
  colliding = undecided = 0;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (flags[i] == Verdict::free) continue;
    const bool collides = certain[i] == Verdict::colliding;
    flags[i] = collides ? Verdict::colliding : Verdict::undecided;
    ++(collides ? colliding : undecided);
  }
}

} // namespace pcl_bsh
