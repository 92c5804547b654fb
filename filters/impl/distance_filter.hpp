// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/filters/distance_filter.h>
#include <pcl_bsh/filters/impl/query_filter.hpp>

namespace pcl_bsh {

template <typename PointT>
DistanceFilterBase<PointT>::DistanceFilterBase(bool extract_removed_indices)
: QueryFilter<PointT, DistanceSettings>(extract_removed_indices, "DistanceFilter")
{
}

template <typename PointT>
void DistanceFilterBase<PointT>::computeDistances(PointDistances& result)
{
  result = this->distances(this->inputShape());
}

template <typename PointT>
void DistanceFilter<PointT>::setIndices(std::size_t row_start, std::size_t col_start, std::size_t nb_rows,
                                        std::size_t nb_cols)
{
  this->keepingIndices([&] { DistanceFilterBase<PointT>::setIndices(row_start, col_start, nb_rows, nb_cols); });
}

} // namespace pcl_bsh

#define PCL_INSTANTIATE_DistanceFilter(T)                                                                              \
  template class PCL_BSH_EXPORT pcl_bsh::QueryFilter<T, pcl_bsh::DistanceSettings>;                                    \
  template class PCL_BSH_EXPORT pcl_bsh::DistanceFilterBase<T>;                                                        \
  template class PCL_BSH_EXPORT pcl_bsh::DistanceFilter<T>;
