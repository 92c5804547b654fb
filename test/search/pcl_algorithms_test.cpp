// SPDX-License-Identifier: BSD-3-Clause
// PCL's algorithms give with our search what they give with their own.
#include <pcl_bsh/search/bounding_sphere_search.h>

#include <pcl/common/transforms.h>
#include <pcl/features/fpfh.h>
#include <pcl/features/normal_3d.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/keypoints/iss_3d.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/region_growing.h>
#include <pcl/surface/mls.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

namespace pcl_bsh::search {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using Normals = pcl::PointCloud<pcl::Normal>;
using Ours = BoundingSphereSearch<Point>;
using Theirs = pcl::search::KdTree<Point>;

/// Two bumpy sheets, one above the other, without a structure that distances could tie on.
Cloud::Ptr sheets()
{
  std::mt19937 random(3);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  auto cloud = std::make_shared<Cloud>();
  for (int i = 0; i < 4000; ++i) {
    const double x = uniform(0, 4), y = uniform(0, 4), level = i % 2;
    cloud->emplace_back(static_cast<float>(x), static_cast<float>(y),
                        static_cast<float>(2 * level + 0.2 * std::sin(3 * x) * std::cos(2 * y)));
  }
  return cloud;
}

template <typename Search>
Normals::Ptr normalsBy(const Cloud::Ptr& cloud, pcl::NormalEstimation<Point, pcl::Normal>& estimation)
{
  auto normals = std::make_shared<Normals>();
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(std::make_shared<Search>());
  estimation.setKSearch(12);
  estimation.compute(*normals);
  return normals;
}

void expectEqual(const Normals& ours, const Normals& theirs)
{
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    EXPECT_EQ(ours[i].getNormalVector3fMap(), theirs[i].getNormalVector3fMap());
    EXPECT_EQ(ours[i].curvature, theirs[i].curvature);
  }
}

TEST(PclAlgorithms, NormalEstimation)
{
  const auto cloud = sheets();
  pcl::NormalEstimation<Point, pcl::Normal> estimation;
  expectEqual(*normalsBy<Ours>(cloud, estimation), *normalsBy<Theirs>(cloud, estimation));
}

TEST(PclAlgorithms, NormalEstimationOMP)
{
  const auto cloud = sheets();
  pcl::NormalEstimationOMP<Point, pcl::Normal> estimation(2);
  expectEqual(*normalsBy<Ours>(cloud, estimation), *normalsBy<Theirs>(cloud, estimation));
}

std::vector<pcl::Indices> indicesOf(const std::vector<pcl::PointIndices>& clusters)
{
  std::vector<pcl::Indices> lists;
  for (const auto& cluster : clusters) lists.push_back(cluster.indices);
  std::sort(lists.begin(), lists.end());
  return lists;
}

template <typename Search>
std::vector<pcl::Indices> clustersBy(const Cloud::Ptr& cloud, const pcl::IndicesPtr& indices)
{
  pcl::EuclideanClusterExtraction<Point> extraction;
  extraction.setInputCloud(cloud);
  if (indices) extraction.setIndices(indices);
  extraction.setSearchMethod(std::make_shared<Search>());
  extraction.setClusterTolerance(0.12);
  extraction.setMinClusterSize(5);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);
  return indicesOf(clusters);
}

TEST(PclAlgorithms, EuclideanClusterExtraction)
{
  const auto cloud = sheets();
  const auto clusters = clustersBy<Ours>(cloud, nullptr);
  EXPECT_GE(clusters.size(), 2u);
  EXPECT_EQ(clusters, clustersBy<Theirs>(cloud, nullptr));
}

TEST(PclAlgorithms, EuclideanClusterExtractionWithIndices)
{
  const auto cloud = sheets();
  auto indices = std::make_shared<pcl::Indices>();
  for (int i = 0; i < 4000; i += 3) indices->push_back(i);
  const auto clusters = clustersBy<Ours>(cloud, indices);
  EXPECT_GE(clusters.size(), 2u);
  EXPECT_EQ(clusters, clustersBy<Theirs>(cloud, indices));
}

/// Three pairs of duplicates are three clusters: searches that list a point's twin before the point make six of them.
TEST(PclAlgorithms, EuclideanClusterExtractionOfDuplicates)
{
  auto cloud = std::make_shared<Cloud>();
  for (int i = 0; i < 6; ++i) cloud->emplace_back(static_cast<float>(10 * (i / 2)), 0.0f, 0.0f);
  pcl::EuclideanClusterExtraction<Point> extraction;
  extraction.setInputCloud(cloud);
  extraction.setSearchMethod(std::make_shared<Ours>());
  extraction.setClusterTolerance(0.1);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);
  EXPECT_EQ(clusters.size(), 3u);
}

template <typename Search>
std::vector<pcl::Indices> regionsBy(const Cloud::Ptr& cloud, const Normals::Ptr& normals)
{
  pcl::RegionGrowing<Point, pcl::Normal> growing;
  growing.setInputCloud(cloud);
  growing.setInputNormals(normals);
  growing.setSearchMethod(std::make_shared<Search>());
  growing.setNumberOfNeighbours(15);
  growing.setMinClusterSize(20);
  growing.setSmoothnessThreshold(0.2f);
  growing.setCurvatureThreshold(0.2f);
  std::vector<pcl::PointIndices> clusters;
  growing.extract(clusters);
  return indicesOf(clusters);
}

TEST(PclAlgorithms, RegionGrowing)
{
  const auto cloud = sheets();
  pcl::NormalEstimation<Point, pcl::Normal> estimation;
  const auto normals = normalsBy<Theirs>(cloud, estimation);
  const auto regions = regionsBy<Ours>(cloud, normals);
  EXPECT_FALSE(regions.empty());
  EXPECT_EQ(regions, regionsBy<Theirs>(cloud, normals));
}

template <typename Search>
Cloud smoothedBy(const Cloud::Ptr& cloud)
{
  pcl::MovingLeastSquares<Point, Point> smoothing;
  smoothing.setInputCloud(cloud);
  smoothing.setSearchMethod(std::make_shared<Search>());
  smoothing.setSearchRadius(0.25);
  smoothing.setPolynomialOrder(2);
  Cloud smooth;
  smoothing.process(smooth);
  return smooth;
}

/// Both smooth equal neighbours, except for points at the very end of the radius, which ours includes. Sums of equal
/// terms in another order may differ in their last bits.
TEST(PclAlgorithms, MovingLeastSquares)
{
  const auto cloud = sheets();
  const Cloud ours = smoothedBy<Ours>(cloud), theirs = smoothedBy<Theirs>(cloud);
  ASSERT_GT(ours.size(), cloud->size() / 2);
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i)
    EXPECT_LE((ours[i].getVector3fMap() - theirs[i].getVector3fMap()).norm(), 1e-5f) << i;
}

template <typename Search>
Cloud keypointsBy(const Cloud::Ptr& cloud)
{
  pcl::ISSKeypoint3D<Point, Point> detector;
  detector.setInputCloud(cloud);
  detector.setSearchMethod(std::make_shared<Search>());
  detector.setSalientRadius(0.3);
  detector.setNonMaxRadius(0.2);
  Cloud keypoints;
  detector.compute(keypoints); // by OpenMP, so in any order
  std::sort(keypoints.begin(), keypoints.end(),
            [](const Point& p, const Point& q) { return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z); });
  return keypoints;
}

TEST(PclAlgorithms, KeypointsISS)
{
  const auto cloud = sheets();
  const Cloud ours = keypointsBy<Ours>(cloud), theirs = keypointsBy<Theirs>(cloud);
  EXPECT_FALSE(ours.empty());
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i) EXPECT_EQ(ours[i].getVector3fMap(), theirs[i].getVector3fMap());
}

template <typename Search>
pcl::PointCloud<pcl::FPFHSignature33> featuresBy(const Cloud::Ptr& cloud, const Normals::Ptr& normals)
{
  pcl::FPFHEstimation<Point, pcl::Normal, pcl::FPFHSignature33> estimation;
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(normals);
  estimation.setSearchMethod(std::make_shared<Search>());
  estimation.setKSearch(10);
  pcl::PointCloud<pcl::FPFHSignature33> features;
  estimation.compute(features);
  return features;
}

TEST(PclAlgorithms, FeaturesFPFH)
{
  const auto cloud = sheets();
  pcl::NormalEstimation<Point, pcl::Normal> estimation;
  const auto normals = normalsBy<Theirs>(cloud, estimation);
  const auto ours = featuresBy<Ours>(cloud, normals), theirs = featuresBy<Theirs>(cloud, normals);
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i)
    for (std::size_t bin = 0; bin < 33; ++bin) EXPECT_NEAR(ours[i].histogram[bin], theirs[i].histogram[bin], 1e-3f);
}

template <typename Search>
Eigen::Matrix4f alignedBy(const Cloud::Ptr& source, const Cloud::Ptr& target)
{
  pcl::IterativeClosestPoint<Point, Point> icp;
  icp.setInputSource(source);
  icp.setInputTarget(target);
  icp.setSearchMethodTarget(std::make_shared<Search>());
  icp.setSearchMethodSource(std::make_shared<Search>());
  icp.setUseReciprocalCorrespondences(true);
  icp.setMaximumIterations(20);
  Cloud aligned;
  icp.align(aligned);
  EXPECT_TRUE(icp.hasConverged());
  return icp.getFinalTransformation();
}

TEST(PclAlgorithms, IterativeClosestPoint)
{
  const auto target = sheets();
  auto source = std::make_shared<Cloud>();
  Eigen::Affine3f moved = Eigen::Affine3f::Identity();
  moved.translate(Eigen::Vector3f(0.02f, -0.01f, 0.015f));
  moved.rotate(Eigen::AngleAxisf(0.01f, Eigen::Vector3f::UnitZ()));
  pcl::transformPointCloud(*target, *source, moved);
  EXPECT_EQ(alignedBy<Ours>(source, target), alignedBy<Theirs>(source, target));
}

} // namespace
} // namespace pcl_bsh::search
