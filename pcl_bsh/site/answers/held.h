// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/question/held.h>
#include <pcl_bsh/site/collide_site.h>

#include <memory>
#include <type_traits>

namespace pcl_bsh::site {

/// What is asked of a and b as they stand, or of b at these poses.
Question questionOf(const SiteRequest& request, const Placed& a, const Placed& b,
                    const std::vector<Eigen::Isometry3d>* poses);

/// Adds what b holds of a tile, where it is asked as a solid. @param found of the surface, of a and b as they stand
/// @param poses of b instead; null: as it stands
template <typename Found>
void addHeldOf(const SiteRequest& request, const Placed& a, const Placed& b, Found& found,
               const std::vector<Eigen::Isometry3d>* poses = nullptr)
{
  if (!request.solid) return;
  Shape tile("a tile", std::shared_ptr<const SphereHierarchy>(std::shared_ptr<const void>(), &a.hierarchy()));
  const Question question = questionOf(request, a, b, poses);
  if constexpr (std::is_same_v<Found, TrajectoryResult>)
    addHeld(question, tile, *request.solid, found, request.pivot);
  else
    addHeld(question, tile, *request.solid, found);
}

} // namespace pcl_bsh::site
