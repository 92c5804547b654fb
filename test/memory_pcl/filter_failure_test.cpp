// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/collision_filter.h>
#include <pcl_bsh/search/bounding_sphere_search.h>

#include "../memory/every_allocation.h"

#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <bit>
#include <tuple>

namespace pcl_bsh::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

Cloud::Ptr grid(float at, int n)
{
  auto cloud = std::make_shared<Cloud>();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      cloud->push_back(
          {at + 0.1f * static_cast<float>(i), 0.1f * static_cast<float>(j), 0.01f * static_cast<float>(i * j)});
  return cloud;
}

const Cloud::Ptr& input()
{
  static const Cloud::Ptr cloud = grid(0.0f, 20);
  return cloud;
}
const Cloud::Ptr& obstacle()
{
  static const Cloud::Ptr cloud = grid(1.02f, 15);
  return cloud;
}

std::vector<std::uint32_t> bitsOf(const std::vector<float>& values)
{
  std::vector<std::uint32_t> bits;
  for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
  return bits;
}

TEST(FilterAllocationFailure, OfClouds)
{
  struct Subject {
    CollisionFilter<pcl::PointXYZ> filter{true};
    Cloud output;
  };
  for (const bool moving : {false, true})
    failEachAllocation(
        [&] {
          auto subject = std::make_unique<Subject>();
          subject->filter.setInputCloud(input());
          subject->filter.setObstacleCloud(obstacle());
          subject->filter.setClearance(0.1);
          if (moving)
            subject->filter.setTrajectory(
                {Eigen::Isometry3d::Identity(), Eigen::Isometry3d(Eigen::Translation3d(-0.3, 0, 0))});
          return subject;
        },
        [](const auto& subject) {
          subject->filter.filter(subject->output);
          pcl::Indices kept;
          subject->filter.filter(kept);
          std::vector<std::uint8_t> flags;
          subject->filter.computeFlags(flags);
          return std::tuple(subject->output.size(), kept, flags, *subject->filter.getRemovedIndices(), input()->size());
        });
}

TEST(FilterAllocationFailure, OfBlobs)
{
  auto blob = std::make_shared<pcl::PCLPointCloud2>();
  pcl::toPCLPointCloud2(*input(), *blob);
  failEachAllocation(
      [&] {
        auto filter = std::make_unique<CollisionFilter<pcl::PCLPointCloud2>>();
        filter->setInputCloud(blob);
        filter->setObstacleCloud(obstacle());
        filter->setClearance(0.1);
        return filter;
      },
      [](const auto& filter) {
        pcl::PCLPointCloud2 output;
        filter->filter(output);
        return std::tuple(output.width, output.data);
      });
}

TEST(SearchAllocationFailure, OfEverySearch)
{
  using Search = search::BoundingSphereSearch<pcl::PointXYZ>;
  const auto make = [] {
    auto search = std::make_unique<Search>();
    search->setNumberOfThreads(1);
    return search;
  };
  failEachAllocation(make, [](const auto& search) {
    search->setInputCloud(input());
    std::vector<pcl::Indices> lists;
    std::vector<std::vector<float>> squares;
    pcl::Indices nearest, within, box;
    std::vector<float> squared;
    search->nearestKSearch((*obstacle())[20], 12, nearest, squared);
    search->radiusSearch((*obstacle())[20], 0.5, within, squared);
    search->radiusSearch(*obstacle(), {}, 0.2, lists, squares);
    search->boxSearch({0, 0, 0}, {1, 1, 1}, box);
    return std::tuple(nearest, within, bitsOf(squared), lists, box,
                      search->anyInBalls(*obstacle(), std::vector<float>(obstacle()->size(), 0.1f)));
  });
}

} // namespace
} // namespace pcl_bsh::test
