// SPDX-License-Identifier: BSD-3-Clause
// One of several obstacles of a site, on its way past the tiles.
#pragma once

#include <pcl_bsh/site/answers/passage_sum.h>
#include <pcl_bsh/site/answers/tile_query.h>
#include <pcl_bsh/site/tiles/needed_tiles.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl_bsh::site {

/// Returns an upper bound of the distance of any point in one box from any point in the other.
inline double mostDistance(const Bounds& a, const Bounds& b)
{
  Point3 most;
  for (std::size_t k = 0; k < 3; ++k) most[k] = std::max(a.high[k] - b.low[k], b.high[k] - a.low[k]);
  return std::hypot(most[0], most[1], most[2]) * (1.0 + 1e-9);
}

/// An obstacle on its way past the tiles.
class PassingObstacle {
public:
  PassingObstacle(const Question& question, const SiteMeans& means, const Site& site, Shape& shape)
  : part{question, means, site, &shape, nullptr},
    poses(question.poses()),
    wanted(alongPath(part)),
    sum(part, poses.size()),
    boxes_(boxesOf(part.model().view(), question.solid)),
    reach_(boxes_, poses, pathReach(wanted))
  {
    if (boxes_.empty()) return;
    for (const Eigen::Isometry3d& pose : poses) at_poses_.push_back(moved(boxes_.whole(), pose, 0.0));
  }
  PassingObstacle(const PassingObstacle&) = delete;
  PassingObstacle& operator=(const PassingObstacle&) = delete;

  bool mayReach(const Tile& tile) const
  {
    return reach_.mayReach(trueBounds(tile, part.question.uncertaintyOfInput()));
  }

  /// Holds all points of a tile that may be within reach. @pre mayReach()
  Bounds boxOfReach(const Tile& tile) const
  {
    return moved(reach_.whole(), Eigen::Isometry3d::Identity(), straying(tile, part.question.uncertaintyOfInput()));
  }

  /// At most the smallest distance from a tile's points as they were measured, at any pose.
  double lowerBound(const Tile& tile) const
  {
    double least = infinity;
    for (const Bounds& box : at_poses_) least = std::min(least, leastDistance(*tile.bounds, box));
    return least > 0.0 ? least : -boxes_.largestRadius(); // where boxes overlap, a point may be inside a ball
  }

  /// At least the smallest distance.
  double upperBound(const Tile& tile) const
  {
    double most = infinity;
    for (const Bounds& box : at_poses_) most = std::min(most, mostDistance(*tile.bounds, box));
    return most;
  }

  /// Whether a tile's points may lie within its faces.
  bool mayClose(const Tile& tile) const
  {
    return part.shape->isSurface() && !part.question.solid &&
           std::any_of(at_poses_.begin(), at_poses_.end(),
                       [&](const Bounds& box) { return overlap(*tile.bounds, box); });
  }

  QuestionPart part;
  const std::vector<Eigen::Isometry3d> poses;
  const TrajectoryRequest wanted;
  PassageSum sum;

private:
  const CloudBoxes boxes_;
  const PathBoxes reach_;
  std::vector<Bounds> at_poses_; ///< at each pose, the box about the whole obstacle
};

} // namespace pcl_bsh::site
