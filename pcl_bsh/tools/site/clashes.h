// SPDX-License-Identifier: BSD-3-Clause
// pcl_bsh_site collide --clashes: the places of a site that collide, as pcl_bsh_collide lists them.
#pragma once

#include "site_options.h"
#include "site_report.h"

#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/site/site_clashes.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// The lists of clashes. Does nothing where no list is asked for.
class SiteClashList {
public:
  /// Reads the earlier list. To be called by all ranks.
  /// @throws files::FileError for a list that cannot be written or compared with
  SiteClashList(const site::Site& site, const SiteOptions& options);

  bool isWanted() const noexcept { return finder_.has_value(); }

  /// Warnings about the earlier list, a line each; see finish().
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }

  /// Returns the finder that the question fills for the lists; null where no list is wanted.
  site::ClashFinder* finder() { return finder_ ? &*finder_ : nullptr; }

  /// The distance within which colliding points are one clash; 0 where no list is wanted.
  double clusterDistance() const noexcept { return distance_; }

  /// Writes the lists on the first rank. To be called by all ranks, after the question. Afterwards warnings() has those
  /// of the comparison with the earlier list.
  /// @param surface the obstacle where it is a surface, else null
  /// @param report gets the numbers of clashes that are there now: certain ones, and those perhaps
  void finish(const SphereHierarchy& obstacle, const io::Obstacle* surface, const site::SiteAnswer& found,
              Json& report);

  /// Writes the lists where the obstacle is a site.
  void finish(const site::Site& obstacle, const site::SiteAnswer& found, Json& report);

  /// After finish(): as io::clashCounts() tells it.
  const std::string& counts() const noexcept { return counts_; }

private:
  using Visit = std::function<void(FormerPlaces&, const TrajectoryRequest& motion)>;

  void write(site::SiteClashes clashes, const PointsView& model, const io::Obstacle* surface,
             const site::SiteAnswer& found, std::function<io::SourcePoint(std::uint32_t)> model_source_of,
             const Visit& visit, Json& report);
  void compare(io::ClashReport& list, const Visit& visit);

  const site::Site& site_;
  const SiteOptions& options_;
  double distance_ = 0.0;
  io::ClashList earlier_;
  std::string counts_;
  std::vector<std::string> warnings_;
  std::optional<site::ClashFinder> finder_;
};

} // namespace pcl_bsh::cli
