// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/filters/collision_filter.h>
#include <pcl_bsh/filters/impl/query_filter.hpp>

namespace pcl_bsh {

template <typename PointT>
CollisionFilterBase<PointT>::CollisionFilterBase(bool extract_removed_indices)
: QueryFilter<PointT, CollisionSettings>(extract_removed_indices, "CollisionFilter")
{
}

template <typename PointT>
void CollisionFilterBase<PointT>::computeFlags(std::vector<Verdict>& flags)
{
  flags = this->collisionFlags(this->inputShape());
}

template <typename PointT>
void CollisionFilterBase<PointT>::computeTrajectory(TrajectoryResult& result)
{
  result = this->alongTrajectory(this->inputShape());
}

template <typename PointT>
void CollisionFilter<PointT>::setIndices(std::size_t row_start, std::size_t col_start, std::size_t nb_rows,
                                         std::size_t nb_cols)
{
  this->keepingIndices([&] { CollisionFilterBase<PointT>::setIndices(row_start, col_start, nb_rows, nb_cols); });
}

} // namespace pcl_bsh

#define PCL_INSTANTIATE_CollisionFilter(T)                                                                             \
  template class PCL_BSH_EXPORT pcl_bsh::QueryFilter<T, pcl_bsh::CollisionSettings>;                                   \
  template class PCL_BSH_EXPORT pcl_bsh::CollisionFilterBase<T>;                                                       \
  template class PCL_BSH_EXPORT pcl_bsh::CollisionFilter<T>;
