// SPDX-License-Identifier: BSD-3-Clause
// One question about a site and several obstacles in memory, with the answers of one hierarchy over all its points.
//
//   std::vector<PlacedShape> parts = {{press, T_hall_press}, {mill, T_hall_mill}};
//   const site::SiteObstaclesAnswer answer = site::ask(question, hall, parts);
//   if (answer.each[0].verdict == Verdict::colliding) ...
//
// Each tile is read once, and asked about all obstacles that may be near it. Threads share the obstacles.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/question/obstacles.h>
#include <pcl_bsh/site/ask_site.h>

#include <cstdint>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::site {

/// The answer about one of several obstacles.
struct SiteObstacleAnswer : ObstacleAnswer {
  std::optional<SitePair> pair; ///< the pair of `closest`; closest.pair has 0 as the site's point
  Point3 place = {0, 0, 0};     ///< where the site's point of the pair is
  TrajectoryResult found;       ///< its counts, poses and first contacts
  Answer::Unseen not_seen;      ///< with `seen`: its records that are unseen
};

/// The answer about all obstacles, together and one by one.
struct SiteObstaclesAnswer {
  /// A point counts once, with the gravest of its verdicts. Counts at the poses of a path add up.
  SiteAnswer all;
  std::uint32_t closest = kNothing;     ///< the obstacle of `all.closest`
  std::vector<SiteObstacleAnswer> each; ///< in the order of the obstacles
};

/// Asks for flags, contacts, poses, the smallest distances and what is unseen. A receiver gets the answer about all
/// obstacles together.
/// @param means its `clashes` is not used
/// @param clashes a finder for each obstacle, or none
/// @throws as ask() of one obstacle does; InvalidInput for no obstacle, and for answers other than these
SiteObstaclesAnswer ask(const Question& question, const Site& site, std::vector<PlacedShape>& obstacles,
                        const SiteMeans& means = {}, const std::vector<ClashFinder*>& clashes = {});

/// Refuses the question where ask() would refuse it for any obstacles. @throws as check() does
void checkOfSeveral(const Question& question);

} // namespace pcl_bsh::site
PCL_BSH_EXPORT_END
