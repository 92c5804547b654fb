// SPDX-License-Identifier: BSD-3-Clause
// A fixed piece of each kind of work, to be counted in instructions, which a busy machine does not change:
//
//   valgrind --tool=callgrind --callgrind-out-file=/dev/null count_instructions flags
//
// Less those of `build`, which every other kind begins with.
#include <pcl_bsh/collide.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <string_view>
#include <vector>

namespace {

using namespace pcl_bsh;

constexpr int kSide = 300; // points along a side of the terrain, one unit apart

std::vector<float> terrain(float x0, float noise, std::mt19937& random)
{
  std::uniform_real_distribution<float> jitter(-0.3f, 0.3f);
  std::vector<float> xyz;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const float x = x0 + static_cast<float>(i) + jitter(random), y = static_cast<float>(j) + jitter(random);
      xyz.insert(xyz.end(), {x, y, 3 * std::sin(x / 17) * std::cos(y / 23) + noise * jitter(random)});
    }
  return xyz;
}

Work flags(const SphereHierarchy& a, const SphereHierarchy& b, const Eigen::Isometry3d& pose)
{
  Work work;
  for (const double clearance : {1.0, 5.0, 20.0}) {
    FlagsRequest request;
    request.clearance = clearance;
    work += collisionFlags({a}, {b, pose}, request).work;
  }
  return work;
}

Work anyAndDistance(const SphereHierarchy& a, const SphereHierarchy& b, Eigen::Isometry3d pose)
{
  Work work;
  AnyRequest request;
  request.clearance = 0.4;
  for (int i = 0; i < 40; ++i) {
    pose.translation().z() = 3 + 0.2 * i;
    work += anyCollision({a}, {b, pose}, request).work;
    work += closestPair({a}, {b, pose}).work;
  }
  return work;
}

Work neighbors(const SphereHierarchy& a, const std::vector<float>& queries)
{
  Work work;
  Neighbors found;
  for (std::size_t i = 0; i < 90'000; i += 3) {
    const Point3 query = {queries[i] + 0.1, queries[i + 1], queries[i + 2]};
    radiusSearch(a, query, 3.0, found, {}, &work);
    nearestKSearch(a, query, 8, found, &work);
  }
  return work;
}

Work distances(const SphereHierarchy& a, const SphereHierarchy& b, const Eigen::Isometry3d& pose)
{
  Work work = pointDistances({a}, {b}).work;
  PointDistancesRequest request;
  request.max_distance = 2.0;
  return work += pointDistances({a}, {b, pose}, request).work;
}

Work path(const SphereHierarchy& scan)
{
  std::vector<float> xyz;
  for (int i = 0; i < 4000; ++i)
    xyz.insert(xyz.end(),
               {40 * std::cos(static_cast<float>(i)), static_cast<float>(i % 50), static_cast<float>(4 + i % 7)});
  const SphereHierarchy model(viewOf(xyz.data(), xyz.size() / 3));
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < 400; ++i) {
    poses.emplace_back(Eigen::AngleAxisd(0.01 * i, Eigen::Vector3d::UnitZ()));
    poses.back().translation() = Eigen::Vector3d(0.5 * i, 100, 0);
  }
  TrajectoryRequest request;
  request.clearance = 2;
  Work work = collideAlong({scan}, model, poses, request).work;
  request.distances = request.first_poses = true;
  work += collideAlong({scan}, model, poses, request).work;
  return work;
}

} // namespace

int main(int argc, char** argv)
{
  const std::string_view kind = argc == 2 ? argv[1] : "";
  std::mt19937 random(3);
  const std::vector<float> xyz_a = terrain(0, 0, random), xyz_b = terrain(90, 4, random);
  const SphereHierarchy a(viewOf(xyz_a.data(), xyz_a.size() / 3)), b(viewOf(xyz_b.data(), xyz_b.size() / 3));
  a.buildAll();
  b.buildAll();
  const Eigen::Isometry3d pose(Eigen::AngleAxisd(0.01, Eigen::Vector3d(1, 2, 3).normalized()));
  Work work;
  if (kind == "flags")
    work = flags(a, b, pose);
  else if (kind == "pairs")
    work = anyAndDistance(a, b, pose);
  else if (kind == "neighbors")
    work = neighbors(a, xyz_a);
  else if (kind == "distances")
    work = distances(a, b, pose);
  else if (kind == "path")
    work = path(a);
  else if (kind != "build") {
    std::fputs("count_instructions: give one of build, flags, pairs, neighbors, distances, path\n", stderr);
    return 2;
  }
  const auto counted = [](std::uint64_t count) { return static_cast<unsigned long long>(count); };
  std::printf("node pairs %llu, updates %llu, leaf pairs %llu, exact decisions %llu\n", counted(work.node_pairs),
              counted(work.updates()), counted(work.leaf_pairs), counted(work.exact_decisions));
}
