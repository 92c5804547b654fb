// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/added_fields.h>
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/float_cloud.h>
#include <pcl_bsh/search/cloud_view.h>

#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace pcl_bsh::pipeline {
namespace {

struct EuclideanCluster : Stage {
  double cluster_tolerance = 0;
  std::uint32_t min_cluster_size = 1;
  std::uint32_t max_cluster_size = std::numeric_limits<std::uint32_t>::max();

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    if (min_cluster_size > max_cluster_size) {
      throw OptionError("min_cluster_size", "exceeds `max_cluster_size`: exchange them");
    }
    CloudHeader header = inputs[0];
    addFields(header, {"cluster"}, pcl::PCLPointField::INT32);
    return header;
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    const auto output = ownCloud(std::move(inputs[0]));
    pcl::PCLPointCloud2& cloud = output->cloud;
    const std::size_t offset = addFields(cloud, {"cluster"}, pcl::PCLPointField::INT32)[0];
    const std::vector<std::int32_t> numbers = clusterNumbers(viewOf(cloud));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      std::memcpy(&cloud.data[i * cloud.point_step + offset], &numbers[i], sizeof numbers[i]);
    }
    return output;
  }

private:
  /// One per record: its cluster's rank, or -1.
  std::vector<std::int32_t> clusterNumbers(const PointsView& view)
  {
    std::vector<std::int32_t> numbers(view.count, -1);
    const FloatCloud points = floatCloud(view);
    std::vector<pcl::PointIndices> clusters = clustersOf(points);
    // PCL orders them by size, but those of one size in no order that it promises.
    std::stable_sort(clusters.begin(), clusters.end(), [](const pcl::PointIndices& a, const pcl::PointIndices& b) {
      return a.indices.size() != b.indices.size() ? a.indices.size() > b.indices.size() : a.indices[0] < b.indices[0];
    });
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      for (const pcl::index_t i : clusters[c].indices) {
        numbers[points.records[static_cast<std::size_t>(i)]] = static_cast<std::int32_t>(c);
      }
    }
    return numbers;
  }

  std::vector<pcl::PointIndices> clustersOf(const FloatCloud& points)
  {
    std::vector<pcl::PointIndices> clusters;
    if (points.points->empty()) return clusters;
    const std::string warning = roundingWarning(points, cluster_tolerance);
    if (!warning.empty()) warn(warning);

    // Unsorted: PCL skips the first of sorted neighbours as the point itself, but it may be a duplicate of the point.
    const auto search = std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>(false);
    pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
    setInput(extraction, points);
    extraction.setSearchMethod(search);
    extraction.setClusterTolerance(cluster_tolerance);
    extraction.setMinClusterSize(min_cluster_size);
    extraction.setMaxClusterSize(max_cluster_size);
    extraction.extract(clusters);
    return clusters;
  }
};

} // namespace

StageType euclideanCluster()
{
  return describe<EuclideanCluster>(
             "filters.euclidean_cluster",
             "Adds a field `cluster` (int32): 0 for points of the largest cluster, 1 for the next, -1 for points of "
             "no cluster. Computed in float32 about the cloud's middle; coordinates stay as they are.")
      .alias("pcl::EuclideanClusterExtraction")
      .option(&EuclideanCluster::cluster_tolerance, "cluster_tolerance",
              "greatest distance between neighbours in a cluster")
      .positiveLength()
      .required()
      .option(&EuclideanCluster::min_cluster_size, "min_cluster_size", "least number of points of a cluster")
      .option(&EuclideanCluster::max_cluster_size, "max_cluster_size", "greatest number of points of a cluster");
}

} // namespace pcl_bsh::pipeline
