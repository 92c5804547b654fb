// SPDX-License-Identifier: BSD-3-Clause
// An accuracy promises for a site what it promises for one cloud, whatever the tiles. The program tells and writes it.
#include "float64_cloud.h"
#include "io/clouds/samples.h"
#include "support/verdicts.h"
#include "tools/programs/program_run.h"

#ifdef PCL_BSH_SITE_QUERIES
#include "site_questions.h"

#include <pcl_bsh/collide.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/make_site.h>

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>
#include <random>

namespace pcl_bsh::site {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Cloud = pcl::PCLPointCloud2;
using Json = nlohmann::json;

class SiteAccuracy : public testing::Test {
protected:
  SiteAccuracy()
  {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 2000; ++i) a.push_back({10 * unit(random), 10 * unit(random), 0.2 * unit(random)});
    for (int i = 0; i < 300; ++i) b.push_back({2 * unit(random), 2 * unit(random), 0.3 + 0.2 * unit(random)});
    io::writeCloud(folder / "a.pcd", float64Cloud(a));
    io::writeCloud(folder / "b.pcd", float64Cloud(b));
  }

  Site siteOf(std::uint64_t tile_points)
  {
    MakeOptions options;
    options.tile_points = tile_points;
    return makeSite({folder / "a.pcd"}, folder / ("site" + std::to_string(tile_points)), options);
  }

  template <typename Values, typename Result>
  static void put(Values& values, const Cloud& cloud, const Result& result)
  {
    for (std::uint32_t i = 0; i < cloud.width; ++i)
      values[static_cast<std::size_t>(io::valueOf(cloud, i, "record"))] = result[i];
  }

  files::TemporaryFolder folder;
  std::vector<Point3> a, b;
};

TEST_F(SiteAccuracy, KeepsItsPromises)
{
  const SphereHierarchy all(viewOf(a.front().data(), a.size())), other(viewOf(b.front().data(), b.size()));
  constexpr double clearance = 0.15, tolerance = 0.05;
  FlagsRequest wanted;
  wanted.clearance = clearance;
  wanted.flagged = Flagged::both;
  const FlagsResult truth = pcl_bsh::collisionFlags({all}, {other}, wanted);
  wanted.clearance = clearance + tolerance;
  const FlagsResult wider = pcl_bsh::collisionFlags({all}, {other}, wanted);
  const PointDistances distances = pcl_bsh::pointDistances({all}, {other}, {});
  const double least = pcl_bsh::closestPair({all}, {other}, {}).distance;
  std::size_t left_undecided = 0;
  for (const std::uint64_t tile_points : {100000u, 200u, 20u}) {
    const Site site = siteOf(tile_points);
    for (const char* text :
         {"exact", "tolerance=0.05", "level=0", "level=2", "pairs=3", "pairs=300", "time=0", "time=10"}) {
      SCOPED_TRACE(std::to_string(tile_points) + " " + text);
      SiteQuestion request;
      request.clearance = clearance;
      request.accuracy = Accuracy::parse(text);
      const bool exact = request.accuracy.isExact(), stops = request.accuracy.stopsEarly();

      std::vector<Verdict> flags(a.size(), Verdict::free), along(a.size(), Verdict::free);
      const SiteAnswer found = collisionFlags(
          site, other, Flagged::both, request,
          [&](const Tile&, const Cloud& cloud, const Answer& result) { put(flags, cloud, result.collisions.flags); });
      const SiteAnswer passage = collideAlong(
          site, other, {Eigen::Isometry3d::Identity()}, request,
          [&](const Tile&, const Cloud& cloud, const Answer& result) { put(along, cloud, result.collisions.flags); });
      EXPECT_EQ(std::isinf(passage.closest.distance), stops || passage.collisions.colliding == 0);
      const auto expectKept = [&](const std::vector<Verdict>& said, const std::vector<Verdict>& collides,
                                  const std::vector<Verdict>& nearly) {
        for (std::size_t i = 0; i < said.size(); ++i) {
          ASSERT_LE(said[i], stops ? Verdict::undecided : Verdict::colliding);
          if (said[i] == Verdict::free) {
            EXPECT_EQ(collides[i], Verdict::free) << i;
          }
          if (said[i] == Verdict::colliding) {
            EXPECT_EQ(exact || stops ? collides[i] : nearly[i], Verdict::colliding) << i;
          }
          left_undecided += said[i] == Verdict::undecided ? 1 : 0;
        }
      };
      expectKept(flags, truth.a, wider.a);
      expectKept(along, truth.a, wider.a);
      expectKept(found.obstacle_flags, truth.b, wider.b);
      EXPECT_EQ(found.collisions.undecided,
                static_cast<std::uint64_t>(std::count(flags.begin(), flags.end(), Verdict::undecided)));
      EXPECT_EQ(found.obstacle_undecided,
                static_cast<std::uint64_t>(
                    std::count(found.obstacle_flags.begin(), found.obstacle_flags.end(), Verdict::undecided)));

      const Verdict verdict = anyCollision(site, other, request).any.verdict;
      EXPECT_TRUE(verdict == Verdict::colliding || (stops && verdict == Verdict::undecided));

      const SiteAnswer closest = closestPair(site, other, request);
      EXPECT_LE(closest.closest.interval.lower, least);
      EXPECT_GE(closest.closest.distance, least);
      if (closest.pair) {
        EXPECT_GE(closest.closest.interval.upper, least);
      }
      if (exact) {
        EXPECT_EQ(closest.closest.distance, least);
        EXPECT_GE(closest.closest.interval.lower, std::nextafter(least, 0.0));
      }
      if (!stops) {
        EXPECT_LE(closest.closest.distance, least + tolerance);
      }

      std::vector<double> measured(a.size(), std::nan(""));
      const SiteAnswer of_points = pointDistances(site, other, std::numeric_limits<double>::infinity(), request,
                                                  [&](const Tile&, const Cloud& cloud, const Answer& result) {
                                                    put(measured, cloud, result.distances.a.distance);
                                                  });
      EXPECT_EQ(of_points.distances.a.measured + of_points.distances.a.undecided, a.size());
      for (std::size_t i = 0; i < a.size(); ++i) {
        if (std::isnan(measured[i])) continue;
        EXPECT_GE(measured[i], distances.distance[i]);
        EXPECT_LE(measured[i], distances.distance[i] + (stops || exact ? 0.0 : tolerance));
      }
    }
  }
  EXPECT_GT(left_undecided, 0U);
}

TEST_F(SiteAccuracy, OfTheProgram)
{
  siteOf(200);
  const std::string asked = "collide site200 b.pcd --clearance 0.15 ";
  const auto report = [&](const std::string& arguments) -> Json {
    const Outcome outcome = run("pcl_bsh_site", asked + "--report r.json " + arguments, folder.path());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.exit_code == 0 ? Json::parse(files::contentOf(folder / "r.json")) : Json();
  };
  const Json level = report("--accuracy level=0 --out out --obstacle-out marked.pcd");
  EXPECT_EQ(level["accuracy"], "level=0");
  EXPECT_GT(level["undecided"], 0);
  EXPECT_EQ(readSite(folder / "out").fields.back().name, "collision");

  // Exactly, the obstacle's flags are those that pcl_bsh_collide gives it as an input.
  report("--obstacle-out marked.pcd");
  ASSERT_EQ(run("pcl_bsh_collide", "b.pcd a.pcd memory.pcd --clearance 0.15", folder.path()).exit_code, 0);
  io::expectSame(io::readCloud(folder / "marked.pcd"), io::readCloud(folder / "memory.pcd"));

  const std::string tile = files::contentOf(folder / "site200/tiles/tile_000000.pcd");
  for (const auto& [arguments, words] :
       {std::pair{"--accuracy level=1 --clashes c.json", "decides which points collide, not when and how near"},
        {"--obstacle-out b.pcd", "is the file of OBSTACLE"},
        {"--obstacle-out site200/tiles/tile_000000.pcd", "lies in the folder of SITE"},
        {"--report site200/../site200/site.json", "lies in the folder of SITE"},
        {"--obstacle-out c.pcd --clashes c.json", "--obstacle-out: are flags at one pose"},
        {"--report c.json --swept 0.1", "--swept: is given, but nothing moves"}, // as all faces say it
        {"--report c.json --sigmas 2", "--sigmas: is given, but no uncertainty is a field"},
        {"--report c.json --max-distance -1", "--max-distance: -1: give a length >= 0"}}) {
    const Outcome outcome = run("pcl_bsh_site", asked + arguments, folder.path());
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(words));
  }
  EXPECT_TRUE(files::contentOf(folder / "site200/tiles/tile_000000.pcd") == tile);
}

TEST_F(SiteAccuracy, TellsProgramsWhatASiteHolds)
{
  const Site site = siteOf(200);
  const Outcome info = run("pcl_bsh_site", "info site200 --json", folder.path());
  ASSERT_EQ(info.exit_code, 0) << info.err;
  const Json told = Json::parse(info.out);
  EXPECT_EQ(told["points"], a.size());
  EXPECT_EQ(told["tiles"]["count"], site.tiles.size());
  EXPECT_LE(told["tiles"]["most_points"], 200);
  EXPECT_EQ(told["bounds"]["low"], Json(site.bounds->low));
  EXPECT_EQ(told["fields"], (Json{"x", "y", "z", "source", "record"}));
  EXPECT_EQ(told["sources"][0]["points"], a.size());

  const Outcome sound = run("pcl_bsh_site", "validate site200 --json", folder.path());
  ASSERT_EQ(sound.exit_code, 0) << sound.err;
  EXPECT_EQ(Json::parse(sound.out)["sound"], true);
  folder.write("site200/" + site.tiles[1].file, "damaged");
  const Outcome damaged = run("pcl_bsh_site", "validate site200 --json", folder.path());
  EXPECT_EQ(damaged.exit_code, 1);
  EXPECT_EQ(Json::parse(damaged.out)["sound"], false);
  EXPECT_THAT(Json::parse(damaged.out)["error"].get<std::string>(), HasSubstr(site.tiles[1].file));
  EXPECT_THAT(damaged.err, HasSubstr(site.tiles[1].file));
}

} // namespace
} // namespace pcl_bsh::site
#endif
