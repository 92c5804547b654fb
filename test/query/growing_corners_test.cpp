// SPDX-License-Identifier: BSD-3-Clause
// Costs of every query about two clouds on pairs that are hard for bounding volumes, as they grow. All pairs are at
// nearly one distance, a few points spoil the bounds of all, or floats hardly tell points apart.
#include <pcl_bsh/collide.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/adversarial_clouds.h"
#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace pcl_bsh {
namespace {

using test::HardPair;
using test::Random;
using namespace test::adversarial;

using Points = std::vector<Point3>;
using Poses = std::vector<Eigen::Isometry3d>;

double stepsOf(const Work& work)
{
  return static_cast<double>(work.node_pairs + 16 * work.leaf_pairs + work.exact_decisions);
}

/// A query about a pair of clouds, at a clearance just below their distance: nothing ends it early.
struct Query {
  const char* name;
  std::function<Work(const Placed&, const SphereHierarchy&, const Eigen::Isometry3d&, double)> ask;
};

/// The second cloud's poses on a way past its own pose.
Poses wayPast(const Eigen::Isometry3d& pose, double length)
{
  Poses poses;
  for (int k = 0; k < 8; ++k) {
    const double along = length * (k / 8.0 - 0.5);
    poses.push_back(Eigen::Translation3d(along, 0.3 * along, -0.2 * along) * pose);
  }
  return poses;
}

Work along(const Placed& a, const SphereHierarchy& b, const Poses& poses, double clearance, bool distances,
           std::optional<double> swept)
{
  TrajectoryRequest request;
  request.clearance = clearance;
  request.distances = distances;
  request.swept = swept;
  return collideAlong(a, b, poses, request).work;
}

const std::vector<Query>& queries()
{
  using Pose = Eigen::Isometry3d;
  static const std::vector<Query> all = {
      {"any",
       [](const Placed& a, const SphereHierarchy& b, const Pose& at, double clearance) {
         return anyCollision(a, Placed(b, at), {clearance, {}}).work;
       }},
      {"closest", [](const Placed& a, const SphereHierarchy& b, const Pose& at,
                     double) { return closestPair(a, Placed(b, at), {}).work; }},
      {"100 contacts",
       [](const Placed& a, const SphereHierarchy& b, const Pose& at, double clearance) {
         return nearestContacts(a, Placed(b, at), {2 * clearance, 100}).work;
       }},
      {"pairs within",
       [](const Placed& a, const SphereHierarchy& b, const Pose& at, double clearance) {
         return pairsWithin(a, Placed(b, at), {clearance, 1000}).work;
       }},
      {"any at poses",
       [](const Placed& a, const SphereHierarchy& b, const Pose& at, double clearance) {
         return anyCollisionAtPoses(a, b, wayPast(at, 0.01 * clearance), {clearance, {}}).work;
       }},
      {"closest at poses",
       [](const Placed& a, const SphereHierarchy& b, const Pose& at, double clearance) {
         return closestPairAtPoses(a, b, wayPast(at, 0.01 * clearance), {}).work;
       }},
      {"flags",
       [](const Placed& a, const SphereHierarchy& b, const Pose& at, double clearance) {
         return collisionFlags(a, Placed(b, at), {clearance, Flagged::both}).work;
       }},
      {"flags, 1 % more",
       [](const Placed& a, const SphereHierarchy& b, const Pose& at, double clearance) {
         return collisionFlags(a, Placed(b, at), {1.01 * clearance, Flagged::both}).work;
       }},
      {"path", [](const Placed& a, const SphereHierarchy& b, const Pose& at,
                  double clearance) { return along(a, b, wayPast(at, 0.01 * clearance), clearance, false, {}); }},
      {"path, 10 % more",
       [](const Placed& a, const SphereHierarchy& b, const Pose& at, double clearance) {
         return along(a, b, wayPast(at, 0.01 * clearance), 1.1 * clearance, false, {});
       }},
      {"path, distances",
       [](const Placed& a, const SphereHierarchy& b, const Pose& at, double clearance) {
         return along(a, b, wayPast(at, 0.01 * clearance), 1.1 * clearance, true, {});
       }},
      {"swept", [](const Placed& a, const SphereHierarchy& b, const Pose& at, double clearance) {
         return along(a, b, wayPast(at, 0.5 * clearance), clearance, false, 0.01 * clearance);
       }}};
  return all;
}

/// Growth of steps where points are four times as many: at most so much. Linear work has 4.
struct Corner {
  const char* name;
  std::function<HardPair(std::size_t)> make;
  double one_pair; ///< of queries for a pair
  double flags;
  double path;             ///< flags along a path
  double every;            ///< distances along it, and swept motion
  bool has_strays = false; ///< swept motion refuses coordinates so large for its tolerance
};

Points onCylinder(std::size_t n, double radius, double length, std::uint64_t seed)
{
  Random random(seed);
  Points points(n);
  for (Point3& p : points) {
    const double turn = random.uniform(0, 6.2831853);
    p = {radius * std::cos(turn), radius * std::sin(turn), random.uniform(-length, length)};
  }
  return points;
}

Points onShell(std::size_t n, double radius, std::uint64_t seed)
{
  Random random(seed);
  Points points(n);
  for (Point3& p : points) p = scaled(direction(random), radius);
  return points;
}

Points unitSheet(std::size_t n, double aside, double height)
{
  Points points = sheet(n, aside, 0);
  for (Point3& p : points) p = scaled(p, 1.0 / std::sqrt(static_cast<double>(n)));
  for (Point3& p : points) p[2] = height;
  return points;
}

Points moved(Points points, const Point3& by)
{
  for (Point3& p : points)
    for (std::size_t k = 0; k < 3; ++k) p[k] += by[k];
  return points;
}

Points strayed(Points points, double far)
{
  return with(std::move(points), {{far, far, far}});
}

HardPair posed(HardPair pair, const Eigen::Vector3d& at)
{
  pair.pose_b.translation() = at;
  return pair;
}

const std::vector<Corner>& corners();

std::vector<double> stepsOf(const Corner& corner, std::size_t n)
{
  const HardPair pair = corner.make(n);
  const test::Cloud a(pair.a), b(pair.b);
  const SphereHierarchy of_a(a.view()), of_b(b.view());
  const double clearance = closestPair(of_a, Placed(of_b, pair.pose_b), {}).distance * (1.0 - 1e-6);
  std::vector<double> steps;
  for (const Query& query : queries()) {
    if (corner.has_strays && &query == &queries().back()) continue;
    const SphereHierarchy fresh_a(a.view()), fresh_b(b.view()); // work depends on what was fitted before
    steps.push_back(stepsOf(query.ask(fresh_a, fresh_b, pair.pose_b, clearance)));
  }
  return steps;
}

/// From 250 to 4000 points most of these still grow towards their order; none may become worse.
TEST(GrowingCorners, TakeNoMoreWorkThanKnown)
{
  for (const Corner& corner : corners()) {
    std::vector<double> before;
    for (const std::size_t n : {250u, 1000u, 4000u}) {
      const std::vector<double> steps = stepsOf(corner, n);
      for (std::size_t q = 0; q < steps.size() && !before.empty(); ++q) {
        const double limits[] = {corner.one_pair, corner.flags, corner.path, corner.every};
        const double limit = limits[q < 6 ? 0 : q < 8 ? 1 : q < 10 ? 2 : 3];
        EXPECT_LE(steps[q], limit * before[q] + 2000)
            << corner.name << ": " << queries()[q].name << ", " << n << " points";
      }
      before = steps;
    }
  }
}

const std::vector<Corner>& corners()
{
  static const std::vector<Corner> all = {
      {"cubes far apart",
       [](std::size_t n) {
         return posed({cube(n, 1), cube(n, 2)}, {1000, 0, 0});
       },
       6.5, 5.5, 5, 17.5}, // 250 points: bounds of leaves' points leave little to do
      {"a rod in a pipe",
       [](std::size_t n) {
         return HardPair{onCylinder(n, 1, 10, 1), onCylinder(n, 1.05, 10, 2)};
       },
       5.5, 5.5, 8, 10},
      {"a cylinder and its axis",
       [](std::size_t n) {
         return HardPair{axis(n, 1), onCylinder(n, 1, 1, 1)};
       },
       11.5, 10, 10, 11.5},
      {"a short axis and a circle",
       [](std::size_t n) {
         return HardPair{axis(n, 0.01), helix(n, 1, 0)};
       },
       11, 13, 5, 16.5},
      {"a helix and its axis",
       [](std::size_t n) {
         return HardPair{axis(n, 1), helix(n, 100, 0.01)};
       },
       17.5, 11, 23.5, 14},
      {"concentric shells",
       [](std::size_t n) {
         return HardPair{onShell(n, 1, 1), onShell(n, 1.5, 2)};
       },
       6.5, 6.5, 6, 6.5},
      {"ten shells in ten",
       [](std::size_t n) {
         return HardPair{shells(n, 10, 0.01), moved(shells(n, 10, 0.01), {0, 0, 0.5})};
       },
       5, 5, 5, 5},
      {"a small shell in a large one",
       [](std::size_t n) {
         return HardPair{onShell(n, 1, 1), onShell(n, 0.1, 2)};
       },
       14, 19.5, 6.5, 11},
      {"sheets that face each other",
       [](std::size_t n) {
         return HardPair{unitSheet(n, 0, 0), unitSheet(n, 0.5, 0.1)};
       },
       15.1, 8.5, 7.5, 9.5},
      {"a line above a sheet",
       [](std::size_t n) {
         HardPair pair{unitSheet(n, 0, 0), axis(n, 0.5)};
         pair.pose_b = Eigen::Translation3d(0.5, 0.5, 1) * Eigen::AngleAxisd(1.5707963, Eigen::Vector3d::UnitX());
         return pair;
       },
       5, 12, 5, 16.5},
      {"rings about one axis",
       [](std::size_t n) {
         return HardPair{helix(n, 1, 0), helix(n, 1, 0, 0.3, 0.5)};
       },
       5.1, 9.5, 6.5, 11.5},
      {"combs",
       [](std::size_t n) {
         return HardPair{comb(n, 0), comb(n, 0.5)};
       },
       6, 5.5, 6.5, 6.5},
      {"two helices",
       [](std::size_t n) {
         return HardPair{helix(n, 30, 0.05), helix(n, 30, 0.05, 0.5)};
       },
       12, 5, 12, 7},
      {"clouds of ten octaves",
       [](std::size_t n) {
         return HardPair{octaves(n, 10, 1), octaves(n, 10, 2)};
       },
       8.5, 7, 5, 5},
      {"one place each",
       [](std::size_t n) {
         return HardPair{Points(n, {1, 2, 3}), Points(n, {1, 2, 4})};
       },
       5, 5, 5, 5},
      {"a stray in each",
       [](std::size_t n) {
         return HardPair{strayed(onShell(n, 1, 1), 1e20), strayed(onShell(n, 1.5, 2), -1e20)};
       },
       5.5, 6.5, 6, 6.5, true},
      {"sentinels in each",
       [](std::size_t n) {
         constexpr double far = std::numeric_limits<float>::max();
         return HardPair{strayed(cube(n, 1), far), strayed(moved(cube(n, 2), {3, 0, 0}), far)};
       },
       5, 5, 5, 6, true}};
  return all;
}

} // namespace
} // namespace pcl_bsh
