// SPDX-License-Identifier: BSD-3-Clause
// The queries on real scans, where they are at hand, against an independent kd-tree.
#include <pcl_bsh/collide.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/filters/collision_filter.h>
#include <pcl_bsh/search/cloud_view.h>

#include "shared_scans.h"
#include "support/kd_tree.h"
#include "support/question.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

namespace pcl_bsh {
namespace {

const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();

pcl::PCLPointCloud2 load(const std::string& name)
{
  pcl::PCLPointCloud2 cloud;
  readScan(name, cloud);
  return cloud;
}

struct Scan {
  explicit Scan(const std::string& name) : cloud(load(name)), hierarchy(viewOf(cloud)) {}
  Scan(const Scan&) = delete;
  Scan& operator=(const Scan&) = delete;
  const PointsView& view() const { return hierarchy.view(); }

  const pcl::PCLPointCloud2 cloud;
  const SphereHierarchy hierarchy;
};

class RealScans : public testing::Test {
protected:
  void SetUp() override
  {
    if (!hasScan("lidar_sweep_a")) GTEST_SKIP() << scanFile("*") << " are not there";
  }

  static test::Question within(double clearance)
  {
    test::Question request;
    request.clearance = clearance;
    request.flagged = Flagged::both;
    request.threads = 2;
    return request;
  }

  static void expectFlags(const Scan& a, const Eigen::Isometry3d& pose_a, const Scan& b,
                          const Eigen::Isometry3d& pose_b, double clearance)
  {
    SCOPED_TRACE(clearance);
    const FlagsResult result = collisionFlags({a.hierarchy, pose_a}, {b.hierarchy, pose_b}, within(clearance));
    EXPECT_TRUE(result.a == test::flagsByKdTree(a.view(), pose_a, b.view(), pose_b, clearance));
    EXPECT_TRUE(result.b == test::flagsByKdTree(b.view(), pose_b, a.view(), pose_a, clearance));
    EXPECT_GT(result.colliding_a, 100u); // else the test would say nothing
    EXPECT_LT(result.colliding_a, a.hierarchy.size() - 100);
  }

  /// The smallest distance is right, and exactly where anyCollision() turns.
  static DistanceResult expectDistance(const Scan& a, const Eigen::Isometry3d& pose_a, const Scan& b,
                                       const Eigen::Isometry3d& pose_b)
  {
    const Placed placed_a{a.hierarchy, pose_a}, placed_b{b.hierarchy, pose_b};
    const DistanceResult result = closestPair(placed_a, placed_b, within(0));
    EXPECT_NEAR(result.distance, test::distanceByKdTree(a.view(), pose_a, b.view(), pose_b), 1e-9);
    if (!result.pair) {
      ADD_FAILURE() << "no pair";
      return result;
    }
    const Point3 p = a.view().point(result.pair->a), q = b.view().point(result.pair->b);
    const ExactDistance distance(pose_a, pose_b);
    EXPECT_EQ(distance.gap({p, q}), result.distance);
    for (const double clearance : {std::nextafter(result.distance, 0.0), result.distance,
                                   std::nextafter(result.distance, std::numeric_limits<double>::infinity())}) {
      const Verdict expected = distance.compare(p, q, clearance) <= 0 ? Verdict::colliding : Verdict::free;
      EXPECT_EQ(anyCollision(placed_a, placed_b, within(clearance)).verdict, expected) << clearance;
    }
    return result;
  }
};

TEST_F(RealScans, TwoLidarSweeps)
{
  const Scan a("lidar_sweep_a"), b("lidar_sweep_b");
  Eigen::Matrix3d rotation;
  rotation << 0.999925, 0.0121483, -0.00177009, -0.0121523, 0.999924, -0.00228657, 0.00174218, 0.00230791, 0.999996;
  Eigen::Isometry3d pose_b(Eigen::Quaterniond(rotation).normalized()); // given with six digits: not quite rigid
  pose_b.translation() = Eigen::Vector3d(0.488882, 0.121214, -0.0253342);
  expectFlags(a, identity, b, pose_b, 0.02);
  expectFlags(a, identity, b, pose_b, 0.2);
  expectDistance(a, identity, b, pose_b);
  EXPECT_TRUE(a.hierarchy.validate().none());
}

TEST_F(RealScans, RoomScansWithEveryPointTwice)
{
  const Scan a("indoor_room_scan1"), b("indoor_room_scan2");
  Eigen::Isometry3d pose_b(Eigen::AngleAxisd(0.6931, Eigen::Vector3d::UnitZ()));
  pose_b.pretranslate(Eigen::Vector3d(1.79387, 0.720047, 0));
  expectFlags(a, identity, b, pose_b, 0.05);
  expectDistance(a, identity, b, pose_b);
}

TEST_F(RealScans, LionAgainstItselfShifted) // coordinates step by 0.001: ties everywhere, up to rounding
{
  const Scan lion("statue_lion_takanawa");
  const Eigen::Isometry3d shifted(Eigen::Translation3d(0.004, 0.002, 0.004));
  expectFlags(lion, identity, lion, shifted, 0.002);
  expectFlags(lion, identity, lion, shifted, 0.003);
  const Eigen::Isometry3d turned =
      Eigen::Translation3d(8, 0, 0) * Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized());
  expectDistance(lion, identity, lion, turned);
  EXPECT_TRUE(lion.hierarchy.validate().none());
}

TEST_F(RealScans, PandaArmOverTheTable)
{
  const Scan table("tabletop_rgbd_organized"), arm("robot_panda_sampled");
  Eigen::Isometry3d upright(Eigen::AngleAxisd(std::atan2(-0.82, 0.57), Eigen::Vector3d::UnitX()));
  for (const Eigen::Vector3d& place : {Eigen::Vector3d(0.0, -0.03, -0.77), Eigen::Vector3d(0.3, 0.3, -0.3)}) {
    Eigen::Isometry3d pose = upright;
    pose.translation() = place;
    expectDistance(table, identity, arm, pose);
  }
  EXPECT_TRUE(table.hierarchy.validate().none()); // a fifth of its points are NaN
}

TEST_F(RealScans, Float64TerrainAgainstItsFloat32Twin)
{
  const Scan precise("terrain_stbarth_utm20_f64"), rounded("terrain_stbarth_utm20_f32");
  // A clearance that a pair meets as nearly as a double can: float32 itself moved this point by that much.
  const double tie = ExactDistance(identity, identity).gap({precise.view().point(12345), rounded.view().point(12345)});
  ASSERT_GT(tie, 1e-3);
  expectFlags(precise, identity, rounded, identity, tie);

  // Some points survive float32: the pair found is the smallest of those.
  std::map<Point3, std::uint32_t> first_at;
  for (auto i = static_cast<std::uint32_t>(rounded.view().count); i-- > 0;) first_at[rounded.view().point(i)] = i;
  std::uint32_t survivor = 0;
  while (!first_at.count(precise.view().point(survivor))) ++survivor;
  const DistanceResult result = closestPair({precise.hierarchy}, {rounded.hierarchy}, within(0));
  EXPECT_EQ(result.distance, 0.0);
  EXPECT_EQ(result.pair, (PointPair{survivor, first_at[precise.view().point(survivor)]}));
}

/// Flags of PCL's side of things: the filter of clouds with run-time fields.
std::vector<Verdict> flagsByFilter(const pcl::PCLPointCloud2& input, const pcl::PCLPointCloud2& obstacle,
                                   const Eigen::Isometry3d& pose, double clearance)
{
  CollisionFilter<pcl::PCLPointCloud2> filter;
  filter.setInputCloud(std::make_shared<pcl::PCLPointCloud2>(input));
  filter.setObstacleCloud(std::make_shared<pcl::PCLPointCloud2>(obstacle));
  filter.setPose(pose);
  filter.setClearance(clearance);
  std::vector<Verdict> flags;
  filter.computeFlags(flags);
  return flags;
}

TEST_F(RealScans, GeoreferencedTerrainIsExactInFloat64AndOnlyThere)
{
  const Scan precise("terrain_stbarth_utm20_f64"), rounded("terrain_stbarth_utm20_f32");
  const PointsView view = precise.view();
  Eigen::Isometry3d lifted = identity; // turned about its own middle, and lifted by 5 cm
  lifted.translate(Eigen::Vector3d(515050, 1981050, 0.05));
  lifted.rotate(Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitZ()));
  lifted.translate(Eigen::Vector3d(-515050, -1981050, 0));
  // Two points as far apart as the clearance, to the last bit of a double; and the doubles below and above.
  const double tie = ExactDistance(identity, lifted).gap({view.point(12345), view.point(12345)});
  ASSERT_LT(tie, 2.0);
  std::size_t differ = 0;
  for (const double clearance : {0.05, tie, std::nextafter(tie, 0.0), std::nextafter(tie, 10.0)}) {
    const auto expected = test::flagsByKdTree(view, identity, view, lifted, clearance);
    const FlagsResult flags = collisionFlags({precise.hierarchy}, {precise.hierarchy, lifted}, within(clearance));
    EXPECT_TRUE(flags.a == expected);
    EXPECT_TRUE(flagsByFilter(precise.cloud, precise.cloud, lifted, clearance) == expected);
    const bool any = std::find(expected.begin(), expected.end(), Verdict::colliding) != expected.end();
    EXPECT_EQ(anyCollision({precise.hierarchy}, {precise.hierarchy, lifted}, within(clearance)).verdict,
              any ? Verdict::colliding : Verdict::free);
    const auto of_floats = flagsByFilter(rounded.cloud, rounded.cloud, lifted, clearance);
    if (clearance == 0.05)
      for (std::size_t i = 0; i < expected.size(); ++i) differ += of_floats[i] != expected[i];
  }
  EXPECT_GT(differ, 1000u);
  RecordProperty("points that float32 decides otherwise at 5 cm", static_cast<int>(differ));

  const DistanceResult closest = closestPair({precise.hierarchy}, {precise.hierarchy, lifted});
  EXPECT_NEAR(closest.distance, test::distanceByKdTree(view, identity, view, lifted), 1e-8);
  ASSERT_TRUE(closest.pair);
  EXPECT_EQ(closest.distance,
            ExactDistance(identity, lifted).gap({view.point(closest.pair->a), view.point(closest.pair->b)}));
}

/// Distances of every `step`th record of a against a k-d tree of b, which gives those that exact arithmetic compares.
void expectDistances(const Scan& a, const Eigen::Isometry3d& pose_a, const Scan& b, const Eigen::Isometry3d& pose_b,
                     std::size_t step, double max_distance = std::numeric_limits<double>::infinity())
{
  PointDistancesRequest request;
  request.max_distance = max_distance;
  request.threads = 2;
  const PointDistances found = pointDistances({a.hierarchy, pose_a}, {b.hierarchy, pose_b}, request);
  ASSERT_EQ(found.closest_point.size(), a.view().count);
  const test::KdTree tree(b.view(), pose_b);
  const ExactDistance distance(pose_a, pose_b);
  for (std::uint32_t i = 0; i < a.view().count; i += static_cast<std::uint32_t>(step)) {
    const Eigen::Vector3d query = test::KdTree::moved(a.view(), i, pose_a);
    if (!query.allFinite()) {
      ASSERT_EQ(found.closest_point[i], kNothing);
      continue;
    }
    const auto pairWith = [&](std::uint32_t j) { return ExactDistance::Pair{a.view().point(i), b.view().point(j)}; };
    std::uint32_t nearest = tree.nearest(query).record;
    tree.anyWithin(query, tree.nearest(query).distance + 1e-6, [&](std::uint32_t j) {
      const int sign = distance.compareGaps(pairWith(j), pairWith(nearest));
      if (sign < 0 || (sign == 0 && j < nearest)) nearest = j;
      return false;
    });
    if (distance.compare(a.view().point(i), b.view().point(nearest), max_distance) > 0) {
      ASSERT_EQ(found.closest_point[i], kNothing) << "record " << i;
      continue;
    }
    ASSERT_EQ(found.closest_point[i], nearest) << "record " << i;
    ASSERT_EQ(found.distance[i], distance.gap(pairWith(nearest))) << "record " << i;
  }
}

TEST_F(RealScans, DistancesOfPointsAreThoseOfAKdTree)
{
  const Scan lion("statue_lion_takanawa"); // its coordinates have steps of 0.001: many points are equally near
  Eigen::Isometry3d pushed = identity;
  pushed.translation().x() = 0.05;
  expectDistances(lion, identity, lion, pushed, 97);
  expectDistances(lion, identity, lion, pushed, 97, 0.035);

  const Scan sweep_a("lidar_sweep_a"), sweep_b("lidar_sweep_b");
  Eigen::Isometry3d pose = identity;
  pose.rotate(Eigen::AngleAxisd(-0.0122, Eigen::Vector3d(0.19, -0.15, 1).normalized()));
  pose.pretranslate(Eigen::Vector3d(0.488882, 0.121214, -0.0253342));
  expectDistances(sweep_a, identity, sweep_b, pose, 97);
  expectDistances(sweep_b, pose, sweep_a, identity, 97, 0.1);

  const Scan terrain("terrain_stbarth_utm20_f64"), rounded("terrain_stbarth_utm20_f32");
  Eigen::Isometry3d lifted = identity; // turned about its own middle
  lifted.translate(Eigen::Vector3d(515050, 1981050, 0.05));
  lifted.rotate(Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitZ()));
  lifted.translate(Eigen::Vector3d(-515050, -1981050, 0));
  expectDistances(terrain, identity, terrain, lifted, 97);
  expectDistances(rounded, identity, terrain, identity, 97); // float32 records: many are one place
}

} // namespace
} // namespace pcl_bsh
