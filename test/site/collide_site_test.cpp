// SPDX-License-Identifier: BSD-3-Clause
// Questions about a site have the answers of one hierarchy over all its points, whatever the tiles and the ranks.
#include "../programs/program_run.h"

#include <pcl_bsh/collision/collide.h>
#include <pcl_bsh/filters/cloud_files/cloud_file.h>
#include <pcl_bsh/filters/pose_files/pose_file.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/make_site.h>

#ifdef PCL_BSH_SITE_QUERIES
#include <pcl_bsh/site/collide_site.h>

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <utility>

namespace pcl_bsh::sites {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Cloud = pcl::PCLPointCloud2;

Cloud cloudOf(const std::vector<Point3>& points)
{
  Cloud cloud;
  for (const char* axis : {"x", "y", "z"}) io::addField(cloud, axis, io::Field::FLOAT64);
  io::allocate(cloud, static_cast<std::uint32_t>(points.size()));
  if (!points.empty()) std::memcpy(cloud.data.data(), points.data(), cloud.data.size());
  return cloud;
}

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

/// The same of distances that differ by less than a double tells.
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
    io::writeCloud(folder / "1.pcd", cloudOf({scene.a.begin(), scene.a.begin() + static_cast<std::ptrdiff_t>(half)}));
    io::writeCloud(folder / "2.pcd", cloudOf({scene.a.begin() + static_cast<std::ptrdiff_t>(half), scene.a.end()}));
    const SphereHierarchy all(viewOf(scene.a.front().data(), scene.a.size()));
    const SphereHierarchy other(viewOf(scene.b.front().data(), scene.b.size()));
    const Placed b(other, scene.pose);
    const auto nameOf = [&](std::size_t i) {
      return std::pair{i < half ? 0u : 1u, static_cast<std::uint32_t>(i < half ? i : i - half)};
    };
    for (const std::uint64_t tile_points : {100000, 700, 40}) {
      SCOPED_TRACE(tile_points);
      MakeOptions options;
      options.tile_points = tile_points;
      const Site site = makeSite({folder / "1.pcd", folder / "2.pcd"}, folder / std::to_string(places++), options);
      SiteRequest request;
      request.clearance = scene.clearance;

      EXPECT_EQ(anyCollision(site, b, request).verdict,
                pcl_bsh::anyCollision({all}, b, {scene.clearance, {}, 1}).verdict);

      FlagsRequest flags_request;
      flags_request.clearance = scene.clearance;
      flags_request.flagged = Side::both;
      const FlagsResult flags = pcl_bsh::collisionFlags({all}, b, flags_request);
      Answers found;
      const SiteFlags of_site =
          collisionFlags(site, b, Side::both, request, [&](const Tile&, const Cloud& cloud, const FlagsResult& result) {
            for (std::uint32_t i = 0; i < cloud.width; ++i) found[name(cloud, i)] = {double(result.a[i])};
          });
      EXPECT_EQ(of_site.colliding, flags.colliding_a);
      EXPECT_EQ(of_site.b, flags.b);
      EXPECT_LE(of_site.tiles.read, of_site.tiles.needed);
      for (std::size_t i = 0; i < scene.a.size(); ++i)
        EXPECT_EQ(found.count(nameOf(i)) != 0 ? found[nameOf(i)][0] : 0, flags.a[i]) << i;

      const DistanceResult nearest = pcl_bsh::closestPair({all}, b);
      const SiteClosest of_closest = closestPair(site, b, request);
      EXPECT_EQ(of_closest.distance, nearest.distance);
      ASSERT_TRUE(of_closest.point);
      EXPECT_EQ(std::pair(of_closest.point->source, of_closest.point->record), nameOf(nearest.pair->a));
      EXPECT_EQ(of_closest.b, nearest.pair->b);

      for (const double most : {std::numeric_limits<double>::infinity(), 2 * scene.clearance}) {
        PointDistancesRequest distances_request;
        distances_request.max_distance = most;
        const PointDistances distances = pcl_bsh::pointDistances({all}, b, distances_request);
        found.clear();
        const SiteDistances of_distances =
            pointDistances(site, b, most, request, [&](const Tile&, const Cloud& cloud, const PointDistances& result) {
              for (std::uint32_t i = 0; i < cloud.width; ++i)
                found[name(cloud, i)] = {result.distance[i], double(result.nearest[i])};
            });
        EXPECT_EQ(of_distances.measured, distances.measured);
        EXPECT_EQ(of_distances.greatest, distances.greatest);
        for (std::size_t i = 0; i < scene.a.size(); ++i) {
          if (std::isnan(distances.distance[i])) continue;
          ASSERT_EQ(found.count(nameOf(i)), 1U) << i;
          EXPECT_EQ(found[nameOf(i)], (std::vector<double>{distances.distance[i], double(distances.nearest[i])})) << i;
        }
      }

      std::vector<Eigen::Isometry3d> poses;
      for (int k = 0; k < 20; ++k) poses.push_back(Eigen::Translation3d(0.3 * k, 0.1 * k, 0) * scene.pose);
      TrajectoryRequest path_request;
      path_request.clearance = scene.clearance;
      path_request.distances = path_request.first_poses = path_request.closest_poses = true;
      const TrajectoryResult path = pcl_bsh::collideAlong({all}, other, poses, path_request);
      found.clear();
      const SitePassage of_path = collideAlong(
          site, other, poses, request, [&](const Tile&, const Cloud& cloud, const TrajectoryResult& result) {
            for (std::uint32_t i = 0; i < cloud.width; ++i) {
              if (result.flags[i] == 0) continue;
              found[name(cloud, i)] = {double{result.distance[i]}, double(result.first_pose[i]),
                                       double(result.closest_pose[i])};
            }
          });
      EXPECT_EQ(of_path.colliding, path.colliding);
      EXPECT_EQ(found.size(), path.colliding);
      for (std::size_t i = 0; i < scene.a.size(); ++i) {
        if (path.flags[i] == 0) continue;
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
  io::writeCloud(folder / "a.pcd", cloudOf(scene.a));
  MakeOptions options;
  options.tile_points = 40;
  const Site site = makeSite({folder / "a.pcd"}, folder / "site", options);
  const SphereHierarchy other(viewOf(scene.b.front().data(), scene.b.size()));
  SiteRequest request;
  request.clearance = 0.05;
  const TilesRead flags = collisionFlags(site, {other, scene.pose}, Side::a, request).tiles;
  EXPECT_GT(flags.tiles, 150U);
  EXPECT_LT(flags.needed, 40U);
  EXPECT_EQ(flags.read, flags.needed);
  const TilesRead closest = closestPair(site, {other, scene.pose}, request).tiles;
  EXPECT_LT(closest.read, 40U);
  const TilesRead none =
      collisionFlags(site, {other, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 50))}, Side::a, request).tiles;
  EXPECT_EQ(none.needed, 0U);
  // A tile that is not read may be missing its points; one that is read must not.
  for (const Tile& tile : site.tiles) std::ofstream(site.folder / tile.file) << "damaged";
  EXPECT_THROW(collisionFlags(site, {other, scene.pose}, Side::a, request), std::runtime_error);
}

TEST_F(CollideSite, OnTwoRanks)
{
  if (std::system("mpirun --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no mpirun";
  const Scene scene = randomScene(3);
  io::writeCloud(folder / "a.pcd", cloudOf(scene.a));
  io::writeCloud(folder / "b.pcd", cloudOf(scene.b));
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k < 20; ++k) poses.push_back(Eigen::Translation3d(0.3 * k, 0.1 * k, 0) * scene.pose);
  io::writePoses(folder / "poses.txt", poses);
  MakeOptions options;
  options.tile_points = 100;
  makeSite({folder / "a.pcd"}, folder / "site", options);
  // Not this process' environment: where MPI has begun in it, mpirun would take itself for a part of that job.
  const std::string two_ranks = "cd " + folder.path().string() +
                                " && env -i PATH=\"$PATH\" OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
                                "mpirun --oversubscribe -n 2 " PCL_BSH_PROGRAM_DIR "/pcl_bsh_site ";
  const std::string pose = " --pose=3,-2,0.7,0.1,0.2,0.3";
  const std::vector<std::string> questions = {" --clearance 0.2" + pose, " --any --clearance 0.2" + pose,
                                              " --closest" + pose, " --distances" + pose,
                                              std::string(" --clearance 0.2 --trajectory poses.txt")};
  for (const std::string& question : questions) {
    SCOPED_TRACE(question);
    const Outcome one = run("pcl_bsh_site", "collide site b.pcd --report one.json" + question, folder.path());
    EXPECT_EQ(one.exit_code, 0) << one.err;
    EXPECT_EQ(std::system((two_ranks + "collide site b.pcd --report two.json" + question).c_str()), 0);
    const auto withoutCounts = [](std::string text) { return text.substr(0, text.find("\"tiles\"")); };
    EXPECT_EQ(withoutCounts(files::contentOf(folder / "one.json")),
              withoutCounts(files::contentOf(folder / "two.json")));
  }
  for (const auto& entry : fs::directory_iterator(folder / "site/tiles")) std::ofstream(entry.path()) << "damaged";
  EXPECT_NE(std::system((two_ranks + "collide site b.pcd --report - --distances > out.txt 2>&1").c_str()), 0);
  EXPECT_THAT(files::contentOf(folder / "out.txt"), HasSubstr("pcl_bsh_site: rank "));
}

} // namespace
} // namespace pcl_bsh::sites
#endif
