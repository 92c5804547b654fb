// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/scene/responses/contact_planes.h>

#include "support/random.h"

#include <gtest/gtest.h>

#include <vector>

namespace pcl_bsh {
namespace {

using Normals = std::vector<Eigen::Vector3d>;

/// The rest of a motion that meets planes one after another.
Eigen::Vector3d leftAfter(const Normals& normals, Eigen::Vector3d motion)
{
  ContactPlanes planes;
  for (const Eigen::Vector3d& normal : normals) motion = planes.add(normal, motion);
  return motion;
}

const Eigen::Vector3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);

TEST(ContactPlanes, LeaveWhatEntersNoneOfThem)
{
  EXPECT_EQ(leftAfter({x}, {-1, 2, 3}), Eigen::Vector3d(0, 2, 3));
  EXPECT_EQ(leftAfter({x}, {1, 2, 3}), Eigen::Vector3d(1, 2, 3)) << "it moves off";
  EXPECT_EQ(leftAfter({x, y}, {-1, -2, 3}), Eigen::Vector3d(0, 0, 3));
  EXPECT_EQ(leftAfter({x, y, z}, {-1, -2, -3}), Eigen::Vector3d(0, 0, 0)) << "a corner";
  const Eigen::Vector3d slope = (x + y).normalized();
  EXPECT_TRUE(leftAfter({slope}, {-1, 0, 1}).isApprox(Eigen::Vector3d(-0.5, 0.5, 1), 1e-15));
  // In an acute edge what the second leaves would enter the first.
  const Eigen::Vector3d lean = (y - 3 * x).normalized();
  EXPECT_TRUE(leftAfter({x, lean}, {-1, -1, 2}).isApprox(Eigen::Vector3d(0, 0, 2), 1e-12));
}

/// Planes that are nearly one have no edge along which a motion could go.
TEST(ContactPlanes, OfOneDirectionHaveNoEdge)
{
  EXPECT_EQ(leftAfter({x, x}, {-1, 2, 3}), Eigen::Vector3d(0, 2, 3));
  EXPECT_EQ(leftAfter({x, -x}, {-1, 2, 3}), Eigen::Vector3d(0, 2, 3)) << "a slot";
  ContactPlanes again; // no edge with the first, which is the same, but with the second
  again.add(x, z);
  again.add((z - 3 * x).normalized(), z);
  EXPECT_TRUE(again.add(x, {-1, 1, -1}).isApprox(y, 1e-12));
  const Eigen::Vector3d tilted = (-x + 1e-8 * y).normalized();
  ContactPlanes planes;
  planes.add(tilted, {0, 0, 1});
  EXPECT_EQ(planes.add(x, {-1, 2, 3}), Eigen::Vector3d(0, 2, 3));
  EXPECT_EQ(planes.add(x, {-1, -2, 3}), Eigen::Vector3d(0, 0, 0)) << "across the edge, which is too faint to follow";
}

TEST(ContactPlanes, AreForgottenAndFewAreKept)
{
  ContactPlanes planes;
  planes.add(x, {0, 0, 1});
  planes.forget();
  EXPECT_EQ(planes.add(y, {-1, -1, 0}), Eigen::Vector3d(-1, 0, 0));
  for (int i = 0; i < 40; ++i) planes.add(z, {0, 0, -1}); // more than there is room for
  EXPECT_EQ(planes.add(y, {-1, -1, -1}), Eigen::Vector3d(-1, 0, 0));
}

TEST(ContactPlanes, LetNothingIntoAnyAndLeaveNoMoreThanThereWas)
{
  test::Random random(3);
  int corners = 0, along = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto direction = [&] { return Eigen::Vector3d(random.rotation() * Eigen::Vector3d::UnitX()); };
    Normals normals(static_cast<std::size_t>(random.integer(1, 4)));
    for (Eigen::Vector3d& normal : normals) normal = direction();
    const Eigen::Vector3d motion = random.uniform(0.1, 3.0) * direction(), left = leftAfter(normals, motion);
    for (const Eigen::Vector3d& normal : normals) EXPECT_GE(left.dot(normal), -1e-9) << i;
    EXPECT_LE(left.norm(), motion.norm() * (1 + 1e-12)) << i;
    corners += left.norm() == 0.0;
    along += left.norm() > 0.0;
  }
  EXPECT_GT(corners, 100);
  EXPECT_GT(along, 1000);
}

} // namespace
} // namespace pcl_bsh
