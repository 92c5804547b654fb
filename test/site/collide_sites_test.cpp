// SPDX-License-Identifier: BSD-3-Clause
// Questions about two sites have the answers of one hierarchy over all points of each, whatever the tiles and the
// ranks.
#include "float64_cloud.h"
#include "site_questions.h"
#include "support/verdicts.h"
#include "tools/programs/program_run.h"
#include "two_ranks.h"

#include <pcl_bsh/collide.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/site/check_site.h>
#include <pcl_bsh/site/make_site.h>
#include <pcl_bsh/site/site_clashes.h>

#ifdef PCL_BSH_SITE_QUERIES

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <random>
#include <stdexcept>
#include <utility>

namespace pcl_bsh::site {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Cloud = pcl::PCLPointCloud2;
using Points = std::vector<Point3>;

/// A wavy floor with a dense patch, and points that are none.
Points floorOf(std::size_t n, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  Points points;
  for (std::size_t i = 0; i < n; ++i) {
    const double size = i % 2 == 0 ? 10.0 : 0.5, x = size * unit(random), y = size * unit(random);
    points.push_back({x, y, std::sin(x) * std::cos(y)});
  }
  for (std::size_t i = 5; i < n; i += 400) points[i][1] = std::numeric_limits<double>::quiet_NaN();
  return points;
}

/// A lattice, some points of which are there twice.
Points lattice(int side, double shift, double height)
{
  Points points;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (int twice = 0; twice < (i % 3 == 0 ? 2 : 1); ++twice)
        points.push_back({side - i + shift, double(j), height});
  return points;
}

class CollideSites : public testing::Test {
protected:
  /// A site of two sources.
  Site siteOf(const std::string& name, const Points& points, std::uint64_t tile_points)
  {
    const auto half = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 3);
    io::writeCloud(folder / (name + "1.pcd"), float64Cloud({points.begin(), half}));
    io::writeCloud(folder / (name + "2.pcd"), float64Cloud({half, points.end()}));
    MakeOptions options;
    options.tile_points = tile_points;
    return makeSite({folder / (name + "1.pcd"), folder / (name + "2.pcd")}, folder / (name + std::to_string(places++)),
                    options);
  }

  /// The place of a tile's point among all.
  static std::size_t placeOf(const Cloud& cloud, std::uint32_t i, const Points& points)
  {
    return placeOf({static_cast<std::uint32_t>(io::valueOf(cloud, i, "source")),
                    static_cast<std::uint32_t>(io::valueOf(cloud, i, "record"))},
                   points);
  }
  static std::size_t placeOf(const SitePoint& point, const Points& points)
  {
    return point.record + (point.source == 0 ? 0 : points.size() / 3);
  }

  void expectSamePassage(const Points& a, const Points& b, const std::vector<Eigen::Isometry3d>& poses,
                         double clearance, double uncertainty);

  /// Compares all questions with those of one hierarchy for each, for several tilings of both.
  void expectSameAnswers(const Points& a, const Points& b, const Eigen::Isometry3d& pose, double clearance,
                         double uncertainty_a = 0.0, double uncertainty_b = 0.0)
  {
    PointsView view_a = viewOf(a.front().data(), a.size()), view_b = viewOf(b.front().data(), b.size());
    const SphereHierarchy measured_a(view_a), measured_b(view_b);
    view_a.uncertainty = uncertainty_a;
    view_b.uncertainty = uncertainty_b;
    const SphereHierarchy all_a(view_a), all_b(view_b);
    FlagsRequest wanted;
    wanted.clearance = clearance;
    wanted.flagged = Flagged::both;
    const FlagsResult flags = pcl_bsh::collisionFlags({all_a}, {all_b, pose}, wanted);
    const AnyResult any = pcl_bsh::anyCollision({all_a}, {all_b, pose}, {clearance, 1});
    const DistanceResult nearest = pcl_bsh::closestPair({measured_a}, {measured_b, pose});
    const std::uint64_t tilings[][2] = {{100000, 100000}, {300, 70}, {30, 900}};
    for (const auto& tiling : tilings) {
      SCOPED_TRACE(std::to_string(tiling[0]) + " and " + std::to_string(tiling[1]));
      const Site site = siteOf("a", a, tiling[0]), other = siteOf("b", b, tiling[1]);
      Uncertainty of_b;
      of_b.length = uncertainty_b;
      const StandingSite placed{other, pose, of_b};
      SiteQuestion request;
      request.clearance = clearance;
      request.uncertainty.length = uncertainty_a;
      EXPECT_EQ(anyCollision(site, placed, request).any.verdict, any.verdict);

      const auto expectFlags = [&](bool of_b, const Points& points, const std::vector<Verdict>& right,
                                   std::size_t colliding, std::size_t undecided) {
        std::vector<Verdict> found(points.size(), Verdict::free);
        const auto put = [&](const Tile&, const Cloud& cloud, const Answer& result) {
          const std::vector<Verdict>& of_tile = of_b ? result.obstacle_flags : result.collisions.flags;
          for (std::uint32_t i = 0; i < cloud.width; ++i) found[placeOf(cloud, i, points)] = of_tile[i];
        };
        const SiteAnswer of_sites =
            of_b ? collisionFlagsOfB(site, placed, request, put) : collisionFlags(site, placed, request, put);
        EXPECT_EQ(found, right);
        EXPECT_EQ(of_b ? of_sites.obstacle_colliding : of_sites.collisions.colliding, colliding);
        EXPECT_EQ(of_b ? of_sites.obstacle_undecided : of_sites.collisions.undecided, undecided);
        const TilesRead &once = of_b ? of_sites.obstacle_tiles : of_sites.tiles,
                        &others = of_b ? of_sites.tiles : of_sites.obstacle_tiles;
        EXPECT_EQ(once.read, once.needed);
        EXPECT_GE(others.read, others.needed);
      };
      expectFlags(false, a, flags.a, flags.colliding_a, flags.undecided_a);
      expectFlags(true, b, flags.b, flags.colliding_b, flags.undecided_b);

      const SiteAnswer closest = closestPair(site, placed, request);
      EXPECT_EQ(closest.closest.distance, nearest.distance);
      EXPECT_EQ(closest.closest.interval.lower, nearest.interval.lower);
      EXPECT_EQ(closest.closest.interval.upper, nearest.interval.upper);
      ASSERT_TRUE(closest.pair);
      EXPECT_EQ(placeOf(closest.pair->a, a), nearest.pair->a);
      EXPECT_EQ(placeOf(closest.pair->b, b), nearest.pair->b);

      for (const double most : {std::numeric_limits<double>::infinity(), 1.5 * clearance}) {
        PointDistancesRequest near;
        near.max_distance = most;
        const PointDistances right = pcl_bsh::pointDistances({measured_a}, {measured_b, pose}, near);
        std::vector<double> found(a.size(), std::numeric_limits<double>::quiet_NaN());
        const SiteAnswer distances =
            pointDistances(site, placed, most, request, [&](const Tile&, const Cloud& cloud, const Answer& of_tile) {
              for (std::uint32_t i = 0; i < cloud.width; ++i)
                found[placeOf(cloud, i, a)] = of_tile.distances.a.distance[i];
            });
        for (std::size_t i = 0; i < a.size(); ++i) {
          EXPECT_TRUE(found[i] == right.distance[i] || (std::isnan(found[i]) && std::isnan(right.distance[i])))
              << i << ": " << found[i] << ", " << right.distance[i];
        }
        EXPECT_EQ(distances.distances.a.measured, right.measured);
        EXPECT_TRUE(distances.distances.a.greatest == right.greatest ||
                    (std::isnan(right.greatest) && distances.distances.a.measured == 0));
      }
    }
  }

  files::TemporaryFolder folder;
  int places = 0; ///< sites made
};

TEST_F(CollideSites, RandomPointsAtAPose)
{
  Eigen::Isometry3d pose =
      Eigen::Translation3d(0.4, -0.3, 0.1) * Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 30).normalized());
  expectSameAnswers(floorOf(2500, 1), floorOf(1500, 2), pose, 0.07);
  expectSameAnswers(floorOf(900, 3), floorOf(2500, 4), Eigen::Isometry3d(Eigen::Translation3d(3, 2, 0.2)), 0.2);
}

TEST_F(CollideSites, PointsThatAreUncertain)
{
  expectSameAnswers(floorOf(1500, 1), floorOf(1500, 2), Eigen::Isometry3d::Identity(), 0.05, 0.02, 0.01);
}

/// Each point is at the clearance of some other, and each distance is one of many.
TEST_F(CollideSites, Ties)
{
  expectSameAnswers(lattice(20, 0.0, 0.0), lattice(20, 0.0, 3.0), Eigen::Isometry3d::Identity(), 3.0);
  const Eigen::Isometry3d far(Eigen::Translation3d(600000.25, 0, 0));
  expectSameAnswers(lattice(20, 600000.25, 0.0), lattice(20, 0.0, 3.0), far, 3.0);
}

/// Distances differ by less than a double tells: exact arithmetic chooses among the tiles.
TEST_F(CollideSites, NearTies)
{
  Points a, b;
  const double least = std::numeric_limits<double>::denorm_min();
  for (int i = 0; i < 120; ++i) {
    a.push_back({10.0 * i, i == 90 ? 0.0 : (i + 1) * 1e-30 + least, 1.0});
    b.push_back({10.0 * i, 0.0, 0.0});
  }
  expectSameAnswers(a, b, Eigen::Isometry3d::Identity(), 1.0);
}

/// Compares the site b along a path with one hierarchy for each, for several tilings of both.
void CollideSites::expectSamePassage(const Points& a, const Points& b, const std::vector<Eigen::Isometry3d>& poses,
                                     double clearance, double uncertainty)
{
  PointsView view_a = viewOf(a.front().data(), a.size()), view_b = viewOf(b.front().data(), b.size());
  view_a.uncertainty = view_b.uncertainty = uncertainty;
  const SphereHierarchy all_a(view_a), all_b(view_b);
  TrajectoryRequest wanted;
  wanted.clearance = clearance;
  wanted.distances = wanted.first_poses = wanted.closest_poses = wanted.pose_summaries = true;
  const TrajectoryResult right = pcl_bsh::collideAlong({all_a}, all_b, poses, wanted);
  EXPECT_GT(right.colliding + right.undecided, 20u);
  const std::uint64_t tilings[][2] = {{100000, 100000}, {300, 70}, {30, 900}};
  for (const auto& tiling : tilings) {
    SCOPED_TRACE(std::to_string(tiling[0]) + " and " + std::to_string(tiling[1]));
    const Site site = siteOf("a", a, tiling[0]), other = siteOf("b", b, tiling[1]);
    SiteQuestion request;
    request.clearance = clearance;
    request.uncertainty.length = uncertainty;
    request.wanted.poses = true;
    TrajectoryResult found = right;
    std::fill(found.flags.begin(), found.flags.end(), Verdict::free);
    std::fill(found.distance.begin(), found.distance.end(), std::numeric_limits<float>::quiet_NaN());
    std::fill(found.first_pose.begin(), found.first_pose.end(), -1);
    std::fill(found.closest_pose.begin(), found.closest_pose.end(), -1);
    const SiteAnswer passage = collideAlong(site, other, request.uncertainty, poses, request,
                                            [&](const Tile&, const Cloud& cloud, const Answer& result) {
                                              for (std::uint32_t i = 0; i < cloud.width; ++i) {
                                                const std::size_t place = placeOf(cloud, i, a);
                                                found.flags[place] = result.collisions.flags[i];
                                                found.distance[place] = result.collisions.distance[i];
                                                found.first_pose[place] = result.collisions.first_pose[i];
                                                found.closest_pose[place] = result.collisions.closest_pose[i];
                                              }
                                            });
    EXPECT_EQ(found.flags, right.flags);
    EXPECT_EQ(found.first_pose, right.first_pose);
    EXPECT_EQ(found.closest_pose, right.closest_pose);
    EXPECT_THAT(found.distance, testing::Pointwise(testing::NanSensitiveFloatEq(), right.distance));
    EXPECT_EQ(passage.collisions.colliding, right.colliding);
    EXPECT_EQ(passage.collisions.undecided, right.undecided);
    float least = std::numeric_limits<float>::infinity();
    for (const float distance : right.distance) least = std::fmin(least, distance);
    EXPECT_EQ(passage.closest.distance, double{least});
    std::int32_t first = -1;
    for (const std::int32_t pose : right.first_pose)
      if (pose >= 0 && (first < 0 || pose < first)) first = pose;
    EXPECT_EQ(passage.first_pose, std::optional<std::size_t>(first));
    EXPECT_EQ(passage.tiles.read, passage.tiles.needed);
    ASSERT_EQ(passage.collisions.poses.size(), right.poses.size());
    for (std::size_t k = 0; k < poses.size(); ++k) {
      SCOPED_TRACE(k);
      EXPECT_EQ(passage.collisions.poses[k].colliding, right.poses[k].colliding);
      EXPECT_EQ(passage.collisions.poses[k].colliding_points, right.poses[k].colliding_points);
      EXPECT_EQ(passage.collisions.poses[k].undecided_points, right.poses[k].undecided_points);
      EXPECT_EQ(passage.collisions.poses[k].distance, right.poses[k].distance);
    }
  }
}

std::vector<Eigen::Isometry3d> pathOver(std::size_t count, double step, double turn, double height)
{
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t k = 0; k < count; ++k) {
    const double way = step * static_cast<double>(k);
    poses.push_back(Eigen::Translation3d(way - 4, 0.3 * way, height) *
                    Eigen::AngleAxisd(turn * way, Eigen::Vector3d(0.2, 0.1, 1).normalized()));
  }
  return poses;
}

TEST_F(CollideSites, AlongAPath)
{
  Points body = floorOf(500, 14);
  for (Point3& p : body) p = {0.2 * p[0], 0.2 * p[1], 0.2 * p[2]};
  expectSamePassage(floorOf(2000, 13), body, pathOver(25, 0.3, 0.2, 0.4), 0.3, 0.0);
  expectSamePassage(floorOf(2000, 13), body, pathOver(25, 0.3, 0.2, 0.4), 0.3, 0.02);
  expectSamePassage(floorOf(2000, 15), body, pathOver(1, 0.0, 0.0, 0.1), 0.5, 0.0);
}

/// A row passes another one: each point is as near to all tiles of the body, one pose after another. Where the height
/// differs by less than a float tells, exact arithmetic chooses the pose.
TEST_F(CollideSites, AlongAPathOfTies)
{
  Points row, body;
  for (int i = 0; i < 90; ++i) row.push_back({double(i), 0, 0});
  for (int i = 0; i < 75; ++i) body.push_back({double(i), 0, 0});
  for (const double differs : {0.0, 1e-9, -1e-9}) {
    std::vector<Eigen::Isometry3d> poses;
    for (int k = 0; k < 40; ++k)
      poses.push_back(Eigen::Isometry3d(Eigen::Translation3d(k - 20, 0, 1.0 + differs * (k * 7 % 40))));
    expectSamePassage(row, body, poses, 1.25, 0.0);
  }
}

/// At one pose two tiles of the body are as near: the smaller point counts, whichever tile comes first.
TEST_F(CollideSites, OfTilesAsNearTheSmallerPointCounts)
{
  const Points row = {{0, 0, 0}};
  for (const double side : {-1.0, 1.0}) {
    Points body;
    for (int k = 0; k < 2; ++k)
      for (int i = 0; i < 40; ++i) body.push_back({(k == 0 ? side : -side) * (1.0 + 0.1 * i), 0, 0});
    const Site site = siteOf("a", row, 100), other = siteOf("b", body, 40);
    ASSERT_GT(other.tiles.size(), 1U);
    SiteQuestion request;
    request.clearance = 1.0;
    ClashFinder finder(site, 1.0);
    request.clashes = &finder;
    const SiteAnswer passage = collideAlong(site, other, {}, {Eigen::Isometry3d::Identity()}, request);
    EXPECT_EQ(passage.collisions.colliding, 1U);
    const SiteClashes found = finder.finish();
    ASSERT_EQ(found.clashes.size(), 1U);
    const MetPoint& met = found.met.at(found.clashes[0].model_point);
    EXPECT_EQ(met.point, (SitePoint{0, 0})) << side;
    EXPECT_EQ(met.place, body[0]) << side;
  }
}

/// Without distances flags alone are joined; and a site of nothing meets nothing.
TEST_F(CollideSites, AlongAPathWithoutDistances)
{
  const Points a = floorOf(400, 20), body = floorOf(100, 21);
  const Site site = siteOf("a", a, 60), other = siteOf("b", body, 30), none = siteOf("c", {}, 30);
  const std::vector<Eigen::Isometry3d> poses = pathOver(3, 1.5, 0.3, 0.3);
  SiteQuestion request;
  request.clearance = 0.3;
  request.accuracy = Accuracy::parse("level=2");
  const SphereHierarchy all(viewOf(a.front().data(), a.size())), model(viewOf(body.front().data(), body.size()));
  TrajectoryRequest exact;
  exact.clearance = 0.3;
  const std::vector<Verdict> truth = pcl_bsh::collideAlong({all}, model, poses, exact).flags;
  std::vector<Verdict> found(a.size(), Verdict::free);
  const SiteAnswer passage =
      collideAlong(site, other, {}, poses, request, [&](const Tile&, const Cloud& cloud, const Answer& result) {
        EXPECT_TRUE(result.collisions.distance.empty());
        EXPECT_TRUE(result.collisions.closest_point.empty());
        for (std::uint32_t i = 0; i < cloud.width; ++i) found[placeOf(cloud, i, a)] = result.collisions.flags[i];
      });
  EXPECT_GT(passage.collisions.colliding + passage.collisions.undecided, 0U);
  EXPECT_TRUE(std::isinf(passage.closest.distance));
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(truth[i] == Verdict::free || found[i] != Verdict::free) << i;
  request.accuracy = {};
  EXPECT_EQ(collideAlong(none, other, {}, poses, request).collisions.colliding, 0U);
  EXPECT_EQ(collideAlong(site, none, {}, poses, request).collisions.colliding, 0U);
  EXPECT_EQ(collideAlong(none, model, poses, request).collisions.colliding, 0U);
}

TEST_F(CollideSites, AlongAPathOfSweptMotion)
{
  Points body = floorOf(300, 16);
  for (Point3& p : body) p = {0.1 * p[0], 0.1 * p[1], 0.1 * p[2]};
  const Points a = floorOf(1500, 17);
  const std::vector<Eigen::Isometry3d> poses = pathOver(6, 1.5, 0.3, 0.3);
  const SphereHierarchy all_a(viewOf(a.front().data(), a.size())), all_b(viewOf(body.front().data(), body.size()));
  const Site site = siteOf("a", a, 200), other = siteOf("b", body, 60);
  SiteQuestion request;
  request.clearance = 0.2;
  request.swept = 0.05;
  TrajectoryRequest wanted;
  wanted.clearance = *request.clearance;
  wanted.swept = 1e-4; // as good as exact here
  const std::vector<Verdict> least = pcl_bsh::collideAlong({all_a}, all_b, poses, wanted).flags;
  wanted.clearance += request.swept;
  const std::vector<Verdict> most = pcl_bsh::collideAlong({all_a}, all_b, poses, wanted).flags;
  std::vector<Verdict> found(a.size(), Verdict::free);
  const SiteAnswer passage =
      collideAlong(site, other, {}, poses, request, [&](const Tile&, const Cloud& cloud, const Answer& result) {
        for (std::uint32_t i = 0; i < cloud.width; ++i) found[placeOf(cloud, i, a)] = result.collisions.flags[i];
      });
  EXPECT_GT(passage.collisions.colliding, 20u);
  ASSERT_TRUE(passage.collisions.first_contact);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LE(least[i], found[i]) << i;
    EXPECT_LE(found[i], most[i]) << i;
  }
  request.wanted.poses = true;
  EXPECT_THROW(collideAlong(site, other, {}, poses, request), std::invalid_argument);
  request.wanted.poses = false;
  request.clearance = -1.0;
  EXPECT_THROW(collideAlong(site, other, {}, poses, request), std::invalid_argument);
}

TEST_F(CollideSites, ASiteAgainstItself)
{
  const Points points = floorOf(1200, 5);
  const Site site = siteOf("a", points, 100);
  SiteQuestion request;
  const SiteAnswer flags = collisionFlags(site, {site}, request);
  EXPECT_EQ(flags.collisions.colliding, points.size() - 3) << "three are not finite";
  EXPECT_EQ(pointDistances(site, {site}, 1.0, request).distances.a.greatest, 0.0);
}

TEST_F(CollideSites, ReadOnlyTilesThatMatter)
{
  const Site site = siteOf("a", floorOf(2000, 6), 50), other = siteOf("b", floorOf(2000, 7), 50);
  SiteQuestion request;
  request.clearance = 0.1;
  const SiteAnswer aside = collisionFlags(site, {other, Eigen::Isometry3d(Eigen::Translation3d(19, 0, 0))}, request);
  EXPECT_LT(aside.tiles.needed, aside.tiles.tiles / 2);
  EXPECT_LT(aside.obstacle_tiles.needed, aside.obstacle_tiles.tiles / 2);
  EXPECT_EQ(aside.obstacle_tiles.read, aside.obstacle_tiles.needed) << "all that was read is kept";
  const SiteAnswer far = collisionFlags(site, {other, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 50))}, request);
  EXPECT_EQ(far.tiles.read + far.obstacle_tiles.read, 0u);
  EXPECT_LT(closestPair(site, {other, Eigen::Isometry3d(Eigen::Translation3d(25, 0, 0))}, request).tiles.read, 20u);
  // Where memory holds a tile of each alone, tiles are read for each that they come near to.
  request.memory = 2 * 50 * (3 * 8 + 8 + 64);
  const SiteAnswer small = collisionFlags(site, {other}, request);
  EXPECT_GT(small.obstacle_tiles.read, small.obstacle_tiles.needed);
  request.memory = 2 * 50 * (3 * 8 + 8 + 64) - 1000;
  EXPECT_THROW(collisionFlags(site, {other}, request), std::invalid_argument);
  // A tile that is damaged is not "free".
  for (const Tile& tile : other.tiles) std::ofstream(other.folder / tile.file) << "damaged";
  EXPECT_THROW(collisionFlags(site, {other}, {}), std::runtime_error);
}

TEST_F(CollideSites, TellTheirProgressAndStop)
{
  const Site site = siteOf("a", floorOf(1000, 6), 50), other = siteOf("b", floorOf(1000, 7), 300);
  SiteQuestion request;
  request.clearance = 0.1;
  std::vector<double> told;
  request.progress = [&](double done) {
    told.push_back(done);
    return true;
  };
  const SiteAnswer flags = collisionFlags(site, {other}, request);
  ASSERT_EQ(told.size(), flags.tiles.needed);
  EXPECT_EQ(told.front(), 1.0 / static_cast<double>(flags.tiles.needed));
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1.0);
  const double third = 3.0 / static_cast<double>(flags.tiles.needed);
  request.progress = [third](double done) { return done < third; };
  EXPECT_THROW(collisionFlags(site, {other}, request), Cancelled);
  EXPECT_THROW(pointDistances(site, {other}, 1.0, request), Cancelled);
}

TEST_F(CollideSites, APathPastEverythingHasNoDistanceAndNoContact)
{
  const Site site = siteOf("a", floorOf(300, 8), 50), other = siteOf("b", lattice(4, 0.0, 0.0), 1000);
  std::vector<Eigen::Isometry3d> poses(2, Eigen::Isometry3d::Identity());
  poses[0].translation().z() = 4.0;
  poses[1].translation().z() = 5.0;
  const Point3 origin = {0, 0, 0};
  const SphereHierarchy model(viewOf(origin.data(), 1));
  SiteQuestion request;
  request.clearance = 0.25;
  request.swept = 1e-3;
  for (const SiteAnswer& passage :
       {collideAlong(site, model, poses, request), collideAlong(site, other, {}, poses, request)}) {
    EXPECT_EQ(passage.collisions.colliding, 0u);
    EXPECT_TRUE(std::isinf(passage.closest.distance));
    EXPECT_FALSE(passage.first_pose);
    EXPECT_FALSE(passage.collisions.first_contact);
    EXPECT_FALSE(passage.collisions.certain_contact);
  }
}

/// Tiles that follow each other are asked about in runs: of one that fails the next hides nothing.
TEST_F(CollideSites, AFailureEndsTheVisit)
{
  const Points a = floorOf(900, 5), b = lattice(6, 0.0, 0.0);
  const Site site = siteOf("a", a, 30), other = siteOf("b", b, 1000);
  SiteQuestion request;
  request.clearance = 20.0;
  int asked = 0;
  const auto fail_once = [&](const Tile&, const Cloud&, const Answer&) {
    if (asked++ == 0) throw std::length_error("the first tile");
  };
  EXPECT_THROW(collideAlong(site, other, {}, {Eigen::Isometry3d::Identity()}, request, fail_once), std::length_error);
  EXPECT_EQ(asked, 1);
  asked = 1;
  EXPECT_NO_THROW(collideAlong(site, other, {}, {Eigen::Isometry3d::Identity()}, request, fail_once));
  EXPECT_GE(asked, 8) << "runs of several tiles";
}

TEST_F(CollideSites, RefuseWhatOneHierarchyWouldRefuse)
{
  const Site site = siteOf("a", floorOf(100, 8), 50), other = siteOf("b", floorOf(100, 9), 50);
  const Eigen::Isometry3d far(Eigen::Translation3d(0, 0, 1000));
  Eigen::Isometry3d crooked = far;
  crooked.linear() *= 1.5;
  SiteQuestion negative, sigmas, level;
  negative.clearance = -1.0;
  sigmas.uncertainty.field = "sigma";
  level.accuracy = Accuracy::level(2);
  EXPECT_THROW(anyCollision(site, {other, far}, negative), std::invalid_argument);
  EXPECT_THROW(collisionFlags(site, {other, far}, negative), std::invalid_argument);
  EXPECT_THROW(collisionFlagsOfB(site, {other, crooked}, {}), std::invalid_argument);
  EXPECT_THROW(closestPair(site, {other, crooked}, {}), std::invalid_argument);
  EXPECT_THROW(pointDistances(site, {other, far}, -1.0, {}), std::invalid_argument);
  EXPECT_THROW(pointDistances(site, {other, far}, 1.0, level), std::invalid_argument);
  EXPECT_THROW(collisionFlags(site, {other, far}, sigmas), std::invalid_argument);
  EXPECT_THROW(collisionFlags(site, {other, far, sigmas.uncertainty}, {}), std::invalid_argument);
}

/// The program.
class SitePairProgram : public CollideSites {
protected:
  SitePairProgram()
  {
    fs::rename(siteOf("a", a, 120).folder, folder / "now");
    fs::rename(siteOf("b", b, 200).folder, folder / "before");
  }

  Outcome collide(const std::string& arguments)
  {
    return run("pcl_bsh_site", "collide now before " + arguments, folder.path());
  }

  /// The numbers of a field of a site, by the places of its points among all.
  std::vector<double> valuesOf(const std::string& site, const std::string& field, const Points& points)
  {
    const Site found = readSite(folder / site);
    checkSite(found);
    std::vector<double> values(points.size(), -7.0);
    for (const Tile& tile : found.tiles) {
      const Cloud cloud = readTile(found, tile);
      for (std::uint32_t i = 0; i < cloud.width; ++i) values[placeOf(cloud, i, points)] = io::valueOf(cloud, i, field);
    }
    return values;
  }

  const Points a = floorOf(1500, 10), b = floorOf(1200, 11);
  static constexpr auto poses_text = "1 0 0 0 0 1 0 0 0 0 1 0.5\n1 0 0 0 0 1 0 0 0 0 1 0.25\n1 0 0 0 0 1 0 0 0 0 1 0\n";
};

TEST_F(SitePairProgram, WritesWhatCollidesOfBoth)
{
  const SphereHierarchy of_a(viewOf(a.front().data(), a.size())), of_b(viewOf(b.front().data(), b.size()));
  const Eigen::Isometry3d pose(Eigen::Translation3d(0.1, 0, 0));
  FlagsRequest wanted;
  wanted.clearance = 0.08;
  wanted.flagged = Flagged::both;
  const FlagsResult right = pcl_bsh::collisionFlags({of_a}, {of_b, pose}, wanted);
  const std::string asked =
      "--clearance 0.08 --pose 0.1,0,0,0,0,0 --out now_found --obstacle-out before_found --report r.json";
  const Outcome outcome = collide(asked);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(valuesOf("now_found", "collision", a),
            std::vector<double>(bytesOf(right.a), bytesOf(right.a) + right.a.size()));
  EXPECT_EQ(valuesOf("before_found", "collision", b),
            std::vector<double>(bytesOf(right.b), bytesOf(right.b) + right.b.size()));
  const std::string report = files::contentOf(folder / "r.json");
  EXPECT_THAT(report, HasSubstr("\"colliding\": " + std::to_string(right.colliding_a) + ","));
  EXPECT_THAT(report, HasSubstr("\"colliding_of_obstacle\": " + std::to_string(right.colliding_b) + ","));
  EXPECT_THAT(report, HasSubstr("\"tiles_of_obstacle\""));

  const Outcome again = collide(asked);
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.err, HasSubstr("now_found"));
  ASSERT_EQ(collide("--distances --max-distance 0.5 --out distances").exit_code, 0);
  PointDistancesRequest near;
  near.max_distance = 0.5;
  const PointDistances distances = pcl_bsh::pointDistances({of_a}, {of_b}, near);
  const std::vector<double> found = valuesOf("distances", "distance", a);
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_TRUE(std::isnan(found[i]) ? std::isnan(distances.distance[i])
                                     : found[i] == double{static_cast<float>(distances.distance[i])})
        << i;
}

TEST_F(SitePairProgram, WritesWhatCollidesAlongAPath)
{
  std::ofstream(folder / "poses.txt") << poses_text;
  const Outcome outcome = collide("--clearance 0.05 --trajectory poses.txt --out found --report r.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const SphereHierarchy of_a(viewOf(a.front().data(), a.size())), of_b(viewOf(b.front().data(), b.size()));
  std::vector<Eigen::Isometry3d> poses(3, Eigen::Isometry3d::Identity());
  for (std::size_t k = 0; k < 3; ++k) poses[k].translation().z() = 0.25 * static_cast<double>(2 - k);
  TrajectoryRequest wanted;
  wanted.clearance = 0.05;
  wanted.distances = wanted.first_poses = wanted.closest_poses = true;
  const TrajectoryResult right = pcl_bsh::collideAlong({of_a}, of_b, poses, wanted);
  EXPECT_EQ(valuesOf("found", "collision", a),
            std::vector<double>(bytesOf(right.flags), bytesOf(right.flags) + right.flags.size()));
  EXPECT_EQ(valuesOf("found", "first_pose", a), std::vector<double>(right.first_pose.begin(), right.first_pose.end()));
  EXPECT_EQ(valuesOf("found", "closest_pose", a),
            std::vector<double>(right.closest_pose.begin(), right.closest_pose.end()));
  const std::string report = files::contentOf(folder / "r.json");
  EXPECT_THAT(report, HasSubstr("\"poses\": 3,"));
  EXPECT_THAT(report, HasSubstr("\"colliding\": " + std::to_string(right.colliding) + ","));
  EXPECT_THAT(report, HasSubstr("\"tiles_of_obstacle\""));
}

TEST_F(SitePairProgram, SaysTheSameOnTwoRanks)
{
  if (!hasMpirun()) GTEST_SKIP() << "no mpirun";
  std::ofstream(folder / "poses.txt") << poses_text;
  for (const std::string question :
       {"--clearance 0.05 --out found --obstacle-out before_found", "--closest", "--any --clearance 0.001",
        "--distances --out found", "--clearance 0.05 --trajectory poses.txt --out found"}) {
    const Outcome one = collide(question + " --report report.json");
    ASSERT_EQ(one.exit_code, 0) << one.err;
    fs::create_directory(folder / "one");
    for (const char* name : {"report.json", "found", "before_found"})
      if (fs::exists(folder / name)) fs::rename(folder / name, folder / "one" / name);
    const Outcome two = runOnTwoRanks("collide now before " + question + " --report report.json", folder.path());
    ASSERT_EQ(two.exit_code, 0) << two.err;
    const auto answerOf = [&](const fs::path& report) { // what was read depends on who read it
      const std::string text = files::contentOf(report);
      return text.substr(0, text.find("\"tiles\""));
    };
    EXPECT_EQ(answerOf(folder / "report.json"), answerOf(folder / "one" / "report.json")) << question;
    for (const auto& entry : fs::recursive_directory_iterator(folder / "one")) {
      const fs::path name = fs::relative(entry.path(), folder / "one");
      if (!entry.is_regular_file() || name == "report.json") continue;
      EXPECT_TRUE(files::contentOf(entry.path()) == files::contentOf(folder / name)) << question << name;
    }
    for (const char* name : {"one", "report.json", "found", "before_found"}) fs::remove_all(folder / name);
  }
}

TEST_F(SitePairProgram, RefusesInOneLine)
{
  const auto expectRefused = [&](const std::string& arguments, int exit_code, const std::string& line) {
    const Outcome outcome = collide(arguments);
    EXPECT_EQ(outcome.exit_code, exit_code) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(line)) << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  };
  expectRefused("--clearance 0.1 --clashes c.txt", 2, "unknown extension");
  expectRefused("--clearance 0.1 --report before/r.json", 2, "lies in the folder of OBSTACLE");
  expectRefused("--clearance 0.1 --obstacle-out before/found", 2, "lies in the folder of OBSTACLE");
  fs::create_directory(folder / "mine");
  std::ofstream(folder / "mine" / "notes.txt") << "mine";
  expectRefused("--clearance 0.1 --obstacle-out mine", 1, "mine");
  EXPECT_EQ(files::contentOf(folder / "mine" / "notes.txt"), "mine");
  fs::remove(folder / "before" / "site.json");
  expectRefused("--clearance 0.1 --report r.json", 1, "before");
  EXPECT_FALSE(fs::exists(folder / "r.json"));
}

} // namespace
} // namespace pcl_bsh::site
#endif
