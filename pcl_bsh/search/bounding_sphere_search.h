// SPDX-License-Identifier: BSD-3-Clause
// A search object for all of PCL: give it wherever a pcl::search::Search or a pcl::search::KdTree is asked for.
//
//   auto search = std::make_shared<pcl_bsh::search::BoundingSphereSearch<pcl::PointXYZ>>();
//   normals.setSearchMethod(search);          // features, keypoints, clustering, smoothing
//   icp.setSearchMethodTarget(search);        // registration
//
// Answers are those of exact arithmetic on the given coordinates; PCL's own classes round: see below.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/search/cloud_view.h>

#include <pcl/memory.h>
#include <pcl/search/kdtree.h>

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::search {

/// The return type of setInputCloud() of a search class: PCL changed it.
template <typename Search>
using SetInputCloudResultOf = decltype(std::declval<Search&>().setInputCloud(
    std::declval<const typename Search::PointCloudConstPtr&>(), pcl::IndicesConstPtr()));

/// A bounding-sphere hierarchy behind PCL's interface, for point types whose x, y, z are float or double.
///
/// Rules of every search, in all overloads:
///  - a radius includes its end: a point with |p - q| == radius is found;
///  - max_nn gives the nearest ones; 0, or more than there are, all of them;
///  - results of nearestKSearch(), and of radiusSearch() unless setSortedResults(false), ascend by distance, equal
///    distances by index. Unsorted results come in any order, but always the same one;
///  - squared distances are the exact ones, rounded once to float;
///  - points that are not finite are never found, whatever is_dense says; a query that is not finite finds nothing;
///  - k above the number of points gives all of them; an empty cloud gives 0, and both outputs are cleared;
///  - where setInputCloud() had indices, only those points are found, under their numbers in the cloud;
///  - const methods may be called from several threads at once.
///
/// It is a pcl::search::KdTree because registration accepts nothing else, but builds no k-d tree: setEpsilon() and
/// setPointRepresentation() have no effect.
///
/// The cloud and the indices must not change until the next setInputCloud(). Instantiated for PCL's XYZ types. For a
/// point type of your own define PCL_NO_PRECOMPILE before the first PCL header.
template <typename PointT>
class BoundingSphereSearch : public pcl::search::KdTree<PointT> {
  using Base = pcl::search::KdTree<PointT>;

public:
  using typename Base::PointCloud;
  using typename Base::PointCloudConstPtr;
  using IndicesConstPtr = pcl::IndicesConstPtr;
  using Ptr = std::shared_ptr<BoundingSphereSearch<PointT>>;
  using ConstPtr = std::shared_ptr<const BoundingSphereSearch<PointT>>;

  /// void up to PCL 1.13, bool from 1.14 on (then: true).
  using SetInputCloudResult = SetInputCloudResultOf<Base>;

  using Base::nearestKSearch;
  using Base::radiusSearch;

  /// @param sorted whether radiusSearch() sorts
  explicit BoundingSphereSearch(bool sorted = true);

  /// Builds the whole hierarchy, so that queries build nothing. @throws std::invalid_argument when the cloud is
  /// null, or an index is outside of it; the former input stays then.
  SetInputCloudResult setInputCloud(const PointCloudConstPtr& cloud,
                                    const IndicesConstPtr& indices = IndicesConstPtr()) override;

  /// @throws std::invalid_argument before setInputCloud() was called, as all searches do; when k is negative
  int nearestKSearch(const PointT& point, int k, pcl::Indices& k_indices,
                     std::vector<float>& k_sqr_distances) const override;

  /// @throws std::invalid_argument when the radius is negative or NaN
  int radiusSearch(const PointT& point, double radius, pcl::Indices& k_indices, std::vector<float>& k_sqr_distances,
                   unsigned int max_nn = 0) const override;

  /// Answers many queries at once: the points of `cloud` that `indices` name, or all of them when it is empty. Threads
  /// share them, in an order that suits the caches. Results are those of the single queries.
  void nearestKSearch(const PointCloud& cloud, const pcl::Indices& indices, int k, std::vector<pcl::Indices>& k_indices,
                      std::vector<std::vector<float>>& k_sqr_distances) const override;
  void radiusSearch(const PointCloud& cloud, const pcl::Indices& indices, double radius,
                    std::vector<pcl::Indices>& k_indices, std::vector<std::vector<float>>& k_sqr_distances,
                    unsigned int max_nn = 0) const override;

  /// Does any point lie within the radius? Stops at the first.
  bool anyInRadius(const PointT& point, double radius) const;

  /// Answers many balls at once: 1 where a point of the input lies in the ball around centers[i].
  /// @param radii one per center. @throws std::invalid_argument when their number differs, or one is negative or NaN
  std::vector<std::uint8_t> anyInBalls(const PointCloud& centers, const std::vector<float>& radii) const;

  /// The points with min_pt <= p <= max_pt on each axis, ascending. @return how many
  int boxSearch(const Eigen::Vector3f& min_pt, const Eigen::Vector3f& max_pt, pcl::Indices& k_indices) const;

  /// Threads that setInputCloud() and searches for many queries use. 0, the default: all of the machine's.
  void setNumberOfThreads(unsigned int threads = 0) { threads_ = threads; }
  unsigned int getNumberOfThreads() const { return threads_; }

  /// The hierarchy behind the searches, for other queries too. setInputCloud() replaces it.
  const SphereHierarchy& getHierarchy() const;

private:
  static Point3 placeOf(const PointT& point);

  std::unique_ptr<const SphereHierarchy> hierarchy_;
  unsigned int threads_ = 0;
};

} // namespace pcl_bsh::search
PCL_BSH_EXPORT_END

#ifdef PCL_NO_PRECOMPILE
#include <pcl_bsh/search/impl/bounding_sphere_search.hpp>
#endif
