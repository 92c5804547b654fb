// SPDX-License-Identifier: BSD-3-Clause
// Every public query of two clouds, on random, hard and scanned clouds: what must not change an answer does not.
#include "symmetries.h"

#include "fuzz/random_input.h"
#include "hard_instances.h"
#include "support/pcd_points.h"

#include <gtest/gtest.h>

#include <exception>
#include <filesystem>

namespace pcl_bsh::symmetries {
namespace {

using test::Random;

std::size_t expectSymmetric(const Instance& instance, Random& random)
{
  try {
    return requireSymmetric(instance, random);
  }
  catch (const std::exception& error) {
    ADD_FAILURE() << error.what();
    return 0;
  }
}

TEST(Symmetries, OfRandomClouds)
{
  std::size_t compared = 0;
  for (std::uint32_t seed = 0; seed < 150; ++seed) {
    const std::vector<std::uint8_t> input = fuzz::randomInput(seed);
    fuzz::Bytes bytes(input.data(), input.size());
    Random random(seed);
    compared += expectSymmetric(anyInstance(bytes, "random instance " + std::to_string(seed)), random);
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_GT(compared, 150u * 10u); // few are left out because they would round
}

TEST(Symmetries, OfHardCases)
{
  Random random(1);
  for (const hard_cases::HardCase& c : hard_cases::catalogue()) expectSymmetric(instanceOf(c), random);
}

TEST(Symmetries, OfHardSurfaces)
{
  Random random(4);
  const std::vector<Instance> hard = instancesOfHardSurfaces();
  EXPECT_GT(hard.size(), 30u);
  for (const Instance& instance : hard) EXPECT_GT(expectSymmetric(instance, random), 5u) << instance.name;
}

/// A sampled robot, where it is there, and a coarser one that moves past it.
TEST(Symmetries, OfARobot)
{
  const std::string file = PCL_BSH_SHARED_DIR "/data/robot_panda_sampled.pcd";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "there is no " << file;
  const test::PcdPoints all = test::readPcdPoints(file);
  const auto some = [&](std::size_t step) {
    Body body;
    body.scalar = all.scalar;
    for (std::size_t i = 0; i < all.points.size(); i += step) body.points.push_back(all.points[i]);
    return body;
  };
  Random random(2);
  for (const std::size_t step : {1009u, 2003u}) {
    Instance instance;
    instance.name = "robot, each point of " + std::to_string(step);
    instance.a = some(step);
    instance.b = some(step + 700);
    instance.clearance = 0.02;
    instance.tolerance = 0.001;
    for (int i = 0; i < 3; ++i) {
      Eigen::Isometry3d pose(Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitZ()));
      pose.translation() = Eigen::Vector3d(0.1 * i, 0.02 * i, 0);
      instance.path.push_back(pose);
    }
    instance.relative = instance.path;
    instance.queries = {instance.b.points.front(), instance.b.points.back()};
    instance.low = {-0.1, -0.1, 0.2};
    instance.high = {0.1, 0.2, 0.6};
    expectSymmetric(instance, random);
  }
}

} // namespace
} // namespace pcl_bsh::symmetries
