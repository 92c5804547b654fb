// SPDX-License-Identifier: BSD-3-Clause
// Independent answers for clouds too large for brute force: nanoflann in double, exact arithmetic where that is not
// sure.
#pragma once

#include "support/radius_hits.h"
#include "support/verdicts.h"

#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <Eigen/Geometry>
#include <nanoflann.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace pcl_bsh::test {

class KdTree {
public:
  struct Nearest {
    std::uint32_t record;
    double distance;
  };

  /// A tree of the finite points of the view, under a pose. Must not be empty.
  KdTree(const PointsView& view, const Eigen::Isometry3d& pose)
  {
    for (std::size_t i = 0; i < view.size(); ++i) {
      const Eigen::Vector3d point = moved(view, view.record(i), pose);
      if (!point.allFinite()) continue;
      points_.records.push_back(view.record(i));
      points_.coordinates.push_back(point);
    }
    tree_.buildIndex();
  }

  KdTree(const KdTree&) = delete;
  KdTree& operator=(const KdTree&) = delete;

  static Eigen::Vector3d moved(const PointsView& view, std::uint32_t record, const Eigen::Isometry3d& pose)
  {
    const Point3 point = view.point(record);
    return pose * Eigen::Vector3d(point[0], point[1], point[2]);
  }

  Nearest nearest(const Eigen::Vector3d& query) const
  {
    std::size_t index = 0;
    double squared = 0;
    tree_.knnSearch(query.data(), 1, &index, &squared);
    return {points_.records[index], std::sqrt(squared)};
  }

  /// Whether accept(record) holds for any point within the distance, give or take rounding.
  template <class Accept>
  bool anyWithin(const Eigen::Vector3d& query, double distance, const Accept& accept) const
  {
    RadiusHits<std::size_t, double> found;
    tree_.radiusSearch(query.data(), distance * distance, found, {});
    return std::any_of(found.begin(), found.end(), [&](const auto& hit) { return accept(points_.records[hit.first]); });
  }

private:
  struct Points {
    std::vector<std::uint32_t> records;
    std::vector<Eigen::Vector3d> coordinates;

    std::size_t kdtree_get_point_count() const { return coordinates.size(); }
    double kdtree_get_pt(std::size_t index, std::size_t axis) const
    {
      return coordinates[index][static_cast<Eigen::Index>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const
    {
      return false;
    }
  };
  using Metric = nanoflann::L2_Simple_Adaptor<double, Points>;

  Points points_;
  nanoflann::KDTreeSingleIndexAdaptor<Metric, Points, 3, std::size_t> tree_{3, points_};
};

/// The expected collisionFlags() of a. For clearances well above the rounding of the world's coordinates.
inline std::vector<Verdict> flagsByKdTree(const PointsView& a, const Eigen::Isometry3d& pose_a, const PointsView& b,
                                          const Eigen::Isometry3d& pose_b, double clearance)
{
  constexpr double band = 1e-6;
  const KdTree tree(b, pose_b);
  const ExactDistance distance(pose_a, pose_b);
  std::vector<Verdict> flags(a.count, Verdict::free);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::uint32_t record = a.record(i);
    const Eigen::Vector3d query = KdTree::moved(a, record, pose_a);
    if (!query.allFinite()) continue;
    const double nearest = tree.nearest(query).distance;
    const auto collides = [&](std::uint32_t other) {
      return distance.compare(a.point(record), b.point(other), clearance) <= 0;
    };
    if (nearest <= clearance * (1 - band))
      flags[record] = Verdict::colliding;
    else if (nearest <= clearance * (1 + band))
      flags[record] = verdictIf(tree.anyWithin(query, clearance * (1 + 2 * band), collides));
  }
  return flags;
}

/// The smallest distance, within rounding.
inline double distanceByKdTree(const PointsView& a, const Eigen::Isometry3d& pose_a, const PointsView& b,
                               const Eigen::Isometry3d& pose_b)
{
  const KdTree tree(b, pose_b);
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector3d query = KdTree::moved(a, a.record(i), pose_a);
    if (query.allFinite()) smallest = std::min(smallest, tree.nearest(query).distance);
  }
  return smallest;
}

} // namespace pcl_bsh::test
