// SPDX-License-Identifier: BSD-3-Clause
// Clouds that are far from each other for the size of b: spheres that are outdone, for answers of brute force.
#include "expect_distances.h"
#include "support/random_clouds.h"

#include <cmath>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Eigen::Isometry3d posed(const Eigen::Vector3d& at, Random& random)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(at);
  pose.rotate(Eigen::AngleAxisd(random.uniform(0, 3), Eigen::Vector3d(1, 2, 3).normalized()));
  return pose;
}

std::vector<float> someRadii(std::size_t count, Random& random)
{
  std::vector<float> radii(count);
  for (float& radius : radii) radius = static_cast<float>(random.uniform(0, 0.05));
  return radii;
}

TEST(DifferenceBound, AnswersAreThoseOfBruteForceAtAnyDistance)
{
  Random random(11);
  for (int round = 0; round < 60; ++round) {
    Cloud near(test::makePoints(round % 2 ? test::Shape::sphere : test::Shape::plane, 400, 0.2, random));
    Cloud far(test::makePoints(round % 3 ? test::Shape::plane : test::Shape::sphere, 600, 0.5, random));
    if (round % 4 >= 2) far.setRadii(someRadii(600, random));
    if (round % 5 >= 3) near.setRadii(someRadii(400, random));
    const SphereHierarchy a(near.view()), b(far.view());
    const double away = std::exp(random.uniform(-1, 8));
    const Placed there(b, posed(Eigen::Vector3d(1, 0.5, -0.2).normalized() * away, random));
    for (const double max : {kInfinity, away}) {
      PointDistancesRequest request;
      request.max_distance = max;
      test::expectSame(pointDistances(a, there, request), brute_force::pointDistances(a, there, request));
    }
    if (testing::Test::HasFailure()) return;
  }
}

/// Two heaps of b's points beside each other, one of them a little farther from the middle of a's, and points of a to
/// the sides. The nearer heap changes within one leaf of a.
TEST(DifferenceBound, TheFartherHeapIsStillTheNearerOneToPointsAtTheSide)
{
  Random random(12);
  std::size_t changes = 0;
  for (const double extent : {0.5, 2.0}) {
    for (const double away : {5.0, 20.0, 80.0}) {
      for (double share = 0.1; share < 1.4; share += 0.05) {
        const double radius = 0.5, farther = share * radius * extent / away;
        std::vector<double> of_a, of_b;
        for (int i = 0; i < 16; ++i) {
          const double turn = i * 3.14159265358979 / 8;
          of_a.insert(of_a.end(), {0.0, radius * std::cos(turn), radius * std::sin(turn)});
        }
        for (const double side : {-0.5, 0.5}) {
          for (int i = 0; i < 16; ++i) {
            of_b.insert(of_b.end(), {away + (side > 0 ? farther : 0.0) + random.uniform(0, 1e-7),
                                     side * extent + random.uniform(0, 1e-7), random.uniform(0, 1e-7)});
          }
        }
        const SphereHierarchy a(viewOf(of_a.data(), 16)), b(viewOf(of_b.data(), 32));
        const PointDistances found = pointDistances(a, b);
        test::expectSame(found, brute_force::pointDistances(a, b));
        std::size_t to_farther = 0;
        for (const std::uint32_t record : found.closest_point) to_farther += record >= 16;
        changes += to_farther > 0 && to_farther < 8;
      }
    }
  }
  EXPECT_GT(changes, 60u) << "of 156: else nothing is tested";
}

TEST(DifferenceBound, FarPointsAreNotComparedWithAllOfASmallCloud)
{
  Random random(13);
  Cloud wide(test::makePoints(test::Shape::plane, 4000, 10, random));
  Cloud small(test::makePoints(test::Shape::sphere, 4000, 1, random));
  const SphereHierarchy a(wide.view()), b(small.view());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(3, 2, 40);
  const PointDistances found = pointDistances(a, Placed(b, pose));
  const std::size_t all = (4000 / 16) * (4000 / 16);
  EXPECT_LT(found.work.leaf_pairs, all / 3);
}

} // namespace
} // namespace pcl_bsh
