// SPDX-License-Identifier: BSD-3-Clause
// How far to push one body out of another.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/manifold/contact_manifold.h>
#include <pcl_bsh/query/result.h>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The smallest way that a has to go along the contact's normal until it is apart from b, with all that is inside. One
/// of them at least has a solid; points and open surfaces have no inside. At each way shorter than the lower end, some
/// place of one is in the other, within the rounding of the pose. At the upper end they are apart, as exact arithmetic
/// on the rounded pose decides. The lower end grows by depths of places. Where no place is inside, and only edges
/// cross, the lower end stays, and the interval is wide. The parting is not the depth of a record, which may have its
/// nearest way out elsewhere.
/// @param tolerance the upper end is no farther than this above a way at which they meet; finite, > 0
/// @param most where no shorter way parts them, the upper end is infinite; finite, > 0
/// @throws InvalidInput naming the value
Interval partingOf(const PlacedCollider& a, const PlacedCollider& b, const Contact& contact, double tolerance,
                   double most);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
