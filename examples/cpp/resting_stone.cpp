// SPDX-License-Identifier: BSD-3-Clause
// A scanned stone falls on a scanned hillside, rolls and rests. Both are clouds of points; here they are made up.
//
//   pcl_bsh_resting_stone
#include <pcl_bsh/physics/world.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <random>
#include <vector>

namespace {

std::vector<float> hillside(std::mt19937& random, int count)
{
  std::uniform_real_distribution<float> anywhere(-3.0f, 3.0f), noise(-0.002f, 0.002f);
  std::vector<float> xyz;
  for (int i = 0; i < count; ++i) {
    const float x = anywhere(random), y = anywhere(random);
    xyz.insert(xyz.end(), {x, y, 0.05f * x * x + 0.04f * std::sin(5.0f * y) + noise(random)});
  }
  return xyz;
}

std::vector<float> stone(std::mt19937& random, int count)
{
  std::normal_distribution<float> any;
  std::vector<float> xyz;
  for (int i = 0; i < count; ++i) {
    const float x = any(random), y = any(random), z = any(random), length = std::sqrt(x * x + y * y + z * z);
    const float radius = 0.3f * (1.0f + 0.1f * std::sin(5.0f * x / length));
    xyz.insert(xyz.end(), {radius * x / length, radius * y / length, 0.7f * radius * z / length});
  }
  return xyz;
}

} // namespace

int main()
try {
  std::mt19937 random(7);
  const std::vector<float> ground_xyz = hillside(random, 250000), stone_xyz = stone(random, 10000);
  const pcl_bsh::SphereHierarchy ground_points(pcl_bsh::viewOf(ground_xyz.data(), ground_xyz.size() / 3)),
      stone_points(pcl_bsh::viewOf(stone_xyz.data(), stone_xyz.size() / 3));
  const pcl_bsh::Collider ground(ground_points), body(stone_points);
  pcl_bsh::MassProperties mass; // an ellipsoid's: a scan encloses nothing
  mass.mass = 200.0;
  mass.inertia = Eigen::Vector3d(5.4, 5.4, 7.2).asDiagonal();

  pcl_bsh::WorldOptions options;
  options.damping = 0.5; // grass
  pcl_bsh::World world(options);
  world.addFixed(ground);
  const pcl_bsh::BodyId id = world.add(body, Eigen::Isometry3d(Eigen::Translation3d(2, 0, 1)), mass, {0.6, 0.2});
  int step = 0;
  for (; step < 240 * 20 && !world.isAsleep(id); ++step) world.step(1.0 / 240.0);
  const Eigen::Vector3d place = world.pose(id).translation();
  std::printf("%s after %.1f s at %.3f %.3f %.3f\n", world.isAsleep(id) ? "rests" : "moves", step / 240.0, place.x(),
              place.y(), place.z());
}
catch (const std::exception& error) {
  std::fprintf(stderr, "pcl_bsh_resting_stone: %s\n", error.what());
  return 1;
}
