// SPDX-License-Identifier: BSD-3-Clause
// Each stage gives what the PCL class of its name gives when called directly.
#include "../filters/clouds.h"
#include "run_stage.h"
#include "support/verdicts.h"

#include <pcl_bsh/filters/collision_filter.h>

#include <pcl/common/transforms.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/approximate_voxel_grid.h>
#include <pcl/filters/crop_box.h>
#include <pcl/filters/passthrough.h>
#include <pcl/filters/radius_outlier_removal.h>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/filters/uniform_sampling.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace pcl_bsh::pipeline {
namespace {

using Point = pcl::PointXYZRGBNormal;
using Cloud = pcl::PointCloud<Point>;

/// A wavy surface with noise and outliers, coloured, with normals. All finite.
Cloud::Ptr surface(std::size_t points = 3000)
{
  auto cloud = std::make_shared<Cloud>();
  std::mt19937 random(3);
  const auto uniform = [&](float least, float most) {
    return least + (most - least) * static_cast<float>(random()) / 4294967296.0F;
  };
  for (std::size_t i = 0; i < points; ++i) {
    Point p;
    p.x = uniform(-5, 5);
    p.y = uniform(-5, 5);
    p.z = std::sin(p.x) + uniform(-0.05F, 0.05F) + (i % 97 == 0 ? uniform(1, 3) : 0.0F);
    p.r = static_cast<std::uint8_t>(random());
    p.g = static_cast<std::uint8_t>(random());
    p.b = static_cast<std::uint8_t>(random());
    p.getNormalVector3fMap() = Eigen::Vector3f(uniform(-1, 1), uniform(-1, 1), 1).normalized();
    p.curvature = uniform(0, 1);
    cloud->push_back(p);
  }
  return cloud;
}

/// Equal to the last bit: for stages that keep points as they are.
void expectSamePoints(const Cloud& actual, const Cloud& expected)
{
  ASSERT_EQ(actual.size(), expected.size());
  ASSERT_GT(actual.size(), 0U);
  for (std::size_t i = 0; i < actual.size(); ++i) {
    EXPECT_EQ(actual[i].getArray3fMap().matrix(), expected[i].getArray3fMap().matrix()) << i;
    EXPECT_EQ(actual[i].rgba, expected[i].rgba) << i;
    EXPECT_EQ(actual[i].getNormalVector3fMap(), expected[i].getNormalVector3fMap()) << i;
  }
}

/// Equal within the last digits, which depend on the order of a sum.
void expectNearPoints(const Cloud& actual, const Cloud& expected, bool unit_normals)
{
  ASSERT_EQ(actual.size(), expected.size());
  ASSERT_GT(actual.size(), 0U);
  for (std::size_t i = 0; i < actual.size(); ++i) {
    EXPECT_TRUE(actual[i].getVector3fMap().isApprox(expected[i].getVector3fMap(), 1e-5F)) << i;
    for (const auto channel : {&Point::r, &Point::g, &Point::b}) {
      EXPECT_NEAR(actual[i].*channel, expected[i].*channel, 1) << i;
    }
    const Eigen::Vector3f normal = expected[i].getNormalVector3fMap();
    EXPECT_TRUE(actual[i].getNormalVector3fMap().isApprox(unit_normals ? normal : normal.normalized(), 1e-4F)) << i;
    EXPECT_NEAR(actual[i].curvature, expected[i].curvature, 1e-5) << i;
  }
}

/// The stage's and the class's choice of points, for some settings of what all filters have.
/// @param rows of the cloud that keeps them; of more than one, PCL searches neighbours as if a camera had seen them
template <typename Filter>
void expectSelectionTwins(Filter& filter, const std::string& type_and_options, std::uint32_t rows = 30)
{
  const Cloud::Ptr cloud = surface();
  filter.setInputCloud(cloud);
  Cloud expected;
  filter.filter(expected);
  EXPECT_LT(expected.size(), cloud->size());
  expectSamePoints(typedOf<Point>(outputOf(stageCloud(*cloud), "{" + type_and_options + "}")), expected);

  filter.setNegative(true);
  filter.filter(expected);
  expectSamePoints(typedOf<Point>(outputOf(stageCloud(*cloud), "{" + type_and_options + R"(, "negative": true})")),
                   expected);

  cloud->width = 3000 / rows;
  cloud->height = rows;
  filter.setInputCloud(cloud);
  filter.setNegative(false);
  filter.setKeepOrganized(true);
  filter.setUserFilterValue(-9);
  filter.filter(expected);
  const StageCloudPtr organised =
      outputOf(stageCloud(*cloud), "{" + type_and_options + R"(, "keep_organized": true, "user_filter_value": -9})");
  EXPECT_EQ(organised->cloud.width, 3000 / rows);
  EXPECT_EQ(organised->cloud.height, rows);
  expectSamePoints(typedOf<Point>(organised), expected);
}

TEST(PclTwins, PassThrough)
{
  pcl::PassThrough<Point> filter;
  filter.setFilterFieldName("z");
  filter.setFilterLimits(-0.3F, 0.7F);
  expectSelectionTwins(filter, R"("type": "pcl::PassThrough", "filter_field_name": "z", "filter_limits": [-0.3, 0.7])");
  pcl::PassThrough<Point> curvature;
  curvature.setFilterFieldName("curvature");
  curvature.setFilterLimits(0.25F, std::numeric_limits<float>::max());
  expectSelectionTwins(curvature, R"("type": "filters.pass_through", "filter_field_name": "curvature",
                                     "filter_limits": [0.25, null])");
}

TEST(PclTwins, CropBox)
{
  pcl::CropBox<Point> filter;
  filter.setMin({-2, -1, -1, 1});
  filter.setMax({2, 3, 0.5F, 1});
  expectSelectionTwins(filter, R"("type": "pcl::CropBox", "min": [-2, -1, -1], "max": [2, 3, 0.5])");
  filter.setTranslation({0.5F, -1, 0.25F});
  filter.setRotation({0.1F, 0.2F, 0.7F});
  filter.setKeepOrganized(false);
  const Eigen::Affine3f moved = pcl::getTransformation(0.3F, 0.1F, 0, 0, 0, -0.4F);
  filter.setTransform(moved);
  expectSelectionTwins(filter, R"("type": "pcl::CropBox", "min": [-2, -1, -1], "max": [2, 3, 0.5],
      "translation": [0.5, -1, 0.25], "rotation": [0.1, 0.2, 0.7], "transform": [0.3, 0.1, 0, 0, 0, -0.4])");
}

TEST(PclTwins, StatisticalOutlierRemoval)
{
  pcl::StatisticalOutlierRemoval<Point> filter;
  filter.setMeanK(8);
  filter.setStddevMulThresh(1.5);
  expectSelectionTwins(filter,
                       R"("type": "filters.statistical_outlier_removal", "mean_k": 8, "stddev_mul_thresh": 1.5)", 1);
}

TEST(PclTwins, RadiusOutlierRemoval)
{
  pcl::RadiusOutlierRemoval<Point> filter;
  filter.setRadiusSearch(0.4);
  filter.setMinNeighborsInRadius(6);
  expectSelectionTwins(
      filter, R"("type": "filters.radius_outlier_removal", "radius_search": 0.4, "min_neighbors_in_radius": 6)", 1);
}

TEST(PclTwins, BshCollision)
{
  const auto obstacle = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (float x = -3; x < 3; x += 0.1F) obstacle->emplace_back(x, 0.0F, 0.0F);
  CollisionFilter<Point> filter;
  filter.setObstacleCloud(obstacle);
  filter.setClearance(0.8);
  Eigen::Isometry3d pose(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitZ()));
  filter.setPose(pose);
  const Cloud::Ptr cloud = surface();
  filter.setInputCloud(cloud);
  const std::string stage = R"("type": "filters.bsh_collision", "obstacle": "other", "clearance": 0.8,
                               "pose": [0, 0, 0, 0, 0, 1])";
  for (const bool negative : {false, true}) {
    filter.setNegative(negative);
    Cloud expected;
    filter.filter(expected);
    for (const bool by_keep : {false, true}) {
      const std::string keep = by_keep ? R"("keep": "colliding")" : R"("negative": true)";
      const std::string options = negative ? ", " + keep : "";
      expectSamePoints(typedOf<Point>(outputOf(stageCloud(*cloud), "{" + stage + options + "}", stageCloud(*obstacle))),
                       expected);
    }
  }
  std::vector<Verdict> flags;
  filter.computeFlags(flags);
  const StageCloudPtr flagged = outputOf(stageCloud(*cloud), R"({"type": "filters.bsh_flag", "obstacle": "other",
      "clearance": 0.8, "pose": [0, 0, 0, 0, 0, 1]})",
                                         stageCloud(*obstacle));
  ASSERT_EQ(flagged->cloud.fields.back().name, "collision");
  for (std::size_t i = 0; i < flags.size(); ++i) {
    EXPECT_EQ(flagged->cloud.data[i * flagged->cloud.point_step + flagged->cloud.fields.back().offset],
              bytesOf(flags)[i]);
  }
}

TEST(PclTwins, VoxelGrid)
{
  const Cloud::Ptr cloud = surface();
  (*cloud)[5].x = std::numeric_limits<float>::quiet_NaN();
  cloud->is_dense = false;
  pcl::VoxelGrid<Point> filter;
  filter.setInputCloud(cloud);
  filter.setLeafSize(0.3F, 0.4F, 0.5F);
  Cloud expected;
  filter.filter(expected);
  expectNearPoints(
      typedOf<Point>(outputOf(stageCloud(*cloud), R"({"type": "pcl::VoxelGrid", "leaf_size": [0.3, 0.4, 0.5]})")),
      expected, true);

  filter.setMinimumPointsNumberPerVoxel(4);
  filter.filter(expected);
  expectNearPoints(
      typedOf<Point>(outputOf(stageCloud(*cloud), R"({"type": "pcl::VoxelGrid", "leaf_size": [0.3, 0.4, 0.5],
                                                                  "minimum_points_number_per_voxel": 4})")),
      expected, true);
}

TEST(PclTwins, VoxelGridOfCoordinatesAlone)
{
  const Cloud::Ptr cloud = surface();
  pcl::VoxelGrid<Point> filter;
  filter.setInputCloud(cloud);
  filter.setLeafSize(0.5F, 0.5F, 0.5F);
  filter.setDownsampleAllData(false);
  Cloud expected;
  filter.filter(expected);
  const Cloud actual = typedOf<Point>(
      outputOf(stageCloud(*cloud), R"({"type": "pcl::VoxelGrid", "leaf_size": 0.5, "downsample_all_data": false})"));
  ASSERT_EQ(actual.size(), expected.size());
  std::set<std::uint32_t> colours;
  for (const Point& point : *cloud) colours.insert(point.rgba);
  for (std::size_t i = 0; i < actual.size(); ++i) {
    EXPECT_TRUE(actual[i].getVector3fMap().isApprox(expected[i].getVector3fMap(), 1e-5F)) << i;
    EXPECT_EQ(colours.count(actual[i].rgba), 1U) << "the other fields are one point's, where PCL leaves zeros";
  }
}

TEST(PclTwins, VoxelGridOfLabels)
{
  pcl::PointCloud<pcl::PointXYZL> cloud;
  std::mt19937 random(5);
  for (const Eigen::Vector3d& p : test::randomPoints(2000, 4)) {
    cloud.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()), random() % 4);
  }
  pcl::VoxelGrid<pcl::PointXYZL> filter;
  filter.setInputCloud(cloud.makeShared());
  filter.setLeafSize(0.2F, 0.2F, 0.2F);
  pcl::PointCloud<pcl::PointXYZL> expected;
  filter.filter(expected);
  const auto actual =
      typedOf<pcl::PointXYZL>(outputOf(stageCloud(cloud), R"({"type": "pcl::VoxelGrid", "leaf_size": 0.2})"));
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) EXPECT_EQ(actual[i].label, expected[i].label) << i;
}

TEST(PclTwins, ApproximateVoxelGrid)
{
  const Cloud::Ptr cloud = surface();
  pcl::ApproximateVoxelGrid<Point> filter;
  filter.setInputCloud(cloud);
  filter.setLeafSize(0.5F, 0.5F, 0.5F);
  Cloud expected;
  filter.filter(expected);
  expectNearPoints(
      typedOf<Point>(outputOf(stageCloud(*cloud), R"({"type": "pcl::ApproximateVoxelGrid", "leaf_size": 0.5})")),
      expected, false);
}

TEST(PclTwins, UniformSampling)
{
  const Cloud::Ptr cloud = surface();
  pcl::UniformSampling<Point> filter;
  filter.setInputCloud(cloud);
  filter.setRadiusSearch(0.5);
  Cloud expected;
  filter.filter(expected);
  const Cloud actual =
      typedOf<Point>(outputOf(stageCloud(*cloud), R"({"type": "pcl::UniformSampling", "radius_search": 0.5})"));
  // PCL adds 1 to each squared distance before it compares them, so of points almost as near it may take another.
  using Cell = std::array<int, 3>;
  const auto cell = [](const Point& p) {
    return Cell{static_cast<int>(std::floor(p.x * 2)), static_cast<int>(std::floor(p.y * 2)),
                static_cast<int>(std::floor(p.z * 2))};
  };
  const auto fromCentre = [&](const Point& p) {
    const Cell c = cell(p);
    return (p.getVector3fMap() - Eigen::Vector3f(static_cast<float>(c[0]) + 0.5F, static_cast<float>(c[1]) + 0.5F,
                                                 static_cast<float>(c[2]) + 0.5F) /
                                     2)
        .squaredNorm();
  };
  std::map<Cell, float> distances;
  for (const Point& point : expected) distances[cell(point)] = fromCentre(point);
  ASSERT_EQ(actual.size(), expected.size());
  for (const Point& point : actual) {
    ASSERT_EQ(distances.count(cell(point)), 1U);
    EXPECT_NEAR(fromCentre(point), distances[cell(point)], 3e-7);
    distances.erase(cell(point));
  }
}

TEST(PclTwins, Transform)
{
  const Cloud::Ptr cloud = surface();
  const Eigen::Affine3f map = pcl::getTransformation(1, 2, 3, 0.1F, 0.2F, 0.3F);
  Cloud expected;
  pcl::transformPointCloudWithNormals(*cloud, expected, map);
  const Cloud actual = typedOf<Point>(
      outputOf(stageCloud(*cloud), R"({"type": "pcl::transformPointCloud", "transform": [1, 2, 3, 0.1, 0.2, 0.3]})"));
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    EXPECT_TRUE(actual[i].getVector3fMap().isApprox(expected[i].getVector3fMap(), 1e-5F)) << i;
    EXPECT_TRUE(actual[i].getNormalVector3fMap().isApprox(expected[i].getNormalVector3fMap(), 1e-5F)) << i;
    EXPECT_EQ(actual[i].rgba, expected[i].rgba);
  }
}

TEST(PclTwins, NormalEstimation)
{
  pcl::PointCloud<pcl::PointXYZ> cloud;
  pcl::copyPointCloud(*surface(), cloud);
  for (const bool by_count : {true, false}) {
    pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
    estimation.setInputCloud(cloud.makeShared());
    estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
    estimation.setViewPoint(0, 0, 50);
    if (by_count) {
      estimation.setKSearch(12);
    }
    else {
      estimation.setRadiusSearch(0.5);
    }
    pcl::PointCloud<pcl::Normal> expected;
    estimation.compute(expected);
    const StageCloudPtr output =
        outputOf(stageCloud(cloud), std::string(R"({"type": "pcl::NormalEstimation", "view_point": [0, 0, 50], )") +
                                        (by_count ? R"("k_search": 12})" : R"("radius_search": 0.5})"));
    const auto actual = typedOf<pcl::PointNormal>(output);
    ASSERT_EQ(actual.size(), expected.size());
    std::size_t without = 0;
    for (std::size_t i = 0; i < actual.size(); ++i) {
      EXPECT_EQ(actual[i].getVector3fMap(), cloud[i].getVector3fMap());
      if (std::isnan(expected[i].normal_x)) {
        ++without;
        EXPECT_TRUE(std::isnan(actual[i].normal_x)) << i;
        continue;
      }
      EXPECT_EQ(actual[i].getNormalVector3fMap(), expected[i].getNormalVector3fMap()) << i;
      EXPECT_EQ(actual[i].curvature, expected[i].curvature) << i;
    }
    EXPECT_EQ(output->cloud.is_dense != 0, without == 0);
  }
}

TEST(PclTwins, EuclideanCluster)
{
  pcl::PointCloud<pcl::PointXYZ> cloud;
  std::mt19937 random(9);
  for (int blob = 0; blob < 12; ++blob) {
    for (int i = 0; i < 20 + 7 * blob; ++i) {
      cloud.emplace_back(static_cast<float>(blob) * 3 + static_cast<float>(random() % 1000) / 1000,
                         static_cast<float>(random() % 1000) / 1000, static_cast<float>(random() % 1000) / 1000);
    }
  }
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
  extraction.setInputCloud(cloud.makeShared());
  extraction.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>(false));
  extraction.setClusterTolerance(0.5);
  extraction.setMinClusterSize(30);
  extraction.setMaxClusterSize(80);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);
  ASSERT_GT(clusters.size(), 3U);

  const StageCloudPtr output = outputOf(stageCloud(cloud), R"({"type": "pcl::EuclideanClusterExtraction",
      "cluster_tolerance": 0.5, "min_cluster_size": 30, "max_cluster_size": 80})");
  ASSERT_EQ(output->cloud.fields.back().name, "cluster");
  std::map<std::int32_t, pcl::Indices> found;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::int32_t number;
    std::memcpy(&number, &output->cloud.data[i * output->cloud.point_step + output->cloud.fields.back().offset], 4);
    if (number >= 0) found[number].push_back(static_cast<pcl::index_t>(i));
  }
  ASSERT_EQ(found.size(), clusters.size());
  std::set<pcl::Indices> expected;
  for (const pcl::PointIndices& cluster : clusters) expected.insert(cluster.indices);
  for (std::int32_t number = 0; number < static_cast<std::int32_t>(clusters.size()); ++number) {
    EXPECT_EQ(expected.count(found[number]), 1U) << number;
    EXPECT_EQ(found[number].size(), clusters[static_cast<std::size_t>(number)].indices.size()) << "largest first";
  }
}

TEST(PclTwins, Merge)
{
  const Cloud::Ptr a = surface(20);
  const Cloud::Ptr b = surface(30);
  expectSamePoints(typedOf<Point>(outputOf(stageCloud(*a), R"({"type": "filters.merge", "inputs": ["in", "other"]})",
                                           stageCloud(*b))),
                   *a + *b);
}

} // namespace
} // namespace pcl_bsh::pipeline
