// SPDX-License-Identifier: BSD-3-Clause
// An independent nearest neighbour, for clouds too large for brute force: nanoflann, in double.
#pragma once

#include <pcl_bsh/hierarchy/points_view.h>

#include <Eigen/Geometry>
#include <nanoflann.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

namespace pcl_bsh::test {

class KdTree {
public:
  struct Nearest {
    std::uint32_t record;
    double distance;
  };

  /// Of the finite points of the view, under a pose. Must not be empty.
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

} // namespace pcl_bsh::test
