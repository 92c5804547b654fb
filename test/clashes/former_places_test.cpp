// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/clashes/former_places.h>

#include <gtest/gtest.h>

namespace pcl_bsh {
namespace {

/// A clash about x that is not found again.
Clash resolvedAt(double x)
{
  Clash clash;
  clash.id = "x" + std::to_string(x);
  clash.status = ClashStatus::resolved;
  clash.points = clash.certain_points = 3;
  clash.low = {x - 1, 0, 0};
  clash.high = {x + 1, 1, 1};
  clash.place = {x, 0, 0};
  clash.distance = 0.1;
  return clash;
}

class FormerPlacesAlongALine : public testing::Test {
protected:
  static constexpr double clearance = 0.25, cluster_distance = 0.5; // a reach of 0.75

  /// A dot that stops at these stations.
  void visit(FormerPlaces& former, const std::vector<double>& stations, std::optional<double> swept = {}) const
  {
    std::vector<Eigen::Isometry3d> poses(stations.size(), Eigen::Isometry3d::Identity());
    for (std::size_t i = 0; i < stations.size(); ++i) poses[i].translation().x() = stations[i];
    TrajectoryRequest motion;
    motion.swept = swept;
    former.visit(SphereHierarchy(viewOf(dot.data(), 1)), poses, motion);
  }

  static void scan(FormerPlaces& former, const std::vector<Point3>& points)
  {
    former.scan(viewOf(points.front().data(), points.size()));
  }

  std::vector<ClashStatus> statuses() const
  {
    std::vector<ClashStatus> all;
    for (const Clash& clash : clashes) all.push_back(clash.status);
    return all;
  }

  Point3 dot = {0, 0, 0};
  std::vector<Clash> clashes = {resolvedAt(0), resolvedAt(10), resolvedAt(20)};
};

TEST_F(FormerPlacesAlongALine, AreResolvedOnlyWhereTheRunLooked)
{
  clashes.push_back(resolvedAt(30));
  clashes.back().status = ClashStatus::persisting;
  FormerPlaces former(clashes, clearance, cluster_distance);
  EXPECT_FALSE(former.empty());
  visit(former, {0, 10});
  scan(former, {{std::nan(""), 0, 0}, {-1.75, 0, 0}, {20, 0.5, 0.5}, {8.249, 0, 0}, {10, 0, std::nan("")}});
  former.judge();
  EXPECT_EQ(statuses(), (std::vector{ClashStatus::resolved, ClashStatus::not_scanned, ClashStatus::not_visited,
                                     ClashStatus::persisting}))
      << "touching counts; 0.001 beyond does not";
}

TEST_F(FormerPlacesAlongALine, AreLookedAtInParts)
{
  FormerPlaces former(clashes, clearance, cluster_distance);
  EXPECT_TRUE(former.mayScan({{0, 0, 0}, {0, 0, 0}}));
  for (const double x : {0.0, 10.0, 20.0}) {
    visit(former, {x});
    scan(former, {{x, std::nan(""), 0}, {x, 0, 0}});
  }
  EXPECT_FALSE(former.mayScan({{0, 0, 0}, {0, 0, 0}})) << "known already";
  former.judge();
  EXPECT_EQ(statuses(), std::vector(3, ClashStatus::resolved));
}

TEST_F(FormerPlacesAlongALine, AreVisitedBetweenPosesBySweptMotion)
{
  for (const bool swept : {false, true}) {
    clashes = {resolvedAt(10)};
    FormerPlaces former(clashes, clearance, cluster_distance);
    visit(former, {0, 20}, swept ? std::optional(0.01) : std::nullopt);
    scan(former, {{10, 0, 0}});
    former.judge();
    EXPECT_EQ(clashes[0].status, swept ? ClashStatus::resolved : ClashStatus::not_visited);
  }
}

TEST_F(FormerPlacesAlongALine, PartsThatTellNothingAreKnownBefore)
{
  FormerPlaces former(clashes, clearance, cluster_distance);
  const std::vector<Eigen::Isometry3d> poses(1, Eigen::Isometry3d::Identity());
  EXPECT_TRUE(former.mayVisit({{9, -1, -1}, {11, 1, 1}}, poses, {}));
  EXPECT_FALSE(former.mayVisit({{4, -1, -1}, {5, 1, 1}}, poses, {}));
  EXPECT_TRUE(former.mayScan({{11.5, 0, 0}, {15, 1, 1}}));
  EXPECT_FALSE(former.mayScan({{12, 0, 0}, {15, 1, 1}}));
  clashes = {resolvedAt(0)};
  FormerPlaces one(clashes, clearance, cluster_distance);
  EXPECT_TRUE(one.mayVisit({{-40.5, -20, -20}, {-0.5, 20, 20}}, poses, {})) << "at the box's side";
}

/// An uncertain clash may have been farther away than the clearance: its place is still near it.
TEST_F(FormerPlacesAlongALine, ReachAsFarAsTheClashesThemselves)
{
  clashes = {resolvedAt(0)};
  clashes[0].certain_points = 0;
  clashes[0].distance = 3;
  dot = {0, 3, 0};
  FormerPlaces former(clashes, clearance, cluster_distance);
  visit(former, {0});
  scan(former, {{0, 0, 0}});
  former.judge();
  EXPECT_EQ(clashes[0].status, ClashStatus::resolved);
}

TEST_F(FormerPlacesAlongALine, NeedNothingWhereNothingIsResolved)
{
  clashes.clear();
  FormerPlaces former(clashes, clearance, cluster_distance);
  EXPECT_TRUE(former.empty());
  visit(former, {0});
  scan(former, {{0, 0, 0}});
  former.judge();
}

} // namespace
} // namespace pcl_bsh
