// SPDX-License-Identifier: BSD-3-Clause
#include "io/clouds/las_sample.h"
#include "program_run.h"
#include "support/e57_sample.h"
#include "support/verdicts.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/question/options.h>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace pcl_bsh {

using io::valueOf;
using testing::HasSubstr;
using testing::StartsWith;
using Json = nlohmann::json;
namespace fs = std::filesystem;

/// A folder with a small input of every kind of field, and an obstacle of two points.
class Collide : public testing::Test {
protected:
  /// Runs with names taken from the folder: {input.ply} becomes its path.
  Outcome collide(std::string arguments) const
  {
    for (std::size_t at; (at = arguments.find('{')) != std::string::npos;) {
      const std::size_t end = arguments.find('}', at);
      arguments.replace(at, end - at + 1, (folder / arguments.substr(at + 1, end - at - 1)).string());
    }
    return run("pcl_bsh_collide", arguments);
  }

  void expectDone(const std::string& arguments) const
  {
    const Outcome done = collide(arguments);
    EXPECT_EQ(done.exit_code, 0) << arguments << '\n' << done.err;
  }

  /// One line, the code, and nothing written.
  void expectFailure(const std::string& arguments, int exit_code, const std::string& message) const
  {
    const std::size_t files = folder.files();
    const Outcome failed = collide(arguments);
    EXPECT_EQ(failed.exit_code, exit_code) << arguments;
    EXPECT_THAT(failed.err, StartsWith("pcl_bsh_collide: ")) << arguments;
    EXPECT_THAT(failed.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(std::count(failed.err.begin(), failed.err.end(), '\n'), 1) << failed.err;
    EXPECT_EQ(failed.out, "");
    EXPECT_EQ(folder.files(), files) << arguments;
  }

  Json report() const { return Json::parse(io::contentOf(folder / "report.json")); }

  std::vector<int> flags(const std::string& file) const
  {
    const pcl::PCLPointCloud2 cloud = io::readCloud(folder / file);
    std::vector<int> values;
    for (std::size_t i = 0; i < cloud.width; ++i) values.push_back(static_cast<int>(valueOf(cloud, i, "collision")));
    return values;
  }

  io::TemporaryFolder folder;
  fs::path input =
      folder.write("input.ply", "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
                                "property float z\nproperty uchar red\nproperty ushort label\n"
                                "property double time\nend_header\n"
                                "0 0 0 1 1000 0.1\n1 0 0 2 2000 0.2\n2 0 0 3 3000 0.3\nnan 0 0 4 4000 0.4\n"
                                "0 1 0 5 5000 0.5\n");
  fs::path obstacle = folder.write("obstacle.xyz", "1.5 0 0\n9 9 9\n");
};

TEST_F(Collide, FlagsTouchingPointsAndKeepsEveryField)
{
  for (const std::string output : {"out.pcd", "out.ply"}) {
    expectDone("{input.ply} {obstacle.xyz} {" + output + "} --clearance 0.5");
    EXPECT_EQ(flags(output), (std::vector<int>{0, 1, 1, 0, 0}));
    const pcl::PCLPointCloud2 cloud = io::readCloud(folder / output);
    const pcl::PCLPointCloud2 before = io::readCloud(input);
    ASSERT_EQ(cloud.fields.size(), before.fields.size() + 1);
    for (std::size_t i = 0; i < before.fields.size(); ++i) {
      EXPECT_EQ(cloud.fields[i].name, before.fields[i].name);
      EXPECT_EQ(cloud.fields[i].datatype, before.fields[i].datatype);
      EXPECT_EQ(valueOf(cloud, 4, cloud.fields[i].name), valueOf(before, 4, cloud.fields[i].name));
    }
    EXPECT_EQ(cloud.fields.back().name, "collision");
    EXPECT_EQ(cloud.fields.back().datatype, pcl::PCLPointField::UINT8);
  }
}

TEST_F(Collide, KeepsOnlyWhatIsAskedFor)
{
  expectDone("{input.ply} {obstacle.xyz} {colliding.pcd} --clearance 0.5 --keep colliding");
  expectDone("{input.ply} {obstacle.xyz} {free.ply} --clearance 0.5 --keep free");
  const pcl::PCLPointCloud2 colliding = io::readCloud(folder / "colliding.pcd");
  const pcl::PCLPointCloud2 free = io::readCloud(folder / "free.ply");
  ASSERT_EQ(colliding.width, 2U);
  ASSERT_EQ(free.width, 2U) << "the point that is not finite is neither";
  EXPECT_EQ(colliding.fields.size(), 6U);
  EXPECT_EQ(valueOf(colliding, 1, "label"), 3000);
  EXPECT_EQ(valueOf(free, 0, "label"), 1000);
  EXPECT_EQ(valueOf(free, 1, "time"), 0.5);
  expectDone("{input.ply} {obstacle.xyz} {none.pcd} --clearance 0.25 --keep colliding");
  EXPECT_EQ(io::readCloud(folder / "none.pcd").width, 0U);
}

/// The distances are 1.5, 0.5, 0.5 and 1.8: ties on both sides of the clearance.
TEST_F(Collide, VerdictsHoldWhereverPointsTrulyAre)
{
  const std::string job = "{input.ply} {obstacle.xyz} {out.ply} --clearance 1 --report {report.json} ";
  for (const std::string options :
       {"--uncertainty 0.5", "--obstacle-uncertainty 0.5", "--uncertainty 0.375 --obstacle-uncertainty 0.125"}) {
    const Outcome done = collide(job + options);
    ASSERT_EQ(done.exit_code, 0) << done.err;
    EXPECT_EQ(flags("out.ply"), (std::vector<int>{2, 1, 1, 0, 0})) << options;
    EXPECT_THAT(done.out, HasSubstr("2 of 5 points collide, 1 are undecided; smallest distance 0.5"));
    const Json json = report();
    EXPECT_EQ(json["colliding"], 2);
    EXPECT_EQ(json["undecided"], 1);
    EXPECT_EQ(json["free"], 1) << "the point that is not finite is neither";
  }
  EXPECT_EQ(report()["uncertainty"], (Json{{"input", 0.375}, {"obstacle", 0.125}}));
  expectDone(job + "--uncertainty 0.4999");
  EXPECT_EQ(flags("out.ply"), (std::vector<int>{0, 1, 1, 0, 0}));
  expectDone(job + "--uncertainty 0.5001");
  EXPECT_EQ(flags("out.ply"), (std::vector<int>{2, 2, 2, 0, 0}));

  expectDone(job + "--uncertainty time --sigmas 5"); // 0.5, 1, 1.5 and 2.5
  EXPECT_EQ(flags("out.ply"), (std::vector<int>{2, 2, 2, 0, 2}));
  EXPECT_EQ(report()["uncertainty"]["input"], (Json{{"field", "time"}, {"sigmas", 5.0}}));
  expectDone("{input.ply} {obstacle.xyz} {free.ply} --clearance 1 --uncertainty 0.5 --keep free");
  EXPECT_EQ(io::readCloud(folder / "free.ply").width, 1U) << "what is undecided is not free";
}

TEST_F(Collide, GuardsAgainstHolesBetweenPoints)
{
  std::string wall;
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 12; ++i) wall += std::to_string(i) + ' ' + std::to_string(j) + " 0\n";
  folder.write("wall.xyz", wall);
  folder.write("points.xyz", "5 5 0.25\n5.5 5.5 0.25\n5.5 5.5 2\n");
  const std::string job = "{points.xyz} {wall.xyz} {out.ply} --clearance 0.25 --report {report.json}";
  expectDone(job);
  EXPECT_EQ(flags("out.ply"), (std::vector<int>{1, 0, 0}));
  EXPECT_EQ(report()["density"]["widest_gap"], nullptr);
  const Outcome done = collide(job + " --density");
  EXPECT_EQ(flags("out.ply"), (std::vector<int>{1, 3, 0}));
  EXPECT_THAT(done.out, HasSubstr("1 of 3 points collide, 1 are not scanned densely enough; smallest distance"));
  EXPECT_EQ(report()["sparse"], 1);
  EXPECT_EQ(report()["free"], 1);
  EXPECT_EQ(report()["density"]["widest_gap"], 8.0);
  expectDone(job + " --density --widest-gap 1.2");
  EXPECT_EQ(flags("out.ply"), (std::vector<int>{1, 0, 0})) << "what gapes wider is an opening";
  expectFailure(job + " --widest-gap 1", 2, "--widest-gap: is given, but not --density: give --density, too");
  expectFailure(job + " --density --widest-gap=-1", 2, "--widest-gap");
  expectFailure(job + " --density --from 0,0,0,0,0,0 --to 1,0,0,0,0,0 --steps 2", 2,
                "--density: is about which points collide at one pose: leave out the path");
}

TEST_F(Collide, RefusesUncertaintiesThatAreNone)
{
  const std::string job = "{input.ply} {obstacle.xyz} {out.ply} --clearance 1 ";
  for (const std::string option : {"--uncertainty", "--obstacle-uncertainty"})
    for (const std::string wrong : {"-1", "nan", "inf", "0,5"})
      expectFailure(job + option + "=" + wrong, 2, ": give a finite length >= 0, or the name of a field");
  expectFailure(job + "--uncertainty sigma", 1,
                "input.ply: field 'sigma' of its points' sigmas is missing: give a length, or one of its fields: x, y");
  expectFailure(job + "--uncertainty y --sigmas=-1", 2, "--sigmas");
  expectFailure(job + "--uncertainty 1 --sigmas 2", 2,
                "--sigmas: is given, but no uncertainty is a field: give the length itself");
  folder.write("negative.xyz", "0 0 0 0.5\n1 0 0 -0.5\n");
  expectFailure("{negative.xyz} {obstacle.xyz} {out.ply} --clearance 1 --uncertainty column_4", 1,
                "negative.xyz: field 'column_4' of point 1 is -0.5: give finite lengths >= 0");
}

/// Beams of a scanner at (0, 0, 1) all around; those to the right meet nothing.
TEST_F(Collide, BeamsWithoutAReturnSeeAsFarAsIsTold)
{
  E57SampleScan scan;
  std::vector<double> ranges, azimuths, elevations;
  std::vector<std::int64_t> states;
  for (double elevation = -1.55; elevation <= 1.55; elevation += 0.05)
    for (double azimuth = -3.14; azimuth < 3.14; azimuth += 0.05) {
      ranges.push_back(5.0);
      azimuths.push_back(azimuth);
      elevations.push_back(elevation);
      states.push_back(std::cos(elevation) * std::cos(azimuth) > 0.5 ? 1 : 0);
    }
  scan.values = {E57SampleValue::doubles("sphericalRange", ranges),
                 E57SampleValue::doubles("sphericalAzimuth", azimuths),
                 E57SampleValue::doubles("sphericalElevation", elevations),
                 E57SampleValue::integer("sphericalInvalidState", 0, 2, states)};
  scan.more_xml = E57SampleScan::pose("1 0 0 0", "0 0 1");
  folder.write("scan.e57", E57Sample{{scan}}.text());
  folder.write("machine.xyz", "1 0 1\n3 0 1\n-3 0 1\n8 0 1\n");
  const std::string rest = "{scan.e57} {machine.xyz} {out.pcd} --clearance 0.15 --seen --obstacle-out {seen.pcd} ";
  ASSERT_EQ(collide(rest).exit_code, 0);
  EXPECT_EQ(flags("seen.pcd"), (std::vector<int>{4, 4, 0, 4}));
  ASSERT_EQ(collide(rest + "--seen-beyond 6").exit_code, 0);
  EXPECT_EQ(flags("seen.pcd"), (std::vector<int>{0, 0, 0, 4}));
  folder.write("scan.xyz", "5 0 0\n");
  expectFailure("{scan.xyz} {machine.xyz} {out.pcd} --clearance 0.1 --seen --origin 0,0,1 --seen-beyond 6", 1,
                "field 'beam_x' of beams without a return is missing: leave out --seen-beyond, or read an .e57 with "
                "its beams; the fields are: x");
  expectFailure(rest + "--seen-beyond 0", 2, "--seen-beyond");
}

/// Beams from (0, 0, 1) all around, five metres long, but those to the right, which end after two.
TEST_F(Collide, TellsWhatOfTheObstacleNobodySaw)
{
  std::string points, header = "FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nVIEWPOINT 0 0 1 1 0 0 0\nPOINTS ";
  int count = 0;
  for (double elevation = -1.55; elevation <= 1.55; elevation += 0.05) {
    for (double azimuth = 0.0; azimuth < 6.28; azimuth += 0.05, ++count) {
      const double right = std::cos(elevation) * std::cos(azimuth), range = right > 0.5 ? 2.0 : 5.0;
      points += std::to_string(range * right) + ' ' + std::to_string(range * std::cos(elevation) * std::sin(azimuth)) +
                ' ' + std::to_string(1.0 + range * std::sin(elevation)) + '\n';
    }
  }
  folder.write("scan.pcd", header + std::to_string(count) + "\nDATA ascii\n" + points);
  folder.write("scan.xyz", points);
  folder.write("machine.xyz", "1 0 1\n3 0 1\n-3 0 1\n2 0 1\n");
  const std::string rest = " {machine.xyz} {out.pcd} --clearance 0.15 --seen ";
  for (const std::string& scan : {"{scan.pcd}" + rest, "{scan.xyz}" + rest + "--origin 0,0,1 "}) {
    const Outcome done = collide(scan + "--obstacle-out {seen.pcd} --report {report.json}");
    ASSERT_EQ(done.exit_code, 0) << done.err;
    EXPECT_THAT(done.out, HasSubstr("; of the obstacle, 1 point is unseen (1 in shadow, 0 in the skin)"));
    EXPECT_EQ(report()["unseen"]["in_shadow"], 1);
    EXPECT_EQ(report()["unseen"]["in_skin"], 0);
    EXPECT_EQ(flags("seen.pcd"), (std::vector<int>{0, 4, 0, 1}));
    EXPECT_EQ(report()["unseen"]["obstacle_points"], 1);
    EXPECT_EQ(report()["unseen"]["first_pose"], 0);
    EXPECT_NEAR(report()["unseen"]["angles_of_scans"][0], 0.075, 0.01);
  }
  folder.write("path.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0.1 0 1 0 0 0 0 1 0\n");
  expectDone("{scan.pcd}" + rest + "--trajectory {path.txt} --clashes {clashes.json} --cluster-distance 0.5");
  const Json list = Json::parse(io::contentOf(folder / "clashes.json"))["clashes"];
  ASSERT_GE(list.size(), 2u);
  EXPECT_EQ(list.back()["status"], "unseen"); // of the point behind the pillar
  EXPECT_EQ(list.back()["points"], 1);
  EXPECT_EQ(list.back()["box"]["min"], (Json{3, 0, 1}));
  expectFailure("{scan.xyz}" + rest, 1, "scan.xyz: does not say where its scanner stood: give --origin, as X,Y,Z");
  expectFailure("{scan.pcd}" + rest + "--seen-angle 1", 1, "--seen-angle: 1 radians: give one in [0.0001, 0.25]");
  expectFailure("{scan.pcd}" + rest + "--origin 1,2", 2, "--origin: '1,2' is none: give X,Y,Z");
  expectFailure("{scan.pcd} {machine.xyz} {out.pcd} --clearance 1 --origin 0,0,0", 2,
                "--origin: is given, but not --seen: give --seen, too");
}

/// Two scanners on either side of a pillar, in one file, where a field tells whose each point is.
TEST_F(Collide, TakesScannersFromATableByAField)
{
  io::LasSample las(4, 6);
  las.scale = {1e-4, 1e-4, 1e-4};
  las.offset = {431200, 5412300, 0};
  std::string csv = "x,y,z,scan\n", columns;
  for (const int scan : {7, 12}) {
    const double x = scan == 7 ? 0.0 : 6.0, towards = scan == 7 ? 1.0 : -1.0, pillar = scan == 7 ? 2.0 : 3.5;
    for (double elevation = -1.55; elevation <= 1.55; elevation += 0.05) {
      for (double azimuth = 0.0; azimuth < 6.28; azimuth += 0.05) {
        const double along = std::cos(elevation) * std::cos(azimuth), range = towards * along > 0.5 ? pillar : 5.0;
        const std::array<double, 3> end = {x + range * along, range * std::cos(elevation) * std::sin(azimuth),
                                           1.0 + range * std::sin(elevation)};
        std::string point(las.length(), '\0');
        std::string row;
        for (std::size_t k = 0; k < 3; ++k) {
          io::put(point, 4 * k, static_cast<std::int32_t>(std::lround(1e4 * end[k])));
          row += std::to_string(end[k]) + ' ';
        }
        point[14] = 0x11; // the only return
        io::put(point, 20, static_cast<std::uint16_t>(scan));
        las.points.push_back(point);
        row += std::to_string(scan) + '\n';
        columns += row;
        std::replace(row.begin(), row.end(), ' ', ',');
        csv += row;
      }
    }
  }
  folder.write("scans.las", las.text());
  folder.write("scans.csv", csv);
  folder.write("scans.xyz", columns);
  folder.write("machine.xyz", "1 0 1\n3 0 1\n-3 0 1\n");
  const std::string rest = " {machine.xyz} {out.pcd} --clearance 0.1 --seen --obstacle-out {seen.pcd} ";
  const std::string grid = "--pose 431200,5412300,0,0,0,0 ";
  const std::string in_grid = "7=431200,5412300,1;12=431206,5412300,1\"", near = "7=0,0,1;12=6,0,1\"";
  for (const std::string& job :
       {"{scans.las}" + rest + grid + "--origin \"point_source_id:" + in_grid,
        "{scans.csv}" + rest + "--origin \"scan:" + near, "{scans.xyz}" + rest + "--origin \"column_4:" + near}) {
    expectDone(job);
    EXPECT_EQ(flags("seen.pcd"), (std::vector<int>{0, 0, 0})) << job;
  }
  for (const std::string& job :
       {"{scans.las}" + rest + grid + "--origin 431200,5412300,1", "{scans.csv}" + rest + "--origin 0,0,1"}) {
    expectDone(job); // the other scanner's returns end beams of this one
    EXPECT_EQ(flags("seen.pcd").at(1), 4) << job;
  }
  expectFailure("{scans.las}" + rest, 1, "scans.las: does not say where its scanner stood: give --origin");
  expectFailure("{scans.csv}" + rest + "--origin \"scan:7=0,0,1\"", 1,
                "is of scan 12 in field 'scan', which has no origin: give one for each scan");
  expectFailure("{scans.las}" + rest + "--origin \"source:7=0,0,1\"", 1,
                "scans.las: field 'source' that numbers its scans is missing: give one of its fields: ");
}

TEST_F(Collide, VerdictsHoldForUncertainPoses)
{
  expectDone("{input.ply} {obstacle.xyz} {out.pcd} --clearance 0.6 --pose-uncertainty 0.05,0.1,1.5,0,0 "
             "--report {report.json}");
  EXPECT_EQ(flags("out.pcd"), (std::vector<int>{0, 1, 1, 0, 0}));
  EXPECT_EQ(report()["options"]["pose_uncertainty"], "0.05,0.1,1.5,0,0");
  expectDone("{input.ply} {obstacle.xyz} {out.pcd} --clearance 0.6 --pose-uncertainty 0.2");
  EXPECT_EQ(flags("out.pcd"), (std::vector<int>{0, 2, 2, 0, 0}));
  expectFailure("{input.ply} {obstacle.xyz} {no.pcd} --clearance 1 --pose-uncertainty a", 2,
                "--pose-uncertainty: 'a' is none: give T");
}

TEST_F(Collide, ReportsWhatItFoundAndWhatItCost)
{
  const Outcome done = collide("{input.ply} {obstacle.xyz} {out.pcd} --clearance 0.5 --report {report.json}");
  EXPECT_THAT(done.out,
              HasSubstr("2 of 5 points collide; smallest distance 0.5, between point 1 of the input and point "
                        "0 of the obstacle"));
  const Json json = report();
  EXPECT_EQ(json["input"], (Json{{"file", input.string()}, {"points", 5}, {"finite", 4}}));
  EXPECT_EQ(json["obstacle"], (Json{{"file", obstacle.string()}, {"points", 2}, {"finite", 2}}));
  EXPECT_EQ(json["clearance"], 0.5);
  EXPECT_EQ(json["colliding"], 2);
  EXPECT_EQ(json["distance"], 0.5);
  EXPECT_EQ(json["closest_pair"], (Json{1, 0}));
  EXPECT_EQ(json["accuracy"], "exact");
  for (const char* count : {"node_pairs", "volumes_carried", "volumes_built", "leaf_pairs", "exact_decisions",
                            "voxels_built", "voxels_total"}) {
    EXPECT_TRUE(json["work"][count].is_number_unsigned()) << count;
  }
  EXPECT_GT(json["work"]["voxels_built"], 0);
  EXPECT_GT(json["work"]["volumes_carried"], 0);
  EXPECT_GT(json["work"]["volumes_built"], 0);
  EXPECT_LE(json["work"]["voxels_built"], json["work"]["voxels_total"]);
  for (const char* step : {"load", "build", "query", "write"}) {
    EXPECT_TRUE(json["seconds"][step].is_number_float()) << step;
    EXPECT_GT(json["seconds"][step], 0) << step;
  }
  ASSERT_EQ(json["warnings"].size(), 1U);
  EXPECT_THAT(json["warnings"][0].get<std::string>(), HasSubstr("points is not finite: it is left out"));
  EXPECT_THAT(done.err, HasSubstr("pcl_bsh_collide: warning: "));
}

TEST_F(Collide, CloudsWithoutFinitePointsHaveNoDistance)
{
  folder.write("nothing.xyz", "nan 0 0\n");
  expectDone("{input.ply} {nothing.xyz} {out.pcd} --clearance 0.5 --report {report.json}");
  EXPECT_TRUE(report()["distance"].is_null());
  EXPECT_TRUE(report()["closest_pair"].is_null());
  EXPECT_EQ(report()["colliding"], 0);
  expectDone("{nothing.xyz} {obstacle.xyz} {out.pcd} --clearance 0.5 --report {report.json}");
  EXPECT_EQ(flags("out.pcd"), std::vector<int>{0});
}

TEST_F(Collide, PosesAreOfTheObstacleInTheInputsFrame)
{
  // A quarter turn about z takes (1.5, 0, 0) to (0, 1.5, 0); then it is moved by (0, -0.5, 0) onto the last point.
  const std::string quarter = std::to_string(std::acos(0.0));
  expectDone("{input.ply} {obstacle.xyz} {out.pcd} --clearance 0.001 --pose 0,-0.5,0,0,0," + quarter);
  EXPECT_EQ(flags("out.pcd"), (std::vector<int>{0, 0, 0, 0, 1}));
  folder.write("pose.txt", "# a quarter turn\n0 -1 0 0\n1 0 0 -0.5\n0 0 1 0\n");
  expectDone("{input.ply} {obstacle.xyz} {out.pcd} --clearance 0 --pose {pose.txt}");
  EXPECT_EQ(flags("out.pcd"), (std::vector<int>{0, 0, 0, 0, 1}));
  folder.write("pose.txt", "0, -1, 0, 0\n1, 0, 0, -0.5\n0, 0, 1, 0\n0, 0, 0, 1\n");
  expectDone("{input.ply} {obstacle.xyz} {out.pcd} --clearance 0 --pose {pose.txt}");
  EXPECT_EQ(flags("out.pcd"), (std::vector<int>{0, 0, 0, 0, 1}));
}

/// Half a radian about z, with as many digits as printf gives: 6 behind the point.
TEST_F(Collide, PrintedMatricesStandForTheirNearestRotations)
{
  folder.write("point.xyz", "1 0 0\n");
  folder.write("rows.txt", "0.877583 -0.479426 0 0\n0.479426 0.877583 0 0\n0 0 1 0\n");
  folder.write("poses.txt", "\xef\xbb\xbf"
                            "0.877583 -0.479426 0 0 0.479426 0.877583 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0\n");
  const std::string job = "{input.ply} {point.xyz} {out.pcd} --clearance 1 --report {report.json} ";
  for (const std::string pose :
       {"--pose {rows.txt}", "--trajectory {poses.txt}", "--from {rows.txt} --to 0,0,0,0,0,0 --steps 2"}) {
    const Outcome done = collide(job + pose);
    ASSERT_EQ(done.exit_code, 0) << pose << done.err;
    EXPECT_THAT(done.err, HasSubstr("|R'R - I| is 1.7")) << pose;
    EXPECT_THAT(done.err, HasSubstr("the nearest rotation is used")) << pose;
    EXPECT_THAT(report()["warnings"].dump(), HasSubstr("the nearest rotation is used")) << pose;
  }
  // Notes on an earlier list stand beside it.
  folder.write("other.xyz", "1 0 0\n");
  const std::string along = " {out.pcd} --clearance 1 --trajectory {poses.txt} --clashes {a.json} ";
  expectDone("{input.ply} {point.xyz}" + along);
  const Outcome again = collide("{input.ply} {other.xyz}" + along + "--previous {a.json}");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("the nearest rotation is used"));
  EXPECT_THAT(again.err, HasSubstr("lists clashes of the obstacle 'point.xyz'"));

  folder.write("rows.txt", "0.5 -0.87 0 0\n0.87 0.5 0 0\n0 0 1 0\n");
  const Outcome refused = collide(job + "--pose {rows.txt}");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("--pose: not rigid, |R'R - I| is "));
}

TEST_F(Collide, RollComesBeforePitchBeforeYaw)
{
  // Roll turns z to -y, pitch leaves -y, yaw turns it to x: the obstacle's (0, 0, 2) arrives at (2, 0, 0).
  folder.write("point.xyz", "0 0 2\n");
  const std::string quarter = "1.5707963267948966";
  expectDone("{input.ply} {point.xyz} {out.pcd} --clearance 1e-9 --pose 0,0,0," + quarter + "," + quarter + "," +
             quarter);
  EXPECT_EQ(flags("out.pcd"), (std::vector<int>{0, 0, 1, 0, 0}));
}

TEST_F(Collide, GeoreferencedDoublesAreNotRounded)
{
  std::string a = "x y z\n", apart = a, near = a;
  for (int i = 0; i < 1000; ++i) {
    const std::string x = std::to_string(500000.003 + 0.01 * i);
    a += x + " 5400000.26 100\n";
    apart += x + " 5400000.34 100\n";
    near += x + " 5400000.30 100\n";
  }
  folder.write("a.txt", a);
  folder.write("apart.xyz", apart);
  folder.write("near.xyz", near);
  expectDone("{a.txt} {apart.xyz} {a.pcd} --clearance 0.05 --report {report.json}");
  EXPECT_EQ(report()["colliding"], 0);
  EXPECT_NEAR(report()["distance"], 0.08, 1e-9);
  expectDone("{a.pcd} {near.xyz} {a.ply} --clearance 0.05 --report {report.json}");
  EXPECT_EQ(report()["colliding"], 1000);
  EXPECT_EQ(valueOf(io::readCloud(folder / "a.ply"), 1, "x"), 500000.013);
  EXPECT_EQ(report()["warnings"].size(), 0U);
}

TEST_F(Collide, WarnsOfFloatsTooCoarseForTheClearance)
{
  folder.write("utm.ply",
               "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
               "end_header\n500000 5400000 100\n");
  expectDone(
      "{utm.ply} {obstacle.xyz} {out.pcd} --clearance 0.05 --pose 500000,5400000,100,0,0,0 --report {report.json}");
  ASSERT_EQ(report()["warnings"].size(), 1U);
  EXPECT_THAT(report()["warnings"][0].get<std::string>(), HasSubstr("utm.ply: its float32 coordinates lie 0.5 apart"));
  expectDone("{utm.ply} {obstacle.xyz} {out.pcd} --clearance 5 --pose 500000,5400000,100,0,0,0 --report {report.json}");
  EXPECT_EQ(report()["warnings"].size(), 0U);
}

TEST_F(Collide, ReadsEveryFormat)
{
  folder.write("a.obj", "v 1 0 0\nv 5 0 0\n");
  folder.write("a.off", "OFF\n2 0 0\n1 0 0\n5 0 0\n");
  folder.write("a.txt", "1,0,0,7\n5,0,0,8\n");
  folder.write("a.pcd", "FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nPOINTS 2\nDATA ascii\n1 0 0\n5 0 0\n");
  for (const std::string file : {"{a.obj}", "{a.off}", "{a.txt}", "{a.pcd}"}) {
    expectDone(file + " {obstacle.xyz} {out.ply} --clearance 0.5");
    EXPECT_EQ(flags("out.ply"), (std::vector<int>{1, 0})) << file;
    expectDone("{input.ply} " + file + " {out.ply} --clearance 0");
    EXPECT_EQ(flags("out.ply"), (std::vector<int>{0, 1, 0, 0, 0})) << file;
  }
}

TEST_F(Collide, OutputReplacesTheInputWhenAsked)
{
  const std::string before = io::contentOf(input);
  expectFailure("{input.ply} {obstacle.xyz} {input.ply} --clearance 0.5", 2,
                "OUTPUT: " + input.string() + ": is the file of INPUT, which is read: choose another name");
  EXPECT_EQ(io::contentOf(input), before);
  const std::size_t files = folder.files();
  expectDone("{input.ply} {obstacle.xyz} {input.ply} --clearance 0.5 --in-place");
  EXPECT_EQ(flags("input.ply"), (std::vector<int>{0, 1, 1, 0, 0}));
  // Flags that are there already are replaced, not doubled.
  expectDone("{input.ply} {obstacle.xyz} {input.ply} --clearance 0.25 --in-place");
  EXPECT_EQ(flags("input.ply"), (std::vector<int>{0, 0, 0, 0, 0}));
  EXPECT_EQ(io::readCloud(input).fields.size(), 7U);
  EXPECT_EQ(folder.files(), files);
}

TEST_F(Collide, ReadsAndWritesStreams)
{
  const std::string wanted = "--clearance 0.5 ";
  expectDone("{input.ply} {obstacle.xyz} {plain.pcd} " + wanted);
  const Outcome piped = collide("- {obstacle.xyz} - " + wanted + "<{input.ply}");
  EXPECT_EQ(piped.exit_code, 0) << piped.err;
  EXPECT_TRUE(piped.out == io::contentOf(folder / "plain.pcd"));
  EXPECT_THAT(piped.err, HasSubstr("2 of 5 points collide")) << "not into the cloud";
  const Outcome report = collide("{input.ply} {obstacle.xyz} {out.pcd} " + wanted + "--report -");
  EXPECT_EQ(Json::parse(report.out)["colliding"], 2);

  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  expectDone("{input.ply} {pipe} {out.pcd} " + wanted + "& cat {obstacle.xyz} >{pipe}; wait $!");
  EXPECT_EQ(flags("out.pcd"), (std::vector<int>{0, 1, 1, 0, 0}));
  expectFailure("- - {out2.pcd} " + wanted + "<{pipe} & : >{pipe}; wait $!", 2, "OBSTACLE: -: is the pipe of INPUT");
}

TEST_F(Collide, ThreadsChangeNothing)
{
  io::writeCloud(folder / "many.pcd", io::randomCloud<float>(20000, 1, {}));
  const std::string job =
      "{many.pcd} {many.pcd} {out.pcd} --clearance 20000 --pose 1e4,0,0,0.1,0.2,0.3 --report {report.json}";
  expectDone(job + " --threads 1");
  const std::string first = io::contentOf(folder / "out.pcd");
  const Json found = report();
  expectDone(job + " --threads 3");
  EXPECT_TRUE(io::contentOf(folder / "out.pcd") == first);
  for (const char* key : {"colliding", "distance", "closest_pair", "work"}) EXPECT_EQ(report()[key], found[key]) << key;
  EXPECT_GT(found["colliding"], 0);
}

TEST_F(Collide, TellsTheDistanceOfEveryPoint)
{
  const std::string page = "{a\"<b>.html}";
  const Outcome done = collide("{input.ply} {obstacle.xyz} {out.pcd} --clearance 0.5 --distances --unit m "
                               "--report {report.json} --distance-page '" +
                               page + "'");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("2 of 5 points collide"));
  EXPECT_THAT(done.out, HasSubstr("; distances of 4 points: mean "));
  EXPECT_THAT(done.out, HasSubstr(" m; Hausdorff distance 14.5258 m; wrote "));
  EXPECT_EQ(flags("out.pcd"), (std::vector<int>{0, 1, 1, 0, 0}));
  const pcl::PCLPointCloud2 cloud = io::readCloud(folder / "out.pcd");
  EXPECT_EQ(cloud.fields.back().name, "distance");
  EXPECT_EQ(cloud.fields.back().datatype, pcl::PCLPointField::FLOAT32);
  const std::vector<double> expected = {1.5, 0.5, 0.5, std::nan(""), std::hypot(1.5f, 1.0f)};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double told = valueOf(cloud, i, "distance");
    EXPECT_TRUE(std::abs(told - expected[i]) < 1e-6 || (std::isnan(told) && std::isnan(expected[i]))) << i;
  }
  const Json distances = report()["distances"];
  EXPECT_EQ(distances["unit"], "m");
  EXPECT_EQ(distances["input_to_obstacle"]["count"], 4);
  EXPECT_EQ(distances["input_to_obstacle"]["median"], 1.0);
  EXPECT_EQ(distances["input_to_obstacle"]["farthest_pair"], (Json{4, 0}));
  EXPECT_EQ(distances["obstacle_to_input"]["farthest_pair"], (Json{2, 1}));
  EXPECT_EQ(distances["hausdorff"], distances["obstacle_to_input"]["maximum"]);
  EXPECT_EQ(distances["hausdorff_pair"], (Json{2, 1}));
  const std::string html = io::contentOf(folder / "a\"<b>.html");
  EXPECT_THAT(html, HasSubstr("Hausdorff distance [m]"));

  expectDone("{input.ply} {obstacle.xyz} {near.ply} --distances --max-distance 0.5 --report {report.json}");
  const pcl::PCLPointCloud2 near = io::readCloud(folder / "near.ply");
  EXPECT_EQ(valueOf(near, 1, "distance"), 0.5) << "inclusive";
  EXPECT_TRUE(std::isnan(valueOf(near, 0, "distance")));
  EXPECT_EQ(report()["warnings"].size(), 1U) << "without a clearance, none is too small";
  EXPECT_TRUE(report()["distances"]["hausdorff"].is_null());

  expectDone("{input.ply} {obstacle.xyz} {free.ply} --distances --clearance 0.5 --keep free");
  const pcl::PCLPointCloud2 free = io::readCloud(folder / "free.ply");
  ASSERT_EQ(free.width, 2U);
  EXPECT_EQ(valueOf(free, 0, "distance"), 1.5);
  EXPECT_EQ(free.fields.size(), 7U);
}

TEST_F(Collide, DistancesOfNothing)
{
  folder.write("nothing.xyz", "nan 0 0\n");
  for (const std::string clouds :
       {"{input.ply} {nothing.xyz}", "{nothing.xyz} {input.ply}", "{nothing.xyz} {nothing.xyz}"}) {
    expectDone(clouds + " {out.pcd} --distances --report {report.json} --distance-page {page.html}");
    const Json distances = report()["distances"];
    for (const char* side : {"input_to_obstacle", "obstacle_to_input"}) {
      EXPECT_EQ(distances[side]["count"], 0);
      EXPECT_TRUE(distances[side]["mean"].is_null());
    }
    EXPECT_TRUE(distances["hausdorff"].is_null());
    EXPECT_TRUE(std::isnan(valueOf(io::readCloud(folder / "out.pcd"), 0, "distance")));
  }
}

TEST_F(Collide, RefusesDistancesThatCannotBe)
{
  const std::string job = "{input.ply} {obstacle.xyz} {out.pcd} --clearance 0.5 ";
  for (const std::string option : {"--max-distance 1", "--distance-page {p.html}"})
    expectFailure(job + option, 2, "no distances are asked for: give --distances");
  expectFailure(job + "--distances --max-distance -1", 2, "--max-distance: -1: give a length >= 0");
  expectFailure(job + "--distances --max-distance nan", 2, "--max-distance: ");
  expectFailure(job + "--distances --distance-page {p.txt}", 2, "--distance-page: ");
  expectFailure(job + "--distances --distance-page {none/p.html}", 1, "none");
  expectFailure(job + "--distances --distance-page {out.pcd}", 2, "is the file of OUTPUT");
  expectFailure(job + "--distances --accuracy level=1", 2, "--accuracy: level=1: leaves points without a distance");
  expectFailure(job + "--distances --from 0,0,0,0,0,0 --to 1,0,0,0,0,0 --steps 2", 2, "--distances: are of one pose");
  expectFailure("{input.ply} {obstacle.xyz} {out.pcd} --max-distance 1", 2, "give --distances");
  folder.write("taken.txt", "x y z distance\n0 0 0 7\n");
  expectFailure("{taken.txt} {obstacle.xyz} {out.pcd} --distances", 1, "field 'distance' exists already");
}

/// Two sheets, one over the other: many voxels, and a distance that a coarse look cannot tell.
class CollideAccuracy : public Collide {
protected:
  CollideAccuracy()
  {
    std::string low = "x y z\n", high = "x y z\n";
    for (int i = 0; i < 6400; ++i) {
      const std::string at = std::to_string(0.1 * (i % 80)) + ' ' + std::to_string(0.1 * (i / 80)) + ' ';
      low += at + "0\n";
      high += at + (i % 80 < 20 ? "0.25\n" : "3\n");
    }
    folder.write("low.txt", low);
    folder.write("high.txt", high);
    expectDone(job + "{exact.ply} --clearance 0.3 --report {report.json}");
    exact = report();
    exact_flags = flags("exact.ply");
  }

  const std::string job = "{low.txt} {high.txt} ";
  Json exact;
  std::vector<int> exact_flags;
};

TEST_F(CollideAccuracy, IsCertifiedInTheReport)
{
  EXPECT_EQ(exact["accuracy"], "exact");
  EXPECT_EQ(exact["undecided"], 0);
  EXPECT_LE(exact["distance_interval"][0], 0.25);
  EXPECT_GE(exact["distance_interval"][1], 0.25);
  EXPECT_EQ(std::count(exact_flags.begin(), exact_flags.end(), 1), exact["colliding"]);

  int undecided = 0;
  for (const std::string setting : {"level=0", "level=1", "level=8", "pairs=100", "time=1e-04", "tolerance=0.1"}) {
    const Outcome done = collide(job + "{out.ply} --clearance 0.3 --report {report.json} --accuracy " + setting);
    ASSERT_EQ(done.exit_code, 0) << done.err;
    const Json json = report();
    EXPECT_EQ(json["accuracy"], setting);
    EXPECT_LE(json["distance_interval"][0], 0.25) << setting;
    EXPECT_GE(json["distance_interval"][1], 0.25) << setting;
    EXPECT_THAT(done.out, HasSubstr("or less, certainly in [")) << setting;
    const std::vector<int> found = flags("out.ply");
    const bool tolerant = setting == "tolerance=0.1"; // what lies a little farther may count
    for (std::size_t i = 0; i < found.size(); ++i)
      ASSERT_TRUE(found[i] == 2 || found[i] == exact_flags[i] || (tolerant && found[i] == 1))
          << setting << ", point " << i;
    EXPECT_EQ(std::count(found.begin(), found.end(), 1), json["colliding"]);
    EXPECT_EQ(std::count(found.begin(), found.end(), 2), json["undecided"]);
    EXPECT_EQ(done.out.find(std::to_string(json["undecided"].get<int>()) + " are undecided") != std::string::npos,
              !tolerant);
    undecided += json["undecided"].get<int>();
  }
  EXPECT_GT(undecided, 0) << "nothing was ever undecided";
}

TEST_F(CollideAccuracy, UndecidedPointsAreNeverKeptAsFree)
{
  expectDone(job + "{free.ply} --clearance 0.3 --accuracy pairs=0 --keep free");
  expectDone(job + "{rest.ply} --clearance 0.3 --accuracy pairs=0 --keep colliding");
  EXPECT_EQ(io::readCloud(folder / "free.ply").width, 0U);
  EXPECT_EQ(io::readCloud(folder / "rest.ply").width, 6400U);
}

TEST_F(CollideAccuracy, HoldsAlongAPath)
{
  const std::string path = "--clearance 0.3 --from 0,0,0,0,0,0 --to 0,0,0.5,0,0,0 --steps 9 --report {report.json} ";
  expectDone(job + "{exact.ply} " + path);
  const std::vector<int> expected = flags("exact.ply");
  int undecided = 0;
  for (const std::string setting : {"level=0", "level=1", "level=9", "pairs=500", "time=1e-04"}) {
    const Outcome done = collide(job + "{out.ply} " + path + "--accuracy " + setting);
    ASSERT_EQ(done.exit_code, 0) << done.err;
    const std::vector<int> found = flags("out.ply");
    for (std::size_t i = 0; i < found.size(); ++i)
      ASSERT_TRUE(found[i] == 2 || found[i] == expected[i]) << setting << ", point " << i;
    const Json json = report();
    EXPECT_EQ(json["accuracy"], setting);
    EXPECT_EQ(std::count(found.begin(), found.end(), 2), json["undecided"]);
    EXPECT_TRUE(json["distance"].is_null());
    EXPECT_EQ(json["path"]["poses"], 10);
    EXPECT_EQ(json["path"]["table"].size(), 0U);
    EXPECT_EQ(io::readCloud(folder / "out.ply").fields.back().name, "collision") << "and no more than that";
    undecided += json["undecided"].get<int>();
  }
  EXPECT_GT(undecided, 0) << "nothing was ever undecided";
  const Outcome done = collide(job + "{out.ply} " + path + "--accuracy tolerance=0.01 --clashes {a.json}");
  EXPECT_THAT(done.out, HasSubstr("smallest distance 0.25 within the tolerance"));
}

TEST_F(CollideAccuracy, Refuses)
{
  for (const std::string wrong : {"roughly", "level", "level=1.5", "tolerance=-1", "time=1s", "exact=1"}) {
    expectFailure(job + "{out.ply} --clearance 0.3 --accuracy " + wrong, 2,
                  "--accuracy: '" + wrong + "' is none: give exact, tolerance=LENGTH, level=N, pairs=N or time=");
  }
  expectFailure(job + "{out.ply} --clearance 0.3 --accuracy level=1 --clashes {a.csv}", 2,
                "--accuracy: level=1: decides which points collide, not when and how near");
  expectFailure(job + "{out.ply} --clearance 0.3 --accuracy level=1 --swept 0.1 --from 0,0,0,0,0,0 --to 1,0,0,0,0,0 " +
                    "--steps 2",
                2, "--accuracy: level=1: swept motion has a tolerance of its own: give exact");
}

/// A wall of points along x, and a probe of one point that passes it at a distance that depends on where it is.
class CollideAlong : public Collide {
protected:
  CollideAlong()
  {
    std::string points = "x y z\n", lines;
    for (int i = 0; i <= 40; ++i) points += std::to_string(0.25 * i) + " 0 0\n";
    folder.write("wall.txt", points);
    folder.write("probe.xyz", "0 0 0\n");
    // In at 2, away at 4 and 6, in again and nearer at 8.
    for (const char* pose : {"2 0.2 0", "4 5 0", "6 5 0", "8 0.1 0"}) lines += "0 " + std::string(pose) + " 0 0 0 1\n";
    folder.write("poses.txt", lines);
  }

  Json clashes(const std::string& file) const { return Json::parse(io::contentOf(folder / file))["clashes"]; }

  const std::string job = "{wall.txt} {probe.xyz} {out.ply} --clearance 0.3 ";
};

TEST_F(CollideAlong, WritesItsFieldsAndReports)
{
  const Outcome done = collide(job + "--trajectory {poses.txt} --report {report.json}");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("4 of 41 points collide; smallest distance 0.1 at pose 3, between point 32 of the "
                                  "input and point 0 of the obstacle; 4 poses; wrote "));
  const pcl::PCLPointCloud2 cloud = io::readCloud(folder / "out.ply");
  ASSERT_EQ(cloud.fields.size(), 7U);
  EXPECT_EQ(cloud.fields[3].datatype, pcl::PCLPointField::UINT8);
  EXPECT_EQ(cloud.fields[4].datatype, pcl::PCLPointField::FLOAT32);
  EXPECT_EQ(cloud.fields[5].datatype, pcl::PCLPointField::INT32);
  EXPECT_EQ(valueOf(cloud, 8, "collision"), 1);
  EXPECT_NEAR(valueOf(cloud, 8, "distance"), 0.2, 1e-7);
  EXPECT_EQ(valueOf(cloud, 8, "first_pose"), 0);
  EXPECT_EQ(valueOf(cloud, 32, "closest_pose"), 3);
  EXPECT_EQ(valueOf(cloud, 20, "collision"), 0);
  EXPECT_TRUE(std::isnan(valueOf(cloud, 20, "distance")));
  EXPECT_EQ(valueOf(cloud, 20, "first_pose"), -1);
  EXPECT_EQ(valueOf(cloud, 20, "closest_pose"), -1);

  const Json json = report();
  EXPECT_EQ(json["colliding"], 4);
  EXPECT_EQ(json["path"]["poses"], 4);
  EXPECT_EQ(json["path"]["table"][0]["colliding"], 1);
  EXPECT_EQ(json["path"]["table"][0]["closest_pair"], (Json{8, 0}));
  EXPECT_EQ(json["path"]["table"][1],
            (Json{{"pose", 1}, {"colliding", 0}, {"undecided", 0}, {"distance", nullptr}, {"closest_pair", nullptr}}));
  EXPECT_EQ(json["density"]["input"], (Json{{"median", 0.25}, {"nine_of_ten", 0.25}, {"sampled_points", 41}}));
}

TEST_F(CollideAlong, StraightRunsAndSweptMotion)
{
  const std::string run = "--from 0,-1,0,0,0,0 --to 10,1,0,0,0,1 --steps ";
  expectDone(job + run + "1 --report {report.json}");
  EXPECT_EQ(report()["path"]["poses"], 2);
  EXPECT_EQ(report()["colliding"], 0);
  expectDone(job + run + "1 --swept 0.01 --report {report.json}");
  EXPECT_GT(report()["colliding"], 0);
  EXPECT_EQ(report()["path"]["first_contact"]["pose"], 0);
  EXPECT_NEAR(report()["path"]["first_contact"]["fraction"], 0.35, 0.03);
  expectDone(job + run + "100 --report {report.json}");
  EXPECT_EQ(report()["path"]["poses"], 101);
  EXPECT_GT(report()["colliding"], 0);
}

TEST_F(CollideAlong, ListsClashesAndComparesThem)
{
  const std::string lists = "--trajectory {poses.txt} --clashes {a.json} --clashes {a.csv} --clashes {a.html} ";
  expectDone(job + lists + "--cluster-distance 0.5");
  const Json first = clashes("a.json");
  ASSERT_EQ(first.size(), 2U);
  EXPECT_EQ(first[0]["id"], "C4_0_0");
  EXPECT_EQ(first[0]["status"], "new");
  EXPECT_EQ(first[0]["points"], 3);
  EXPECT_EQ(first[0]["closest_pose"], 3);
  EXPECT_EQ(first[0]["box"]["min"], (Json{7.75, 0, 0}));
  EXPECT_EQ(first[0]["closest_pair"]["input"]["point"], 32);
  EXPECT_EQ(first[0]["closest_pair"]["obstacle"]["at"], (Json{8.0, 0.1, 0.0}));
  EXPECT_EQ(first[1]["id"], "C1_0_0");
  const std::string csv = io::contentOf(folder / "a.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_THAT(csv, HasSubstr("\nC4_0_0,new,3,"));
  const std::string html = io::contentOf(folder / "a.html");
  EXPECT_THAT(html, StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(html, HasSubstr("id=\"C1_0_0\""));
  EXPECT_EQ(html.find("http"), std::string::npos) << "needs nothing from elsewhere";

  // Once more, then without the first place.
  expectDone(job + lists + "--cluster-distance 0.5 --previous {a.json}");
  for (const Json& clash : clashes("a.json")) EXPECT_EQ(clash["status"], "persisting");
  folder.write("poses.txt", "0 8 0.1 0 0 0 0 1\n0 9.5 0.1 0 0 0 0 1\n");
  expectDone(job + lists + "--cluster-distance 0.5 --previous {a.json}");
  const Json last = clashes("a.json");
  ASSERT_EQ(last.size(), 3U);
  EXPECT_EQ(last[2]["status"], "not_visited") << "the path does not come there any more";
  EXPECT_EQ(last[2]["id"], "C1_0_0");
}

TEST_F(CollideAlong, ClashesAreResolvedOnlyWhereTheRunLooked)
{
  const std::string options = " {probe.xyz} {out.ply} --clearance 0.3 --trajectory {poses.txt} --cluster-distance 0.5 ";
  expectDone("{wall.txt}" + options + "--clashes {first.json} --clashes {page.html} --unit m");
  EXPECT_EQ(Json::parse(io::contentOf(folder / "first.json"))["unit"], "m");
  EXPECT_THAT(io::contentOf(folder / "page.html"), HasSubstr("Lengths in m."));
  const std::string again = options + "--clashes {b.json} --clashes {b.html} --clashes {b.csv} --previous {first.json}";
  const auto statusOf = [&](const std::string& id) -> std::string {
    for (const Json& clash : clashes("b.json"))
      if (clash["id"] == id) return clash["status"];
    return "forgotten";
  };

  // The wall lies 0.6 farther away: scanned, and free.
  std::string moved = "x y z\n", half = moved;
  for (int i = 0; i <= 40; ++i) moved += std::to_string(0.25 * i) + " -0.6 0\n";
  for (int i = 0; i <= 18; ++i) half += std::to_string(0.25 * i) + " 0 0\n";
  folder.write("moved.txt", moved);
  folder.write("half.txt", half);
  const Outcome free = collide("{moved.txt}" + again);
  EXPECT_THAT(free.out, HasSubstr("0 clashes, 2 resolved; wrote")) << free.err;
  EXPECT_THAT(free.err, Not(HasSubstr("of a scan"))) << "a wall that moves by less than a clash's reach";

  // A scan of half of it.
  const Outcome less = collide("{half.txt}" + again);
  EXPECT_THAT(less.out, HasSubstr("1 clash, 0 resolved, 1 not scanned; wrote")) << less.err;
  EXPECT_THAT(less.err,
              HasSubstr("first.json: lists clashes of a scan from (0, 0, 0) to (10, 0, 0), now it is from (0, "
                        "0, 0) to (4.5, 0, 0): "));
  EXPECT_EQ(statusOf("C4_0_0"), "not_scanned");
  EXPECT_THAT(io::contentOf(folder / "b.html"), HasSubstr("<span class=\"badge not_scanned\">not scanned</span>"));
  EXPECT_THAT(io::contentOf(folder / "b.csv"), HasSubstr("\nC4_0_0,not_scanned,3,"));

  // A place that was not scanned is not forgotten, as long as nobody looks.
  expectDone("{half.txt}" + options + "--clashes {b.json} --previous {b.json}");
  EXPECT_EQ(statusOf("C4_0_0"), "not_scanned");
  expectDone("{wall.txt}" + options + "--clashes {b.json} --previous {b.json}");
  EXPECT_EQ(statusOf("C4_0_0"), "persisting");
}

TEST_F(CollideAlong, CertainClashesAreToldFromThosePerhaps)
{
  const std::string options = "--trajectory {poses.txt} --cluster-distance 0.5 --uncertainty 0.15 ";
  const Outcome done = collide(job + options + "--clashes {a.json} --clashes {a.html} --clashes {a.csv}");
  EXPECT_THAT(done.out, HasSubstr("; 1 clash, 1 perhaps; wrote")) << done.err;
  const Json list = Json::parse(io::contentOf(folder / "a.json"));
  EXPECT_EQ(list["uncertainty"], (Json{{"input", 0.15}, {"obstacle", 0.0}}));
  EXPECT_EQ(list["clashes"][0]["id"], "C4_0_0");
  EXPECT_EQ(list["clashes"][0]["certainty"], "certain");
  EXPECT_EQ(list["clashes"][1]["certainty"], "perhaps");
  EXPECT_THAT(io::contentOf(folder / "a.html"), HasSubstr("<h1>1 clash, 1 perhaps</h1>"));
  EXPECT_THAT(io::contentOf(folder / "a.csv"), HasSubstr(",perhaps,0,0.3,0.15,0,,exact,,,,,\n"));
  expectDone(job + options + "--clashes {b.json} --previous {a.json}");
  for (const Json& clash : clashes("b.json")) EXPECT_EQ(clash["status"], "persisting");
  expectFailure(job + "--trajectory {poses.txt} --clashes {c.json} --previous {a.json}", 1,
                "a.json: lists clashes with uncertainty 0.15, now it is not given: ");
}

TEST_F(CollideAlong, AMadeDateMakesTheSameReport)
{
  const std::string lists = "--trajectory {poses.txt} --clashes {a.html} ";
  ASSERT_EQ(setenv("SOURCE_DATE_EPOCH", "86400", 1), 0);
  expectDone(job + lists);
  EXPECT_THAT(io::contentOf(folder / "a.html"), HasSubstr(" on 1970-01-02."));
  ASSERT_EQ(setenv("SOURCE_DATE_EPOCH", "today", 1), 0);
  for (const std::string asked : {"--trajectory {poses.txt} --clashes {c.html} ", "--distances"})
    expectFailure(job + asked, 1, "SOURCE_DATE_EPOCH: 'today' is no date: ");
  unsetenv("SOURCE_DATE_EPOCH");
}

TEST_F(CollideAlong, ClashesOfOnePose)
{
  expectDone(job + "--pose 2,0.2,0,0,0,0 --clashes {a.json}");
  ASSERT_EQ(clashes("a.json").size(), 1U);
  EXPECT_EQ(io::readCloud(folder / "out.ply").fields.size(), 4U) << "no path, no fields of a path";
  expectDone(job + "--pose 2,9,0,0,0,0 --clashes {a.json} --clashes {a.html}");
  EXPECT_EQ(clashes("a.json").size(), 0U);
}

TEST_F(CollideAlong, WarnsOfHolesThatCollisionsHideIn)
{
  std::string sheet = "x y z\n";
  for (int i = 0; i < 400; ++i) sheet += std::to_string(i % 20) + ' ' + std::to_string(i / 20) + " 0\n";
  folder.write("sheet.txt", sheet);
  expectDone("{sheet.txt} {sheet.txt} {out.ply} --clearance 1 --report {report.json}");
  ASSERT_EQ(report()["warnings"].size(), 1U);
  EXPECT_THAT(report()["warnings"][0].get<std::string>(),
              HasSubstr("sheet.txt: surfaces may touch with no two points"));
  EXPECT_EQ(report()["density"]["could_hide_collisions"], true);
  expectDone("{sheet.txt} {sheet.txt} {out.ply} --clearance 1.5 --report {report.json}");
  EXPECT_EQ(report()["warnings"].size(), 0U);
  EXPECT_EQ(report()["density"]["could_hide_collisions"], false);
}

TEST_F(CollideAlong, Refuses)
{
  const std::string path = "--trajectory {poses.txt} ";
  expectFailure(job + path + "--pose 0,0,0,0,0,0", 2, "--pose: a path is given too: give one of them");
  expectFailure(job + path + "--steps 3", 2, "--from: --trajectory is given too");
  expectFailure(job + "--from 0,0,0,0,0,0 --steps 3", 2, "--from: a straight run is not complete");
  expectFailure(job + "--from 0,0,0,0,0,0 --to 1,2 --steps 3", 2, "--to: '1,2' is neither six numbers nor a file");
  expectFailure(job + "--from 0,0,0,0,0,0 --to 1,0,0,0,0,0 --steps 0", 2, "--steps: 0: give 1 to 10000000");
  expectFailure(job + "--from nan,0,0,0,0,0 --to 1,0,0,0,0,0 --steps 2", 1, "--from: not finite");
  expectFailure(job + "--swept 0.1", 2, "--swept: nothing moves");
  expectFailure(job + path + "--swept 0", 2, "--swept: ");
  expectFailure(job + path + "--swept much", 2, "--swept: 'much' is not a number");
  expectFailure(job + "--trajectory {none.txt}", 1, "none.txt: no such file");
  folder.write("bad.txt", "0 2 0.2 0 0 0 0 1\n0 4 5 0 0 0 0\n");
  expectFailure(job + "--trajectory {bad.txt}", 1, "bad.txt: line 2 has 7 numbers");
  expectFailure(job + path + "--clashes {a.txt}", 2, "--clashes: ");
  expectFailure(job + path + "--clashes {none/a.csv}", 1, "there is no folder");
  expectFailure(job + path + "--clashes {a.csv} --clashes {a.csv}", 2,
                "is the file of --clashes, too: choose another name");
  expectFailure(job + path + "--cluster-distance 1", 2, "--cluster-distance: no clash report is written");
  expectFailure(job + path + "--previous {a.json}", 2, "--previous: no clash report is written");
  expectFailure(job + path + "--unit m", 2, "--unit: no report tells it: give --distances or --clashes FILE");
  expectFailure(job + path + "--clashes {a.csv} --cluster-distance 0", 2, "--cluster-distance: 0: give a finite");
  expectFailure(job + path + "--clashes {a.csv} --previous {none.json}", 1, "none.json: no such file");
  folder.write("odd.json", "{\"clashes\": [{\"id\": 7}]}");
  expectFailure(job + path + "--clashes {a.csv} --previous {odd.json}", 1, "odd.json: is no list of clashes: ");
  folder.write("cut.json", "{\"clashes\": [");
  expectFailure(job + path + "--clashes {a.csv} --previous {cut.json}", 1,
                "cut.json: is no list of clashes: is no JSON");
  folder.write("distance.pcd", "FIELDS x y z distance\nSIZE 4 4 4 8\nTYPE F F F F\nPOINTS 1\nDATA ascii\n1 2 3 0.5\n");
  expectFailure("{distance.pcd} {probe.xyz} {out.ply} --clearance 1 " + path, 1, "field 'distance' exists already");
}

TEST_F(Collide, HelpShowsAnExample)
{
  const Outcome help = collide("--help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("pcl_bsh_collide hall.ply robot.pcd marked.pcd --clearance 0.05"));
}

/// Whoever adds a row to the table has an option of the program.
TEST_F(Collide, HasEachOptionOfAQuestion)
{
  const std::string help = collide("--help").out;
  for (const QuestionOption& row : questionOptions()) {
    std::string name = row.name;
    std::replace(name.begin(), name.end(), '_', '-');
    const std::string option = "--" + name + (row.value[0] == '\0' ? "" : " " + std::string(row.value));
    EXPECT_THAT(help, HasSubstr(option)) << row.name;
  }
  EXPECT_THAT(help, HasSubstr("in the clouds' unit"));
  EXPECT_THAT(help, Not(HasSubstr("`")));
}

TEST_F(Collide, RefusesClouds)
{
  folder.write("cut.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 9\nDATA binary\nabcdefghijkl");
  folder.write("flat.pcd", "FIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA ascii\n1 2\n");
  folder.write("many.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 2147483648\nDATA binary\n");
  folder.write("image.ply", "\x89PNG\r\n");
  folder.write("scan.fls", "LASF");
  folder.write("collision.pcd",
               "FIELDS x y z collision\nSIZE 4 4 4 4\nTYPE F F F F\nPOINTS 1\nDATA ascii\n1 2 3 0.5\n");
  const std::string rest = " {out.pcd} --clearance 1";
  for (const auto& [file, message] :
       {std::pair<std::string, std::string>{"{none.pcd}", "none.pcd: no such file: "},
        {"{}", ": is a folder: "},
        {"{cut.pcd}", "cut.pcd: is truncated: its header promises 9 points, its size allows 1 at most: "},
        {"{flat.pcd}", "flat.pcd: field 'z' is missing"},
        {"{many.pcd}", "many.pcd: it has 2147483648 points, more than the 2147483647 that an index can name: split"},
        {"{image.ply}", "image.ply: is not a PLY file"},
        {"{scan.fls}", "scan.fls: unknown extension '.fls': "}}) {
    expectFailure(file + " {obstacle.xyz}" + rest, 1, message);
    expectFailure("{input.ply} " + file + rest, 1, message);
  }
  expectFailure("{collision.pcd} {obstacle.xyz}" + rest, 1, "collision.pcd: field 'collision' exists already");
}

TEST_F(Collide, RefusesOutputs)
{
  const std::string clouds = "{input.ply} {obstacle.xyz} ";
  expectFailure(clouds + "{out.e57} --clearance 1", 1, "out.e57: unknown extension '.e57': write a .pcd, .ply, ");
  expectFailure(clouds + "{none/out.pcd} --clearance 1", 1, "cannot be written, there is no folder");
  expectFailure(clouds + "{out.pcd} --clearance 1 --report {none/report.json}", 1, "there is no folder");
  expectFailure(clouds + "{out.pcd} --clearance 1 --report {}", 1, ": is a folder: ");
  expectFailure(clouds + "{out.pcd} --clearance 1 --report {out.pcd}", 2,
                "is the file of OUTPUT, too: choose another name");
  expectFailure(clouds + "{out.pcd} --clearance 1 --report {input.ply}", 2,
                "is the file of INPUT, which is read: choose another name");
}

TEST_F(Collide, RefusesClearances)
{
  const std::string job = "{input.ply} {obstacle.xyz} {out.pcd} --clearance ";
  expectFailure(job + "-1", 2, "pcl_bsh_collide: --clearance: -1: give a finite length >= 0");
  expectFailure(job + "nan", 2, "--clearance: nan: ");
  expectFailure(job + "inf", 2, "--clearance: inf: ");
  expectFailure(job + "wide", 2, "--clearance: 'wide' is not a number: ");
}

TEST_F(Collide, RefusesPoses)
{
  const std::string job = "{input.ply} {obstacle.xyz} {out.pcd} --clearance 1 --pose ";
  expectFailure(job + "1,2,3", 2, "--pose: '1,2,3' is neither six numbers nor a file: ");
  expectFailure(job + "nowhere.txt", 2, "--pose: 'nowhere.txt' is neither six numbers nor a file: ");
  expectFailure(job + "nan,0,0,0,0,0", 1, "--pose: not finite");
  folder.write("scale.txt", "2 0 0 0\n0 2 0 0\n0 0 2 0\n");
  expectFailure(job + "{scale.txt}", 1, "--pose: not rigid");
  folder.write("mirror.txt", "-1 0 0 0\n0 1 0 0\n0 0 1 0\n");
  expectFailure(job + "{mirror.txt}", 1, "--pose: a mirror");
  folder.write("row.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2\n");
  expectFailure(job + "{row.txt}", 1, "--pose: last row is 0 0 0 2");
  folder.write("short.txt", "1 0 0 0\n0 1 0 0\n");
  expectFailure(job + "{short.txt}", 1, "short.txt: holds 8 numbers: give the 12 or 16 ");
  folder.write("words.txt", "one\n");
  expectFailure(job + "{words.txt}", 1, "words.txt: line 1 is damaged: 'one' is not a number: ");
}

TEST_F(Collide, RefusesCommandLines)
{
  expectFailure("", 2, "command line: INPUT is required: see pcl_bsh_collide --help");
  expectFailure("{input.ply} {obstacle.xyz} {out.pcd}", 2, "--clearance is required");
  const std::string job = "{input.ply} {obstacle.xyz} {out.pcd} --clearance 1 ";
  expectFailure(job + "--fast", 2, "--fast");
  expectFailure(job + "--pose", 2, "--pose");
  expectFailure(job + "--keep some", 2, "--keep: 'some' is unknown: give flagged, colliding or free");
  expectFailure(job + "--threads many", 2, "--threads: 'many' is not a whole number");
  expectFailure(job + "--threads -1", 2, "--threads: '-1' is not a whole number");
}

} // namespace pcl_bsh
