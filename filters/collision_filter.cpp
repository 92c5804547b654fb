// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/impl/collision_filter.hpp>

#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/filters/removed_points.h>

#include <pcl/common/io.h>
#include <pcl/impl/instantiate.hpp>
#include <pcl/point_types.h>

namespace pcl_bsh {

void CollisionFilter<pcl::PCLPointCloud2>::applyFilter(pcl::PCLPointCloud2& output)
{
  if (keep_flagged_) {
    output = question_.path ? withFields(*input_, fieldsOf(alongTrajectory(inputShape())))
                            : withField(*input_, collision_field_name, collisionFlags(inputShape()));
    removed_indices_->clear();
    return;
  }

  pcl::Indices kept;
  if (!keep_organized_) {
    applyFilter(kept);
    pcl::copyPointCloud(*input_, kept, output);
    return;
  }

  select(passing(inputShape()), kept, removed_indices_.get());
  output = *input_;
  overwritePoints(output, *removed_indices_, user_filter_value_);
}

} // namespace pcl_bsh

template class pcl_bsh::QueryFilter<pcl::PCLPointCloud2, pcl_bsh::CollisionSettings>;
template class pcl_bsh::CollisionFilterBase<pcl::PCLPointCloud2>;
PCL_INSTANTIATE(CollisionFilter, PCL_XYZ_POINT_TYPES)
