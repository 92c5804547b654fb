// SPDX-License-Identifier: BSD-3-Clause
// Obstacles with faces: a site is asked about their surface, with the answers of pcl_bsh_collide; and no site is made
// of faces.
#include "float64_cloud.h"
#include "solid/meshes.h"
#include "tools/programs/process.h"
#include "tools/programs/program_run.h"

#ifdef PCL_BSH_SITE_QUERIES
#include "two_ranks.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/ask_site.h>
#include <pcl_bsh/site/make_site.h>
#include <pcl_bsh/site/result_site.h>

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <random>
#include <thread>

namespace pcl_bsh::site {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

/// A crate two metres wide, and a site of points on one of its faces, about it and far away.
class SurfaceSite : public testing::Test {
protected:
  static constexpr auto crate_text = "OFF\n8 6 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n0 0 2\n2 0 2\n2 2 2\n0 2 2\n"
                                     "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";

  SurfaceSite()
  {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<Point3> points;
    for (int i = 0; i < 5000; ++i) points.push_back({1 + 0.9 * unit(random), 1 + 0.9 * unit(random), 2});
    for (int i = 0; i < 3000; ++i) points.push_back({1 + 6 * unit(random), 1 + 3 * unit(random), 1 + 3 * unit(random)});
    io::writeCloud(folder / "scan.pcd", float64Cloud(points));
    folder.write("crate.off", crate_text);
    std::vector<Eigen::Isometry3d> poses;
    for (int k = 0; k < 12; ++k)
      poses.push_back(Eigen::Translation3d(0.7 * k - 4, 0.1 * k, 0.3) *
                      Eigen::AngleAxisd(0.1 * k, Eigen::Vector3d::UnitZ()));
    io::writePoses(folder / "poses.txt", poses);
    MakeOptions options;
    options.tile_points = 900;
    site = makeSite({folder / "scan.pcd"}, folder / "site", options);
  }

  Outcome ask(const std::string& arguments) const
  {
    return run("pcl_bsh_site", "collide site crate.off " + arguments, folder.path());
  }
  Json json(const std::string& name) const { return Json::parse(files::contentOf(folder / name)); }

  /// The results of a site as they are of each record.
  std::vector<double> column(const std::string& name, const std::string& field) const
  {
    const Site out = readSite(folder / name);
    std::vector<double> values(out.points, -7.0);
    for (const Tile& tile : out.tiles) {
      const pcl::PCLPointCloud2 cloud = readTile(out, tile);
      for (std::uint32_t i = 0; i < cloud.width; ++i)
        values[static_cast<std::size_t>(io::valueOf(cloud, i, "record"))] = io::valueOf(cloud, i, field);
    }
    return values;
  }

  /// Expects that a field of the site of results equals that of a file that pcl_bsh_collide has written.
  void expectSame(const std::string& out, const std::string& cloud_file, const std::string& field) const
  {
    const pcl::PCLPointCloud2 cloud = io::readCloud(folder / cloud_file);
    const std::vector<double> found = column(out, field);
    ASSERT_EQ(found.size(), cloud.width);
    std::size_t different = 0;
    for (std::uint32_t i = 0; i < cloud.width; ++i) {
      const double wanted = io::valueOf(cloud, i, field);
      if (found[i] != wanted && !(std::isnan(found[i]) && std::isnan(wanted))) ++different;
    }
    EXPECT_EQ(different, 0U) << field;
  }

  /// Runs both programs with these options.
  Json expectedOf(const std::string& arguments)
  {
    for (const char* name : {"out", "m.pcd", "m.json", "r.json"}) fs::remove_all(folder / name);
    const Outcome memory =
        run("pcl_bsh_collide", "scan.pcd crate.off m.pcd --report m.json " + arguments, folder.path());
    EXPECT_EQ(memory.exit_code, 0) << memory.err;
    const Outcome done = ask("--out out --report r.json " + arguments);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    said = done.out + done.err;
    EXPECT_EQ(json("r.json")["surface"], json("m.json")["surface"]);
    EXPECT_EQ(json("r.json")["options"], json("m.json")["options"]);
    const Json of_memory = json("m.json")["warnings"];
    for (const Json& warning : json("r.json")["warnings"])
      EXPECT_EQ(std::count(of_memory.begin(), of_memory.end(), warning), 1) << warning;
    return json("m.json");
  }

  files::TemporaryFolder folder;
  Site site;
  std::string said;
};

TEST_F(SurfaceSite, FlagsAreThoseOfMemory)
{
  for (const std::string more : {"", "--accuracy tolerance=0.01", "--vertices-only"}) {
    SCOPED_TRACE(more);
    const Json expected = expectedOf("--clearance 0.2 " + more);
    const Json found = json("r.json");
    EXPECT_EQ(found["colliding"], expected["colliding"]);
    EXPECT_EQ(found["undecided"], expected["undecided"]);
    expectSame("out", "m.pcd", "collision");
    const bool is_surface = more != "--vertices-only";
    EXPECT_EQ(found["colliding"].get<int>() >= 5000, is_surface);
    EXPECT_EQ(found["surface"].is_null(), !is_surface);
    if (is_surface) {
      EXPECT_THAT(said, HasSubstr("a surface of 12 triangles: what it encloses is no part of it"));
      EXPECT_LE(found["colliding_of_obstacle"].get<int>(), 12);
    }
    else {
      EXPECT_LE(found["colliding_of_obstacle"].get<int>(), 8);
    }
  }
  ASSERT_EQ(ask("--clearance 0.2 --any --report any.json").exit_code, 0);
  EXPECT_EQ(json("any.json")["collides"], true);
  EXPECT_EQ(json("any.json")["surface"]["triangles"], 12);
}

TEST_F(SurfaceSite, DistancesAreThoseOfMemory)
{
  const Json expected = expectedOf("--distances");
  expectSame("out", "m.pcd", "distance");
  EXPECT_GE(json("r.json")["greatest"].get<double>(), 1.0);
  for (const char* pose : {"0,0,0,0,0,0", "0,0,40,0,0,0"}) {
    const std::string at = std::string("--pose ") + pose;
    ASSERT_EQ(
        run("pcl_bsh_collide", "scan.pcd crate.off m.pcd --clearance 0 --report m.json " + at, folder.path()).exit_code,
        0);
    const Outcome done = ask("--closest --report r.json " + at);
    ASSERT_EQ(done.exit_code, 0) << done.err;
    const Json found = json("r.json"), wanted = json("m.json");
    EXPECT_EQ(found["distance"], wanted["distance"]);
    EXPECT_GE(found["distance"].get<double>(), 0.0);
    EXPECT_EQ(found["distance_interval"], wanted["distance_interval"]);
    EXPECT_EQ(found["triangle_of_obstacle"], wanted["closest_pair"][1]);
    EXPECT_FALSE(found.contains("point_of_obstacle"));
  }
}

TEST_F(SurfaceSite, PathsAreThoseOfMemory)
{
  for (const std::string swept : {"", " --swept 0.01"}) {
    SCOPED_TRACE(swept);
    const std::string lists = " --clearance 0.2 --cluster-distance 0.5 --trajectory poses.txt" + swept;
    for (const char* name : {"out", "m.json", "r.json"}) fs::remove_all(folder / name);
    const Outcome memory =
        run("pcl_bsh_collide", "scan.pcd crate.off m.pcd --report m.json --clashes m_list.json" + lists, folder.path());
    ASSERT_EQ(memory.exit_code, 0) << memory.err;
    const Outcome done = ask("--out out --report r.json --clashes r_list.json --clashes r_list.csv" + lists);
    ASSERT_EQ(done.exit_code, 0) << done.err;
    const Json found = json("r.json"), wanted = json("m.json");
    EXPECT_EQ(found["surface"], wanted["surface"]);
    EXPECT_EQ(found["colliding"], wanted["colliding"]);
    for (const char* field : {"collision", "distance", "first_pose", "closest_pose"}) expectSame("out", "m.pcd", field);
    EXPECT_GE(found["distance"].get<double>(), 0.0);
    Json clashes = json("r_list.json"), of_memory = json("m_list.json");
    EXPECT_EQ(clashes["surface"], of_memory["surface"]);
    ASSERT_EQ(clashes["clashes"].size(), of_memory["clashes"].size());
    ASSERT_GT(clashes["clashes"].size(), 0U);
    for (std::size_t i = 0; i < clashes["clashes"].size(); ++i) {
      Json &clash = clashes["clashes"][i], &expected = of_memory["clashes"][i];
      EXPECT_EQ(clash["closest_pair"]["input"]["record"], expected["closest_pair"]["input"]["point"]);
      EXPECT_EQ(clash["closest_pair"]["obstacle"], expected["closest_pair"]["obstacle"]) << "a triangle, and where";
      EXPECT_TRUE(clash["closest_pair"]["obstacle"].contains("triangle"));
      for (const char* key : {"id", "points", "box", "distance", "first_pose", "closest_pose"})
        EXPECT_EQ(clash[key], expected[key]) << key;
    }
    EXPECT_THAT(files::contentOf(folder / "r_list.csv"), HasSubstr("obstacle_triangle,obstacle_x"));
  }
}

TEST_F(SurfaceSite, SolidsAreThoseOfMemory)
{
  const Json flags = expectedOf("--clearance 0.2 --solid");
  EXPECT_EQ(json("r.json")["colliding"], flags["colliding"]);
  expectSame("out", "m.pcd", "collision");
  const Json hollow = expectedOf("--clearance 0.2");
  EXPECT_GT(flags["colliding"].get<int>(), hollow["colliding"].get<int>() + 20) << "those in the middle";

  expectedOf("--distances --solid");
  expectSame("out", "m.pcd", "distance");
  for (const char* pose : {"0,0,0,0,0,0", "0,0,0.5,0.3,0,0", "0,0,40,0,0,0"}) {
    const std::string at = std::string("--solid --pose ") + pose;
    ASSERT_EQ(
        run("pcl_bsh_collide", "scan.pcd crate.off m.pcd --clearance 0 --report m.json " + at, folder.path()).exit_code,
        0);
    ASSERT_EQ(ask("--closest --report r.json " + at).exit_code, 0);
    const Json found = json("r.json"), wanted = json("m.json");
    EXPECT_EQ(found["distance"], wanted["distance"]);
    EXPECT_EQ(found["distance"].get<double>() < 0.0, std::string(pose).find("40") == std::string::npos);
    ASSERT_EQ(ask("--any --clearance 0 --report r.json " + at).exit_code, 0);
    EXPECT_EQ(json("r.json")["collides"], wanted["colliding"].get<int>() > 0);
  }
  expectedOf("--clearance 0.05 --trajectory poses.txt --solid");
  for (const char* field : {"collision", "first_pose"}) expectSame("out", "m.pcd", field);
}

/// As the whole cloud: of tiles inside, whose boxes meet that of the solid, the deepest point counts.
TEST_F(SurfaceSite, TheClosestPairOfASolidIsThatOfMemory)
{
  const pcl::PCLPointCloud2 scan = io::readCloud(folder / "scan.pcd");
  const io::Mesh mesh = io::readMesh(folder / "crate.off");
  for (const double up : {0.0, 0.5, 40.0}) {
    SCOPED_TRACE(up);
    pcl_bsh::Shape cloud("the input", viewOf(scan)),
        crate("the obstacle", viewOf(trianglesOf(viewOf(mesh.vertices),
                                                 std::make_shared<const std::vector<Triangle>>(mesh.triangles))));
    const Eigen::Isometry3d pose(Eigen::Translation3d(0, 0, up));
    Question question;
    question.solid = true;
    question.wanted.closest = true;
    question.pose = pose;
    const Answer wanted = pcl_bsh::ask(question, cloud, crate);
    const SiteAnswer found = site::ask(question, site, crate);
    EXPECT_EQ(found.closest.distance, wanted.closest.distance);
    EXPECT_EQ(found.closest.distance < 0.0, up < 10.0);
    ASSERT_TRUE(found.pair && wanted.closest.pair);
    EXPECT_EQ(found.pair->a.record, wanted.closest.pair->a);
  }
}

/// Near the surface what a solid holds is certain or not by the clearance, too.
TEST_F(SurfaceSite, WhatASolidHoldsOfUncertainPointsIsThatOfMemory)
{
  const test::ClosedMesh mesh = test::boxMesh(2.0);
  const pcl::PCLPointCloud2 scan = io::readCloud(folder / "scan.pcd");
  Shape crate("crate", viewOf(mesh.view())), points("scan", viewOf(scan));
  Question question;
  question.clearance = 0.2;
  question.uncertainty = 0.1;
  question.solid = true;
  std::vector<Verdict> flags(scan.width);
  SiteMeans means;
  means.receiver = [&](const Tile&, const pcl::PCLPointCloud2& cloud, const Answer& found) {
    for (std::uint32_t i = 0; i < cloud.width; ++i)
      flags[static_cast<std::size_t>(io::valueOf(cloud, i, "record"))] = found.collisions.flags[i];
  };

  question.wanted.flags = true;
  std::fill(flags.begin(), flags.end(), Verdict::free);
  site::ask(question, site, crate, means);
  EXPECT_EQ(flags, pcl_bsh::ask(question, points, crate).collisions.flags);
  question.path = io::readPoses(folder / "poses.txt");
  std::fill(flags.begin(), flags.end(), Verdict::free);
  site::ask(question, site, crate, means);
  EXPECT_EQ(flags, pcl_bsh::ask(question, points, crate).collisions.flags);

  question.path.reset();
  question.wanted = {};
  question.wanted.any = true;
  for (const double depth : {0.05, 0.15, 0.25, 0.35}) {
    const std::vector<Point3> one = {{1, 1, 2 - depth}};
    io::writeCloud(folder / "one.pcd", float64Cloud(one));
    const Site of_one = makeSite({folder / "one.pcd"}, folder / ("one" + std::to_string(depth)), {});
    Shape point("point", viewOf(one[0].data(), 1));
    EXPECT_EQ(site::ask(question, of_one, crate).any.verdict, pcl_bsh::ask(question, point, crate).any.verdict)
        << depth;
  }
}

/// A tile in the middle of a solid meets no box about parts of its surface.
TEST_F(SurfaceSite, TilesInTheMiddleOfALargeSolidAreAskedAbout)
{
  std::string large = crate_text;
  for (std::size_t at = large.find('2', 10); at != std::string::npos && at < large.find("\n4");
       at = large.find('2', at + 1))
    large.replace(at, 1, "9000");
  folder.write("large.off", large);
  const std::string about = "collide site large.off --pose=-4500,-4500,-4500,0,0,0 --clearance 0 --report r.json";
  ASSERT_EQ(run("pcl_bsh_site", about + " --solid", folder.path()).exit_code, 0);
  EXPECT_EQ(json("r.json")["colliding"], 8000);
  EXPECT_THAT(json("r.json")["warnings"].dump(), Not(HasSubstr("close round")));
  ASSERT_EQ(run("pcl_bsh_site", about, folder.path()).exit_code, 0);
  EXPECT_EQ(json("r.json")["colliding"], 0);
}

/// A crate that is thrice as large, round the middle of the scan.
TEST_F(SurfaceSite, TellsWhereFacesCloseRoundThePoints)
{
  const auto warned = [&](const std::string& arguments, const std::string& mesh = "large.off") {
    const Outcome done = run("pcl_bsh_site", "collide site " + mesh + " --report r.json " + arguments, folder.path());
    EXPECT_EQ(done.exit_code, 0) << done.err;
    const bool told = done.err.find("its faces close round places of ") != std::string::npos;
    EXPECT_EQ(told, json("r.json")["warnings"].dump().find("close round") != std::string::npos);
    return told;
  };
  std::string large = crate_text;
  for (std::size_t at = large.find('2', 10); at != std::string::npos && at < large.find("\n4");
       at = large.find('2', at + 1))
    large.replace(at, 1, "60");
  folder.write("large.off", large);
  const std::string in = " --pose=-30,-30,-30,0,0,0";
  io::writePoses(folder / "in.txt", {Eigen::Isometry3d(Eigen::Translation3d(-30, -30, -30))});
  for (const std::string kind : {"--clearance 0.1", "--any --clearance 0.1", "--closest", "--distances"}) {
    SCOPED_TRACE(kind);
    EXPECT_TRUE(warned(kind + in));
    EXPECT_FALSE(warned(kind + in + " --solid"));
    EXPECT_FALSE(warned(kind + " --pose=-200,0,0,0,0,0"));
    EXPECT_FALSE(warned(kind, "crate.off")) << "points lie on it";
  }
  EXPECT_TRUE(warned("--clearance 0.1 --trajectory in.txt"));
  EXPECT_FALSE(warned("--clearance 26 --trajectory in.txt")) << "something collides";
  const std::string open = std::string(large).replace(large.find("8 6 0"), 5, "8 5 0").erase(large.rfind("\n4 ") + 1);
  folder.write("large.off", open);
  EXPECT_FALSE(warned("--clearance 0.1" + in));
}

TEST_F(SurfaceSite, WarnsOfWhatIsHollowWhereNothingIsNear)
{
  const io::Mesh mesh = io::readMesh(folder / "crate.off");
  pcl::PCLPointCloud2 corners = mesh.vertices;
  for (std::size_t i = 0; i < corners.width; ++i) { // sixty metres wide
    double p[3];
    std::memcpy(p, &corners.data[i * corners.point_step], sizeof p);
    for (double& c : p) c *= 30;
    std::memcpy(&corners.data[i * corners.point_step], p, sizeof p);
  }
  const auto triangles = std::make_shared<const std::vector<Triangle>>(mesh.triangles);
  pcl_bsh::Shape crate("the crate", viewOf(trianglesOf(viewOf(corners), triangles)));
  pcl_bsh::Shape points("the corners", viewOf(corners));
  const auto warned = [&](const Question& question, pcl_bsh::Shape& obstacle) {
    for (const Warning& warning : site::ask(question, site, obstacle).warnings) {
      if (warning.kind != WarningKind::hollow) continue;
      EXPECT_THAT(warning.text, HasSubstr("the crate: its faces close round places of " + site.folder.string()));
      return true;
    }
    return false;
  };
  const Eigen::Isometry3d about(Eigen::Translation3d(-30, -30, -30)), beside(Eigen::Translation3d(-200, 0, 0));
  Question question;
  question.pose = about;
  question.wanted.distances = true; // which do not tell how near it is
  EXPECT_TRUE(warned(question, crate));
  EXPECT_FALSE(warned(question, points));
  question.wanted = {};
  question.wanted.closest = true;
  EXPECT_TRUE(warned(question, crate));
  question.wanted = {};
  question.wanted.any = true;
  question.clearance = 40.0;
  EXPECT_FALSE(warned(question, crate)) << "something is near its faces";
  question.clearance = 0.1;
  EXPECT_TRUE(warned(question, crate));
  question.wanted = {};
  question.wanted.distances = true;
  question.pose = beside;
  EXPECT_FALSE(warned(question, crate));
  question.wanted = {};
  question.wanted.flags = true;
  question.path = std::vector<Eigen::Isometry3d>(3, beside);
  EXPECT_FALSE(warned(question, crate));
  question.path->back() = about;
  EXPECT_TRUE(warned(question, crate));
  question.solid = true;
  EXPECT_FALSE(warned(question, crate));
}

TEST_F(SurfaceSite, RefusesSolidsThatDoNotClose)
{
  std::string open = crate_text;
  folder.write("crate.off", open.replace(open.find("8 6 0"), 5, "8 5 0").erase(open.rfind("\n4 ") + 1));
  const Outcome refused = ask("--clearance 0.2 --solid --report r.json");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("crate.off: 4 edges are open"));
  EXPECT_EQ(run("pcl_bsh_site", "collide site site --clearance 1 --solid --report r.json", folder.path()).exit_code, 2);
}

TEST_F(SurfaceSite, TellsOfLooseVerticesAsMemoryDoes)
{
  std::string loose = crate_text;
  loose.replace(loose.find("8 6 0"), 5, "9 6 0").replace(loose.find("4 0 3 2 1"), 0, "50 50 50\n");
  folder.write("crate.off", loose);
  expectedOf("--clearance 0.2");
  EXPECT_THAT(said, HasSubstr("crate.off: 1 of its vertices belongs to no face"));
  EXPECT_THAT(json("r.json")["warnings"][0].get<std::string>(), HasSubstr("belongs to no face"));
}

TEST_F(SurfaceSite, RefusesWhatNoSurfaceHas)
{
  const auto fails = [&](const std::string& arguments, int code, const std::string& message) {
    const Outcome failed = ask(arguments + " --clearance 0.2 --report r.json");
    EXPECT_EQ(failed.exit_code, code) << arguments;
    EXPECT_THAT(failed.err, HasSubstr(message));
    EXPECT_FALSE(fs::exists(folder / "r.json"));
  };
  fails("--surface-tolerance 1", 2, "--surface-tolerance");
  fails("--obstacle-uncertainty sigma", 1,
        "crate.off: is a surface, which has no field 'sigma': give a length, or --vertices-only");
  fails("--obstacle-out marked.pcd", 1, "marked.pcd");
}

/// Each triangle has its own flag.
TEST_F(SurfaceSite, MarksTheObstaclesTriangles)
{
  const Outcome done = ask("--clearance 0.2 --pose 0,0,0.03,0,0,0 --obstacle-out marked.ply --report r.json");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const io::Mesh marked = io::readMesh(folder / "marked.ply");
  ASSERT_EQ(marked.triangles.size(), 12U);
  ASSERT_EQ(marked.face_values.size(), 1U);
  EXPECT_EQ(marked.face_values[0].name, "collision");
  // The flags are those of the crate as the input, with the scan as the obstacle.
  ASSERT_EQ(
      run("pcl_bsh_collide", "crate.off scan.pcd expected.ply --clearance 0.2 --pose 0,0,-0.03,0,0,0", folder.path())
          .exit_code,
      0);
  EXPECT_EQ(marked.face_values[0].values, io::readMesh(folder / "expected.ply").face_values[0].values);
  const auto colliding = std::count(marked.face_values[0].values.begin(), marked.face_values[0].values.end(), 1.0);
  EXPECT_EQ(json("r.json")["colliding_of_obstacle"], colliding);
  EXPECT_GT(colliding, 1);
  EXPECT_GE(json("r.json")["colliding"].get<int>(), 5000);
}

/// Answers about another surface are not taken over: one with other faces between the same corners, say.
TEST_F(SurfaceSite, GoesOnWithTheSameSurfaceAlone)
{
  const std::vector<std::string> asked = {"collide",   "site",     "crate.off", "--clearance", "0.2", "--trajectory",
                                          "poses.txt", "--report", "r.json",    "--out",       "out"};
  const auto killed = [&] {
    fs::remove_all(folder / "out");
    for (int attempt = 0; attempt < 20; ++attempt) {
      Process program("pcl_bsh_site", asked, folder.path());
      while (!program.hasEnded() && answersIn(folder / "out") == 0) std::this_thread::yield();
      program.send(SIGKILL);
      program.end();
      if (!fs::exists(folder / "out/site.json")) return;
      fs::remove_all(folder / "out"); // it was quicker
    }
    GTEST_SKIP() << "it is always quicker";
  };
  const auto resumed = [&](std::vector<std::string> more) {
    more.insert(more.begin(), asked.begin(), asked.end());
    more.emplace_back("--resume");
    Process program("pcl_bsh_site", more, folder.path());
    const int code = program.end();
    return std::pair(code, program.err());
  };
  killed();
  for (const std::vector<std::string>& other :
       std::vector<std::vector<std::string>>{{"--vertices-only"},
                                             {"--solid"},
                                             {"--swept", "0.01"},
                                             {"--accuracy", "tolerance=0.01"},
                                             {"--uncertainty", "0.01"},
                                             {"--obstacle-uncertainty", "0.01"},
                                             {"--pose-uncertainty", "0.01,0"},
                                             {"--input-pose-uncertainty", "0.01,0"},
                                             {"--seen", "--origin", "0,0,9", "--seen-angle", "0.01"}})
    EXPECT_THAT(resumed(other).second, HasSubstr("holds what another question has found")) << other.front();
  std::string open = crate_text;
  open.replace(open.find("8 6 0"), 5, "8 5 0").erase(open.find("4 0 3 2 1"), 10);
  folder.write("crate.off", open);
  EXPECT_THAT(resumed({}).second, HasSubstr("holds what another question has found"));
  folder.write("crate.off", crate_text);
  const auto [code, err] = resumed({});
  EXPECT_EQ(code, 0) << err;
  EXPECT_LT(json("r.json")["tiles"]["read"], json("r.json")["tiles"]["needed"]);
}

TEST_F(SurfaceSite, IsTheSameOfTwoRanks)
{
  if (!hasMpirun()) GTEST_SKIP() << "no mpirun";
  const std::string asked = "--clearance 0.2 --obstacle-out ";
  ASSERT_EQ(ask(asked + "one.ply --report one.json").exit_code, 0);
  const Outcome two = runOnTwoRanks("collide site crate.off " + asked + "two.ply --report two.json", folder.path());
  ASSERT_EQ(two.exit_code, 0) << two.err;
  EXPECT_EQ(json("two.json")["colliding"], json("one.json")["colliding"]);
  EXPECT_EQ(json("two.json")["surface"], json("one.json")["surface"]);
  EXPECT_TRUE(files::contentOf(folder / "one.ply") == files::contentOf(folder / "two.ply"));
}

TEST_F(SurfaceSite, IsNotMadeOfFaces)
{
  folder.write("faces.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("faces.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
               "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 "
               "0\n3 0 1 2\n");
  folder.write("faces.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                            "endloop\nendfacet\nendsolid a\n");
  for (const std::string name : {"crate.off", "faces.obj", "faces.ply", "faces.stl"}) {
    const Outcome refused = run("pcl_bsh_site", "make scan.pcd " + name + " --out made", folder.path());
    EXPECT_EQ(refused.exit_code, 1) << name;
    EXPECT_THAT(refused.err, HasSubstr(name + ": has faces, which a site cannot hold: take its vertices alone "
                                              "(--vertices-only)"));
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
    EXPECT_FALSE(fs::exists(folder / "made"));
    EXPECT_EQ(run("pcl_bsh_site", "make " + name + " --vertices-only --out made", folder.path()).exit_code, 0);
    EXPECT_EQ(readSite(folder / "made").points, name == "crate.off" ? 8U : 3U);
    fs::remove_all(folder / "made");
  }
  // Points in files that may have faces.
  folder.write("points.ply", "ply\nformat ascii 1.0\ncomment a surface\nelement vertex 1\nproperty float x\nproperty "
                             "float y\nproperty float z\nelement face 0\nproperty list uchar int vertex_indices\n"
                             "end_header\n0 0 0\n");
  folder.write("points.obj", "v 0 0 0\nv 1 0 0\n");
  folder.write("points.off", "OFF\n2 0 0\n0 0 0\n1 0 0\n");
  for (const std::string name : {"points.ply", "points.obj", "points.off"}) {
    EXPECT_EQ(run("pcl_bsh_site", "make " + name + " --out made", folder.path()).exit_code, 0) << name;
    fs::remove_all(folder / "made");
  }
}

} // namespace
} // namespace pcl_bsh::site
#endif
