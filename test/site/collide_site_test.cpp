// SPDX-License-Identifier: BSD-3-Clause
// Questions about a site have the answers of one hierarchy over all its points, whatever the tiles and the ranks.
#include "float64_cloud.h"
#include "site_questions.h"
#include "support/verdicts.h"
#include "tools/programs/program_run.h"
#include "two_ranks.h"

#include <pcl_bsh/collide.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/make_site.h>

#ifdef PCL_BSH_SITE_QUERIES

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <utility>

namespace pcl_bsh::site {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Cloud = pcl::PCLPointCloud2;

struct Scene {
  std::vector<Point3> a, b;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  double clearance = 0.0;
};

/// A wavy floor with a dense patch, and something above it.
Scene randomScene(unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  Scene scene;
  for (int i = 0; i < 6000; ++i) {
    const double size = i % 2 == 0 ? 20.0 : 0.5;
    const double x = size * unit(random), y = size * unit(random);
    scene.a.push_back({x, y, std::sin(x) * std::cos(y)});
  }
  for (int i = 0; i < 500; ++i) scene.b.push_back({unit(random), unit(random), 0.3 * unit(random)});
  scene.pose = Eigen::Translation3d(3, -2, 0.7) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  scene.clearance = 0.2;
  scene.a[17][1] = std::numeric_limits<double>::quiet_NaN();
  return scene;
}

/// Everything is a tie: points of a lattice, many of them twice, at distances that are equal or nearly so.
Scene latticeScene(double shift)
{
  Scene scene;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j)
      for (int twice = 0; twice < 2; ++twice) scene.a.push_back({double(11 - i) + shift, double(j), 0});
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j) scene.b.push_back({double(j) + shift, double(i), 3});
  scene.clearance = 3.0;
  return scene;
}

/// Everything is nearly a tie: distances differ by less than a double tells.
Scene nearTieScene()
{
  Scene scene;
  const double least = std::numeric_limits<double>::denorm_min();
  for (int i = 0; i < 200; ++i) scene.a.push_back({10.0 * i, i == 150 ? 0.0 : (i + 1) * 1e-30 + least, 1.0});
  for (int i = 0; i < 200; ++i) scene.b.push_back({10.0 * i, 0.0, 0.0});
  scene.clearance = 1.0;
  return scene;
}

/// The answers as numbers by (source, record), from tiles or from memory.
using Answers = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<double>>;

class CollideSite : public testing::Test {
protected:
  /// Compares all questions with those of one hierarchy, for several tilings. The site has two sources.
  void expectSameAnswers(const Scene& scene)
  {
    const std::size_t half = scene.a.size() / 3;
    io::writeCloud(folder / "1.pcd",
                   float64Cloud({scene.a.begin(), scene.a.begin() + static_cast<std::ptrdiff_t>(half)}));
    io::writeCloud(folder / "2.pcd",
                   float64Cloud({scene.a.begin() + static_cast<std::ptrdiff_t>(half), scene.a.end()}));
    const SphereHierarchy all(viewOf(scene.a.front().data(), scene.a.size()));
    const SphereHierarchy other(viewOf(scene.b.front().data(), scene.b.size()));
    const Placed b(other, scene.pose);
    const auto nameOf = [&](std::size_t i) {
      return std::pair{i < half ? 0u : 1u, static_cast<std::uint32_t>(i < half ? i : i - half)};
    };
    for (const std::uint64_t tile_points : {100000u, 700u, 40u}) {
      SCOPED_TRACE(tile_points);
      MakeOptions options;
      options.tile_points = tile_points;
      const Site site = makeSite({folder / "1.pcd", folder / "2.pcd"}, folder / std::to_string(places++), options);
      SiteQuestion request;
      request.clearance = scene.clearance;

      EXPECT_EQ(anyCollision(site, b, request).any.verdict,
                pcl_bsh::anyCollision({all}, b, {scene.clearance, 1}).verdict);

      FlagsRequest flags_request;
      flags_request.clearance = scene.clearance;
      flags_request.flagged = Flagged::both;
      const FlagsResult flags = pcl_bsh::collisionFlags({all}, b, flags_request);
      Answers found;
      const SiteAnswer of_site =
          collisionFlags(site, b, Flagged::both, request, [&](const Tile&, const Cloud& cloud, const Answer& result) {
            for (std::uint32_t i = 0; i < cloud.width; ++i)
              found[name(cloud, i)] = {static_cast<double>(result.collisions.flags[i])};
          });
      EXPECT_EQ(of_site.collisions.colliding, flags.colliding_a);
      EXPECT_EQ(of_site.obstacle_flags, flags.b);
      EXPECT_LE(of_site.tiles.read, of_site.tiles.needed);
      for (std::size_t i = 0; i < scene.a.size(); ++i)
        EXPECT_EQ(found.count(nameOf(i)) != 0 ? found[nameOf(i)][0] : 0, static_cast<double>(flags.a[i])) << i;

      const DistanceResult nearest = pcl_bsh::closestPair({all}, b);
      const SiteAnswer of_closest = closestPair(site, b, request);
      EXPECT_EQ(of_closest.closest.distance, nearest.distance);
      ASSERT_TRUE(of_closest.pair);
      EXPECT_EQ(std::pair(of_closest.pair->a.source, of_closest.pair->a.record), nameOf(nearest.pair->a));
      EXPECT_EQ(of_closest.pair->b.record, nearest.pair->b);

      for (const double most : {std::numeric_limits<double>::infinity(), 2 * scene.clearance}) {
        PointDistancesRequest distances_request;
        distances_request.max_distance = most;
        const PointDistances distances = pcl_bsh::pointDistances({all}, b, distances_request);
        found.clear();
        const SiteAnswer of_distances =
            pointDistances(site, b, most, request, [&](const Tile&, const Cloud& cloud, const Answer& result) {
              for (std::uint32_t i = 0; i < cloud.width; ++i)
                found[name(cloud, i)] = {result.distances.a.distance[i], double(result.distances.a.closest_point[i])};
            });
        EXPECT_EQ(of_distances.distances.a.measured, distances.measured);
        EXPECT_EQ(of_distances.distances.a.greatest, distances.greatest);
        for (std::size_t i = 0; i < scene.a.size(); ++i) {
          if (std::isnan(distances.distance[i])) continue;
          ASSERT_EQ(found.count(nameOf(i)), 1U) << i;
          EXPECT_EQ(found[nameOf(i)], (std::vector<double>{distances.distance[i], double(distances.closest_point[i])}))
              << i;
        }
      }

      std::vector<Eigen::Isometry3d> poses;
      for (int k = 0; k < 20; ++k) poses.push_back(Eigen::Translation3d(0.3 * k, 0.1 * k, 0) * scene.pose);
      TrajectoryRequest path_request;
      path_request.clearance = scene.clearance;
      path_request.distances = path_request.first_poses = path_request.closest_poses = true;
      const TrajectoryResult path = pcl_bsh::collideAlong({all}, other, poses, path_request);
      found.clear();
      const SiteAnswer of_path =
          collideAlong(site, other, poses, request, [&](const Tile&, const Cloud& cloud, const Answer& result) {
            for (std::uint32_t i = 0; i < cloud.width; ++i) {
              if (result.collisions.flags[i] == Verdict::free) continue;
              found[name(cloud, i)] = {double{result.collisions.distance[i]}, double(result.collisions.first_pose[i]),
                                       double(result.collisions.closest_pose[i])};
            }
          });
      EXPECT_EQ(of_path.collisions.colliding, path.colliding);
      EXPECT_EQ(found.size(), path.colliding);
      for (std::size_t i = 0; i < scene.a.size(); ++i) {
        if (path.flags[i] == Verdict::free) continue;
        EXPECT_EQ(found[nameOf(i)], (std::vector<double>{double{path.distance[i]}, double(path.first_pose[i]),
                                                         double(path.closest_pose[i])}))
            << i;
      }
    }
  }

  static std::pair<std::uint32_t, std::uint32_t> name(const Cloud& cloud, std::uint32_t i)
  {
    return {static_cast<std::uint32_t>(io::valueOf(cloud, i, "source")),
            static_cast<std::uint32_t>(io::valueOf(cloud, i, "record"))};
  }

  files::TemporaryFolder folder;
  int places = 0; ///< sites made
};

TEST_F(CollideSite, RandomPoints)
{
  expectSameAnswers(randomScene(1));
}

TEST_F(CollideSite, Ties)
{
  expectSameAnswers(latticeScene(0.0));
  expectSameAnswers(latticeScene(600000.25));
}

TEST_F(CollideSite, NearTies)
{
  expectSameAnswers(nearTieScene());
}

TEST_F(CollideSite, ReadsOnlyTilesThatMatter)
{
  const Scene scene = randomScene(2);
  io::writeCloud(folder / "a.pcd", float64Cloud(scene.a));
  MakeOptions options;
  options.tile_points = 40;
  const Site site = makeSite({folder / "a.pcd"}, folder / "site", options);
  const SphereHierarchy other(viewOf(scene.b.front().data(), scene.b.size()));
  SiteQuestion request;
  request.clearance = 0.05;
  const TilesRead flags = collisionFlags(site, {other, scene.pose}, Flagged::a, request).tiles;
  EXPECT_GT(flags.tiles, 150U);
  EXPECT_LT(flags.needed, 40U);
  EXPECT_EQ(flags.read, flags.needed);
  const TilesRead closest = closestPair(site, {other, scene.pose}, request).tiles;
  EXPECT_LT(closest.read, 40U);
  const TilesRead none =
      collisionFlags(site, {other, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 50))}, Flagged::a, request).tiles;
  EXPECT_EQ(none.needed, 0U);
  // A tile that is not read may be missing its points; one that is read must not.
  for (const Tile& tile : site.tiles) std::ofstream(site.folder / tile.file) << "damaged";
  EXPECT_THROW(collisionFlags(site, {other, scene.pose}, Flagged::a, request), std::runtime_error);
}

/// Along a path, at its poses or swept, on tiles of very different sizes.
void expectSamePassage(const std::vector<Point3>& points, const SphereHierarchy& model,
                       const std::vector<Eigen::Isometry3d>& poses, double clearance, const fs::path& folder)
{
  fs::create_directory(folder);
  io::writeCloud(folder / "points.pcd", float64Cloud(points));
  const SphereHierarchy all(viewOf(points.front().data(), points.size()));
  for (const std::optional<double> swept : {std::optional<double>(), std::optional<double>(0.01)}) {
    TrajectoryRequest wanted;
    wanted.clearance = clearance;
    wanted.swept = swept;
    wanted.distances = wanted.first_poses = wanted.closest_poses = true;
    const TrajectoryResult path = pcl_bsh::collideAlong({all}, model, poses, wanted);
    for (const std::uint64_t tile_points : {100000u, 300u, 9u}) {
      SCOPED_TRACE(std::to_string(tile_points) + (swept ? " swept" : ""));
      MakeOptions options;
      options.tile_points = tile_points;
      const fs::path place = folder / ("site" + std::to_string(tile_points) + (swept ? "s" : ""));
      const Site site = makeSite({folder / "points.pcd"}, place, options);
      SiteQuestion request;
      request.clearance = clearance;
      request.swept = swept.value_or(0.0);
      std::size_t seen = 0;
      const SiteAnswer found =
          collideAlong(site, model, poses, request, [&](const Tile&, const Cloud& cloud, const Answer& result) {
            for (std::uint32_t i = 0; i < cloud.width; ++i) {
              const auto p = static_cast<std::uint32_t>(io::valueOf(cloud, i, "record"));
              ASSERT_EQ(result.collisions.flags[i], path.flags[p]) << p;
              if (path.flags[p] == Verdict::free) continue;
              ++seen;
              EXPECT_EQ(result.collisions.distance[i], path.distance[p]) << p;
              EXPECT_EQ(result.collisions.first_pose[i], path.first_pose[p]) << p;
              EXPECT_EQ(result.collisions.closest_pose[i], path.closest_pose[p]) << p;
            }
          });
      EXPECT_EQ(seen, path.colliding);
      EXPECT_EQ(found.collisions.colliding, path.colliding);
      ASSERT_EQ(found.collisions.first_contact.has_value(), path.first_contact.has_value());
      if (!path.first_contact) continue;
      EXPECT_EQ(found.collisions.first_contact->pose, path.first_contact->pose);
      EXPECT_EQ(found.collisions.first_contact->fraction, path.first_contact->fraction);
    }
  }
}

/// The model is a rod which is longer than tiles. It turns, leaves the points and comes back to where it was.
TEST_F(CollideSite, AlongAPathThatTurnsAndReturns)
{
  std::vector<Point3> rod;
  for (int i = 0; i <= 400; ++i) rod.push_back({0.02 * i - 4, 0.1 * std::sin(i), 0.1 * std::cos(i)});
  const SphereHierarchy model(viewOf(rod.front().data(), rod.size()));
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k < 40; ++k) {
    const Eigen::Translation3d at(k < 20 ? -8 + k : 31 - k, k % 20 > 12 ? 100 : 0.2 * k, 0.4);
    poses.push_back(at * Eigen::AngleAxisd(0.9 * k, Eigen::Vector3d(0.1, 0.2, 1).normalized()));
  }
  std::vector<Point3> points = randomScene(4).a;
  points.resize(3000);
  for (std::size_t i = 0; i < 300; ++i) points.push_back(points[7 * i]); // twice
  for (std::size_t i = 0; i < 20; ++i) points.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  expectSamePassage(points, model, poses, 0.1, folder / "rod");
}

/// Two poses are far apart, so that nothing is near to either, and what is between is found by the motion alone.
TEST_F(CollideSite, BetweenFarPoses)
{
  const std::vector<Point3> arm = {{10, 0, 0}};
  const SphereHierarchy model(viewOf(arm.front().data(), arm.size()));
  std::vector<Eigen::Isometry3d> poses(2, Eigen::Isometry3d::Identity());
  poses[1].rotate(Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitZ())); // by way of (0, 10, 0), which no chord comes near
  std::vector<Point3> points;
  for (int i = 0; i < 40; ++i) points.push_back({0.2 * i - 4, 10, 0});
  expectSamePassage(points, model, poses, 0.05, folder / "arm");
}

/// Points lie exactly at the clearance on both sides of where tiles may end, and one unit in the last place beyond.
TEST_F(CollideSite, AtExactlyTheClearance)
{
  std::vector<Point3> points, body = {{0, 0, 0}};
  for (int i = 0; i < 64; ++i)
    for (const double height : {0.25, std::nextafter(0.25, 1.0), -0.25, 40.0}) points.push_back({0.5 * i, 0, height});
  const SphereHierarchy model(viewOf(body.front().data(), body.size()));
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k < 64; ++k) poses.emplace_back(Eigen::Translation3d(0.5 * k, 0, 0));
  expectSamePassage(points, model, poses, 0.25, folder / "exact");
}

/// Poses may be off rigid by 1e-6: they shrink the places of balls, not the balls.
TEST_F(CollideSite, BallsKeepTheirSizeAtAPoseThatShrinks)
{
  std::vector<Point3> points, body = {{0, 0, 0}};
  for (int i = 0; i < 40; ++i) points.push_back({i % 2 == 0 ? 1000.0 : 3000.0, 0, 0});
  const float radius = 1000.0f;
  PointsView balls = viewOf(body.front().data(), body.size());
  balls.radii = &radius;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() *= 1.0 - 2e-7;
  const SphereHierarchy model(balls);
  const std::vector<Eigen::Isometry3d> poses = {pose, pose};
  ASSERT_GT(pcl_bsh::collideAlong({SphereHierarchy(viewOf(points.front().data(), points.size()))}, model, poses, {})
                .colliding,
            0U);
  expectSamePassage(points, model, poses, 0.0, folder / "balls");
}

TEST_F(CollideSite, APathReadsOnlyTilesBesideIt)
{
  const Scene scene = randomScene(2);
  io::writeCloud(folder / "a.pcd", float64Cloud(scene.a));
  MakeOptions options;
  options.tile_points = 40;
  const Site site = makeSite({folder / "a.pcd"}, folder / "site", options);
  const SphereHierarchy other(viewOf(scene.b.front().data(), scene.b.size()));
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k < 1000; ++k) poses.emplace_back(Eigen::Translation3d(-20 + 0.04 * k, 10, 0));
  SiteQuestion request;
  request.clearance = 0.05;
  const TilesRead along = collideAlong(site, other, poses, request).tiles;
  EXPECT_GT(along.needed, 0U);
  EXPECT_LT(along.needed, along.tiles / 3);
  // Wrong paths are refused although no tile is asked about.
  poses = {poses[0], poses[0]};
  for (Eigen::Isometry3d& pose : poses) pose.translation().z() = 1000;
  EXPECT_EQ(collideAlong(site, other, poses, request).tiles.needed, 0U);
  request.swept = 0.01;
  poses[1].rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  EXPECT_THROW(collideAlong(site, other, poses, request), std::invalid_argument);
  request.swept = -1;
  EXPECT_THROW(collideAlong(site, other, poses, request), std::invalid_argument);
}

TEST_F(CollideSite, RefusesWithoutATileToAsk)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  io::writeCloud(folder / "a.pcd", float64Cloud({{nan, 0, 0}, {0, nan, 0}}));
  const Site site = makeSite({folder / "a.pcd"}, folder / "site", {});
  const Point3 point = {0, 0, 0};
  const SphereHierarchy other(viewOf(point.data(), 1));
  EXPECT_FALSE(closestPair(site, {other}, {}).pair);
  EXPECT_EQ(pointDistances(site, {other}, 1.0, {}).distances.a.measured, 0U);
  EXPECT_EQ(collideAlong(site, other, {Eigen::Isometry3d::Identity()}, {}).collisions.colliding, 0U);
  Placed bad(other);
  bad.pose.linear() *= 2;
  EXPECT_THROW(closestPair(site, bad, {}), std::invalid_argument);
  EXPECT_THROW(pointDistances(site, bad, std::numeric_limits<double>::infinity(), {}), std::invalid_argument);
  EXPECT_THROW(pointDistances(site, {other}, nan, {}), std::invalid_argument);
  EXPECT_THROW(collideAlong(site, other, {bad.pose}, {}), std::invalid_argument);
}

/// No tile can be near to it, whatever the distance.
TEST_F(CollideSite, NothingIsNearACloudWithoutPoints)
{
  io::writeCloud(folder / "a.pcd", float64Cloud(randomScene(2).a));
  MakeOptions options;
  options.tile_points = 40;
  const Site site = makeSite({folder / "a.pcd"}, folder / "site", options);
  const SphereHierarchy nothing{PointsView{}};
  const SiteAnswer closest = closestPair(site, nothing, {});
  EXPECT_FALSE(closest.pair);
  EXPECT_EQ(closest.closest.distance, std::numeric_limits<double>::infinity());
  EXPECT_EQ(closest.tiles.needed, 0U);
  EXPECT_EQ(closest.tiles.read, 0U);
  const SiteAnswer distances = pointDistances(site, nothing, std::numeric_limits<double>::infinity(), {});
  EXPECT_EQ(distances.distances.a.measured, 0U);
  EXPECT_EQ(distances.tiles.needed, 0U);
  EXPECT_EQ(anyCollision(site, nothing, {}).any.verdict, Verdict::free);
}

/// From far away, one tile is enough.
TEST_F(CollideSite, FarSmallestDistanceReadsFewTiles)
{
  const Scene scene = randomScene(2);
  io::writeCloud(folder / "a.pcd", float64Cloud(scene.a));
  MakeOptions options;
  options.tile_points = 40;
  const Site site = makeSite({folder / "a.pcd"}, folder / "site", options);
  const SphereHierarchy all(viewOf(scene.a.front().data(), scene.a.size()));
  const SphereHierarchy other(viewOf(scene.b.front().data(), scene.b.size()));
  for (const Point3& from : {Point3{1000, 20, 3}, Point3{-300, -500, 90}, Point3{0, 0, 1e7}}) {
    const Placed b(other, Eigen::Isometry3d(Eigen::Translation3d(from[0], from[1], from[2])));
    const SiteAnswer found = closestPair(site, b, {});
    const DistanceResult nearest = pcl_bsh::closestPair({all}, b);
    EXPECT_EQ(found.closest.distance, nearest.distance);
    ASSERT_TRUE(found.pair);
    EXPECT_EQ(found.pair->a.record, nearest.pair->a);
    EXPECT_EQ(found.pair->b.record, nearest.pair->b);
    if (from[2] < 1e6) {
      EXPECT_LT(found.tiles.read, 20U);
    }
    ASSERT_EQ(found.tiles.costs.size(), found.tiles.read);
    for (std::uint32_t i = 0; i < found.tiles.read; ++i) EXPECT_EQ(found.tiles.costs[i].place, i);
  }
}

TEST_F(CollideSite, OnTwoRanks)
{
  if (!hasMpirun()) GTEST_SKIP() << "no mpirun";
  const Scene scene = randomScene(3);
  io::writeCloud(folder / "a.pcd", float64Cloud(scene.a));
  io::writeCloud(folder / "b.pcd", float64Cloud(scene.b));
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k < 20; ++k) poses.push_back(Eigen::Translation3d(0.3 * k, 0.1 * k, 0) * scene.pose);
  io::writePoses(folder / "poses.txt", poses);
  MakeOptions options;
  options.tile_points = 100;
  makeSite({folder / "a.pcd"}, folder / "site", options);
  const std::string pose = " --pose=3,-2,0.7,0.1,0.2,0.3";
  const std::vector<std::string> questions = {" --clearance 0.2" + pose,
                                              " --any --clearance 0.2" + pose,
                                              " --closest" + pose,
                                              " --distances" + pose,
                                              std::string(" --clearance 0.2 --trajectory poses.txt"),
                                              std::string(" --clearance 0.2 --uncertainty 0.1 --trajectory poses.txt"),
                                              std::string(" --clearance 0.2 --swept 0.01 --trajectory poses.txt")};
  for (const std::string& question : questions) {
    SCOPED_TRACE(question);
    const Outcome one = run("pcl_bsh_site", "collide site b.pcd --report one.json" + question, folder.path());
    EXPECT_EQ(one.exit_code, 0) << one.err;
    const Outcome two = runOnTwoRanks("collide site b.pcd --report two.json" + question, folder.path());
    EXPECT_EQ(two.exit_code, 0) << two.err;
    const auto withoutCounts = [](std::string text) { return text.substr(0, text.find("\"tiles\"")); };
    EXPECT_EQ(withoutCounts(files::contentOf(folder / "one.json")),
              withoutCounts(files::contentOf(folder / "two.json")));
  }
  for (const auto& entry : fs::directory_iterator(folder / "site/tiles")) std::ofstream(entry.path()) << "damaged";
  const Outcome damaged = runOnTwoRanks("collide site b.pcd --report - --distances", folder.path());
  EXPECT_NE(damaged.exit_code, 0);
  EXPECT_THAT(damaged.err, HasSubstr("pcl_bsh_site: rank "));
}

/// The rank that meets nothing has no say.
TEST_F(CollideSite, FirstContactOfOneOfTwoRanks)
{
  if (!hasMpirun()) GTEST_SKIP() << "no mpirun";
  io::writeCloud(folder / "a.pcd", float64Cloud({{7.25, 0, 0}, {500, 0, 0}}));
  io::writeCloud(folder / "b.pcd", float64Cloud({{0, 0, 0}}));
  const Eigen::Isometry3d begin = Eigen::Isometry3d::Identity(), end(Eigen::Translation3d(8, 0, 0));
  io::writePoses(folder / "poses.txt", {begin, begin, end});
  MakeOptions options;
  options.tile_points = 1;
  EXPECT_EQ(makeSite({folder / "a.pcd"}, folder / "site", options).tiles.size(), 2U);
  const Outcome two = runOnTwoRanks(
      "collide site b.pcd --report - --clearance 0.25 --swept 0.01 --trajectory poses.txt", folder.path());
  EXPECT_EQ(two.exit_code, 0) << two.err;
  const auto contact = nlohmann::json::parse(two.out).at("first_contact");
  EXPECT_EQ(contact.at("pose"), 1);
  EXPECT_NEAR(contact.at("fraction").get<double>(), 7.0 / 8, 0.01);
}

/// A tile whose box is near, and whose points are not, is asked about on the one rank, the other tile on the other.
TEST_F(CollideSite, WhatOneOfTwoRanksLeavesUndecided)
{
  if (!hasMpirun()) GTEST_SKIP() << "no mpirun";
  io::writeCloud(folder / "b.pcd", float64Cloud({{0, 0, 0}}));
  MakeOptions options;
  options.tile_points = 2;
  for (const double beside : {0.01, 0.2}) { // before the tile that matters, or after it
    io::writeCloud(folder / "a.pcd", float64Cloud({{0.35, 0, 0}, {5, 0, 0}, {-beside, 5, 0}, {-5, beside, 0}}));
    const std::string site = beside < 0.1 ? "before" : "after";
    ASSERT_EQ(makeSite({folder / "a.pcd"}, folder / site, options).tiles.size(), 2U);
    const Outcome two =
        runOnTwoRanks("collide " + site + " b.pcd --report - --clearance 0.25 --uncertainty 0.2 --any", folder.path());
    ASSERT_EQ(two.exit_code, 0) << two.err;
    const auto report = nlohmann::json::parse(two.out);
    EXPECT_EQ(report.at("undecided"), true) << site;
    EXPECT_EQ(report.at("tiles").at("read"), 2);
  }
}

} // namespace
} // namespace pcl_bsh::site
#endif
