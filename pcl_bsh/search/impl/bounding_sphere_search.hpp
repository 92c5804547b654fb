// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/search/bounding_sphere_search.h>

#include <stdexcept>
#include <string>
#include <type_traits>

namespace pcl_bsh::search {
namespace detail {

/// Lends a caller's vectors to a search and gives them back filled.
template <typename Found, typename Indices, typename SquaredDistances, typename Search>
void fill(Indices& indices, SquaredDistances& squared_distances, const Search& search)
{
  Found found{std::move(indices), std::move(squared_distances)};
  search(found);
  indices = std::move(found.indices);
  squared_distances = std::move(found.squared_distances);
}

inline std::size_t checkedK(int k)
{
  if (k < 0) throw std::invalid_argument("k: " + std::to_string(k) + ": give the number of neighbours, >= 0");
  return static_cast<std::size_t>(k);
}

template <typename Cloud>
PointsView queriesOf(const Cloud& cloud, const pcl::Indices& indices)
{
  return indices.empty() ? viewOf(cloud) : viewOf(cloud, indices);
}

} // namespace detail

template <typename PointT>
BoundingSphereSearch<PointT>::BoundingSphereSearch(bool sorted) : Base(sorted)
{
  this->name_ = "BoundingSphereSearch";
}

template <typename PointT>
typename BoundingSphereSearch<PointT>::SetInputCloudResult
BoundingSphereSearch<PointT>::setInputCloud(const PointCloudConstPtr& cloud, const IndicesConstPtr& indices)
{
  if (!cloud) throw std::invalid_argument("input cloud is null: give an empty cloud if there are no points");
  HierarchyOptions options;
  options.threads = threads_;
  auto hierarchy = std::make_unique<SphereHierarchy>(indices ? viewOf(*cloud, *indices) : viewOf(*cloud), options);
  hierarchy->buildAll(threads_);
  hierarchy_ = std::move(hierarchy);
  this->input_ = cloud;
  this->indices_ = indices;
  if constexpr (!std::is_void_v<SetInputCloudResult>) return true;
}

template <typename PointT>
const SphereHierarchy& BoundingSphereSearch<PointT>::getHierarchy() const
{
  if (!hierarchy_) throw std::invalid_argument("input cloud is missing: call setInputCloud() before searching");
  return *hierarchy_;
}

template <typename PointT>
Point3 BoundingSphereSearch<PointT>::placeOf(const PointT& point)
{
  return {static_cast<double>(point.x), static_cast<double>(point.y), static_cast<double>(point.z)};
}

template <typename PointT>
int BoundingSphereSearch<PointT>::nearestKSearch(const PointT& point, int k, pcl::Indices& k_indices,
                                                 std::vector<float>& k_sqr_distances) const
{
  detail::fill<Neighbors>(k_indices, k_sqr_distances, [&](Neighbors& found) {
    pcl_bsh::nearestKSearch(getHierarchy(), placeOf(point), detail::checkedK(k), found);
  });
  return static_cast<int>(k_indices.size());
}

template <typename PointT>
int BoundingSphereSearch<PointT>::radiusSearch(const PointT& point, double radius, pcl::Indices& k_indices,
                                               std::vector<float>& k_sqr_distances, unsigned int max_nn) const
{
  detail::fill<Neighbors>(k_indices, k_sqr_distances, [&](Neighbors& found) {
    pcl_bsh::radiusSearch(getHierarchy(), placeOf(point), radius, found, {max_nn, this->sorted_results_});
  });
  return static_cast<int>(k_indices.size());
}

template <typename PointT>
void BoundingSphereSearch<PointT>::nearestKSearch(const PointCloud& cloud, const pcl::Indices& indices, int k,
                                                  std::vector<pcl::Indices>& k_indices,
                                                  std::vector<std::vector<float>>& k_sqr_distances) const
{
  detail::fill<NeighborLists>(k_indices, k_sqr_distances, [&](NeighborLists& found) {
    pcl_bsh::nearestKSearch(getHierarchy(), detail::queriesOf(cloud, indices), detail::checkedK(k), found, threads_);
  });
}

template <typename PointT>
void BoundingSphereSearch<PointT>::radiusSearch(const PointCloud& cloud, const pcl::Indices& indices, double radius,
                                                std::vector<pcl::Indices>& k_indices,
                                                std::vector<std::vector<float>>& k_sqr_distances,
                                                unsigned int max_nn) const
{
  detail::fill<NeighborLists>(k_indices, k_sqr_distances, [&](NeighborLists& found) {
    pcl_bsh::radiusSearch(getHierarchy(), detail::queriesOf(cloud, indices), radius, found,
                          {max_nn, this->sorted_results_}, threads_);
  });
}

template <typename PointT>
bool BoundingSphereSearch<PointT>::anyInRadius(const PointT& point, double radius) const
{
  return pcl_bsh::anyInRadius(getHierarchy(), placeOf(point), radius);
}

template <typename PointT>
std::vector<std::uint8_t> BoundingSphereSearch<PointT>::anyInBalls(const PointCloud& centers,
                                                                   const std::vector<float>& radii) const
{
  if (radii.size() != centers.size()) {
    throw std::invalid_argument(std::to_string(radii.size()) + " radii for " + std::to_string(centers.size()) +
                                " centers: give one per center");
  }
  static constexpr float none = 0.0f; // a view of no balls still has radii
  PointsView balls = viewOf(centers);
  balls.radii = radii.empty() ? &none : radii.data();
  return pcl_bsh::anyInBalls(getHierarchy(), balls, threads_);
}

template <typename PointT>
int BoundingSphereSearch<PointT>::boxSearch(const Eigen::Vector3f& min_pt, const Eigen::Vector3f& max_pt,
                                            pcl::Indices& k_indices) const
{
  const Eigen::Vector3d low = min_pt.cast<double>(), high = max_pt.cast<double>();
  return static_cast<int>(
      pcl_bsh::boxSearch(getHierarchy(), {low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}, k_indices));
}

} // namespace pcl_bsh::search

#define PCL_INSTANTIATE_BoundingSphereSearch(T) template class PCL_BSH_EXPORT pcl_bsh::search::BoundingSphereSearch<T>;
