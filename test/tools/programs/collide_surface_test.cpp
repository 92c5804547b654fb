// SPDX-License-Identifier: BSD-3-Clause
// pcl_bsh_collide with obstacles that have faces. test/certify holds its verdicts against exact distances.
#include "program_run.h"
#include "support/verdicts.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

using io::valueOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

/// A crate of eight corners, two metres wide, and points about it.
class CollideSurface : public testing::Test {
protected:
  Outcome collide(const std::string& arguments) const { return run("pcl_bsh_collide", arguments, folder.path()); }

  std::string collideOutput(const std::string& arguments) const
  {
    const Outcome done = collide(arguments);
    EXPECT_EQ(done.exit_code, 0) << arguments << '\n' << done.err;
    return done.out + done.err;
  }

  std::vector<double> column(const std::string& name, const std::string& file = "out.pcd") const
  {
    const pcl::PCLPointCloud2 cloud = io::readCloud(folder / file);
    std::vector<double> values;
    for (std::size_t i = 0; i < cloud.width; ++i) values.push_back(valueOf(cloud, i, name));
    return values;
  }

  Json json(const std::string& file) const { return Json::parse(io::contentOf(folder / file)); }

  io::TemporaryFolder folder;
  std::filesystem::path crate =
      folder.write("crate.off", "OFF\n8 6 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n0 0 2\n2 0 2\n2 2 2\n0 2 2\n"
                                "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  /// In the middle of a face, 5 cm from it, a metre inside, 20 cm outside an edge, far away.
  std::filesystem::path scan = folder.write("scan.xyz", "1 1 2\n1 1 2.05\n1 1 1\n1 2.12 2.16\n9 9 9\n");
};

TEST_F(CollideSurface, TheMiddleOfAFaceCollides)
{
  const std::string job = "scan.xyz crate.off out.pcd --clearance 0.1 --report report.json";
  const std::string said = collideOutput(job);
  EXPECT_THAT(column("collision"), ElementsAre(1, 1, 0, 0, 0));
  EXPECT_THAT(said, HasSubstr("2 of 5 points collide; smallest distance 0, between point 0 of the input and triangle"));
  EXPECT_THAT(said, HasSubstr("a surface of 12 triangles: what it encloses is no part of it"));
  const Json report = json("report.json");
  EXPECT_EQ(report["surface"]["triangles"], 12);
  EXPECT_THAT(report["surface"]["promise"].get<std::string>(), HasSubstr("what it encloses is no part of it"));
  EXPECT_EQ(report["obstacle"]["points"], 8);
  EXPECT_EQ(report["density"]["obstacle"], nullptr);
  EXPECT_EQ(report["closest_pair"][0], 0);
  EXPECT_LT(report["closest_pair"][1], 12);
  EXPECT_EQ(report["distance"], 0.0);
  EXPECT_EQ(report["distance_interval"][1], 0.0);
  EXPECT_TRUE(report["warnings"].empty()) << report["warnings"];

  const std::string before = collideOutput(job + " --vertices-only");
  EXPECT_THAT(column("collision"), ElementsAre(0, 0, 0, 0, 0));
  EXPECT_THAT(before, HasSubstr("point 3 of the input and point"));
  EXPECT_EQ(json("report.json")["surface"], nullptr);
}

/// A mesh of a machine comes back as a mesh, with what each of its triangles does.
TEST_F(CollideSurface, MarksTheObstaclesTriangles)
{
  const auto values = [&](const std::string& file) {
    const io::Mesh mesh = io::readMesh(folder / file);
    EXPECT_EQ(mesh.triangles.size(), 12U) << file;
    EXPECT_EQ(mesh.face_values.size(), 1U) << file;
    EXPECT_EQ(mesh.face_values.at(0).name, "collision") << file;
    return mesh.face_values.at(0).values;
  };
  io::writeMesh(folder / "crate.ply", io::readMesh(crate).vertices, io::readMesh(crate).triangles);
  for (const std::string obstacle : {"crate.off", "crate.ply"}) {
    const std::string said = collideOutput("scan.xyz " + obstacle +
                                           " out.pcd --clearance 0.2 --pose 0,0,0.03,0,0,0 "
                                           "--obstacle-out marked.ply --report report.json");
    EXPECT_THAT(said, Not(HasSubstr("--vertices-only")));
    collideOutput(obstacle + " scan.xyz expected.ply --clearance 0.2 --pose 0,0,-0.03,0,0,0");
    const std::vector<double> found = values("marked.ply");
    EXPECT_EQ(found, values("expected.ply")) << "as of the input of the question the other way round";
    const auto colliding = std::count(found.begin(), found.end(), 1.0);
    EXPECT_GT(colliding, 1);
    EXPECT_EQ(json("report.json")["colliding_of_obstacle"], colliding);
  }
  collideOutput("scan.xyz crate.off out.pcd --clearance 0.2 --vertices-only --obstacle-out marked.pcd");
  EXPECT_EQ(column("collision", "marked.pcd").size(), 8U);
  collideOutput("scan.xyz scan.xyz out.pcd --clearance 0.2 --pose 0,0,1,0,0,0 --obstacle-out marked.pcd");
  EXPECT_THAT(column("collision", "marked.pcd"), ElementsAre(0, 0, 1, 0, 0));
}

TEST_F(CollideSurface, MarksWhichTrianglesNobodySaw)
{
  std::string points; // of a scanner amid a ball, with a pillar before what is at x = 3
  for (double elevation = -1.55; elevation <= 1.55; elevation += 0.02) {
    for (double azimuth = 0.0; azimuth < 6.28; azimuth += 0.02) {
      const double right = std::cos(elevation) * std::cos(azimuth), range = right > 0.5 ? 2.0 : 5.0;
      points += std::to_string(range * right) + ' ' + std::to_string(range * std::cos(elevation) * std::sin(azimuth)) +
                ' ' + std::to_string(range * std::sin(elevation)) + '\n';
    }
  }
  folder.write("ball.xyz", points);
  folder.write("parts.off", "OFF\n9 3 0\n3 0 0\n3 0.1 0\n3 0 0.1\n-3 0 0\n-3 0.1 0\n-3 0 0.1\n"
                            "-5 0 0\n-5 0.1 0\n-5 0 0.1\n3 0 1 2\n3 3 4 5\n3 6 7 8\n");
  for (const std::string rest : {"", "--from 0,0,0,0,0,0 --to 0,0,0.01,0,0,0 --steps 1", "--clashes c.json"}) {
    collideOutput("ball.xyz parts.off out.pcd --clearance 0.1 --seen --origin 0,0,0 --obstacle-out marked.ply " + rest);
    EXPECT_THAT(io::readMesh(folder / "marked.ply").face_values.at(0).values, ElementsAre(4, 0, 1)) << rest;
  }
}

TEST_F(CollideSurface, RefusesFilesThatHaveNoPlaceForFlagsOfTriangles)
{
  for (const char* file : {"marked.pcd", "marked.las", "marked.stl", "marked.obj", "marked.off", "marked.xyz"}) {
    const Outcome refused = collide(std::string("scan.xyz crate.off out.pcd --clearance 0.2 --obstacle-out ") + file);
    EXPECT_EQ(refused.exit_code, 1) << file;
    EXPECT_THAT(refused.err, HasSubstr(std::string(file) + ": has no place for what is known of triangles: write a "
                                                           ".ply file"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pcd")) << file;
    EXPECT_FALSE(std::filesystem::exists(folder / file)) << file;
  }
  for (const char* rest : {"--clashes c.json", "--from 0,0,0,0,0,0 --to 0,0,1,0,0,0 --steps 2"}) {
    const Outcome refused =
        collide(std::string("scan.xyz crate.off out.pcd --clearance 0.2 --obstacle-out marked.ply ") + rest);
    EXPECT_EQ(refused.exit_code, 2) << rest;
    EXPECT_THAT(refused.err, HasSubstr("--obstacle-out: are flags at one pose")) << rest;
  }
}

TEST_F(CollideSurface, DistancesAreThoseOfTheTriangles)
{
  collideOutput(
      "scan.xyz crate.off out.pcd --clearance 0.1 --distances --report report.json --distance-page page.html");
  const std::vector<double> truth = {0, 0.05, 1, 0.2, 7 * std::sqrt(3.0)};
  const std::vector<double> told = column("distance");
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(told[i], truth[i], 1e-6) << i; // of floats
  }
  const Json distances = json("report.json")["distances"];
  EXPECT_LT(distances["hausdorff_pair"][1], 12);
  EXPECT_LT(distances["input_to_obstacle"]["places"][0]["closest_point"], 12);
  EXPECT_EQ(distances["obstacle_to_input"]["count"], 12);
  EXPECT_LT(distances["obstacle_to_input"]["farthest_pair"][1], 12);
  EXPECT_THAT(io::contentOf(folder / "page.html"), HasSubstr("a triangle of the obstacle"));
  EXPECT_THAT(io::contentOf(folder / "page.html"),
              HasSubstr("the distance of a triangle is that of its nearest point"));
}

/// Two clusters in a crate, of which the list, the page and the table tell how deep they are.
TEST_F(CollideSurface, ListsHowDeepClashesAre)
{
  folder.write("deep.xyz", "1 1 1.9774\n1 1 2.01\n0.304 0.7 0.7\n9 9 9\n");
  const std::string said =
      collideOutput("deep.xyz crate.off out.pcd --clearance 0.05 --solid --cluster-distance 0.1 "
                    "--clashes clashes.json --clashes clashes.csv --clashes clashes.html --report report.json");
  EXPECT_THAT(said, HasSubstr("3 of 4 points collide; smallest distance -0.304 (0.304 deep), between point 2 of"));
  const Json list = json("clashes.json")["clashes"];
  ASSERT_EQ(list.size(), 2u);
  EXPECT_NEAR(list[0]["distance"], -0.304, 1e-12);
  EXPECT_NEAR(list[1]["distance"], -0.0226, 1e-12);
  EXPECT_LE(list[0]["distance_interval"][0], -0.304 + 1e-15);
  EXPECT_GE(list[0]["distance_interval"][1], -0.304 - 1e-15);
  EXPECT_EQ(list[0]["closest_pair"]["input"]["point"], 2);
  EXPECT_NEAR(list[0]["closest_pair"]["obstacle"]["at"][0], 0.0, 1e-12); // the face x = 0
  EXPECT_NEAR(list[0]["closest_pair"]["obstacle"]["at"][1], 0.7, 1e-12);
  const std::string page = io::contentOf(folder / "clashes.html");
  EXPECT_THAT(page, testing::AllOf(HasSubstr("<td>0.304 deep</td>"), HasSubstr("<td>0.0226 deep</td>"),
                                   HasSubstr("<b>0.304 deep</b> at the deepest")));
  EXPECT_LT(page.find("<td>0.304 deep</td>"), page.find("<td>0.0226 deep</td>")) << "by severity";
  EXPECT_NEAR(json("report.json")["distance"], -0.304, 1e-12);
  collideOutput("deep.xyz crate.off out.pcd --clearance 0.05 --solid --from 0,0,3,0,0,0 --to 0,0,-3,0,0,0 --steps 6 "
                "--report report.json");
  const Json table = json("report.json")["path"]["table"];
  ASSERT_EQ(table.size(), 7u);
  EXPECT_EQ(table[0]["closest_pair"], nullptr);
  EXPECT_NEAR(table[3]["distance"], -0.304, 1e-12);
  EXPECT_EQ(table[3]["closest_pair"][0], 2);
  EXPECT_LT(table[3]["closest_pair"][1], 12);
}

/// The report of the motion from each pose to the next.
TEST_F(CollideSurface, TellsOfEachMotionWhatItMeets)
{
  folder.write("still.xyz", "1 1 2.25\n1 5 2\n");
  const std::string job = "still.xyz crate.off out.pcd --clearance 0.1 --from 0,0,3,0,0,0 --to 0,0,-3,0,0,0 --steps 6 "
                          "--swept 0.001 --report report.json";
  collideOutput(job);
  const Json table = json("report.json")["path"]["table"];
  ASSERT_EQ(table.size(), 7u);
  const std::vector<int> colliding = {1, 0, 1, 0, 0, 0, 0}; // its bottom goes by, then its top
  for (std::size_t k = 0; k < 7; ++k) {
    EXPECT_EQ(table[k]["pose"], k);
    EXPECT_EQ(table[k]["colliding"], colliding[k]) << k;
    EXPECT_EQ(table[k]["distance"].is_null(), colliding[k] == 0) << k;
    EXPECT_EQ(table[k]["closest_pair"].is_null(), colliding[k] == 0) << k;
  }
  EXPECT_EQ(table[2]["closest_pair"][0], 0);
  collideOutput(job + " --solid");
  const Json solid = json("report.json")["path"]["table"];
  EXPECT_EQ(solid[1]["colliding"], 1);
  EXPECT_NEAR(solid[1]["distance"], -1.0, 1e-3); // in the middle of it
}

TEST_F(CollideSurface, FollowsAPathAndListsClashesByTriangles)
{
  const std::string path = "--clearance 0.1 --from 0,0,3,0,0,0 --to 0,0,-3,0,0,0 --steps 12 ";
  folder.write("still.xyz", "1 1 2.25\n1 5 2\n");
  // The poses alone pass the first point by a quarter of a metre, the motion between them does not.
  collideOutput("still.xyz crate.off out.pcd " + path);
  EXPECT_THAT(column("collision"), ElementsAre(0, 0));
  collideOutput("still.xyz crate.off out.pcd " + path +
                "--swept 0.001 --clashes clashes.json --clashes clashes.csv --clashes clashes.html");
  EXPECT_THAT(column("collision"), ElementsAre(1, 0));
  EXPECT_GE(column("distance")[0], 0.0);
  const Json clash = json("clashes.json")["clashes"][0]["closest_pair"];
  EXPECT_EQ(clash["input"]["point"], 0);
  EXPECT_LT(clash["obstacle"]["triangle"], 12);
  EXPECT_EQ(clash["obstacle"]["at"][0], 1.0) << "where the triangle is nearest to the point";
  EXPECT_EQ(clash["obstacle"]["at"][1], 1.0);
  EXPECT_THAT(io::contentOf(folder / "clashes.csv"), HasSubstr("obstacle_triangle,obstacle_x"));
  EXPECT_THAT(io::contentOf(folder / "clashes.html"), HasSubstr("Here the obstacle is a surface of 12 triangles"));
  EXPECT_THAT(io::contentOf(folder / "clashes.html"), HasSubstr("and triangle "));
  // A list of a surface can be compared with.
  EXPECT_THAT(collideOutput("still.xyz crate.off out.pcd " + path +
                            "--swept 0.001 --clashes later.json --previous clashes.json"),
              HasSubstr("1 clash, 0 resolved"));
}

TEST_F(CollideSurface, KnowsUncertaintiesAndAccuracies)
{
  // 5 cm from a face, to 1 cm: certainly within 10 cm where all is within 2 cm, perhaps where it is within 8 cm.
  collideOutput("scan.xyz crate.off out.pcd --clearance 0.1 --obstacle-uncertainty 0.02");
  EXPECT_THAT(column("collision"), ElementsAre(1, 1, 0, 0, 0));
  collideOutput("scan.xyz crate.off out.pcd --clearance 0.1 --obstacle-uncertainty 0.08");
  EXPECT_THAT(column("collision"), ElementsAre(1, 2, 0, 0, 0));
  for (const std::string accuracy : {"tolerance=0.01", "level=2", "pairs=100000", "time=10"}) {
    collideOutput("scan.xyz crate.off out.pcd --clearance 0.1 --accuracy " + accuracy);
    const std::vector<double> flags = column("collision");
    EXPECT_NE(flags[0], 0) << accuracy;
    EXPECT_NE(flags[1], 0) << accuracy;
    EXPECT_NE(flags[4], 1) << accuracy;
  }
  EXPECT_THAT(collideOutput("scan.xyz crate.off out.pcd --clearance 0.1 --density"),
              HasSubstr("crate.off: is a surface, which has no holes"));
}

TEST_F(CollideSurface, WarnsOfTheScansHolesOnly)
{
  std::string floor;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) floor += std::to_string(i) + ' ' + std::to_string(j) + " -1\n";
  folder.write("floor.xyz", floor);
  EXPECT_THAT(collideOutput("floor.xyz crate.off out.pcd --clearance 0.1"),
              testing::ContainsRegex("points lie 1 apart in .*floor.xyz: what was scanned may touch the surface of "));
  EXPECT_THAT(collideOutput("floor.xyz crate.off out.pcd --clearance 0.8"), Not(HasSubstr("apart")));
}

TEST_F(CollideSurface, RefusesInOneLine)
{
  folder.write("broken.off", "OFF\n3 1 0\n0 0 0\n1e300 0 0\n0 1 0\n3 0 1 2\n");
  const std::string job = "scan.xyz crate.off out.pcd --clearance 0.1 ";
  const auto expectRefused = [&](const std::string& arguments, int exit_code, const std::string& message) {
    const Outcome failed = collide(arguments);
    EXPECT_EQ(failed.exit_code, exit_code) << arguments;
    EXPECT_THAT(failed.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(std::count(failed.err.begin(), failed.err.end(), '\n'), 1) << failed.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pcd"));
  };
  expectRefused("scan.xyz broken.off out.pcd --clearance 0.1", 1, "broken.off: triangle 0 is too large for a float32");
  expectRefused(job + "--surface-tolerance 0.1", 2, "--surface-tolerance");
  expectRefused(job + "--obstacle-uncertainty sigma", 1, "crate.off: is a surface, which has no field");
}

/// The property `collision` of each face of a .ply that has no other beside its corners.
std::vector<int> faceFlags(const std::filesystem::path& path)
{
  const std::string bytes = io::contentOf(path);
  const std::string end = "property uchar collision\nend_header\n";
  const std::size_t at = bytes.find(end);
  EXPECT_NE(at, std::string::npos) << bytes.substr(0, 500);
  if (at == std::string::npos) return {};
  constexpr std::size_t row = 1 + 3 * 4 + 1;
  std::vector<int> flags;
  for (std::size_t i = bytes.size() - 12 * row; i < bytes.size(); i += row) flags.push_back(bytes[i + row - 1]);
  return flags;
}

TEST_F(CollideSurface, AnInputWithFacesFlagsItsTriangles)
{
  folder.write("point.xyz", "1.5 1 2.0625\n9 9 9\n"); // over one of the two triangles of the top
  const std::string job = "crate.off point.xyz out.ply --clearance 0.1";
  const std::string said = collideOutput(job + " --report report.json");
  EXPECT_THAT(said, HasSubstr("1 of 12 triangles collide; smallest distance"));
  EXPECT_THAT(said, HasSubstr("between triangle "));
  const std::vector<int> flags = faceFlags(folder / "out.ply");
  EXPECT_EQ(std::count(flags.begin(), flags.end(), 1), 1);
  const Json report = json("report.json");
  EXPECT_EQ(report["input_surface"]["triangles"], 12);
  EXPECT_EQ(report["input"]["points"], 12);
  EXPECT_EQ(report["colliding"], 1);
  EXPECT_EQ(flags.at(report["closest_pair"][0]), 1);
  EXPECT_EQ(report["distance"], 0.0625);

  collideOutput(job + " --keep colliding");
  EXPECT_EQ(io::readMesh(folder / "out.ply").triangles.size(), 1u);
  collideOutput(job + " --keep free");
  EXPECT_EQ(io::readMesh(folder / "out.ply").triangles.size(), 11u);
  const std::string before = collideOutput("crate.off point.xyz out.pcd --clearance 0.1 --vertices-only");
  EXPECT_THAT(before, HasSubstr("0 of 8 points collide"));
}

TEST_F(CollideSurface, ItsTrianglesHaveDistances)
{
  folder.write("point.xyz", "1.5 1 2.5\n");
  EXPECT_THAT(collideOutput("crate.off point.xyz out.ply --distances --report report.json"),
              HasSubstr("distances of 12 triangles, each of its nearest place: "));
  const io::Mesh mesh = io::readMesh(folder / "out.ply");
  ASSERT_EQ(mesh.face_values.back().name, "distance");
  const std::vector<double>& distances = mesh.face_values.back().values;
  ASSERT_EQ(distances.size(), 12u);
  EXPECT_EQ(*std::min_element(distances.begin(), distances.end()), 0.5);
  EXPECT_NEAR(*std::max_element(distances.begin(), distances.end()), std::hypot(2.5, 0.5 / std::sqrt(2.0)), 1e-6)
      << "of the bottom, beyond its diagonal";
  EXPECT_EQ(json("report.json")["distances"]["input_to_obstacle"]["count"], 12);
}

TEST_F(CollideSurface, ItsTrianglesAreFlaggedAlongAPath)
{
  folder.write("point.xyz", "1.5 1 0\n");
  const std::string job =
      "crate.off point.xyz out.ply --clearance 0.1 --from=0,0,4,0,0,0 --to=0,0,2.05,0,0,0 --steps 4";
  EXPECT_THAT(collideOutput(job), HasSubstr("1 of 12 triangles collide"));
  EXPECT_THAT(io::contentOf(folder / "out.ply"),
              HasSubstr("property uchar collision\nproperty float distance\nproperty int first_pose\n"
                        "property int closest_pose\nend_header\n"));
}

TEST_F(CollideSurface, AnInputWithFacesRefusesWhatIsAboutPoints)
{
  for (const std::string job : {"out.pcd --clearance 0.1", "out.ply --clearance 0.1 --clashes list.json",
                                "out.ply --clearance 0.1 --uncertainty sigma"}) {
    const Outcome done = collide("crate.off scan.xyz " + job);
    EXPECT_EQ(done.exit_code, 1) << job;
    EXPECT_THAT(done.err, testing::AnyOf(HasSubstr("--vertices-only"), HasSubstr("write a .ply file"))) << job;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.ply")) << job;
  }
}

} // namespace
} // namespace pcl_bsh
