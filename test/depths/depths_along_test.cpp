// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/depths/depths_along.h>

#include <pcl_bsh/geometry/rigid_motion.h>

#include "solid/meshes.h"
#include "support/brute_force/depths.h"
#include "support/random.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <vector>

namespace pcl_bsh {
namespace {

using Poses = std::vector<Eigen::Isometry3d>;

Eigen::Isometry3d at(double x, double y = 0, double z = 0, double turn = 0)
{
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()));
}

class DepthsAlongTest : public testing::Test {
protected:
  static std::vector<std::uint32_t> all(const SphereHierarchy& of)
  {
    std::vector<std::uint32_t> records(of.view().count);
    std::iota(records.begin(), records.end(), 0U);
    return records;
  }

  std::map<std::uint32_t, DepthAlong> along(const SphereHierarchy& thing, const DepthPath& path)
  {
    const QueriedPart part(thing, all(thing));
    std::map<std::uint32_t, DepthAlong> found;
    work = {};
    for (const DepthAlong& depth : depthsAlong({solid, surface}, part, path, work)) found[depth.record] = depth;
    return found;
  }

  DepthsResult bruteForce(const QueriedRecords& queried, const DepthPath& path, const Eigen::Isometry3d& pose) const
  {
    const DeepSolid placed{solid, surface, path.solid_moves ? pose : path.at_rest};
    return brute_force::depthsIn(placed, queried, path.solid_moves ? path.at_rest : pose, 16);
  }

  test::ClosedMesh mesh = test::boxMesh();
  const Solid solid{mesh.view()};
  const SphereHierarchy surface{viewOf(mesh.view())};
  Work work;
};

TEST_F(DepthsAlongTest, ThePoseIsTheDeepest)
{
  const std::vector<Point3> points = {{0.5, 0.5, 0.5}, {9, 9, 9}, {0.5, 0.9, 0.5}};
  const SphereHierarchy cloud(viewOf(points[0].data(), points.size()));
  Poses poses;
  for (int k = 0; k <= 20; ++k) poses.push_back(at(-1.0 + 0.1 * k)); // the middle of the cube is there at pose 10
  const auto found = along(cloud, {poses, at(0)});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found.at(0).pose, 10u);
  EXPECT_NEAR(found.at(0).told, 0.5, 1e-15);
  EXPECT_NEAR(found.at(2).told, 0.1, 1e-15);
  EXPECT_EQ(found.at(2).pose, 6u); // 0.1 and more from both sides: of several the first
}

TEST_F(DepthsAlongTest, PointsAndBallsAreThoseOfBruteForceAtEachPose)
{
  test::Random random(3);
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    std::vector<Point3> points(40);
    std::vector<float> radii;
    for (Point3& p : points) {
      for (double& x : p) x = random.uniform(-0.5, 1.5);
      radii.push_back(static_cast<float>(random.uniform(0, 0.3)));
    }
    PointsView view = viewOf(points[0].data(), points.size());
    if (i % 2 == 1) view.radii = radii.data();
    const SphereHierarchy cloud(view);
    const QueriedRecords queried(cloud);
    Poses poses;
    Eigen::Isometry3d pose = at(-0.5);
    for (int k = 0; k < 30; ++k) {
      poses.push_back(pose);
      if (k % 7 != 3) pose = pose * at(random.uniform(0, 0.1), random.uniform(-0.05, 0.05), 0, random.uniform(0, 0.2));
    }
    const DepthPath path{poses, at(0.1, 0.2), i % 3 != 0};
    const auto found = along(cloud, path);
    std::map<std::uint32_t, std::pair<double, std::uint32_t>> expected;
    for (std::uint32_t k = 0; k < poses.size(); ++k)
      for (const Depth& depth : bruteForce(queried, path, poses[k]).depths) {
        const auto [best, is_new] = expected.try_emplace(depth.record, depth.told, k);
        if (!is_new && depth.told > best->second.first) best->second = {depth.told, k};
      }
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [record, best] : expected) {
      EXPECT_EQ(found.at(record).told, best.first);
      EXPECT_EQ(found.at(record).pose, best.second);
      EXPECT_GE(found.at(record).depth.upper, best.first);
    }
  }
}

TEST_F(DepthsAlongTest, SweptDepthsHoldThoseAtManyInstants)
{
  test::Random random(4);
  std::size_t deep = 0, deeper = 0;
  for (int i = 0; i < 8; ++i) {
    SCOPED_TRACE(i);
    const bool of_triangles = i % 4 == 3;
    std::vector<Point3> points(of_triangles ? 12 : 15);
    std::vector<float> radii;
    for (std::size_t k = 0; k < points.size(); ++k) {
      for (double& x : points[k]) x = random.uniform(-0.5, 1.5);
      radii.push_back(static_cast<float>(random.uniform(0, 0.3)));
    }
    std::vector<Triangle> corners = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}};
    PointsView view = viewOf(points[0].data(), points.size());
    if (i % 4 == 1) view.radii = radii.data();
    if (of_triangles) view = viewOf(TrianglesView{view, corners[0].data(), corners.size()});
    const SphereHierarchy cloud(view);
    const QueriedRecords queried(cloud);
    const Poses poses = {at(-1.5, random.uniform(-0.5, 0.5)), at(0.2, 0, 0, random.uniform(-2, 2)), at(1.7, 0.4)};
    const DepthPath path{poses, at(0.1, 0.2), i % 3 != 0, 0.02, {random.uniform(-1, 1), 0, 0}};
    const auto found = along(cloud, path);
    std::map<std::uint32_t, double> expected;
    for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
      const RigidMotion motion(poses[k], poses[k + 1], {path.pivot[0], path.pivot[1], path.pivot[2]},
                               shorterTurn(poses[k].linear(), poses[k + 1].linear()));
      for (int j = 0; j <= (of_triangles ? 24 : 100); ++j)
        for (const Depth& depth : bruteForce(queried, path, motion.at(j / (of_triangles ? 24.0 : 100.0))).depths)
          if (depth.depth.lower > 0.0) expected[depth.record] = std::max(expected[depth.record], depth.told);
    }
    for (const auto& [record, depth] : expected) {
      ASSERT_TRUE(found.count(record)) << record;
      const DepthAlong& one = found.at(record);
      EXPECT_GE(one.depth.upper, depth - 1e-12) << record;
      EXPECT_GE(one.told, depth - 0.01 - kDepthShare * depth) << record;
      EXPECT_LE(one.depth.upper - one.told, 0.01 + 2 * kDepthShare * one.told + 1e-12) << record;
      EXPECT_LE(one.told, depth + (of_triangles ? 0.25 : 0.05)) << record; // between two instants
      ++deep;
      deeper += one.told > depth;
    }
  }
  EXPECT_GT(deep, 30u);
  EXPECT_GT(deeper, 5u);
}

/// A long path of which few poses hold anything, and a cloud of which few points are ever enclosed; and one that stands
/// still inside.
TEST_F(DepthsAlongTest, CostsWhatIsInside)
{
  test::Random random(5);
  std::vector<Point3> points;
  for (int i = 0; i < 2000; ++i)
    points.push_back({random.uniform(0, 400), random.uniform(-5, 5), random.uniform(-5, 5)});
  const SphereHierarchy cloud(viewOf(points[0].data(), points.size()));
  Poses poses;
  for (int k = 0; k < 2000; ++k) poses.push_back(at(0.2 * k));
  const auto found = along(cloud, {poses, at(0)});
  EXPECT_GT(found.size(), 5u);
  EXPECT_LT(work.leaf_pairs, 2000u * 20u); // of 4,000,000 pairs of a pose and a point
  const std::vector<Point3> inside(200, Point3{0.5, 0.5, 0.25});
  const SphereHierarchy enclosed(viewOf(inside[0].data(), inside.size()));
  const Poses still(500, at(0));
  along(enclosed, {{still}, at(0)});
  const std::uint64_t of_many = work.exact_decisions;
  along(enclosed, {{Poses(2, at(0))}, at(0)});
  EXPECT_LT(of_many, 1000 + 260 * work.exact_decisions);
}

} // namespace
} // namespace pcl_bsh
