// SPDX-License-Identifier: BSD-3-Clause
// pcl_bsh_site collide --out: what was found of each point, as a site.
#pragma once

#include "options.h"

#include <pcl_bsh/filters/cloud_files/cloud_file.h>
#include <pcl_bsh/site/collide_sites.h>
#include <pcl_bsh/site/result_site.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh::cli {

/// What a site is compared with, and how its file says more than points.
struct ObstacleCloud {
  /// @throws files::FileError, also where its points shall be written and cannot
  explicit ObstacleCloud(const SiteOptions& options);

  /// Writes its points with these flags, where they are asked for: on the first rank.
  void write(const std::vector<std::uint8_t>& flags, const SiteOptions& options) const;

  pcl::PCLPointCloud2 cloud;
  io::Viewpoint viewpoint = io::no_viewpoint;
  io::LasHeaderPtr las;
};

/// Of a run with --out that ends before it has answered.
inline constexpr auto what_stays = "what was found stays, and the same command with --resume goes on";

/// Where the obstacle is asked about.
using Poses = std::vector<Eigen::Isometry3d>;

/// The field of flags at one pose.
sites::ResultField collisionField();

/// The site of results, where it is asked for; else its sinks are null.
class SiteOutput {
public:
  /// @param obstacle null where that is a site, too
  /// @param cluster_distance of the lists of clashes; 0 where none is wanted
  /// @throws files::FileError for a folder that cannot be one
  SiteOutput(const sites::Site& site, const ObstacleCloud* obstacle, const Poses& poses, double cluster_distance,
             const SiteOptions& options);

  /// What an earlier run has found, and where this one keeps what it finds; null: nothing is kept.
  sites::TileAnswers* answers() { return out_ ? out_->answers() : nullptr; }

  sites::FlagsSink flags();
  sites::DistancesSink distances();
  sites::PairDistancesSink distancesOfSites();
  sites::PassageSink passage();

  /// After the question. To be called by all ranks.
  void finish();

private:
  const SiteOptions& options_;
  std::optional<sites::ResultSite> out_;
};

} // namespace pcl_bsh::cli
