// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/filters/distance_filter.h>

#include "clouds.h"

#include <pcl/point_types.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace pcl_bsh {
namespace {

using namespace test;
using testing::HasSubstr;
using testing::ThrowsMessage;

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Filter = DistanceFilter<pcl::PointXYZ>;
using Blob = pcl::PCLPointCloud2;
using BlobFilter = DistanceFilter<Blob>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

auto refusedWith(const std::string& text)
{
  return ThrowsMessage<std::invalid_argument>(HasSubstr(text));
}

/// Limits of all kinds: none, some, those at which nothing and everything is within.
const std::vector<std::pair<double, double>> all_limits = {{0, infinity},   {0, 0},     {0, 0.1},       {0.05, 0.15},
                                                           {0.1, infinity}, {0.1, 0.1}, {50, infinity}, {0, 1e300}};

class DistanceFilterTest : public testing::Test {
protected:
  DistanceFilterTest()
  {
    points_[7].x() = nan;
    points_[50].z() = infinity;
    for (std::size_t i = 60; i < 70; ++i) points_[i] = obstacle_[i]; // distance 0 without a pose
    truth_ = brute(Eigen::Isometry3d::Identity());
    cloud_ = typedCloud<pcl::PointXYZ>(points_);
    filter_.setInputCloud(cloud_);
    filter_.setObstacleCloud(typedCloud<pcl::PointXYZ>(obstacle_));
  }

  PointDistances brute(const Eigen::Isometry3d& pose, double max_distance = infinity) const
  {
    PointDistancesRequest request;
    request.max_distance = max_distance;
    const SphereHierarchy a(viewOf(points_.data()->data(), points_.size()));
    const SphereHierarchy b(viewOf(obstacle_.data()->data(), obstacle_.size()));
    return brute_force::pointDistances({a}, {b, pose}, request);
  }

  pcl::Indices expected(const PointDistances& truth, double least, double most, bool negative) const
  {
    pcl::Indices indices;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const bool within = truth.distance[i] >= least && truth.distance[i] <= most;
      if (points_[i].allFinite() && within != negative) indices.push_back(static_cast<pcl::index_t>(i));
    }
    return indices;
  }

  static pcl::Indices rest(const pcl::Indices& kept, std::size_t count)
  {
    pcl::Indices others;
    for (std::size_t i = 0; i < count; ++i) {
      const auto index = static_cast<pcl::index_t>(i);
      if (!std::binary_search(kept.begin(), kept.end(), index)) others.push_back(index);
    }
    return others;
  }

  template <typename F>
  static pcl::Indices indicesOf(F& filter)
  {
    pcl::Indices kept;
    filter.filter(kept);
    return kept;
  }

  Points points_ = randomPoints(500, 1);
  const Points obstacle_ = randomPoints(400, 2);
  PointDistances truth_;
  Cloud::Ptr cloud_;
  Filter filter_{true};
};

TEST_F(DistanceFilterTest, RowsAndColumnsAreTheOnlyPoints)
{
  cloud_->width = 50;
  cloud_->height = 10;
  filter_.setFilterLimits(0, 0.15);
  filter_.setIndices(1, 5, 3, 20);
  pcl::Indices wanted;
  for (const pcl::index_t i : expected(truth_, 0, 0.15, false))
    if (i / 50 >= 1 && i / 50 < 4 && i % 50 >= 5 && i % 50 < 25) wanted.push_back(i);
  ASSERT_FALSE(wanted.empty());
  EXPECT_EQ(indicesOf(filter_), wanted);
}

TEST_F(DistanceFilterTest, KeepsWhatBruteForceFindsWithinTheLimits)
{
  for (const Eigen::Isometry3d& pose : {Eigen::Isometry3d::Identity(), somePose()}) {
    const PointDistances truth = brute(pose);
    filter_.setPose(pose);
    for (const auto& [least, most] : all_limits) {
      filter_.setFilterLimits(least, most);
      for (const bool negative : {false, true}) {
        filter_.setNegative(negative);
        const pcl::Indices wanted = expected(truth, least, most, negative);
        EXPECT_EQ(indicesOf(filter_), wanted) << least << ' ' << most;
        EXPECT_EQ(*filter_.getRemovedIndices(), rest(wanted, points_.size()));
        Cloud output;
        filter_.filter(output);
        ASSERT_EQ(output.size(), wanted.size());
        for (std::size_t i = 0; i < wanted.size(); ++i)
          EXPECT_EQ(output[i].getVector3fMap(), (*cloud_)[static_cast<std::size_t>(wanted[i])].getVector3fMap());
      }
    }
  }
}

/// Each point's own distance as a limit: the nearest doubles on both sides leave it out.
TEST_F(DistanceFilterTest, LimitsAreInclusiveToTheLastBit)
{
  for (std::size_t i = 0; i < points_.size(); i += 25) {
    const double d = truth_.distance[i];
    if (std::isnan(d)) continue;
    const auto keeps = [&](double least, double most) {
      filter_.setFilterLimits(least, most);
      const pcl::Indices kept = indicesOf(filter_);
      EXPECT_EQ(filter_.getRemovedIndices()->size() + kept.size(), points_.size());
      return std::binary_search(kept.begin(), kept.end(), static_cast<pcl::index_t>(i));
    };
    EXPECT_FALSE(keeps(std::nextafter(d, infinity), infinity));
    EXPECT_TRUE(keeps(std::nextafter(d, 0.0), std::nextafter(d, infinity)));
    if (d > 0) {
      EXPECT_FALSE(keeps(0, std::nextafter(d, 0.0)));
    }
  }
}

/// A distance is rounded when it is told, not when it is compared: the root of two is less than its nearest double, the
/// root of three is greater.
TEST_F(DistanceFilterTest, ComparesDistancesBeforeTheyAreRounded)
{
  const double two = std::sqrt(2.0), three = std::sqrt(3.0); // two * two > 2, three * three < 3
  ASSERT_GT(std::fma(two, two, -2.0), 0);
  ASSERT_LT(std::fma(three, three, -3.0), 0);
  const Points origin(1, Eigen::Vector3d::Zero());
  const Points three_points = {Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(3, 4, 0)};
  Filter filter{true};
  filter.setObstacleCloud(typedCloud<pcl::PointXYZ>(origin));
  filter.setInputCloud(typedCloud<pcl::PointXYZ>(three_points));
  const auto keeps = [&](double least, double most) {
    filter.setFilterLimits(least, most);
    return indicesOf(filter);
  };
  EXPECT_EQ(keeps(two, infinity), (pcl::Indices{1, 2})) << "the root is less than its double";
  EXPECT_EQ(keeps(0, two), (pcl::Indices{0}));
  EXPECT_EQ(keeps(three, infinity), (pcl::Indices{1, 2})) << "the root is greater than its double";
  EXPECT_EQ(keeps(0, three), (pcl::Indices{0}));
  EXPECT_EQ(keeps(two, three), (pcl::Indices{}));
  EXPECT_EQ(keeps(5, 5), (pcl::Indices{2}));
  BlobFilter blobs;
  blobs.setObstacleCloud(typedCloud<pcl::PointXYZ>(origin));
  blobs.setInputCloud(fieldCloud<double>(three_points));
  blobs.setFilterLimits(0, three);
  Blob output;
  blobs.filter(output);
  EXPECT_EQ(output.width, 1u) << "where all distances are computed, too";
}

TEST_F(DistanceFilterTest, KeepsRowsAndColumns)
{
  cloud_->width = 25, cloud_->height = 20;
  filter_.setFilterLimits(0.05, 0.1);
  filter_.setKeepOrganized(true);
  filter_.setUserFilterValue(-9.0f);
  Cloud output;
  filter_.filter(output);
  ASSERT_EQ(output.width, 25u);
  ASSERT_EQ(output.height, 20u);
  const pcl::Indices kept = expected(truth_, 0.05, 0.1, false);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const bool is_kept = std::binary_search(kept.begin(), kept.end(), static_cast<pcl::index_t>(i));
    EXPECT_EQ(output[i].x, is_kept ? (*cloud_)[i].x : -9.0f) << i;
  }
}

TEST_F(DistanceFilterTest, AsksOnlyAboutTheGivenIndices)
{
  const auto some = std::make_shared<pcl::Indices>(pcl::Indices{400, 7, 65, 3, 3});
  filter_.setIndices(some);
  filter_.setFilterLimits(0, infinity);
  EXPECT_EQ(indicesOf(filter_), (pcl::Indices{400, 65, 3, 3}));
  EXPECT_EQ(*filter_.getRemovedIndices(), (pcl::Indices{7}));
  PointDistances found;
  filter_.computeDistances(found);
  ASSERT_EQ(found.distance.size(), points_.size());
  EXPECT_EQ(found.distance[400], truth_.distance[400]);
  EXPECT_TRUE(std::isnan(found.distance[401]));
}

TEST_F(DistanceFilterTest, TellsDistancesUpToTheGreatest)
{
  PointDistances found;
  filter_.setFilterLimits(0.2, 0.3); // do not matter
  for (const double most : {infinity, 0.1, 0.0}) {
    filter_.setMaxDistance(most);
    filter_.computeDistances(found);
    const PointDistances truth = brute(Eigen::Isometry3d::Identity(), most);
    EXPECT_EQ(found.closest_point, truth.closest_point);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      EXPECT_TRUE(found.distance[i] == truth.distance[i] ||
                  (std::isnan(found.distance[i]) && std::isnan(truth.distance[i])));
    }
    filter_.setNegative(true);
    EXPECT_EQ(indicesOf(filter_), expected(truth_, 0.2, 0.3, true)) << "which points are kept does not depend on it";
    filter_.setNegative(false);
  }
}

template <typename Coordinate>
class DistanceFilterPcl2Test : public DistanceFilterTest {
protected:
  /// The input's record with a distance behind it.
  static std::vector<std::uint8_t> withDistance(std::vector<std::uint8_t> bytes, float distance)
  {
    std::uint8_t added[sizeof distance];
    std::memcpy(added, &distance, sizeof distance);
    bytes.insert(bytes.end(), std::begin(added), std::end(added));
    return bytes;
  }

  float toldOf(std::size_t i, double max_distance) const
  {
    const double d = truth_.distance[i];
    return d <= max_distance ? static_cast<float>(d) : std::numeric_limits<float>::quiet_NaN();
  }
};

using Coordinates = testing::Types<float, double>;
TYPED_TEST_SUITE(DistanceFilterPcl2Test, Coordinates);

TYPED_TEST(DistanceFilterPcl2Test, KeepsEveryFieldAndAddsTheDistance)
{
  const Blob::Ptr input = fieldCloud<TypeParam>(this->points_);
  BlobFilter filter(true);
  filter.setObstacleCloud(fieldCloud<TypeParam>(this->obstacle_));
  filter.setInputCloud(input);
  for (const auto& [least, most] : all_limits) {
    for (const double max_distance : {infinity, 0.08, 0.0}) {
      filter.setFilterLimits(least, most);
      filter.setMaxDistance(max_distance);
      Blob output;
      filter.filter(output);
      const pcl::Indices kept = this->expected(this->truth_, least, most, false);
      ASSERT_EQ(output.width, kept.size());
      EXPECT_EQ(*filter.getRemovedIndices(), this->rest(kept, this->points_.size()));
      ASSERT_EQ(output.fields.size(), input->fields.size() + 1);
      EXPECT_EQ(output.fields.back().name, "distance");
      EXPECT_EQ(output.fields.back().datatype, pcl::PCLPointField::FLOAT32);
      EXPECT_EQ(output.header.frame_id, "scanner");
      for (std::size_t i = 0; i < kept.size(); ++i) {
        const auto from = static_cast<std::size_t>(kept[i]);
        const std::vector<std::uint8_t> wanted =
            this->withDistance(record(*input, from), this->toldOf(from, max_distance));
        ASSERT_EQ(record(output, i), wanted) << from;
      }
    }
  }
}

TYPED_TEST(DistanceFilterPcl2Test, KeepsRowsAndColumnsWithAllDistances)
{
  const Blob::Ptr input = fieldCloud<TypeParam>(this->points_);
  input->width = 25, input->height = 20, input->row_step = 25 * input->point_step;
  BlobFilter filter(true);
  filter.setObstacleCloud(fieldCloud<TypeParam>(this->obstacle_));
  filter.setInputCloud(input);
  filter.setFilterLimits(0.05, 0.1);
  filter.setKeepOrganized(true);
  Blob output;
  filter.filter(output);
  ASSERT_EQ(output.width * output.height, this->points_.size());
  ASSERT_EQ(output.height, 20u);
  const PointsView before = viewOf(*input), after = viewOf(output);
  const pcl::Indices kept = this->expected(this->truth_, 0.05, 0.1, false);
  for (std::uint32_t i = 0; i < this->points_.size(); ++i) {
    const bool is_kept = std::binary_search(kept.begin(), kept.end(), static_cast<pcl::index_t>(i));
    EXPECT_EQ(isFinite(after.point(i)), is_kept);
    if (is_kept) {
      EXPECT_EQ(after.point(i), before.point(i));
    }
    float told;
    std::memcpy(&told, &output.data[i * output.point_step + output.fields.back().offset], sizeof told);
    const float wanted = this->toldOf(i, infinity);
    EXPECT_TRUE(told == wanted || (std::isnan(told) && std::isnan(wanted))) << i;
  }
}

/// Float32 would move these by half a metre.
TEST_F(DistanceFilterTest, ReadsGeoreferencedCoordinatesInFull)
{
  const Eigen::Vector3d far(500000.123, 5400000.456, 100.789);
  Points here = {far, far + Eigen::Vector3d(0.25, 0, 0)}, there = {far + Eigen::Vector3d(0, 0.125, 0)};
  BlobFilter filter;
  filter.setInputCloud(fieldCloud<double>(here));
  filter.setObstacleCloud(fieldCloud<double>(there));
  PointDistances found;
  filter.computeDistances(found);
  EXPECT_NEAR(found.distance[0], 0.125, 1e-9);
  EXPECT_NEAR(found.distance[1], std::hypot(0.25, 0.125), 1e-9);
}

TEST_F(DistanceFilterTest, OutputMayBeTheInputAndFieldsAreWrittenAnew)
{
  const Blob::Ptr blob = fieldCloud<float>(points_);
  BlobFilter filter;
  filter.setInputCloud(blob);
  filter.setObstacleCloud(fieldCloud<float>(obstacle_));
  filter.filter(*blob);
  const auto step = blob->point_step;
  ASSERT_EQ(blob->fields.back().name, "distance");
  Blob again;
  filter.filter(again);
  EXPECT_EQ(again.point_step, step) << "the field is there already";
  EXPECT_EQ(again.data, blob->data);
  blob->fields.back().datatype = pcl::PCLPointField::UINT32;
  EXPECT_THAT([&] { filter.filter(again); }, refusedWith("field 'distance' exists already"));
}

TEST_F(DistanceFilterTest, EverythingIsFarFromAnEmptyCloud)
{
  for (const Points& none : {Points(), Points(1, Eigen::Vector3d(nan, 0, 0))}) {
    filter_.setObstacleCloud(typedCloud<pcl::PointXYZ>(none));
    filter_.setFilterLimits(7, infinity);
    EXPECT_EQ(indicesOf(filter_).size(), points_.size() - 2);
    filter_.setFilterLimits(0, 1e300);
    EXPECT_TRUE(indicesOf(filter_).empty());
    PointDistances found;
    filter_.computeDistances(found);
    EXPECT_EQ(found.measured, 0u);
  }
  filter_.setInputCloud(std::make_shared<Cloud>());
  EXPECT_TRUE(indicesOf(filter_).empty());
  BlobFilter blobs;
  blobs.setInputCloud(fieldCloud<float>({}));
  blobs.setObstacleCloud(fieldCloud<float>({}));
  Blob output;
  blobs.filter(output);
  EXPECT_EQ(output.width, 0u);
  EXPECT_EQ(output.fields.back().name, "distance");
}

TEST_F(DistanceFilterTest, ToleranceKeepsItsPromise)
{
  PointDistances found;
  filter_.setAccuracy(Accuracy::tolerance(0.02));
  filter_.computeDistances(found);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (std::isnan(truth_.distance[i])) continue;
    EXPECT_GE(found.distance[i], truth_.distance[i]);
    EXPECT_LE(found.distance[i], truth_.distance[i] + 0.02);
  }
}

TEST_F(DistanceFilterTest, AnyNumberOfThreadsFindsTheSame)
{
  filter_.setFilterLimits(0.05, infinity);
  const pcl::Indices one = indicesOf(filter_);
  for (const unsigned threads : {0u, 2u, 5u}) {
    filter_.setNumberOfThreads(threads);
    EXPECT_EQ(indicesOf(filter_), one);
  }
  EXPECT_GT(filter_.getWork().leaf_pairs, 0u);
}

TEST_F(DistanceFilterTest, CopiesFindWhatIsTheirOwn)
{
  filter_.setFilterLimits(0.1, infinity);
  const pcl::Indices kept = indicesOf(filter_), removed = *filter_.getRemovedIndices();
  Filter copy = filter_;
  copy.setFilterLimits(0, 0.05);
  EXPECT_EQ(indicesOf(copy), expected(truth_, 0, 0.05, false));
  EXPECT_EQ(*filter_.getRemovedIndices(), removed);
  copy = filter_;
  EXPECT_EQ(indicesOf(copy), kept);
}

TEST_F(DistanceFilterTest, RefusesWhatHasNoMeaning)
{
  Cloud untouched = *cloud_;
  const auto refuses = [&](const std::string& text) {
    EXPECT_THAT([&] { filter_.filter(untouched); }, refusedWith(text));
    EXPECT_EQ(untouched.size(), cloud_->size());
  };
  for (const auto& [least, most] : std::vector<std::pair<double, double>>{
           {-0.1, 1}, {0.2, 0.1}, {nan, 1}, {0, nan}, {infinity, infinity}, {0, -infinity}}) {
    filter_.setFilterLimits(least, most);
    refuses("filter_limits: from ");
  }
  filter_.setFilterLimits(0, 1);
  for (const double most : {-1.0, nan}) {
    filter_.setMaxDistance(most);
    refuses("max_distance: ");
  }
  filter_.setMaxDistance(1);
  for (const Accuracy& accuracy : {Accuracy::level(1), Accuracy::nodePairs(5), Accuracy::time(0.1)}) {
    filter_.setAccuracy(accuracy);
    refuses("leaves points without a distance");
  }
  filter_.setAccuracy(Accuracy::tolerance(-1));
  refuses("tolerance");
  filter_.setAccuracy(Accuracy::exact());
  filter_.setPose(Eigen::Affine3d(Eigen::Scaling(2.0)));
  refuses("pose of b");
  filter_.setPose(Eigen::Isometry3d::Identity());

  filter_.setProgress([](double) { return false; });
  EXPECT_THROW(filter_.filter(untouched), Cancelled);
  EXPECT_EQ(untouched.size(), cloud_->size());
  filter_.setProgress({});

  const auto changing = typedCloud<pcl::PointXYZ>(obstacle_);
  filter_.setObstacleCloud(changing);
  filter_.filter(untouched);
  (*changing)[3].y += 1.0f;
  EXPECT_THAT([&] { filter_.filter(untouched); }, refusedWith("the obstacle: has changed"));
  EXPECT_THAT([&] { filter_.setObstacleCloud(Cloud::Ptr()); }, refusedWith("obstacle cloud is null"));

  Filter without;
  EXPECT_THAT([&] { without.filter(untouched); }, refusedWith("input cloud is missing"));
  without.setInputCloud(cloud_);
  EXPECT_THAT([&] { without.filter(untouched); }, refusedWith("obstacle cloud is missing"));
  EXPECT_THAT([&] { BlobFilter().setInputCloud(nullptr); }, refusedWith("input cloud is null"));
}

} // namespace
} // namespace pcl_bsh
