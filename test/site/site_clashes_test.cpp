// SPDX-License-Identifier: BSD-3-Clause
// The clashes of a site are those of one cloud of all its points, whatever the tiles and the ranks.
#include "float64_cloud.h"
#include "io/clouds/las_sample.h"
#include "tools/programs/program_run.h"

#ifdef PCL_BSH_SITE_QUERIES
#include "site_questions.h"
#include "two_ranks.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/make_site.h>
#include <pcl_bsh/site/site_clashes.h>

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>
#include <map>
#include <random>

namespace pcl_bsh::site {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Cloud = pcl::PCLPointCloud2;
using Json = nlohmann::json;

/// A model on its way past points.
struct Scene {
  std::vector<Point3> points, model = {{0, 0, 0}};
  std::vector<Eigen::Isometry3d> poses;
  double clearance = 0.5;
  std::vector<double> cluster_distances = {1.0};
  std::optional<double> swept;
};

/// A floor, of which much is near to the model, in clusters that are larger than small tiles.
Scene floorScene()
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  Scene scene;
  for (int i = 0; i < 1500; ++i) scene.points.push_back({20 * unit(random), 3 * unit(random), 0.4 * unit(random)});
  for (int i = 0; i < 600; ++i) scene.points.push_back({0, 0.5, 0.25}); // more at one place than is listed
  for (int i = 0; i < 20; ++i) scene.points[static_cast<std::size_t>(50 * i)][1] = std::nan("");
  for (int i = 0; i < 60; ++i) scene.model.push_back({0.8 * unit(random), 0.8 * unit(random), 0.2 * unit(random)});
  for (int k = 0; k < 25; ++k) {
    scene.poses.push_back(Eigen::Translation3d(1.6 * k - 20, 2 * std::sin(k), 0.5) *
                          Eigen::AngleAxisd(0.3 * k, Eigen::Vector3d::UnitZ()));
  }
  scene.clearance = 0.3;
  scene.cluster_distances = {0.35};
  return scene;
}

/// A lattice of steps of exactly the cluster distance, at the coordinates of maps. One gap is wider by one unit in the
/// last place: the points on either side of it are one clash. All points are as near, so the smallest counts.
Scene latticeScene(double x, double y)
{
  Scene scene;
  const double gap = std::nextafter(x + 8, 2 * x + 9);
  for (int i = 15; i >= 0; --i)
    for (int j = 0; j < 16; ++j) scene.points.push_back({i < 8 ? x + i : gap + (i - 8), y + j, 0.0});
  scene.model.clear();
  for (int i = 0; i < 16; ++i)
    for (int j = 0; j < 16; ++j) scene.model.push_back({i < 8 ? double(i) : gap - x + (i - 8), double(j), 0.0});
  scene.poses.emplace_back(Eigen::Translation3d(x, y, 0.25));
  return scene;
}

/// Two clashes that are apart, but have the same box, beside others in the cell that their ids tell.
Scene sameBoxScene(bool other_first)
{
  Scene scene;
  const auto line = [&](Point3 from, Point3 to) {
    for (int i = 0; i <= 10; ++i) {
      Point3 p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = from[k] + (to[k] - from[k]) * i / 10.0;
      scene.points.push_back(p);
    }
  };
  const auto path = [&](bool one) {
    if (one) {
      line({-5, -5, -5}, {5, -5, -5}), line({5, -5, -5}, {5, 5, -5}), line({5, 5, -5}, {5, 5, 5});
    }
    else {
      line({-5, 5, -5}, {-5, 5, 5}), line({-5, 5, 5}, {-5, -5, 5}), line({-5, -5, 5}, {5, -5, 5});
    }
  };
  path(!other_first);
  path(other_first);
  for (Point3& p : scene.points)
    for (double& c : p) c = c == 0.0 && scene.points.size() % 2 == 0 ? -0.0 : c;
  scene.points.push_back({0.5, 0.5, -0.0});
  scene.points.push_back({0.5, -0.0, 0.0});
  scene.points.push_back({0.5, 0.0, -0.5});
  scene.model = scene.points;
  scene.poses.push_back(Eigen::Isometry3d::Identity());
  scene.clearance = 0.0;
  return scene;
}

class SiteClashList : public testing::Test {
protected:
  /// Expects the clashes of memory from several tilings of a site of two clouds.
  void expectSame(const Scene& scene, std::size_t least)
  {
    const auto half = static_cast<std::ptrdiff_t>(scene.points.size() / 3);
    io::writeCloud(folder / "1.pcd", float64Cloud({scene.points.begin(), scene.points.begin() + half}));
    io::writeCloud(folder / "2.pcd", float64Cloud({scene.points.begin() + half, scene.points.end()}));
    io::writeCloud(folder / "model.pcd", float64Cloud(scene.model));
    const auto nameOf = [&](std::uint32_t i) {
      const auto begin = static_cast<std::uint32_t>(half);
      return i < begin ? SitePoint{0, i} : SitePoint{1, i - begin};
    };
    const SphereHierarchy all(viewOf(scene.points.front().data(), scene.points.size()));
    const SphereHierarchy model(viewOf(scene.model.front().data(), scene.model.size()));
    TrajectoryRequest wanted;
    wanted.clearance = scene.clearance;
    wanted.swept = scene.swept;
    wanted.distances = wanted.first_poses = wanted.closest_poses = true;
    wanted.pose_summaries = !scene.swept;
    const TrajectoryResult in_memory = pcl_bsh::collideAlong({all}, model, scene.poses, wanted);
    std::vector<std::vector<Clash>> expected;
    for (const double distance : scene.cluster_distances) {
      expected.push_back(findClashes(all.view(), in_memory, distance));
      ASSERT_GE(expected.back().size(), least);
    }
    std::vector<std::vector<SitePoint>> drawn;
    for (const std::uint64_t tile_points : {100000u, 200u, 9u}) {
      SCOPED_TRACE(tile_points);
      MakeOptions options;
      options.tile_points = tile_points;
      const Site site = makeSite({folder / "1.pcd", folder / "2.pcd"}, folder / std::to_string(places++), options);
      SiteQuestion request;
      request.clearance = scene.clearance;
      request.swept = scene.swept.value_or(0.0);
      request.wanted.poses = !scene.swept;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        ClashFinder finder(site, scene.cluster_distances[i]);
        request.clashes = &finder;
        const SiteAnswer passage = collideAlong(site, model, scene.poses, request);
        ASSERT_EQ(passage.collisions.poses.size(), in_memory.poses.size());
        for (std::size_t k = 0; k < passage.collisions.poses.size(); ++k) {
          EXPECT_EQ(passage.collisions.poses[k].colliding_points, in_memory.poses[k].colliding_points);
          EXPECT_EQ(passage.collisions.poses[k].distance, in_memory.poses[k].distance);
        }
        const SiteClashes list = finder.finish();
        expectList(list, expected[i], all.view(), in_memory, nameOf);
        if (drawn.size() == i) drawn.push_back(list.points);
        EXPECT_TRUE(list.points == drawn[i]) << "the same points of large clashes";
      }
      if (scene.swept) continue; // what is between the bounds depends on tiles
      options.tile_points = std::max<std::uint64_t>(4, tile_points / 5);
      const Site moved = makeSite({folder / "model.pcd"}, folder / std::to_string(places++), options);
      ClashFinder finder(site, scene.cluster_distances.back());
      request.clashes = &finder;
      collideAlong(site, moved, {}, scene.poses, request);
      SiteClashes list = finder.finish();
      for (Clash& clash : list.clashes) {
        const MetPoint& point = list.met.at(clash.model_point);
        EXPECT_EQ(point.place, scene.model.at(point.point.record));
        clash.model_point = point.point.record;
      }
      expectList(list, expected.back(), all.view(), in_memory, nameOf);
    }
  }

  template <typename NameOf>
  static void expectList(const SiteClashes& list, const std::vector<Clash>& clashes, const PointsView& all,
                         const TrajectoryResult& in_memory, const NameOf& nameOf)
  {
    ASSERT_EQ(list.clashes.size(), clashes.size());
    for (std::size_t i = 0; i < clashes.size(); ++i) {
      const Clash &found = list.clashes[i], &expected = clashes[i];
      SCOPED_TRACE(expected.id);
      EXPECT_EQ(found.id, expected.id);
      EXPECT_EQ(found.points, expected.points);
      EXPECT_EQ(found.certain_points, expected.certain_points);
      EXPECT_EQ(found.place, expected.place);
      EXPECT_EQ(found.low, expected.low);
      EXPECT_EQ(found.high, expected.high);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(std::signbit(found.low[k]), std::signbit(expected.low[k]));
        EXPECT_EQ(std::signbit(found.high[k]), std::signbit(expected.high[k]));
      }
      EXPECT_EQ(found.distance, expected.distance);
      EXPECT_TRUE(list.points[found.scan_point] == nameOf(expected.scan_point));
      EXPECT_EQ(list.places[found.scan_point], all.point(expected.scan_point));
      EXPECT_EQ(found.model_point, expected.model_point);
      EXPECT_EQ(found.first_pose, expected.first_pose);
      EXPECT_EQ(found.closest_pose, expected.closest_pose);
      if (expected.points > ClashFinder::most_points) {
        EXPECT_GE(found.records.size(), ClashFinder::most_points);
        continue;
      }
      ASSERT_EQ(found.records.size(), expected.records.size());
      for (std::size_t k = 0; k < found.records.size(); ++k) {
        const std::uint32_t record = expected.records[k];
        EXPECT_TRUE(list.points[found.records[k]] == nameOf(record));
        EXPECT_EQ(found.distances[k], in_memory.distance[record]);
        EXPECT_EQ(found.closest_poses[k], in_memory.closest_pose[record]);
      }
    }
  }

  files::TemporaryFolder folder;
  int places = 0; ///< sites made
};

TEST_F(SiteClashList, AlongAPath)
{
  Scene scene = floorScene();
  scene.cluster_distances = {0.05, 0.35, 4}; // from single points to farther than small tiles are long
  expectSame(scene, 1);
}

TEST_F(SiteClashList, OfSweptMotion)
{
  Scene scene = floorScene();
  scene.points.resize(1000);
  scene.swept = 0.01;
  expectSame(scene, 3);
}

TEST_F(SiteClashList, StepsOfExactlyTheDistanceLeadFromTileToTile)
{
  expectSame(latticeScene(0, 0), 2);
  expectSame(latticeScene(512000, 5403000), 2);
}

TEST_F(SiteClashList, OneBoxOfTwoClashes)
{
  expectSame(sameBoxScene(false), 3);
  expectSame(sameBoxScene(true), 3);
}

TEST_F(SiteClashList, NothingCollides)
{
  Scene scene = floorScene();
  scene.points.resize(300);
  for (Eigen::Isometry3d& pose : scene.poses) pose.translation().z() = 500;
  expectSame(scene, 0);
}

TEST(SiteSpacing, IsTheMedianOfItsPoints)
{
  Site site;
  EXPECT_EQ(spacingOf(site), 0.0);
  const auto add = [&](double spacing, std::uint64_t points) {
    Tile tile;
    tile.spacing = spacing;
    tile.points = points;
    site.tiles.push_back(tile);
    return spacingOf(site);
  };
  EXPECT_EQ(add(3.0, 10), 3.0);
  EXPECT_EQ(add(1.0, 10), 1.0) << "of two halves the smaller";
  EXPECT_EQ(add(2.0, 1), 2.0);
  EXPECT_EQ(add(4.0, 22), 4.0);
}

TEST_F(SiteClashList, RefusesADistance)
{
  const std::vector<Point3> point = {{0, 0, 0}};
  io::writeCloud(folder / "a.pcd", float64Cloud(point));
  const Site site = makeSite({folder / "a.pcd"}, folder / "site", {});
  for (const double distance : {0.0, -1.0, std::nan("")})
    EXPECT_THROW(ClashFinder(site, distance), std::invalid_argument);
  // Where nothing is measured there are no closest pairs.
  ClashFinder finder(site, 1.0);
  SiteQuestion request;
  request.clashes = &finder;
  request.accuracy = Accuracy::level(2);
  const SphereHierarchy model(viewOf(point.front().data(), 1));
  EXPECT_THROW(collideAlong(site, model, {Eigen::Isometry3d::Identity()}, request), std::invalid_argument);
  EXPECT_THROW(collideAlong(site, site, {}, {Eigen::Isometry3d::Identity()}, request), std::invalid_argument);
}

/// Lists of the program for one and two ranks, and of pcl_bsh_collide for the same points.
TEST_F(SiteClashList, OfThePrograms)
{
  Scene scene = floorScene();
  io::writeCloud(folder / "a.pcd", float64Cloud(scene.points));
  io::writeCloud(folder / "b.pcd", float64Cloud(scene.model));
  io::writePoses(folder / "poses.txt", scene.poses);
  MakeOptions options;
  options.tile_points = 70;
  makeSite({folder / "a.pcd"}, folder / "site", options);
  const std::string asked = " --clearance 0.3 --cluster-distance 0.35 --trajectory poses.txt ";
  const Outcome memory =
      run("pcl_bsh_collide", "a.pcd b.pcd m.pcd" + asked + "--clashes m.json --clashes m.csv", folder.path());
  ASSERT_EQ(memory.exit_code, 0) << memory.err;
  const Outcome one =
      run("pcl_bsh_site",
          "collide site b.pcd" + asked + "--clashes 1.json --clashes 1.csv --clashes 1.html --report r.json",
          folder.path());
  ASSERT_EQ(one.exit_code, 0) << one.err;

  Json expected = Json::parse(files::contentOf(folder / "m.json"));
  const Json found = Json::parse(files::contentOf(folder / "1.json"));
  ASSERT_GE(expected["clashes"].size(), 3u);
  EXPECT_EQ(Json::parse(files::contentOf(folder / "r.json"))["clashes"], expected["clashes"].size());
  expected["input"] = "site";
  for (Json& clash : expected["clashes"]) {
    Json& input = clash["closest_pair"]["input"];
    input["source"] = "a.pcd";
    input["record"] = input["point"];
    input.erase("point");
  }
  Json of_source = found;
  for (Json& clash : of_source["clashes"]) {
    Json& source = clash["closest_pair"]["input"]["source"];
    source = fs::path(source.get<std::string>()).filename().string();
  }
  EXPECT_EQ(of_source, expected);
  const std::string csv = files::contentOf(folder / "1.csv");
  EXPECT_THAT(csv, HasSubstr(",input_source,input_record,input_x,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), static_cast<std::ptrdiff_t>(found["clashes"].size()) + 1);
  EXPECT_THAT(files::contentOf(folder / "1.html"), HasSubstr(" of "));

  // The obstacle as a site.
  options.tile_points = 9;
  makeSite({folder / "b.pcd"}, folder / "moved", options);
  const std::string of_both = "collide site moved" + asked;
  const Outcome sites =
      run("pcl_bsh_site", of_both + "--clashes s.json --clashes s.csv --clashes s.html", folder.path());
  ASSERT_EQ(sites.exit_code, 0) << sites.err;
  const Json found_of_both = Json::parse(files::contentOf(folder / "s.json"));
  Json as_cloud = found_of_both;
  as_cloud["obstacle"] = "b.pcd";
  for (Json& clash : as_cloud["clashes"]) {
    Json& obstacle = clash["closest_pair"]["obstacle"];
    EXPECT_EQ(fs::path(obstacle["source"].get<std::string>()).filename(), "b.pcd");
    obstacle["point"] = obstacle["record"];
    obstacle.erase("source");
    obstacle.erase("record");
  }
  EXPECT_EQ(as_cloud, found);
  EXPECT_THAT(files::contentOf(folder / "s.csv"), HasSubstr(",obstacle_source,obstacle_record,obstacle_x,"));

  // An earlier list may be of either program.
  const Outcome again =
      run("pcl_bsh_site", "collide site b.pcd" + asked + "--clashes 1.json --previous 1.json", folder.path());
  ASSERT_EQ(again.exit_code, 0) << again.err;
  for (const Json& clash : Json::parse(files::contentOf(folder / "1.json"))["clashes"])
    EXPECT_EQ(clash["status"], "persisting");

  if (!hasMpirun()) GTEST_SKIP() << "no mpirun";
  const Outcome two =
      runOnTwoRanks("collide site b.pcd" + asked + "--clashes 2.json --clashes 2.csv --clashes 2.html", folder.path());
  ASSERT_EQ(two.exit_code, 0) << two.err;
  EXPECT_EQ(Json::parse(files::contentOf(folder / "2.json")), found);
  EXPECT_EQ(files::contentOf(folder / "2.csv"), csv);
  EXPECT_EQ(files::contentOf(folder / "2.html"), files::contentOf(folder / "1.html"));
  const Outcome sites_on_two = runOnTwoRanks(of_both + "--clashes s2.json --clashes s2.html", folder.path());
  ASSERT_EQ(sites_on_two.exit_code, 0) << sites_on_two.err;
  EXPECT_EQ(Json::parse(files::contentOf(folder / "s2.json")), found_of_both);
  EXPECT_EQ(files::contentOf(folder / "s2.html"), files::contentOf(folder / "s.html"));
  options.tile_points = scene.points.size(); // one tile: a rank has none
  makeSite({folder / "a.pcd"}, folder / "whole", options);
  const Outcome whole_on_two = runOnTwoRanks("collide whole moved" + asked + "--clashes w2.json", folder.path());
  ASSERT_EQ(whole_on_two.exit_code, 0) << whole_on_two.err;
  Json of_whole = Json::parse(files::contentOf(folder / "w2.json"));
  of_whole["input"] = "site";
  EXPECT_EQ(of_whole, found_of_both);
}

/// Where the points are uncertain, and where a later run does not look: as pcl_bsh_collide.
TEST_F(SiteClashList, OfThePrograms_SayWhatIsNotKnown)
{
  Scene scene = floorScene();
  io::writeCloud(folder / "a.pcd", float64Cloud(scene.points));
  io::writeCloud(folder / "b.pcd", float64Cloud(scene.model));
  io::writeCloud(folder / "far.pcd", float64Cloud({{1e6, 0, 0}}));
  io::writePoses(folder / "poses.txt", scene.poses);
  io::writePoses(folder / "one.txt", {scene.poses.front()});
  MakeOptions options;
  options.tile_points = 70;
  makeSite({folder / "a.pcd"}, folder / "site", options);
  makeSite({folder / "far.pcd"}, folder / "empty", options);
  options.tile_points = 9;
  makeSite({folder / "b.pcd"}, folder / "moved", options);
  const std::string alike = " --clearance 0.2 --cluster-distance 0.35 --uncertainty 0.1 --unit m --trajectory ";
  const auto listOf = [&](const std::string& program, const std::string& arguments) {
    const Outcome outcome = run(program.c_str(), arguments, folder.path());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return Json::parse(files::contentOf(folder / "list.json"));
  };
  const auto summaryOf = [](const Json& list) {
    Json lines = Json::array();
    for (const Json& clash : list["clashes"])
      lines.push_back({clash["id"], clash["status"], clash["certainty"], clash["certain_points"], clash["distance"]});
    return lines;
  };
  const Json in_memory = listOf("pcl_bsh_collide", "a.pcd b.pcd m.pcd" + alike + "poses.txt --clashes list.json");
  const Json of_site = listOf("pcl_bsh_site", "collide site b.pcd" + alike +
                                                  "poses.txt --clashes list.json --clashes first.json --report r.json");
  EXPECT_EQ(summaryOf(of_site), summaryOf(in_memory));
  std::size_t perhaps = 0;
  for (const Json& clash : of_site["clashes"]) perhaps += clash["certainty"] == "perhaps" ? 1U : 0U;
  const Json report = Json::parse(files::contentOf(folder / "r.json"));
  EXPECT_EQ(report["clashes_perhaps"], perhaps);
  EXPECT_EQ(report["clashes"], of_site["clashes"].size() - perhaps);
  EXPECT_EQ(of_site["unit"], "m");
  EXPECT_EQ(of_site["uncertainty"], in_memory["uncertainty"]);

  // One pose alone; and a scan of another place.
  const auto statusesOf = [&](const std::string& what) {
    std::map<std::string, std::size_t> statuses;
    const Json list = listOf("pcl_bsh_site", "collide " + what + " --clashes list.json --previous first.json");
    for (const Json& clash : list["clashes"]) ++statuses[clash["status"]];
    return statuses;
  };
  const Json shorter =
      listOf("pcl_bsh_collide", "a.pcd b.pcd m.pcd" + alike + "one.txt --clashes list.json --previous first.json");
  for (const std::string obstacle : {"b.pcd", "moved"}) {
    EXPECT_EQ(summaryOf(listOf("pcl_bsh_site", "collide site " + obstacle + alike +
                                                   "one.txt --clashes list.json --previous first.json")),
              summaryOf(shorter));
    EXPECT_GT(statusesOf("site " + obstacle + alike + "one.txt")["not_visited"], 0U);
    EXPECT_EQ(statusesOf("empty " + obstacle + alike + "poses.txt"),
              (std::map<std::string, std::size_t>{{"not_scanned", of_site["clashes"].size()}}));
  }
}

TEST_F(SiteClashList, OfThePrograms_NameTheCoordinateSystem)
{
  io::LasSample sample(4, 6);
  sample.records = {io::LasSample::record("LASF_Projection", 2112, "PROJCS[\"ETRS89 / UTM 32N\"]")};
  sample.addPoints(5);
  makeSite({folder.write("a.las", sample.text())}, folder / "site", {});
  const Outcome done = run("pcl_bsh_site",
                           "collide site a.las --clearance 0.1 --clashes list.json --clashes list.csv --clashes "
                           "list.html",
                           folder.path());
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(Json::parse(files::contentOf(folder / "list.json"))["coordinate_system"], "ETRS89 / UTM 32N");
  for (const char* list : {"list.csv", "list.html"})
    EXPECT_THAT(files::contentOf(folder / list), HasSubstr("ETRS89 / UTM 32N"));
}

TEST_F(SiteClashList, OfThePrograms_AreRefused)
{
  io::writeCloud(folder / "a.pcd", float64Cloud({{0, 0, 0}, {1, 0, 0}, {5, 0, 0}}));
  makeSite({folder / "a.pcd"}, folder / "site", {});
  const auto refusal = [&](const std::string& arguments, int exit_code) {
    const Outcome outcome = run("pcl_bsh_site", "collide site a.pcd --clearance 0.1 " + arguments, folder.path());
    EXPECT_EQ(outcome.exit_code, exit_code) << arguments;
    return outcome.err;
  };
  EXPECT_THAT(refusal("--clashes list.txt", 2), HasSubstr("unknown extension '.txt'"));
  EXPECT_THAT(refusal("--clashes list.json --any", 2), HasSubstr("--clashes: are of flags or a path"));
  EXPECT_THAT(refusal("--report a.pcd", 2), HasSubstr("is the file of OBSTACLE"));
  EXPECT_THAT(refusal("--clashes list.json --previous none.json", 1), HasSubstr("none.json"));
  EXPECT_FALSE(fs::exists(folder / "list.json"));
  // At one pose, without a path: the points are flagged, and the list is of one pose.
  const Outcome posed =
      run("pcl_bsh_site", "collide site a.pcd --clearance 0.1 --pose 1,0,0,0,0,0 --clashes list.json --out out",
          folder.path());
  ASSERT_EQ(posed.exit_code, 0) << posed.err;
  EXPECT_THAT(posed.out, HasSubstr("1 clash\n"));
  EXPECT_EQ(Json::parse(files::contentOf(folder / "list.json"))["poses"], 1);
  EXPECT_EQ(readSite(folder / "out").fields.back().name, "collision");
}

} // namespace
} // namespace pcl_bsh::site
#endif
