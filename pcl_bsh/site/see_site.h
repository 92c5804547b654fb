// SPDX-License-Identifier: BSD-3-Clause
// What of a model lies where no scanner of a site saw that the space is empty? The answer is that of one SeenSpace over
// all points of the site.
//
// All tiles that have beams near the directions of the model are read once, and these beams are kept in memory: as many
// as look at the model on its way, but all of a scan where a ball of the model holds the place of its scanner.
#pragma once

#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/site/collide_site.h>

#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::site {

/// Where scanners stood, and what their beams speak for.
struct SiteSight {
  ScanOrigins origins; ///< by a field of the site: `source` numbers its files
  double angle = 0.0;  ///< SeenOptions::angle, which is not measured here
};

/// What of a model is unseen.
struct SiteUnseen {
  Answer::Unseen unseen;         ///< as ask() has it, with `where`
  std::vector<Verdict> verdicts; ///< of the model's records, the gravest of all poses
  std::uint64_t beams = 0;       ///< that were kept
  TilesRead tiles;               ///< that were read for collisions
  TilesRead tiles_of_beams;      ///< without costs
};

/// At each of its poses: what collides there is not unseen. Accuracy, swept motion and answers of the request are not
/// used.
/// @throws std::invalid_argument also for no origin, an angle that SeenSpace refuses, a point whose scan has no origin,
///   and beams that need more memory than the request allows
SiteUnseen unseenAlong(const Site& site, const SiteSight& sight, const SphereHierarchy& model,
                       const std::vector<Eigen::Isometry3d>& poses, const SiteRequest& request);

} // namespace pcl_bsh::site
PCL_BSH_EXPORT_END
