// SPDX-License-Identifier: BSD-3-Clause
// Pairs of objects that share a voxel, where points have radii or may be elsewhere than they were measured.
#include <pcl_bsh/scene/pairs/broad_phase.h>
#include <pcl_bsh/scene/scene.h>

#include "random_world.h"
#include "support/allocations.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using test::at;
using test::Cloud;
using test::Layout;
using test::sheet;
using test::Shelf;

constexpr double reach = 2.5; // of a point, beyond its place

/// @param uncertain whether it may be elsewhere by the reach, or has it as its radius
Cloud reaching(const std::vector<Point3>& points, bool uncertain)
{
  Cloud cloud(points, {Scalar::float64, 0, 0});
  if (uncertain)
    cloud.setUncertainties(reach, {});
  else
    cloud.setRadii(std::vector<float>(points.size(), static_cast<float>(reach)));
  return cloud;
}

/// A grid of objects from 0, in boxes from one corner to another.
struct GridOfBoxes {
  explicit GridOfBoxes(double edge)
  {
    for (int i = 0; i < 4; ++i) rules.addObject("", false);
    grid.reset(edge, rules);
  }

  /// @return how many voxels it came into
  std::uint64_t place(ObjectId object, const std::vector<Box3>& boxes)
  {
    BroadPhaseCost cost;
    grid.place(object, boxes, cost);
    return cost.voxels_entered;
  }

  std::vector<std::pair<ObjectId, ObjectId>> pairs()
  {
    std::vector<std::pair<ObjectId, ObjectId>> found;
    for (const BroadPair* pair : grid.pairs()) found.emplace_back(pair->a, pair->b);
    return found;
  }

  std::vector<ObjectId> around(const Box3& box) const
  {
    std::vector<ObjectId> found;
    grid.around(box, found);
    return found;
  }

  static Box3 box(double low, double high) { return {Eigen::Vector3d::Constant(low), Eigen::Vector3d::Constant(high)}; }

  PairRules rules{0.0, true};
  BroadPhase grid;
};

TEST(BroadPhase, WhatIsNotPlacedYetMeetsNothing)
{
  using Pairs = std::vector<std::pair<ObjectId, ObjectId>>;
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double edge : {1.0, infinity}) {
    SCOPED_TRACE(edge);
    GridOfBoxes boxes(edge);
    const Box3 small = GridOfBoxes::box(0.25, 0.75), everywhere = GridOfBoxes::box(-1000, 1000);
    boxes.place(3, {small});
    boxes.place(1, {everywhere});
    EXPECT_EQ(boxes.pairs(), (Pairs{{1, 3}}));
    for (const Box3& box : {small, everywhere}) EXPECT_EQ(boxes.around(box), (std::vector<ObjectId>{1, 3}));
    EXPECT_TRUE(boxes.around(Box3()).empty());
    boxes.place(2, {GridOfBoxes::box(5.25, 5.75)});
    EXPECT_EQ(boxes.pairs(), edge == 1.0 ? (Pairs{{1, 2}, {1, 3}}) : (Pairs{{1, 2}, {1, 3}, {2, 3}}));
    boxes.place(1, {small});
    if (edge == 1.0) {
      EXPECT_EQ(boxes.pairs(), (Pairs{{1, 3}}));
      EXPECT_EQ(boxes.around(small), (std::vector<ObjectId>{1, 3}));
    }
  }
}

/// A voxel of several boxes counts once; an object of too many voxels is everywhere.
TEST(BroadPhase, AnObjectIsInEachVoxelOfItsBoxesOnce)
{
  GridOfBoxes boxes(1.0);
  EXPECT_EQ(boxes.place(0, {GridOfBoxes::box(0.25, 1.5), GridOfBoxes::box(1.25, 2.5), Box3()}), 15u);
  EXPECT_EQ(boxes.place(1, {{{0.5, 0.5, 0.5}, {63.5, 31.5, 31.5}}}), std::uint64_t{1} << 16);
  EXPECT_EQ(boxes.pairs().size(), 1u);
  EXPECT_EQ(boxes.place(1, {{{70.5, 0.5, 0.5}, {70.75, 0.75, 0.75}}}), 1u);
  EXPECT_TRUE(boxes.pairs().empty());
  EXPECT_EQ(boxes.place(1, {{{70.5, 0.5, 0.5}, {134.5, 31.5, 31.5}}}), 1u) << "65 x 32 x 32";
  EXPECT_EQ(boxes.pairs().size(), 1u) << "though none of its voxels is near";
}

/// A sheet of more than 64 voxels, and a dot above it: nearer than the points of one reach.
TEST(BroadPhase, ALargeObjectIsAsFarAsItsPointsMayBe)
{
  const auto large = sheet({-10, -10, 0}, {0.5, 0, 0}, {0, 0.5, 0}, 41, 41);
  const std::vector<Point3> small = {{0, 0, 0}};
  for (const bool uncertain : {false, true})
    for (const bool of_large : {false, true})
      for (const bool turned : {false, true})
        for (const double height : {2.4, -2.4, 2.6}) {
          SCOPED_TRACE((uncertain ? "uncertainty" : "radius") +
                       std::string(of_large ? " of the large" : " of the small") + " at " + std::to_string(height));
          Shelf shelf;
          const auto plain = [](const std::vector<Point3>& points) { return Cloud(points, {Scalar::float64, 0, 0}); };
          SceneOptions options;
          options.effects.any = options.effects.flags = true;
          options.clearance = 0.05;
          options.voxel_edge = 0.5;
          Scene scene(options);
          Eigen::Isometry3d pose = at(0.2, 0.1, 0.2);
          if (turned) pose.linear() = Eigen::AngleAxisd(1.0, Eigen::Vector3d(1, 2, 2) / 3).toRotationMatrix();
          scene.add(object("large", shelf.add(of_large ? reaching(large, uncertain) : plain(large)), pose));
          scene.add(object("small", shelf.add(of_large ? plain(small) : reaching(small, uncertain)),
                           pose * at(0.25, 0.25, height)));
          for (int again = 0; again < 2; ++again) {
            const SceneResult result = scene.query();
            const bool near = height < 2.5;
            EXPECT_EQ(result.any.size(), near && !uncertain ? 1u : 0u);
            EXPECT_EQ(result.undecided.size(), near && uncertain ? 1u : 0u);
            const FlagsResult expected =
                brute_force::collisionFlags(test::placed(scene, 0, 0), test::placed(scene, 1, 0), test::within(0.05));
            ASSERT_EQ(result.flags.size(), near ? 2u : 0u);
            if (!near) break;
            EXPECT_EQ(result.flags[0].flags, expected.a);
            EXPECT_EQ(result.flags[1].flags, expected.b);
            scene.setPose(1, pose * at(8.25, -8.25, height)); // over other voxels
          }
        }
}

/// Two points far apart, in one box of two layers of voxels: they are not listed to find that they are too many.
TEST(BroadPhase, AnObjectOfTooManyVoxelsTakesNoMemoryForThem)
{
  Shelf shelf;
  SceneOptions options;
  options.effects.any = true;
  options.clearance = 0.05;
  options.voxel_edge = 0.5;
  Scene scene(options);
  scene.add(object("wide", shelf.add({{0, 0, 0}, {1000, 1000, 0}})));
  scene.add(object("small", shelf.add({{0, 0, 0}}), at(1000, 1000, 0.04)));
  test::takeLargestAllocation();
  EXPECT_EQ(scene.query().any.size(), 1u);
  EXPECT_LT(test::takeLargestAllocation(), std::size_t{1} << 20); // of 4000 x 4000 x 2 of 8 bytes: 122 MB
}

} // namespace
} // namespace pcl_bsh
