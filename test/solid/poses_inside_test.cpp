// SPDX-License-Identifier: BSD-3-Clause
// The first pose at which a solid holds each point, against labels at each pose.
#include <pcl_bsh/solid/labels.h>
#include <pcl_bsh/solid/poses_inside.h>

#include "meshes.h"

#include <gtest/gtest.h>

namespace pcl_bsh {
namespace {

TEST(PosesInside, AreThoseOfLabels)
{
  const test::ClosedMesh mesh = test::bumpyMesh(12, 0.3);
  const Solid solid(mesh.view());
  test::Random random(1);
  std::vector<double> points(3 * 20000);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = random.uniform(0, i % 3 == 0 ? 6 : 1);
  const SphereHierarchy cloud(viewOf(points.data(), points.size() / 3));
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < 40; ++i) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.rotate(Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitZ()));
    pose.pretranslate(Eigen::Vector3d(0.2 * i - 2, 0.3, 0));
    poses.push_back(pose);
  }
  std::vector<std::uint32_t> first(points.size() / 3, kNothing);
  std::size_t inside = 0;
  for (std::uint32_t i = 0; i < poses.size(); ++i) {
    const LabelsResult labels = labelPoints({cloud}, {solid, poses[i]});
    for (std::size_t j = 0; j < first.size(); ++j)
      if (labels.labels[j] != labelOf(Label::outside) && first[j] == kNothing) first[j] = i, ++inside;
  }
  HierarchyOptions small;
  small.voxel_edge = 0.15; // a tree of several levels above them
  const SphereHierarchy of_small(viewOf(points.data(), points.size() / 3), small);
  for (const bool built : {false, true})
    for (const SphereHierarchy* const of : {&cloud, &of_small}) {
      if (built) of->buildAll();
      for (const unsigned threads : {1u, 2u}) {
        const PosesInside found = findPosesInside({*of}, solid, poses, threads);
        EXPECT_EQ(found.first, first);
        EXPECT_EQ(found.inside, inside);
      }
    }
  EXPECT_GT(inside, 100u);
}

TEST(PosesInside, OfNoPointsAndOfManyPoses)
{
  const test::ClosedMesh mesh = test::boxMesh();
  const Solid solid(mesh.view());
  std::vector<Eigen::Isometry3d> poses(1500, Eigen::Isometry3d(Eigen::Translation3d(9, 0, 0)));
  poses[1400] = poses[1300] = Eigen::Isometry3d::Identity(); // after those that are looked at together
  poses[1450] = Eigen::Isometry3d(Eigen::Translation3d(2, 0, 0));
  const std::vector<double> points = {0.5, 0.5, 0.5, 2.5, 0.5, 0.5, NAN, 0.5, 0.5, 5, 5, 5};
  const SphereHierarchy cloud(viewOf(points.data(), 4)), nothing(viewOf(points.data() + 6, 1));
  const PosesInside found = findPosesInside({cloud}, solid, poses);
  EXPECT_EQ(found.first, (std::vector<std::uint32_t>{1300, 1450, kNothing, kNothing}));
  EXPECT_EQ(found.inside, 2u);
  const PosesInside none = findPosesInside({nothing}, solid, poses);
  EXPECT_EQ(none.first, std::vector<std::uint32_t>{kNothing});
  EXPECT_EQ(none.inside, 0u);
}

TEST(PosesInside, OfAPathThatIsFarOffCostsItsPoses)
{
  const test::ClosedMesh mesh = test::boxMesh();
  const Solid solid(mesh.view());
  std::vector<double> points(3 * 50000);
  test::Random random(2);
  for (double& x : points) x = random.uniform(10, 20);
  const SphereHierarchy cloud(viewOf(points.data(), 50000));
  const std::vector<Eigen::Isometry3d> poses(500, Eigen::Isometry3d::Identity());
  const PosesInside found = findPosesInside({cloud}, solid, poses);
  EXPECT_EQ(found.inside, 0u);
  EXPECT_LE(found.work.node_pairs, 8u * poses.size());
}

TEST(PosesInside, RefusePosesThatAreNotRigid)
{
  const test::ClosedMesh mesh = test::boxMesh();
  const Solid solid(mesh.view());
  const double point[3] = {0, 0, 0};
  const SphereHierarchy cloud(viewOf(point, 1));
  std::vector<Eigen::Isometry3d> poses(2, Eigen::Isometry3d::Identity());
  poses[1].linear() *= 2.0;
  EXPECT_THROW(findPosesInside({cloud}, solid, poses), std::invalid_argument);
}

} // namespace
} // namespace pcl_bsh
