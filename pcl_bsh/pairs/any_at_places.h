// SPDX-License-Identifier: BSD-3-Clause
// Any collision of points that may be elsewhere than they were measured.
#pragma once

#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/query/uncertain.h>

namespace pcl_bsh {

/// One search, of points that are where `places` says. @param request checked; its accuracy does not stop early
AnyResult anyCollisionAt(const Placed& a, const Placed& b, const AnyRequest& request, Places places);

/// What search(places) finds of what may collide and of what does for certain, as one answer. @pre the points are
/// uncertain, and the search ends early only at a witness
template <class Search>
AnyResult anyOfUncertain(const Search& search)
{
  AnyResult possible = search(Places::possible);
  if (possible.verdict == Verdict::free) return possible;
  AnyResult certain = search(Places::certain);
  certain.work += possible.work;
  if (certain.verdict == Verdict::colliding) return certain;
  return {Verdict::undecided, std::nullopt, {certain.distance.lower, possible.distance.upper}, certain.work};
}

} // namespace pcl_bsh
