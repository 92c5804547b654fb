// SPDX-License-Identifier: BSD-3-Clause
// The request for each tile of a site along a path, and the sum of the answers.
#pragma once

#include <pcl_bsh/site/answers/question_part.h>
#include <pcl_bsh/site/site_clashes.h>
#include <pcl_bsh/site/tiles/path_boxes.h>

#include <cstddef>
#include <vector>

namespace pcl_bsh::site {

/// The request for each tile: flags and, where they are wanted, distances and poses of points that collide.
TrajectoryRequest alongPath(const QuestionPart& part);

/// Returns the reach of the model: a tile within it may collide.
PathReach pathReach(const TrajectoryRequest& request);

/// Returns two opposite corners of the box about its points; nothing for a site without finite points.
std::vector<Point3> cornersOf(const Site& site);

/// Asks about the site's corners, so that the query refuses wrong arguments where no tile is asked about.
/// @throws std::invalid_argument as collideAlong() does
void refusePassage(const Site& site, const SphereHierarchy& model, const std::vector<Eigen::Isometry3d>& poses,
                   const TrajectoryRequest& request);

/// The earlier one of two.
FirstContact earlier(const FirstContact& a, const FirstContact& b);

class PassageSum {
public:
  /// @param poses how many there are
  PassageSum(const QuestionPart& part, std::size_t poses);

  /// Returns the answer about a tile as numbers.
  /// @param met the points that closest_point is an index into, where the model is a site
  std::vector<double> numbersOf(const Tile& tile, const pcl::PCLPointCloud2& cloud, const CollidingRecords& some,
                                const std::vector<MetPoint>* met = nullptr) const;

  void add(const std::vector<double>& numbers);

  /// The sum over all tiles of all ranks, on each rank. To be called once.
  void tell(SiteAnswer& answer);

private:
  ClashFinder* clashes_; ///< null: none are wanted
  std::uint64_t colliding_ = 0, undecided_ = 0;
  std::vector<PoseSummary> poses_;
  double least_, first_;
  FirstContact contact_, certain_;
};

} // namespace pcl_bsh::site
