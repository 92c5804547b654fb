// SPDX-License-Identifier: BSD-3-Clause
// Verdicts about points whose places are uncertain: those of one hierarchy, whatever the tiles and the ranks.
#include "support/verdicts.h"
#include "tools/programs/program_run.h"

#ifdef PCL_BSH_SITE_QUERIES
#include "site_questions.h"
#include "two_ranks.h"

#include <pcl_bsh/collide.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/search/uncertainty.h>
#include <pcl_bsh/site/check_site.h>
#include <pcl_bsh/site/make_site.h>

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>

namespace pcl_bsh::site {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Cloud = pcl::PCLPointCloud2;
using Json = nlohmann::json;

class UncertainSite : public testing::Test {
protected:
  UncertainSite()
  {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    // Far from the machine are points that may be anywhere, so that the tile of the greatest sigma is not the nearest.
    scan = cloudOf(2000, [&](std::size_t i) -> std::array<double, 4> {
      const double x = 20 * unit(random), y = 5 * unit(random), z = 0.3 * unit(random);
      const double sigma = x > 15 && i % 7 == 0 ? 6.0 : i % 3 == 0 ? 0.1 : 0.001;
      return {x, i % 301 == 9 ? std::nan("") : y, z, i % 301 == 9 ? -1.0 : sigma};
    });
    machine = cloudOf(200, [&](std::size_t i) -> std::array<double, 4> {
      return {1.5 * unit(random), 1.5 * unit(random), 0.1 * unit(random), i % 2 == 0 ? 0.05 : 0.0};
    });
    for (int k = 0; k < 12; ++k) {
      poses.push_back(Eigen::Translation3d(k - 4.0, 0.3 * k, 0.5) *
                      Eigen::AngleAxisd(0.2 * k, Eigen::Vector3d::UnitZ()));
    }
    io::writeCloud(folder / "scan.pcd", scan);
    io::writeCloud(folder / "machine.pcd", machine);
    io::writePoses(folder / "poses.txt", poses);
  }

  template <typename PointOf>
  static Cloud cloudOf(std::uint32_t points, const PointOf& pointOf)
  {
    Cloud cloud;
    for (const char* name : {"x", "y", "z", "sigma"}) io::addField(cloud, name, io::Field::FLOAT64);
    io::addField(cloud, "class", io::Field::UINT8);
    io::allocate(cloud, points);
    for (std::uint32_t i = 0; i < points; ++i) {
      const std::array<double, 4> point = pointOf(i);
      std::memcpy(&cloud.data[i * cloud.point_step], point.data(), sizeof point);
    }
    return cloud;
  }

  Site siteOf(std::uint64_t tile_points)
  {
    MakeOptions options;
    options.tile_points = tile_points;
    return makeSite({folder / "scan.pcd"}, folder / ("site" + std::to_string(tile_points)), options);
  }

  static std::uint32_t recordOf(const Cloud& cloud, std::uint32_t i)
  {
    return static_cast<std::uint32_t>(io::valueOf(cloud, i, "record"));
  }

  files::TemporaryFolder folder;
  Cloud scan, machine;
  std::vector<Eigen::Isometry3d> poses;
};

TEST_F(UncertainSite, VerdictsAreThoseOfMemory)
{
  bool saw_any[3] = {false, false, false};
  for (const std::uint64_t tile_points : {100000u, 150u, 9u}) {
    const Site site = siteOf(tile_points);
    for (const Uncertainty& of_site : {Uncertainty(), Uncertainty(0.06), Uncertainty("sigma", 1.5)}) {
      for (const Uncertainty& of_machine : {Uncertainty(), Uncertainty("sigma", 2.0)}) {
        SCOPED_TRACE(std::to_string(tile_points) + " " + of_site.field + " " + of_machine.field);
        const SphereHierarchy a(withUncertainty(viewOf(scan), scan.fields, "scan", of_site));
        const SphereHierarchy b(withUncertainty(viewOf(machine), machine.fields, "machine", of_machine));
        SiteQuestion request;
        request.uncertainty = of_site;
        for (const Eigen::Isometry3d& pose : {poses[0], Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.75)),
                                              Eigen::Isometry3d(Eigen::Translation3d(0, 0, 40))}) {
          request.clearance = 0.3;
          const Verdict verdict = anyCollision(site, {b, pose}, request).any.verdict;
          EXPECT_EQ(verdict, pcl_bsh::anyCollision({a}, {b, pose}, {0.3, 1}).verdict);
          saw_any[static_cast<std::size_t>(verdict)] = true;
          FlagsRequest wanted;
          wanted.clearance = 0.3;
          wanted.flagged = Flagged::both;
          const FlagsResult expected = pcl_bsh::collisionFlags({a}, {b, pose}, wanted);
          std::vector<Verdict> flags(scan.width, Verdict::free);
          const SiteAnswer found = collisionFlags(site, {b, pose}, Flagged::both, request,
                                                  [&](const Tile&, const Cloud& cloud, const Answer& result) {
                                                    for (std::uint32_t i = 0; i < cloud.width; ++i)
                                                      flags[recordOf(cloud, i)] = result.collisions.flags[i];
                                                  });
          EXPECT_EQ(flags, expected.a);
          EXPECT_EQ(found.obstacle_flags, expected.b);
          EXPECT_EQ(found.collisions.colliding, expected.colliding_a);
          EXPECT_EQ(found.collisions.undecided, expected.undecided_a);
          EXPECT_EQ(found.obstacle_colliding, expected.colliding_b);
          EXPECT_EQ(found.obstacle_undecided, expected.undecided_b);
        }
      }
    }
  }
  for (const bool saw : saw_any) EXPECT_TRUE(saw);
}

/// A point that collides with one tile for certain, and perhaps with others, whichever come first.
TEST_F(UncertainSite, CollidingWinsOverUndecided)
{
  const Point3 origin = {0, 0, 0};
  const SphereHierarchy b(viewOf(origin.data(), 1));
  SiteQuestion request;
  request.clearance = 0.3;
  request.uncertainty = Uncertainty(0.05);
  MakeOptions options;
  options.tile_points = 1;
  for (const double side : {1.0, -1.0}) {
    scan = cloudOf(3, [&](std::size_t i) -> std::array<double, 4> {
      return {side * std::array{-0.32, 0.2, 0.33}[i], 0, 0, 0};
    });
    io::writeCloud(folder / "scan.pcd", scan);
    const Site site = makeSite({folder / "scan.pcd"}, folder / (side < 0 ? "left" : "right"), options);
    ASSERT_EQ(site.tiles.size(), 3U);
    const SiteAnswer found = collisionFlags(site, {b}, Flagged::both, request);
    EXPECT_EQ(found.obstacle_flags, test::verdictsOf({1}));
    EXPECT_EQ(found.obstacle_colliding, 1U);
    EXPECT_EQ(found.obstacle_undecided, 0U);
    EXPECT_EQ(found.collisions.undecided, 2U);
    EXPECT_EQ(anyCollision(site, {b}, request).any.verdict, Verdict::colliding);
  }
}

TEST_F(UncertainSite, PathsAreThoseOfMemory)
{
  const SphereHierarchy b(withUncertainty(viewOf(machine), machine.fields, "machine", {"sigma", 2.0}));
  for (const std::uint64_t tile_points : {150u, 9u}) {
    const Site site = siteOf(tile_points);
    for (const Uncertainty& of_site : {Uncertainty(0.06), Uncertainty("sigma", 1.5)}) {
      for (const std::optional<double> swept : {std::optional<double>(), std::optional<double>(0.01)}) {
        const SphereHierarchy a(withUncertainty(viewOf(scan), scan.fields, "scan", of_site));
        TrajectoryRequest wanted;
        wanted.clearance = 0.3;
        wanted.swept = swept;
        wanted.distances = wanted.first_poses = wanted.closest_poses = true;
        const TrajectoryResult expected = pcl_bsh::collideAlong({a}, b, poses, wanted);
        SiteQuestion request;
        request.clearance = 0.3;
        request.swept = swept.value_or(0.0);
        request.uncertainty = of_site;
        std::vector<Verdict> flags(scan.width, Verdict::free);
        std::vector<std::int32_t> first(scan.width, -1), certain(scan.width, -1);
        const SiteAnswer found =
            collideAlong(site, b, poses, request, [&](const Tile&, const Cloud& cloud, const Answer& result) {
              for (std::uint32_t i = 0; i < cloud.width; ++i) {
                const std::uint32_t record = recordOf(cloud, i);
                flags[record] = result.collisions.flags[i];
                first[record] = result.collisions.first_pose[i];
                certain[record] = result.collisions.certain_pose[i];
              }
            });
        EXPECT_EQ(flags, expected.flags);
        EXPECT_EQ(first, expected.first_pose);
        EXPECT_EQ(certain, expected.certain_pose);
        EXPECT_EQ(found.collisions.colliding, expected.colliding);
        EXPECT_EQ(found.collisions.undecided, expected.undecided);
        EXPECT_GT(found.collisions.undecided, 0U);
        const auto expectSame = [](const std::optional<FirstContact>& one, const std::optional<FirstContact>& other) {
          ASSERT_EQ(one.has_value(), other.has_value());
          if (!one) return;
          EXPECT_EQ(std::pair(one->pose, one->fraction), std::pair(other->pose, other->fraction));
        };
        expectSame(found.collisions.first_contact, expected.first_contact);
        expectSame(found.collisions.certain_contact, expected.certain_contact);
      }
    }
  }
}

/// Points of an obstacle that is a site are compared where they lie beyond the clearance, but within their uncertainty
/// of it. All other points of their tile are far away.
TEST_F(UncertainSite, AsObstacleIsCutToWhereItsPointsMayBe)
{
  const auto write = [&](const char* name, const std::vector<std::array<double, 4>>& points) {
    io::writeCloud(folder / name,
                   cloudOf(static_cast<std::uint32_t>(points.size()), [&](std::size_t i) { return points[i]; }));
    return makeSite({folder / name}, folder / (std::string(name) + "_site"), {});
  };
  const Site one = write("one.pcd", {{0, 0, 0, 0}});
  // The candidate, and two points that keep the tile's box wide.
  const Site other = write("other.pcd", {{1.04, 0, 0, 0.05}, {50, 0, 0, 0.05}, {-60, 30, 9, 0.05}});
  ASSERT_EQ(other.tiles.size(), 1U);
  SiteQuestion request;
  request.clearance = 1.0;
  for (const Uncertainty& uncertainty : {Uncertainty(0.05), Uncertainty("sigma", 1.0)}) {
    EXPECT_EQ(anyCollision(one, {other, Eigen::Isometry3d::Identity(), uncertainty}, request).any.verdict,
              Verdict::undecided);
    EXPECT_EQ(collisionFlags(one, {other, Eigen::Isometry3d::Identity(), uncertainty}, request).collisions.undecided,
              1U);
    EXPECT_EQ(collideAlong(one, other, uncertainty, {Eigen::Isometry3d::Identity()}, request).collisions.undecided, 1U);
    request.uncertainty = uncertainty; // with the roles exchanged
    EXPECT_EQ(collisionFlagsOfB(one, {other}, request).obstacle_undecided, uncertainty.field.empty() ? 1U : 0U);
    request.uncertainty = {};
  }
  EXPECT_EQ(anyCollision(one, {other}, request).any.verdict, Verdict::free);
}

/// On its way the machine meets nothing for certain, but it may: the report says how near and from when on.
TEST_F(UncertainSite, APathThatIsOnlyUndecidedHasADistance)
{
  scan = cloudOf(40, [&](std::size_t i) -> std::array<double, 4> {
    return {0.5 * static_cast<double>(i), 0, i % 2 == 0 ? 1.3 : 1.2, 0};
  });
  machine = cloudOf(1, [&](std::size_t) -> std::array<double, 4> { return {0, 0, 0, 0}; });
  poses.clear();
  for (const double x : {-40.0, -9.0, 3.0, 7.5, 60.0}) poses.emplace_back(Eigen::Translation3d(x, 0, 0));
  io::writeCloud(folder / "scan.pcd", scan);
  io::writeCloud(folder / "machine.pcd", machine);
  io::writePoses(folder / "poses.txt", poses);
  makeSite({folder / "machine.pcd"}, folder / "machine", {});
  const Site site = siteOf(7);
  const SphereHierarchy a(withUncertainty(viewOf(scan), scan.fields, "scan", 0.3)), b(viewOf(machine));
  for (const std::string swept : {"", " --swept 0.001"}) {
    TrajectoryRequest wanted;
    wanted.clearance = 1.0;
    wanted.distances = wanted.first_poses = true;
    if (!swept.empty()) wanted.swept = 0.001;
    const TrajectoryResult expected = pcl_bsh::collideAlong({a}, b, poses, wanted);
    ASSERT_EQ(expected.colliding, 0U);
    ASSERT_GT(expected.undecided, 0U);
    float distance = std::numeric_limits<float>::infinity();
    std::int32_t first = 1000;
    for (std::uint32_t i = 0; i < scan.width; ++i) {
      if (expected.flags[i] == Verdict::free) continue;
      distance = std::min(distance, expected.distance[i]);
      first = std::min(first, expected.first_pose[i]);
    }
    for (const std::string obstacle : {"machine.pcd", "machine"}) {
      SCOPED_TRACE(obstacle + swept);
      const Outcome done = run("pcl_bsh_site",
                               "collide site7 " + obstacle +
                                   " --clearance 1 --uncertainty 0.3 --trajectory poses.txt "
                                   "--report r.json" +
                                   swept,
                               folder.path());
      ASSERT_EQ(done.exit_code, 0) << done.err;
      const Json found = Json::parse(files::contentOf(folder / "r.json"));
      EXPECT_EQ(found["colliding"], 0);
      EXPECT_EQ(found["undecided"], expected.undecided);
      EXPECT_EQ(found["distance"], double{distance});
      EXPECT_EQ(found["first_pose"], first);
      EXPECT_EQ(found.contains("first_contact"), !swept.empty());
      EXPECT_FALSE(found.contains("certain_contact"));
    }
  }
}

/// A tile whose points may be far off is read although its box is far away, and others are not.
TEST_F(UncertainSite, ReadsTheTilesThatMayMatter)
{
  const Site site = siteOf(50);
  const SphereHierarchy b(viewOf(machine));
  SiteQuestion request;
  request.clearance = 0.3;
  const Placed placed(b, poses[0]);
  const std::uint64_t measured = collisionFlags(site, placed, Flagged::a, request).tiles.needed;
  request.uncertainty = Uncertainty("sigma", 3.0);
  const TilesRead uncertain = collisionFlags(site, placed, Flagged::a, request).tiles;
  EXPECT_GT(uncertain.needed, measured);
  EXPECT_LT(uncertain.needed, uncertain.tiles);
}

TEST_F(UncertainSite, RefusesWhatItCannotKnow)
{
  const Site site = siteOf(500);
  const SphereHierarchy b(viewOf(machine));
  const auto refusal = [&](const Site& of, const Uncertainty& uncertainty) -> std::string {
    SiteQuestion request;
    request.clearance = 0.3;
    request.uncertainty = uncertainty;
    const Eigen::Isometry3d far_away(Eigen::Translation3d(0, 0, 1000)); // no tile is read
    for (int query = 0; query < 3; ++query) {
      try {
        if (query == 0) anyCollision(of, {b, far_away}, request);
        if (query == 1) collisionFlags(of, {b, far_away}, Flagged::a, request);
        if (query == 2) collideAlong(of, b, {far_away}, request);
        return "none";
      }
      catch (const std::exception& error) {
        if (query == 2) return error.what();
      }
    }
    return "";
  };
  EXPECT_EQ(refusal(site, {"sigma", 1.0}), "none");
  EXPECT_THAT(refusal(site, {"sigmas", 1.0}), HasSubstr("field 'sigmas' of its points' sigmas is missing"));
  EXPECT_THAT(refusal(site, {"class", 1.0}), HasSubstr("does not say how large 'class' is in tiles/tile_000000.pcd"));
  EXPECT_THAT(refusal(site, Uncertainty(-1.0)), HasSubstr("uncertainty: -1"));

  // A site of the first version answers all that needs no greatest values.
  Json json = Json::parse(files::contentOf(site.folder / site_file_name));
  json["version"] = 1;
  for (Json& tile : json["tiles"]) tile.erase("greatest");
  std::ofstream(site.folder / site_file_name) << json;
  const Site old = readSite(site.folder);
  EXPECT_EQ(refusal(old, Uncertainty(0.1)), "none");
  EXPECT_THAT(refusal(old, {"sigma", 1.0}), HasSubstr("does not say how large 'sigma' is"));

  // A greatest value that is too small would leave tiles out.
  const Site whole = siteOf(200);
  EXPECT_NO_THROW(checkSite(whole));
  Site lowered = whole;
  lowered.tiles.back().greatest["sigma"] *= 0.5;
  EXPECT_THROW(checkSite(lowered), files::FileError);
  lowered.tiles.back().greatest.clear(); // leaves none out
  EXPECT_NO_THROW(checkSite(lowered));

  // A sigma that is no length, where its tile is read.
  double sigma = -0.5;
  std::memcpy(&scan.data[5 * scan.point_step + 24], &sigma, sizeof sigma);
  io::writeCloud(folder / "scan.pcd", scan);
  const Site wrong = makeSite({folder / "scan.pcd"}, folder / "wrong", {});
  SiteQuestion request;
  request.uncertainty = Uncertainty("sigma", 1.0);
  EXPECT_THROW(collisionFlags(wrong, {b}, Flagged::a, request), std::invalid_argument);
}

TEST_F(UncertainSite, OfThePrograms)
{
  siteOf(80);
  const std::string asked =
      " --clearance 0.3 --uncertainty sigma --sigmas 1.5 --obstacle-uncertainty 0.05 --pose 0,0,0.6,0,0,0 ";
  const Outcome memory = run("pcl_bsh_collide", "scan.pcd machine.pcd m.pcd --report m.json" + asked, folder.path());
  ASSERT_EQ(memory.exit_code, 0) << memory.err;
  const Outcome one =
      run("pcl_bsh_site", "collide site80 machine.pcd --out out --report 1.json" + asked, folder.path());
  ASSERT_EQ(one.exit_code, 0) << one.err;
  const Json expected = Json::parse(files::contentOf(folder / "m.json")),
             found = Json::parse(files::contentOf(folder / "1.json"));
  EXPECT_GT(found["undecided"], 0);
  EXPECT_EQ(found["colliding"], expected["colliding"]);
  EXPECT_EQ(found["undecided"], expected["undecided"]);
  const Site out = readSite(folder / "out");
  const Cloud marked = io::readCloud(folder / "m.pcd");
  for (const Tile& tile : out.tiles) {
    const Cloud cloud = readTile(out, tile);
    for (std::uint32_t i = 0; i < cloud.width; ++i)
      EXPECT_EQ(io::valueOf(cloud, i, "collision"), io::valueOf(marked, recordOf(cloud, i), "collision"));
  }
  // The site of results knows the greatest sigma, as the site does.
  EXPECT_EQ(out.tiles[0].greatest.count("sigma"), 1U);
  const std::string refused = " --clearance 0.3 --report 3.json --uncertainty ";
  EXPECT_EQ(run("pcl_bsh_site", "collide site80 machine.pcd --report 3.json --closest --uncertainty 0.1", folder.path())
                .exit_code,
            2);
  EXPECT_EQ(run("pcl_bsh_site", "collide site80 machine.pcd" + refused + "class", folder.path()).exit_code, 1);
  EXPECT_FALSE(fs::exists(folder / "3.json"));

  if (!hasMpirun()) GTEST_SKIP() << "no mpirun";
  const Outcome ranks = runOnTwoRanks("collide site80 machine.pcd --report 2.json" + asked, folder.path());
  ASSERT_EQ(ranks.exit_code, 0) << ranks.err;
  const Json two = Json::parse(files::contentOf(folder / "2.json"));
  for (const char* key : {"colliding", "undecided", "colliding_of_obstacle", "undecided_of_obstacle"})
    EXPECT_EQ(two[key], found[key]) << key;
}

} // namespace
} // namespace pcl_bsh::site
#endif
