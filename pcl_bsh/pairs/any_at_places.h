// SPDX-License-Identifier: BSD-3-Clause
// Any collision of points that may be elsewhere than they were measured.
#pragma once

#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/uncertain.h>

namespace pcl_bsh {

/// One search, of points that are where `places` says. @param request checked; its accuracy does not stop early
AnyResult anyCollisionAt(const Placed& a, const Placed& b, const AnyRequest& request, MeantPlaces places,
                         const Watch& watch = {});

/// One answer from two calls of search(places, watch): for pairs that may collide, and for pairs that do for certain.
/// @pre the points are uncertain, and the search ends early only at a witness
template <class Search>
AnyResult anyOfUncertain(Progress& progress, const Search& search)
{
  AnyResult possible = search(MeantPlaces::possible, Watch{&progress, 0.5});
  if (possible.verdict == Verdict::free) return possible;
  AnyResult certain = search(MeantPlaces::certain, Watch{&progress, 1.0});
  certain.work += possible.work;
  if (certain.verdict == Verdict::colliding) return certain;
  return {Verdict::undecided, std::nullopt, {certain.interval.lower, possible.interval.upper}, certain.work};
}

} // namespace pcl_bsh
