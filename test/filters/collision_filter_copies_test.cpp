// SPDX-License-Identifier: BSD-3-Clause
// Copies of a filter, obstacles that change under it, and queries that are stopped.
#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/filters/collision_filter.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "clouds.h"
#include "support/verdicts.h"

#include <pcl/point_types.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>
#include <vector>

namespace pcl_bsh {
namespace {

using namespace test;
using testing::HasSubstr;
using testing::ThrowsMessage;

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Filter = CollisionFilter<pcl::PointXYZ>;

constexpr double clearance = 0.1;

class CollisionFilterCopies : public testing::Test {
protected:
  CollisionFilterCopies()
  {
    filter_.setObstacleCloud(typedCloud<pcl::PointXYZ>(obstacle_));
    filter_.setClearance(clearance);
  }

  pcl::Indices expected(const Points& points, bool colliding = false) const
  {
    return where(doubleLoop(points, obstacle_, Eigen::Isometry3d::Identity(), clearance), colliding, points);
  }

  const Points obstacle_ = randomPoints(300, 2);
  Filter filter_{true};
};

TEST_F(CollisionFilterCopies, FindWhatIsTheirOwn)
{
  const Points first = randomPoints(300, 3), second = randomPoints(500, 4);
  filter_.setInputCloud(typedCloud<pcl::PointXYZ>(first));
  pcl::Indices kept;
  filter_.filter(kept);
  const pcl::Indices removed = *filter_.getRemovedIndices();
  ASSERT_EQ(removed, expected(first, true));

  Filter copy = filter_;
  EXPECT_EQ(*copy.getRemovedIndices(), removed) << "a copy begins as the original is";
  Filter assigned{false};
  assigned = filter_;
  for (Filter* const other : {&copy, &assigned}) {
    other->setInputCloud(typedCloud<pcl::PointXYZ>(second));
    other->filter(kept);
    EXPECT_EQ(kept, expected(second));
    EXPECT_EQ(*other->getRemovedIndices(), expected(second, true));
    EXPECT_EQ(*filter_.getRemovedIndices(), removed) << "the original knows nothing of it";
    EXPECT_EQ(filter_.getIndices()->size(), first.size()) << "nor of the other cloud's size";
  }
  filter_.filter(kept);
  EXPECT_EQ(kept, expected(first));
  EXPECT_EQ(*copy.getRemovedIndices(), expected(second, true));
}

TEST_F(CollisionFilterCopies, ShareTheIndicesThatTheUserSet)
{
  const auto indices = std::make_shared<pcl::Indices>(pcl::Indices{5, 1, 7});
  filter_.setIndices(indices);
  const Filter copy = filter_;
  EXPECT_EQ(const_cast<Filter&>(copy).getIndices(), indices);
}

TEST_F(CollisionFilterCopies, FilterInThreadsOfTheirOwn)
{
  constexpr std::size_t threads = 8, clouds = 40;
  filter_.setKeepOrganized(true);
  std::vector<std::size_t> wrong(threads, 0);
  std::vector<Points> points;
  for (std::size_t i = 0; i < 5; ++i) points.push_back(randomPoints(200 + 100 * i, static_cast<std::uint32_t>(10 + i)));
  std::vector<std::size_t> free;
  for (const Points& one : points) free.push_back(expected(one).size());
  {
    std::vector<Filter> copies(threads, filter_);
    std::vector<std::jthread> workers;
    for (std::size_t t = 0; t < threads; ++t) {
      workers.emplace_back([&, t] {
        for (std::size_t i = 0; i < clouds; ++i) {
          const std::size_t which = (t + i) % points.size();
          copies[t].setInputCloud(typedCloud<pcl::PointXYZ>(points[which]));
          Cloud output;
          copies[t].filter(output);
          std::size_t finite = 0;
          for (const pcl::PointXYZ& p : output) finite += std::isfinite(p.x) ? 1 : 0;
          wrong[t] += output.size() != points[which].size() || finite != free[which] ? 1 : 0;
        }
      });
    }
  }
  EXPECT_EQ(wrong, std::vector<std::size_t>(threads, 0)) << "of " << clouds << " clouds each";
}

/// Any change of any coordinate in place is an error, for the hierarchy holds the points as they were.
TEST_F(CollisionFilterCopies, NoticeAnObstacleThatHasChangedInPlace)
{
  const Points points = randomPoints(200, 5);
  filter_.setInputCloud(typedCloud<pcl::PointXYZ>(points));
  const auto changed = [&](const auto& change) {
    const auto obstacle = typedCloud<pcl::PointXYZ>(obstacle_);
    filter_.setObstacleCloud(obstacle);
    pcl::Indices kept;
    filter_.filter(kept);
    EXPECT_EQ(kept, expected(points));
    change(*obstacle);
    EXPECT_THAT([&] { filter_.filter(kept); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("the obstacle: has changed since it was set")));
    EXPECT_EQ(kept, expected(points)) << "as it was";
    filter_.setObstacleCloud(obstacle);
    EXPECT_NO_THROW(filter_.filter(kept));
  };
  changed([](Cloud& cloud) { cloud[150].z = std::nextafter(cloud[150].z, 9.0F); });
  changed([](Cloud& cloud) { cloud[0].x += 1; });
  changed([](Cloud& cloud) { cloud.back().y = -cloud.back().y; });
  changed([](Cloud& cloud) { std::swap(cloud[10], cloud[20]); });
  // Mirrors change the top bit of many words, which sums of products lose.
  changed([](Cloud& cloud) {
    for (pcl::PointXYZ& p : cloud) p.y = -p.y;
  });
  changed([](Cloud& cloud) { cloud[7].y = -cloud[7].y, cloud[8].y = -cloud[8].y; });
  changed([](Cloud& cloud) { cloud[7].z = -cloud[7].z, cloud[8].z = -cloud[8].z; });
}

TEST_F(CollisionFilterCopies, NoticeAFloat64ObstacleThatHasChangedButNotOtherFields)
{
  CollisionFilter<pcl::PCLPointCloud2> filter;
  filter.setInputCloud(fieldCloud<double>(randomPoints(100, 6)));
  const auto obstacle = std::const_pointer_cast<pcl::PCLPointCloud2>(
      std::shared_ptr<const pcl::PCLPointCloud2>(fieldCloud<double>(obstacle_)));
  filter.setObstacleCloud(obstacle);
  pcl::Indices kept;
  filter.filter(kept);
  for (const pcl::PCLPointField& field : obstacle->fields) {
    if (field.name == "x" || field.name == "y" || field.name == "z") continue;
    obstacle->data[5 * obstacle->point_step + field.offset] ^= 1;
    EXPECT_NO_THROW(filter.filter(kept)) << field.name << " is no coordinate";
  }
  for (const char* const name : {"x", "y", "z"}) {
    for (const pcl::PCLPointField& field : obstacle->fields) {
      if (field.name != name) continue;
      std::uint8_t& last_bit = obstacle->data[99 * obstacle->point_step + field.offset];
      last_bit ^= 1;
      EXPECT_THROW(filter.filter(kept), std::invalid_argument) << name;
      last_bit ^= 1;
      EXPECT_NO_THROW(filter.filter(kept)) << name;
    }
  }
}

TEST_F(CollisionFilterCopies, StopAlongATrajectory)
{
  const Points points = randomPoints(3000, 7);
  filter_.setInputCloud(typedCloud<pcl::PointXYZ>(points));
  filter_.setTrajectory({Eigen::Isometry3d::Identity(), somePose()});
  for (const unsigned threads : {1U, 2U}) {
    filter_.setNumberOfThreads(threads);
    Cloud output;
    output.resize(3);
    filter_.setProgress([](double) { return false; });
    EXPECT_THROW(filter_.filter(output), Cancelled);
    filter_.setProgress([](double) -> bool { throw 17; });
    EXPECT_THROW(filter_.filter(output), int);
    EXPECT_EQ(output.size(), 3U) << "as it was";
    double last = 0;
    filter_.setProgress([&](double share) {
      last = share;
      return true;
    });
    filter_.filter(output);
    EXPECT_GT(last, 0);
    std::vector<Verdict> flags = doubleLoop(points, obstacle_, Eigen::Isometry3d::Identity(), clearance);
    const std::vector<Verdict> posed = doubleLoop(points, obstacle_, somePose(), clearance);
    for (std::size_t i = 0; i < flags.size(); ++i) flags[i] = graver(flags[i], posed[i]);
    EXPECT_EQ(output.size(), where(flags, false, points).size());
  }
}

} // namespace
} // namespace pcl_bsh
