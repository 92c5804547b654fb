// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/filters/collision_filter.h>

#include <memory>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace pcl_bsh {

template <typename PointT>
CollisionFilterBase<PointT>::CollisionFilterBase(bool extract_removed_indices)
: pcl::FilterIndices<PointT>(extract_removed_indices)
{
  this->filter_name_ = "CollisionFilter";
}

template <typename PointT>
CollisionFilterBase<PointT>::CollisionFilterBase(const CollisionFilterBase& other)
: pcl::FilterIndices<PointT>(other),
  ObstacleQuery(other)
{
  this->removed_indices_ = removedOfItsOwn();
  this->indices_ = indicesOfItsOwn();
}

template <typename PointT>
CollisionFilterBase<PointT>& CollisionFilterBase<PointT>::operator=(const CollisionFilterBase& other)
{
  if (this == &other) return *this;
  // All that allocates comes first. Otherwise memory that runs out would leave half of each filter, or lists that both
  // write.
  pcl::IndicesPtr removed = other.removedOfItsOwn(), indices = other.indicesOfItsOwn();
  this->filter_name_.reserve(other.filter_name_.size());
  if constexpr (std::is_same_v<PointT, pcl::PCLPointCloud2>) this->field_sizes_.reserve(other.field_sizes_.size());
  ObstacleQuery::operator=(other);

  pcl::FilterIndices<PointT>::operator=(other);
  this->removed_indices_ = std::move(removed);
  this->indices_ = std::move(indices);
  return *this;
}

/// PCL's classes copy pointers to what each filter() writes: the removed indices and, unless the user has set them, the
/// numbers of all points.
template <typename PointT>
pcl::IndicesPtr CollisionFilterBase<PointT>::removedOfItsOwn() const
{
  return this->removed_indices_ ? std::make_shared<pcl::Indices>(*this->removed_indices_) : nullptr;
}

template <typename PointT>
pcl::IndicesPtr CollisionFilterBase<PointT>::indicesOfItsOwn() const
{
  return this->indices_ && this->fake_indices_ ? std::make_shared<pcl::Indices>(*this->indices_) : this->indices_;
}

template <typename PointT>
void CollisionFilterBase<PointT>::filter(Cloud& output)
{
  requireInput();
  Cloud result; // apart, so that output may be the input and is untouched by an error
  pcl::FilterIndices<PointT>::filter(result);
  output = std::move(result);
}

template <typename PointT>
void CollisionFilterBase<PointT>::filter(pcl::Indices& indices)
{
  requireInput();
  pcl::FilterIndices<PointT>::filter(indices);
}

template <typename PointT>
void CollisionFilterBase<PointT>::computeFlags(std::vector<std::uint8_t>& flags)
{
  requireInput();
  flags = collisionFlags(inputView());
}

template <typename PointT>
void CollisionFilterBase<PointT>::computeTrajectory(TrajectoryResult& result)
{
  requireInput();
  result = alongTrajectory(inputView());
}

template <typename PointT>
void CollisionFilterBase<PointT>::applyFilter(pcl::Indices& indices)
{
  select(inputView(), this->negative_, indices,
         this->extract_removed_indices_ ? this->removed_indices_.get() : nullptr);
}

template <typename PointT>
PointsView CollisionFilterBase<PointT>::inputView() const
{
  // PCL fills in the indices of the whole cloud where none were set.
  const bool subset = this->indices_ && !this->fake_indices_;
  const PointsView view = subset ? viewOf(*this->input_, *this->indices_) : viewOf(*this->input_);
  return getInputUncertainty().isZero() ? view : asUncertainInput(view, fieldsOfRecords(*this->input_));
}

template <typename PointT>
void CollisionFilterBase<PointT>::requireInput() const
{
  if (!this->input_) throw std::invalid_argument("input cloud is missing: call setInputCloud() before filtering");
}

template <typename PointT>
void CollisionFilter<PointT>::setIndices(std::size_t row_start, std::size_t col_start, std::size_t nb_rows,
                                         std::size_t nb_cols)
{
  const pcl::IndicesPtr former = this->indices_;
  try {
    CollisionFilterBase<PointT>::setIndices(row_start, col_start, nb_rows, nb_cols);
  }
  catch (...) {
    this->indices_ = former;
    throw;
  }
}

} // namespace pcl_bsh

#define PCL_INSTANTIATE_CollisionFilter(T)                                                                             \
  template class PCL_BSH_EXPORT pcl_bsh::CollisionFilterBase<T>;                                                       \
  template class PCL_BSH_EXPORT pcl_bsh::CollisionFilter<T>;
