// SPDX-License-Identifier: BSD-3-Clause
// Options that are each right by themselves may not be so together: all of them at once, against brute force.
#include "../fuzz/questions.h"
#include "support/brute_force/neighbors.h"
#include "support/question.h"
#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <exception>
#include <string>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Shape;

/// Bits: float64, radii, a subset, voxels of half a unit.
Cloud cloudWith(unsigned options, std::size_t count, Random& random)
{
  Cloud cloud(test::makePoints(Shape::grid, count, 1.0, random),
              {(options & 1) != 0 ? Scalar::float64 : Scalar::float32, 1, 2});
  if ((options & 2) != 0) {
    std::vector<float> radii(count);
    for (float& radius : radii) radius = static_cast<float>(random.integer(0, 2)) / 16;
    cloud.setRadii(std::move(radii));
  }
  if ((options & 4) != 0) {
    std::vector<std::int32_t> indices;
    for (std::size_t i = count; i-- > 0;)
      if (random.chance(0.6)) indices.push_back(static_cast<std::int32_t>(i));
    cloud.restrictTo(std::move(indices));
  }
  return cloud;
}

HierarchyOptions voxels(unsigned options)
{
  HierarchyOptions built;
  built.voxel_edge = (options & 8) != 0 ? 0.5 : 0.0;
  return built;
}

TEST(RequestCombinations, AnyFlagsAndClosestPair)
{
  const Accuracy accuracies[] = {Accuracy::exact(), Accuracy::tolerance(0.1), Accuracy::level(1),
                                 Accuracy::nodePairs(9), Accuracy::time(0.0)};
  Random random(1);
  Eigen::Isometry3d shifted = Eigen::Isometry3d::Identity();
  shifted.translation() = Eigen::Vector3d(0.5, -0.25, 0.125);
  fuzz::Questions questions;
  for (unsigned options = 0; options < 256; ++options) {
    const Cloud a = cloudWith(options & 15, 20, random), b = cloudWith(options >> 4, 17, random);
    const SphereHierarchy scan(a.view(), voxels(options & 15)), model(b.view(), voxels(options >> 4));
    test::Question request;
    request.clearance = random.integer(0, 4) / 8.0;
    for (const Accuracy& accuracy : accuracies)
      for (const Flagged side : {Flagged::a, Flagged::b, Flagged::both})
        for (const unsigned threads : {1u, 2u}) {
          request.accuracy = accuracy;
          request.flagged = side;
          request.threads = threads;
          try {
            questions.askFlags({scan}, {model, shifted}, request);
            if (side != Flagged::a || threads != 1) continue; // options of flags alone
            questions.askAny({scan}, {model, shifted}, request);
            questions.askClosest({scan}, {model, shifted}, request);
          }
          catch (const std::exception& error) {
            FAIL() << error.what() << ", options " << options << ", accuracy " << accuracy.text() << ", side "
                   << static_cast<int>(side) << ", " << threads << " threads";
          }
        }
  }
}

TEST(RequestCombinations, Neighbors)
{
  Random random(2);
  Neighbors found, expected, any_order;
  NeighborLists lists;
  for (unsigned options = 0; options < 16; ++options) {
    const Cloud cloud = cloudWith(options, 40, random), asked = cloudWith(options ^ 5, 12, random);
    const SphereHierarchy hierarchy(cloud.view(), voxels(options));
    for (const double radius : {0.0, 0.125, 0.375, 5.0})
      for (const std::size_t most : {0u, 1u, 3u, 1000u})
        for (const bool sorted : {false, true})
          for (const unsigned threads : {1u, 3u}) {
            const std::string name = "options " + std::to_string(options) + ", radius " + std::to_string(radius) +
                                     ", most " + std::to_string(most) + (sorted ? ", sorted, " : ", unsorted, ") +
                                     std::to_string(threads) + " threads";
            Work work;
            radiusSearch(hierarchy, asked.view(), radius, lists, {most, sorted}, threads);
            for (std::size_t i = 0; i < asked.view().size(); ++i) {
              const Point3 query = asked.view().point(asked.view().record(i));
              radiusSearch(hierarchy, query, radius, found, {most, sorted}, threads == 1 ? nullptr : &work);
              ASSERT_EQ(lists.indices[i], found.indices) << name;
              ASSERT_EQ(lists.squared_distances[i], found.squared_distances) << name;
              brute_force::radiusSearch(hierarchy, query, radius, expected, {most, true});
              if (!sorted) {
                std::sort(found.indices.begin(), found.indices.end());
                std::sort(expected.indices.begin(), expected.indices.end());
              }
              ASSERT_EQ(found.indices, expected.indices) << name;
            }
          }
  }
}

} // namespace
} // namespace pcl_bsh
