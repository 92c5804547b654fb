// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/filters/query_filter.h>

#include <memory>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace pcl_bsh {

template <typename PointT, typename Settings>
QueryFilter<PointT, Settings>::QueryFilter(bool extract_removed_indices, const char* name)
: InputFilter<PointT>(extract_removed_indices)
{
  this->filter_name_ = name;
}

template <typename PointT, typename Settings>
QueryFilter<PointT, Settings>::QueryFilter(const QueryFilter& other) : InputFilter<PointT>(other),
                                                                       Settings(other)
{
  this->removed_indices_ = removedOfItsOwn();
  this->indices_ = indicesOfItsOwn();
}

template <typename PointT, typename Settings>
QueryFilter<PointT, Settings>& QueryFilter<PointT, Settings>::operator=(const QueryFilter& other)
{
  if (this == &other) return *this;
  // All that allocates comes first. Otherwise memory that runs out would leave half of each filter, or lists that both
  // write.
  pcl::IndicesPtr removed = other.removedOfItsOwn(), indices = other.indicesOfItsOwn();
  this->filter_name_.reserve(other.filter_name_.size());
  if constexpr (std::is_same_v<PointT, pcl::PCLPointCloud2>) this->field_sizes_.reserve(other.field_sizes_.size());
  Settings::operator=(other);

  InputFilter<PointT>::operator=(other);
  this->removed_indices_ = std::move(removed);
  this->indices_ = std::move(indices);
  return *this;
}

/// PCL's classes copy pointers to what each filter() writes: the removed indices and, unless the user has set them, the
/// numbers of all points.
template <typename PointT, typename Settings>
pcl::IndicesPtr QueryFilter<PointT, Settings>::removedOfItsOwn() const
{
  return this->removed_indices_ ? std::make_shared<pcl::Indices>(*this->removed_indices_) : nullptr;
}

template <typename PointT, typename Settings>
pcl::IndicesPtr QueryFilter<PointT, Settings>::indicesOfItsOwn() const
{
  return this->indices_ && this->fake_indices_ ? std::make_shared<pcl::Indices>(*this->indices_) : this->indices_;
}

template <typename PointT, typename Settings>
void QueryFilter<PointT, Settings>::filter(Cloud& output)
{
  this->numberPoints(inputView().size()); // once more: the cloud may have grown
  Cloud result;                           // apart, so that output may be the input and is untouched by an error
  pcl::FilterIndices<PointT>::filter(result);
  output = std::move(result);
}

template <typename PointT, typename Settings>
void QueryFilter<PointT, Settings>::filter(pcl::Indices& indices)
{
  this->numberPoints(inputView().size());
  pcl::FilterIndices<PointT>::filter(indices);
}

template <typename PointT, typename Settings>
void QueryFilter<PointT, Settings>::applyFilter(pcl::Indices& indices)
{
  select(this->passing(inputShape()), indices, this->extract_removed_indices_ ? this->removed_indices_.get() : nullptr);
}

template <typename PointT, typename Settings>
PointsView QueryFilter<PointT, Settings>::inputView() const
{
  if (!this->input_) throw std::invalid_argument("input cloud is missing: call setInputCloud() before filtering");
  // PCL fills in the indices of the whole cloud where none were set.
  const bool subset = this->indices_ && !this->fake_indices_;
  return subset ? viewOf(*this->input_, *this->indices_) : viewOf(*this->input_);
}

} // namespace pcl_bsh
