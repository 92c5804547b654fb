// SPDX-License-Identifier: BSD-3-Clause
#include "support/verdicts.h"

#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/clashes/extent.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

/// A scan of given colliding points: each with a distance, a first and a closest pose.
struct Scan {
  struct Point {
    float x, y, z;
    float distance; ///< NaN: free
    std::int32_t first = 0, closest = 0;
  };

  explicit Scan(const std::vector<Point>& given) : points(given)
  {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool collides = !std::isnan(points[i].distance);
      found.flags.push_back(test::verdictIf(collides));
      found.distance.push_back(points[i].distance);
      found.first_pose.push_back(collides ? points[i].first : -1);
      found.closest_pose.push_back(collides ? points[i].closest : -1);
      found.closest_point.push_back(collides ? static_cast<std::uint32_t>(100 + i) : kNothing);
    }
  }

  PointsView view() const { return viewOf(points.empty() ? nullptr : &points[0].x, points.size(), sizeof(Point)); }
  std::vector<Clash> clashes(double distance = 1.0) const { return findClashes(view(), found, distance); }

  std::vector<Point> points;
  TrajectoryResult found;
};

const float free_point = std::nanf("");

TEST(Clashes, GroupsAndSortsBySeverity)
{
  const Scan scan({{0, 0, 0, 0.04f, 5, 6},
                   {0.5f, 0, 0, 0.02f, 4, 7},
                   {1.5f, 0.25f, 0, 0.03f, 9, 9}, // one apart, and a little: by the chain
                   {0.75f, 0, 0, free_point},
                   {9, 9, 9, 0.01f, 2, 3},
                   {-9, 0, 0, 0.02f, 1, 1}});
  const std::vector<Clash> clashes = scan.clashes(1.25);
  ASSERT_EQ(clashes.size(), 3u);
  EXPECT_EQ(clashes[0].scan_point, 4u);
  EXPECT_EQ(clashes[1].points, 3u) << "of the same distance, more points first";
  EXPECT_EQ(clashes[2].scan_point, 5u);
  const Clash& three = clashes[1];
  EXPECT_EQ(three.records, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(three.distances, (std::vector<float>{0.04f, 0.02f, 0.03f}));
  EXPECT_EQ(three.closest_poses, (std::vector<std::int32_t>{6, 7, 9}));
  EXPECT_EQ(three.low, (Point3{0, 0, 0}));
  EXPECT_EQ(three.high, (Point3{1.5, 0.25, 0}));
  EXPECT_EQ(three.distance, static_cast<double>(0.02f));
  EXPECT_EQ(three.scan_point, 1u);
  EXPECT_EQ(three.model_point, 101u);
  EXPECT_EQ(three.first_pose, 4);
  EXPECT_EQ(three.closest_pose, 7);
}

TEST(Clashes, AreThoseOfWhatCollidesAlone)
{
  Scan scan({{0, 0, 0, free_point}, {1, 0, 0, 0.04f, 5, 6}, {2, 0, 0, free_point}, {9, 9, 9, 0.01f, 2, 3}});
  scan.found.interval.assign(4, Interval{0.0, 1.0});
  scan.found.colliding = 2;
  const CollidingRecords few(scan.found);
  EXPECT_EQ(few.records, (std::vector<std::int32_t>{1, 3}));
  EXPECT_EQ(few.found.closest_point, (std::vector<std::uint32_t>{101, 103}));
  EXPECT_EQ(few.found.interval.size(), 2u);
  EXPECT_TRUE(few.found.certain_pose.empty()) << "was not asked for";
  EXPECT_EQ(few.found.colliding, 2u);
  const std::vector<Clash> found = findClashes(scan.view(), few, 1.0), expected = scan.clashes(1.0);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].id, expected[i].id);
    EXPECT_EQ(found[i].records, expected[i].records);
    EXPECT_EQ(found[i].distance, expected[i].distance);
    EXPECT_EQ(found[i].interval.upper, expected[i].interval.upper);
    EXPECT_EQ(found[i].first_pose, expected[i].first_pose);
    EXPECT_EQ(found[i].closest_pose, expected[i].closest_pose);
    EXPECT_EQ(found[i].model_point, expected[i].model_point);
  }
  EXPECT_TRUE(findClashes(scan.view(), CollidingRecords(), 1.0).empty());
}

TEST(Clashes, HoldTrianglesWhole)
{
  // Two that are a quarter apart, though their middles are far from each other, and one at a distance.
  const std::vector<double> xyz = {0, 0,  0, 10, 0,  0, 0, 1,  0, 10.25, 0,  0, 20, 0,
                                   0, 20, 2, -1, 50, 0, 0, 51, 0, 0,     50, 1, 0};
  const std::vector<std::uint32_t> corners = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  const PointsView view = viewOf(TrianglesView{viewOf(xyz.data(), 9), corners.data(), 3});
  TrajectoryResult found;
  found.flags = test::verdictsOf({1, 1, 1});
  found.distance = {0.03f, 0.02f, 0.04f};
  found.first_pose = found.closest_pose = {0, 0, 0};
  found.closest_point = {0, 0, 0};
  const std::vector<Clash> clashes = findClashes(view, found, 0.5);
  ASSERT_EQ(clashes.size(), 2u);
  EXPECT_EQ(clashes[0].records, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(clashes[0].low, (Point3{0, 0, -1}));
  EXPECT_EQ(clashes[0].high, (Point3{20, 2, 0}));
  EXPECT_EQ(clashes[1].low, (Point3{50, 0, 0}));
  EXPECT_EQ(clashes[1].high, (Point3{51, 1, 0}));
}

/// A box has 0 where points have -0 and 0, whichever comes first.
TEST(Clashes, BoxesAreTheSameWhateverTheOrder)
{
  std::vector<Scan::Point> points = {{-0.0f, 0.0f, 1, 0.1f}, {0.0f, -0.0f, 1, 0.1f}};
  for (int order = 0; order < 2; ++order) {
    const std::vector<Clash> clashes = Scan(points).clashes(1.0);
    ASSERT_EQ(clashes.size(), 1u);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_FALSE(std::signbit(clashes[0].low[k]));
      EXPECT_FALSE(std::signbit(clashes[0].high[k]));
    }
    std::swap(points[0], points[1]);
  }
}

TEST(Clashes, IdsTellThePlaceWhateverTheOrder)
{
  std::vector<Scan::Point> points = {{1, 1, 1, 0.1f}, {-1, 1, 1, 0.2f}, {100, 0, 50, 0.3f}, {101, 2, 50, 0.4f}};
  const auto idsOf = [](const std::vector<Scan::Point>& given) {
    std::vector<std::string> ids;
    for (const Clash& clash : Scan(given).clashes(1.0)) ids.push_back(clash.id);
    return ids;
  };
  const std::vector<std::string> ids = idsOf(points);
  EXPECT_EQ(ids, (std::vector<std::string>{"C0_0_0", "C-1_0_0", "C25_0_12", "C25_0_12#2"}));
  std::reverse(points.begin(), points.end());
  EXPECT_EQ(idsOf(points), ids);
  points[3].x += 0.5f;
  points[3].distance = 0.05f;
  EXPECT_EQ(idsOf(points), ids) << "small changes";
}

TEST(Clashes, IdsCountCellsOfFourClusterDistances)
{
  const Scan scan({{100, 0, 50, 0.1f}});
  EXPECT_EQ(scan.clashes(0.25)[0].id, "C100_0_50");
  EXPECT_EQ(scan.clashes(0.3)[0].id, "C50_0_25"); // of 1.2, the next power of two
  EXPECT_EQ(scan.clashes(1.0)[0].id, "C25_0_12");
}

TEST(Clashes, IdsPassToTheNearestAndToOneEach)
{
  std::vector<Clash> earlier = Scan({{0, 0, 0, 0.1f}, {3, 0, 0, 0.2f}}).clashes();
  std::vector<Clash> clashes = Scan({{2.5f, 0, 0, 0.1f}}).clashes();
  compareWithEarlier(clashes, earlier, 4.0); // both are near
  ASSERT_EQ(clashes.size(), 1u);
  EXPECT_EQ(clashes[0].id, earlier[1].id);

  earlier.erase(earlier.begin());
  clashes = Scan({{2.5f, 0, 0, 0.1f}, {5, 0, 0, 0.2f}}).clashes();
  compareWithEarlier(clashes, earlier, 4.0);
  ASSERT_EQ(clashes.size(), 2u);
  EXPECT_EQ(clashes[0].id, earlier[0].id);
  EXPECT_NE(clashes[1].id, earlier[0].id);
}

TEST(Clashes, NothingCollidesNothingClashes)
{
  EXPECT_TRUE(Scan({{0, 0, 0, free_point}}).clashes().empty());
  EXPECT_TRUE(Scan({}).clashes().empty());
}

TEST(Clashes, AgainstEarlierOnes)
{
  std::vector<Clash> earlier = Scan({{0, 0, 0, 0.1f}, {50, 0, 0, 0.2f}, {90, 0, 0, 0.3f}}).clashes();
  const std::string first = earlier[0].id, gone = earlier[1].id;
  // The first has moved into the next cell, the second is gone, the third has a neighbour now, one more is new.
  std::vector<Clash> clashes =
      Scan({{-0.5f, 0, 0, 0.1f}, {90, 0, 0, 0.3f}, {90, 1.5f, 0, 0.4f}, {20, 0, 0, 0.5f}}).clashes();
  EXPECT_NE(clashes[0].id, first);
  compareWithEarlier(clashes, earlier, 1.0);
  ASSERT_EQ(clashes.size(), 5u);
  EXPECT_EQ(clashes[0].id, first);
  EXPECT_EQ(clashes[0].status, ClashStatus::persisting);
  EXPECT_EQ(clashes[1].id, earlier[2].id);
  EXPECT_EQ(clashes[1].status, ClashStatus::persisting);
  EXPECT_EQ(clashes[2].status, ClashStatus::fresh);
  EXPECT_NE(clashes[2].id, clashes[1].id);
  EXPECT_EQ(clashes[3].status, ClashStatus::fresh);
  EXPECT_EQ(clashes[4].status, ClashStatus::resolved);
  EXPECT_EQ(clashes[4].id, gone);
  EXPECT_TRUE(clashes[4].records.empty()) << "they were of the earlier scan";

  std::vector<Clash> later = Scan({{50, 0, 0, 0.1f}}).clashes();
  compareWithEarlier(later, clashes, 1.0);
  EXPECT_EQ(later[0].status, ClashStatus::fresh) << "what was resolved and is back is new";
  EXPECT_EQ(std::count_if(later.begin(), later.end(),
                          [](const Clash& clash) { return clash.status == ClashStatus::resolved; }),
            4);
}

TEST(Clashes, ThoseThatWereNotLookedAtAreStillThere)
{
  std::vector<Clash> earlier = Scan({{0, 0, 0, 0.1f}, {50, 0, 0, 0.2f}}).clashes();
  earlier[0].status = ClashStatus::not_visited;
  earlier[1].status = ClashStatus::not_scanned;
  std::vector<Clash> now = Scan({{50, 0, 0, 0.2f}}).clashes();
  compareWithEarlier(now, earlier, 1.0);
  ASSERT_EQ(now.size(), 2u) << "not forgotten, as resolved ones are";
  EXPECT_EQ(now[0].status, ClashStatus::persisting);
  EXPECT_EQ(now[1].status, ClashStatus::resolved) << "to be judged by FormerPlaces";
}

/// Places in a grid, of which half are there again, a little moved.
TEST(Clashes, ComparingCostsWhatIsNear)
{
  const auto boxesCompared = [](int side) {
    std::vector<Clash> earlier, now;
    for (int i = 0; i < side * side; ++i) {
      Clash clash;
      const double x = 10.0 * (i % side), y = 10.0 * (i / side);
      clash.id = std::to_string(i);
      clash.points = 1;
      clash.low = {x, y, 0};
      clash.high = {x + 1, y + 1, 1};
      earlier.push_back(clash);
      clash.id = "now " + clash.id;
      clash.low[0] += 0.5;
      clash.high[0] += 0.5;
      if (i % 2 == 0) now.push_back(clash);
    }
    const std::uint64_t compared = compareWithEarlier(now, earlier, 1.0);
    EXPECT_EQ(now.size(), earlier.size());
    EXPECT_EQ(now[0].id, "0");
    return static_cast<double>(compared);
  };
  const double small = boxesCompared(40), large = boxesCompared(160);
  EXPECT_LT(large, 50 * 160 * 160) << "all pairs are 12,800 a clash";
  EXPECT_LT(large, 16 * 1.5 * small);
}

/// A cell full of clashes: each gets a number of its own.
TEST(Clashes, ManyOfOneCellAreNumbered)
{
  std::vector<Clash> clashes(20000);
  for (std::size_t i = 0; i < clashes.size(); ++i) clashes[i].distance = static_cast<double>(i);
  nameClashes(clashes, 1.0);
  EXPECT_EQ(clashes[0].id, "C0_0_0");
  EXPECT_EQ(clashes[1].id, "C0_0_0#2");
  EXPECT_EQ(clashes.back().id, "C0_0_0#20000");
}

/// Undecided: whether they collide depends on where the points truly are.
TEST(Clashes, CertainOnesComeBeforeThoseThatCollidePerhaps)
{
  Scan scan({{0, 0, 0, 0.1f}, {50, 0, 0, 0.3f}, {50, 0.5f, 0, 0.2f}, {90, 0, 0, 0.25f}});
  scan.found.flags = test::verdictsOf({2, 1, 2, 2});
  const std::vector<Clash> clashes = scan.clashes();
  ASSERT_EQ(clashes.size(), 3u);
  EXPECT_EQ(clashes[0].low, (Point3{50, 0, 0}));
  EXPECT_TRUE(clashes[0].isCertain());
  EXPECT_EQ(clashes[0].points, 2u);
  EXPECT_EQ(clashes[0].certain_points, 1u);
  EXPECT_EQ(clashes[0].place, (Point3{50, 0.5, 0}));
  EXPECT_EQ(clashes[1].low, (Point3{0, 0, 0})) << "then by distance";
  EXPECT_FALSE(clashes[1].isCertain());
  EXPECT_FALSE(clashes[2].isCertain());
}

TEST(Clashes, TwoThatBecameOnePersist)
{
  const std::vector<Clash> earlier = Scan({{0, 0, 0, 0.1f}, {3, 0, 0, 0.2f}}).clashes();
  std::vector<Clash> clashes = Scan({{0, 0, 0, 0.1f}, {1, 0, 0, 0.1f}, {2, 0, 0, 0.1f}, {3, 0, 0, 0.2f}}).clashes();
  compareWithEarlier(clashes, earlier, 1.0);
  ASSERT_EQ(clashes.size(), 1u) << "neither is resolved";
  EXPECT_EQ(clashes[0].status, ClashStatus::persisting);
}

TEST(Clashes, RefusesWhatMakesNoSense)
{
  Scan scan({{0, 0, 0, 0.1f}});
  for (const double distance : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(scan.clashes(distance), std::invalid_argument);
  }
  scan.found.first_pose.clear();
  EXPECT_THROW(scan.clashes(), std::invalid_argument);
}

TEST(Extent, HoldsAllFinitePointsOfTheView)
{
  const float nan = std::nanf("");
  const std::vector<float> xyz = {nan, 9, 9, 1, -2, 3, 9, 9, nan, -4, 5, 0.5f, 7, 7, 7};
  PointsView view = viewOf(xyz.data(), 4);
  const std::optional<Extent> all = extentOf(view);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->low, (Point3{-4, -2, 0.5}));
  EXPECT_EQ(all->high, (Point3{1, 5, 3}));
  const std::int32_t some[] = {2, 1};
  view.indices = some;
  view.index_count = 2;
  EXPECT_EQ(extentOf(view)->low, (Point3{1, -2, 3})) << "of the subset";
  EXPECT_EQ(extentOf(view)->high, (Point3{1, -2, 3}));
  view.index_count = 1;
  EXPECT_FALSE(extentOf(view)) << "none is finite";
}

TEST(Extent, OfTrianglesHoldsTheirCorners)
{
  const std::vector<double> xyz = {0, 0, 0, 4, 0, 0, 0, 3, -1};
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  const PointsView view = viewOf(TrianglesView{viewOf(xyz.data(), 3), triangles[0].data(), 1});
  EXPECT_EQ(extentOf(view)->low, (Point3{0, 0, -1}));
  EXPECT_EQ(extentOf(view)->high, (Point3{4, 3, 0}));
}

TEST(Extent, IsNearUpToTheDistanceAlongEachAxis)
{
  const Extent box = {{0, 0, 0}, {1, 1, 1}};
  for (std::size_t k = 0; k < 3; ++k)
    for (const double side : {-1.0, 1.0}) {
      Extent other = box;
      other.low[k] += side * 1.5, other.high[k] += side * 1.5;
      EXPECT_TRUE(box.isNear(other, 0.5)) << k << side;
      EXPECT_FALSE(box.isNear(other, 0.499)) << k << side;
    }
}

TEST(Clashes, AreThereNowWhenNewOrPersisting)
{
  EXPECT_TRUE(isPresent(ClashStatus::fresh));
  EXPECT_TRUE(isPresent(ClashStatus::persisting));
  for (const ClashStatus status :
       {ClashStatus::resolved, ClashStatus::not_visited, ClashStatus::not_scanned, ClashStatus::unseen})
    EXPECT_FALSE(isPresent(status)) << nameOf(status);
}

} // namespace
} // namespace pcl_bsh
