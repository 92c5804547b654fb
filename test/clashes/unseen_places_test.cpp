// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/clashes/unseen_places.h>

#include <pcl_bsh/hierarchy/triangles_view.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

namespace pcl_bsh {
namespace {

/// Three dots on a line, a metre apart, that stop at some places of the x axis.
class UnseenPlaces : public testing::Test {
protected:
  void stop(double x, std::vector<bool> what)
  {
    poses.emplace_back(Eigen::Translation3d(x, 0, 0));
    unseen.push_back(std::move(what));
  }

  /// The model.
  void beOneTriangle()
  {
    static constexpr float corners[] = {0, 0, 0, 9, 0, 0, 0, 9, 0};
    static constexpr Triangle face = {0, 1, 2};
    TrianglesView triangles;
    triangles.vertices = viewOf(corners, 3);
    triangles.corners = face.data();
    triangles.count = 1;
    view = viewOf(triangles);
  }

  std::vector<Clash> places(double distance = 1.0) const { return findUnseenPlaces(along(), distance); }
  UnseenAlong along() const { return {view, poses, unseen}; }

  std::vector<double> dots = {0.5, 0.5, 0.5, 1.5, 0.5, 0.5, 2.5, 0.5, 0.5};
  PointsView view = viewOf(dots.data(), 3);
  std::vector<Eigen::Isometry3d> poses;
  std::vector<std::vector<bool>> unseen;
};

TEST_F(UnseenPlaces, AreClustersOfTheModelAsPlaced)
{
  stop(0, {});
  stop(10, {true, false, false});
  stop(10, {true, true, false}); // most here
  stop(11, {true, true, false}); // not more
  stop(20, {false, false, true});
  const std::vector<Clash> found = places();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].id, "U2_0_0"); // cells of 4 m
  EXPECT_EQ(found[0].status, ClashStatus::unseen);
  EXPECT_TRUE(found[0].wasNoClash());
  EXPECT_EQ(found[0].low, (Point3{10.5, 0.5, 0.5}));
  EXPECT_EQ(found[0].high, (Point3{12.5, 0.5, 0.5}));
  EXPECT_EQ(found[0].place, (Point3{11.5, 0.5, 0.5}));
  EXPECT_EQ(found[0].points, 2u);
  EXPECT_EQ(found[0].first_pose, 1);
  EXPECT_EQ(found[0].closest_pose, 2);
  EXPECT_EQ(found[1].low, (Point3{22.5, 0.5, 0.5}));
  EXPECT_EQ(found[1].points, 1u);
  EXPECT_EQ(found[1].first_pose, 4);
}

TEST_F(UnseenPlaces, LieTogetherInCellsThatTouch)
{
  stop(-4.0, {true, false, false}); // cell -4
  stop(-2.5, {true, false, false}); // cell -2, 1.5 away
  EXPECT_EQ(places().size(), 2u);
  EXPECT_EQ(places(1.5).size(), 1u) << "cells of 2 m";
  stop(-3.0, {true, false, false});
  EXPECT_EQ(places().size(), 1u) << "the cell between";
}

TEST_F(UnseenPlaces, LieTogetherInAllDirections)
{
  dots.resize(6); // one in the cell of the origin, and one in each of its neighbours in turn
  view = viewOf(dots.data(), 2);
  stop(0, {true, true});
  for (const double x : {-0.5, 0.5, 1.5}) {
    for (const double y : {-0.5, 0.5, 1.5}) {
      for (const double z : {-0.5, 0.5, 1.5}) {
        std::copy_n(std::array{x, y, z}.begin(), 3, dots.begin() + 3);
        const std::vector<Clash> found = places();
        ASSERT_EQ(found.size(), 1u) << x << ' ' << y << ' ' << z;
        EXPECT_EQ(found[0].low, (Point3{std::min(x, 0.5), std::min(y, 0.5), std::min(z, 0.5)}));
        EXPECT_EQ(found[0].high, (Point3{std::max(x, 0.5), std::max(y, 0.5), std::max(z, 0.5)}));
      }
    }
  }
}

/// Which would be written as -0.
TEST_F(UnseenPlaces, HaveNoNegativeZeros)
{
  dots = {-0.0, -0.0, -0.0};
  view = viewOf(dots.data(), 1);
  poses.emplace_back(Eigen::Isometry3d::Identity());
  poses.back().translation() = Eigen::Vector3d(-0.0, -0.0, -0.0);
  unseen.push_back({true});
  const std::vector<Clash> found = places();
  ASSERT_EQ(found.size(), 1u);
  for (const double x : found[0].low) EXPECT_FALSE(std::signbit(x));
}

TEST_F(UnseenPlaces, OfATriangleAreOnePlace)
{
  beOneTriangle();
  stop(1, {true});
  const std::vector<Clash> found = places();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].low, (Point3{1, 0, 0}));
  EXPECT_EQ(found[0].high, (Point3{10, 9, 0}));
}

TEST_F(UnseenPlaces, AreNoneWhereAllIsSeen)
{
  stop(0, {});
  EXPECT_TRUE(places().empty());
  EXPECT_THROW(places(0.0), std::invalid_argument);
  EXPECT_THROW(places(std::numeric_limits<double>::infinity()), std::invalid_argument);
}

TEST_F(UnseenPlaces, PassTheirIdsOnAmongThemselves)
{
  stop(10, {true, true, true});
  std::vector<Clash> now = places();
  Clash collided = now[0]; // the same box
  collided.id = "C2_0_0";
  collided.status = ClashStatus::fresh;
  collided.distance = 0.1;
  Clash unseen_before = now[0], gone = now[0];
  unseen_before.id = "U9_9_9";
  gone.id = "U7_0_0";
  gone.low = gone.high = {500, 0, 0};
  compareWithEarlier(now, {collided, unseen_before, gone}, 1.0);
  ASSERT_EQ(now.size(), 2u) << "what was unseen and is not any more is forgotten";
  EXPECT_EQ(now[0].id, "U9_9_9");
  EXPECT_EQ(now[0].status, ClashStatus::unseen);
  EXPECT_EQ(now[1].id, "C2_0_0");
  EXPECT_EQ(now[1].status, ClashStatus::resolved) << "to be judged by FormerPlaces";

  std::vector<Clash> collides = {collided};
  compareWithEarlier(collides, {unseen_before}, 1.0);
  EXPECT_EQ(collides[0].status, ClashStatus::fresh) << "nobody knew of it";
}

TEST_F(UnseenPlaces, AreNoPlacesWhereAClashIsResolved)
{
  stop(10, {true, false, false});
  std::vector<Clash> clashes(3);
  for (std::size_t i = 0; i < clashes.size(); ++i) {
    clashes[i].status = ClashStatus::resolved;
    clashes[i].low = clashes[i].high = clashes[i].place = {10.5 + 1.5 * static_cast<double>(i), 0.5, 0.5};
    clashes[i].distance = 0.0;
  }
  FormerPlaces former(clashes, 0.5, 1.0); // a reach of 1.5
  TrajectoryRequest motion;
  former.visit(SphereHierarchy(view), poses, motion);
  former.scan(view); // nothing is near
  tellUnseen(former, along());
  former.judge();
  EXPECT_EQ(clashes[0].status, ClashStatus::unseen);
  EXPECT_EQ(clashes[1].status, ClashStatus::unseen) << "touching counts";
  EXPECT_EQ(clashes[2].status, ClashStatus::not_scanned);
  EXPECT_FALSE(clashes[0].wasNoClash());
}

TEST_F(UnseenPlaces, OfATriangleReachToAllItsCorners)
{
  beOneTriangle();
  stop(0, {true});
  std::vector<Clash> clashes(3);
  for (std::size_t i = 0; i < clashes.size(); ++i) {
    clashes[i].status = ClashStatus::resolved;
    clashes[i].distance = 0.0;
  }
  clashes[0].place = {9, 0, 0}, clashes[1].place = {0, 9, 0}, clashes[2].place = {0, 11, 0};
  for (Clash& clash : clashes) clash.low = clash.high = clash.place;
  FormerPlaces former(clashes, 0.5, 1.0);
  TrajectoryRequest motion;
  former.visit(SphereHierarchy(view), poses, motion);
  former.scan(PointsView());
  tellUnseen(former, along());
  former.judge();
  EXPECT_EQ(clashes[0].status, ClashStatus::unseen);
  EXPECT_EQ(clashes[1].status, ClashStatus::unseen);
  EXPECT_NE(clashes[2].status, ClashStatus::unseen);
}

/// One triangle, unseen in two corners: in the first it is in shadow, in the second in the skin.
TEST_F(UnseenPlaces, OfPartsOfATriangleAreThese)
{
  beOneTriangle();
  stop(0, {true});
  std::vector<UnseenKinds> kinds(1);
  kinds[0].in_shadow = {true};
  kinds[0].parts = {{0, true, {0, 0, 0}, {2.5, 0.5, 0}},
                    {0, true, {2.5, 0, 0}, {4.5, 0.25, 0}}, // touches the first
                    {0, false, {0, 8.5, 0}, {0.5, 9, 0}}};
  const UnseenAlong parts{view, poses, unseen, &kinds};
  std::vector<Clash> found = findUnseenPlaces(parts, 1.0);
  ASSERT_EQ(found.size(), 2u);
  if (found[0].low[1] > 1.0) std::swap(found[0], found[1]);
  EXPECT_EQ(found[0].high, (Point3{4.5, 0.5, 0}));
  EXPECT_EQ(found[0].points, 1u) << "one triangle";
  EXPECT_EQ(found[0].points_in_shadow, 1u);
  EXPECT_EQ(found[1].low, (Point3{0, 8.5, 0}));
  EXPECT_EQ(found[1].points, 1u);
  EXPECT_EQ(found[1].points_in_shadow, 0u);

  std::vector<Clash> clashes(3);
  for (Clash& clash : clashes) clash.status = ClashStatus::resolved, clash.distance = 0.0;
  clashes[0].place = {4, 0, 0}, clashes[1].place = {0, 9, 0}, clashes[2].place = {8, 0, 0};
  for (Clash& clash : clashes) clash.low = clash.high = clash.place;
  FormerPlaces former(clashes, 0.5, 1.0);
  former.visit(SphereHierarchy(view), poses, TrajectoryRequest());
  const Point3 scanned[] = {{4, 0, 1}, {0, 9, 1}, {8, 0, 1}};
  former.scan(viewOf(scanned[0].data(), 3));
  tellUnseen(former, parts);
  former.judge();
  EXPECT_EQ(clashes[0].status, ClashStatus::unseen);
  EXPECT_EQ(clashes[1].status, ClashStatus::resolved) << "beams passed there";
  EXPECT_EQ(clashes[2].status, ClashStatus::resolved) << "a part that is seen";
}

} // namespace
} // namespace pcl_bsh
