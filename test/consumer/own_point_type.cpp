// SPDX-License-Identifier: BSD-3-Clause
// Filters on one of PCL's point types (from the library) and on a type the library has never seen (from its headers).
#define PCL_NO_PRECOMPILE
#include <pcl_bsh/filters/collision_filter.h>
#include <pcl_bsh/search/cloud_view.h>

#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>

#include <cstdio>

struct Beam {
  PCL_ADD_POINT4D;
  float range;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};
POINT_CLOUD_REGISTER_POINT_STRUCT(Beam, (float, x, x)(float, y, y)(float, z, z)(float, range, range))

template <typename PointT>
bool keepsWhatIsFree()
{
  auto scan = std::make_shared<pcl::PointCloud<PointT>>();
  scan->resize(2);
  for (PointT& point : *scan) point.getVector3fMap().setZero();
  (*scan)[1].x = 2;
  auto obstacle = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  obstacle->emplace_back(0.5f, 0.0f, 0.0f);

  pcl_bsh::CollisionFilter<PointT> filter;
  filter.setInputCloud(scan);
  filter.setObstacleCloud(obstacle);
  filter.setClearance(0.5);
  pcl::PointCloud<PointT> free;
  filter.filter(free);
  std::printf("%zu of %zu points are free\n", free.size(), pcl_bsh::viewOf(*scan).size());
  return free.size() == 1 && free[0].x == 2;
}

int main()
{
  return keepsWhatIsFree<pcl::PointXYZ>() && keepsWhatIsFree<Beam>() ? 0 : 1;
}
