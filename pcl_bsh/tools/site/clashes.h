// SPDX-License-Identifier: BSD-3-Clause
// pcl_bsh_site collide --clashes: the places of a site that collide, as pcl_bsh_collide lists them.
#pragma once

#include "output.h"
#include "site_options.h"
#include "site_report.h"

#include <pcl_bsh/io/reports/compared_obstacles.h>
#include <pcl_bsh/site/site_clashes.h>
#include <pcl_bsh/site/site_obstacles.h>

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// The lists of clashes. Does nothing where no list is asked for.
class SiteClashList {
public:
  /// Reads the earlier list. To be called by all ranks.
  /// @param obstacles in memory, with their questions; null: the obstacle is a site. Obstacles that are not asked about
  ///   get the answers of the earlier list
  /// @throws files::FileError for a list that cannot be written or compared with
  SiteClashList(const site::Site& site, const SiteOptions& options, ObstacleFiles* obstacles);

  bool isWanted() const noexcept { return !finders_.empty(); }

  /// Warnings about the earlier list, a line each; see finish().
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }

  /// Returns the finders that the question fills for the lists, one for each obstacle; none where no list is wanted.
  std::vector<site::ClashFinder*> finders() const;

  /// The distance within which colliding points are one clash; 0 where no list is wanted.
  double clusterDistance() const noexcept { return distance_; }

  /// Writes the lists on the first rank. To be called by all ranks, after the question. Afterwards warnings() has those
  /// of the comparison with the earlier list.
  /// @param report gets the numbers of clashes that are there now: certain ones, and those perhaps
  void finish(ObstacleFiles& obstacles, const site::SiteAnswer& found, Json& report);

  /// Writes the lists of several obstacles.
  void finish(ObstacleFiles& obstacles, const site::SiteObstaclesAnswer& found,
              const std::vector<io::BetweenObstacles>& between, Json& report);

  /// Writes the lists where the obstacle is a site.
  void finish(const site::Site& obstacle, const site::SiteAnswer& found, Json& report);

  /// After finish(): as io::clashCounts() tells it.
  const std::string& counts() const noexcept { return counts_; }

private:
  using Visit = std::function<void(FormerPlaces&, const TrajectoryRequest& motion)>;

  /// The contents of one obstacle's list.
  struct Listed {
    io::ClashQuestion question;
    site::SiteClashes clashes;
    PointsView model;
    const TrajectoryResult& found;
    Visit visit; ///< tells former places where the obstacle moved
    const io::Obstacle* surface = nullptr;
    const Answer::Unseen* unseen = nullptr;
    std::string name = {};
    std::optional<ObstacleAnswer> answer = {};
    std::function<io::SourcePoint(std::uint32_t)> model_source_of = nullptr;
    PointsView scan = {};
    std::vector<Eigen::Isometry3d> poses = {};
    io::ComparedObstacle* kept = nullptr; ///< set where it is not asked about: nothing else is needed
  };

  Listed listed(ObstacleFiles& obstacles, std::size_t i, const TrajectoryResult& found) const;
  void write(std::deque<Listed>& all, const std::vector<io::BetweenObstacles>& between, Json& report);
  void compare(io::ClashLists& lists, const std::deque<Listed>& all);

  const site::Site& site_;
  const SiteOptions& options_;
  double distance_ = 0.0;
  io::ClashListing listing_;
  std::string counts_;
  std::vector<std::string> warnings_;
  std::vector<std::unique_ptr<site::ClashFinder>> finders_; ///< of each obstacle
};

} // namespace pcl_bsh::cli
