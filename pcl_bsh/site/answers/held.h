// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/question/held.h>
#include <pcl_bsh/site/collide_site.h>

#include <memory>

namespace pcl_bsh::site {

/// Adds what b holds of a tile, where it is asked as a solid. @param found of the surface, of a and b as they stand
/// @param poses of b instead; null: as it stands
template <typename Found>
void addHeldOf(const SiteRequest& request, const Placed& a, const Placed& b, Found& found,
               const std::vector<Eigen::Isometry3d>* poses = nullptr)
{
  if (!request.solid) return;
  Question question;
  question.clearance = request.clearance;
  question.threads = request.threads;
  question.swept = request.swept.value_or(0.0);
  question.solid = true;
  question.pose_of_input = a.pose;
  question.pose = b.pose;
  if (poses) question.path = *poses;
  Shape tile("a tile", std::shared_ptr<const SphereHierarchy>(std::shared_ptr<const void>(), &a.hierarchy()));
  addHeld(question, tile, *request.solid, found);
}

} // namespace pcl_bsh::site
