// SPDX-License-Identifier: BSD-3-Clause
// pcl_bsh_site collide --out: what was found of each point, as a site.
#pragma once

#include "options.h"

#include <pcl_bsh/filters/cloud_files/cloud_file.h>
#include <pcl_bsh/site/collide_site.h>
#include <pcl_bsh/site/result_site.h>

#include <optional>

namespace pcl_bsh::cli {

/// What a site is compared with, and how its file says more than points.
struct ObstacleCloud {
  /// @throws files::FileError, also where its points shall be written and cannot
  explicit ObstacleCloud(const SiteOptions& options);

  pcl::PCLPointCloud2 cloud;
  io::Viewpoint viewpoint = io::no_viewpoint;
  io::LasHeaderPtr las;
};

/// The site of results, and the obstacle with its flags, where they are asked for; else its sinks are null.
class SiteOutput {
public:
  /// @throws files::FileError for a folder that cannot be one
  SiteOutput(const sites::Site& site, const ObstacleCloud& obstacle, const SiteOptions& options);

  sites::FlagsSink flags();
  sites::DistancesSink distances();
  sites::PassageSink passage();
  void writeObstacle(const std::vector<std::uint8_t>& flags) const;

  /// After the question. To be called by all ranks.
  void finish();

private:
  const ObstacleCloud& obstacle_;
  const SiteOptions& options_;
  std::optional<sites::ResultSite> out_;
};

} // namespace pcl_bsh::cli
