// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/impl/collision_filter.hpp>

#include <pcl_bsh/filters/collision_field.h>

#include <pcl/common/io.h>
#include <pcl/impl/instantiate.hpp>
#include <pcl/point_types.h>

#include <cmath>
#include <cstring>

namespace pcl_bsh {
namespace {

/// Writes the value to x, y and z of a record, in the type the view says.
void overwrite(std::uint8_t* record, const PointsView& layout, float value)
{
  for (const std::size_t offset : layout.offset) {
    if (layout.scalar == Scalar::float32) {
      std::memcpy(record + offset, &value, sizeof value);
    }
    else {
      const double wide = value;
      std::memcpy(record + offset, &wide, sizeof wide);
    }
  }
}

} // namespace

void CollisionFilter<pcl::PCLPointCloud2>::setInputCloud(const PCLPointCloud2ConstPtr& cloud)
{
  if (!cloud) throw std::invalid_argument("input cloud is null: give an empty cloud if there are no points");
  CollisionFilterBase<pcl::PCLPointCloud2>::setInputCloud(cloud);
}

void CollisionFilter<pcl::PCLPointCloud2>::applyFilter(pcl::PCLPointCloud2& output)
{
  if (keep_flagged_) {
    output = getTrajectory() ? withFields(*input_, fieldsOf(alongTrajectory(inputView())))
                             : withField(*input_, collision_field_name, collisionFlags(inputView()));
    removed_indices_->clear();
    return;
  }

  pcl::Indices kept;
  if (!keep_organized_) {
    applyFilter(kept);
    pcl::copyPointCloud(*input_, kept, output);
    return;
  }

  const PointsView view = inputView();
  select(view, negative_, kept, removed_indices_.get());
  output = *input_;
  for (const pcl::index_t i : *removed_indices_) {
    overwrite(&output.data[static_cast<std::size_t>(i) * view.stride], view, user_filter_value_);
  }
  if (!std::isfinite(user_filter_value_)) output.is_dense = 0;
}

} // namespace pcl_bsh

template class pcl_bsh::CollisionFilterBase<pcl::PCLPointCloud2>;
PCL_INSTANTIATE(CollisionFilter, PCL_XYZ_POINT_TYPES)
