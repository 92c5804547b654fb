// SPDX-License-Identifier: BSD-3-Clause
// A machine in millimetres in a hall in metres: units, places, pairs, waypoints, and a floor that does not count.
#include "program_run.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/poses/pose_file.h>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>

namespace pcl_bsh {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double east = 412004.5, north = 5653210.25;

class CollideUnits : public testing::Test {
protected:
  CollideUnits()
  {
    std::ofstream hall(folder / "hall.csv");
    hall << std::setprecision(12) << "x,y,z,classification\n";
    for (int i = 0; i < 100; ++i)
      for (int j = 0; j < 100; ++j) hall << east + 0.1 * i << ',' << north + 0.1 * j << ",98,2\n";
    for (int j = 0; j < 100; ++j)
      for (int k = 1; k < 40; ++k) hall << east + 9.9 << ',' << north + 0.1 * j << ',' << 98 + 0.1 * k << ",6\n";
    folder.write("machine.obj", box(1000, 500, 2000));
    folder.write("metres.obj", box(1, 0.5, 2));
  }

  /// A box from the origin.
  static std::string box(double x, double y, double z)
  {
    std::ostringstream text;
    for (int i = 0; i < 8; ++i) text << "v " << x * (i & 1) << ' ' << y * (i >> 1 & 1) << ' ' << z * (i >> 2) << '\n';
    text << "f 1 2 4 3\nf 5 6 8 7\nf 1 2 6 5\nf 3 4 8 7\nf 1 3 7 5\nf 2 4 8 6\n";
    return text.str();
  }

  Outcome collide(const std::string& arguments) const { return run("pcl_bsh_collide", arguments, folder.path()); }

  /// The report of what was done.
  nlohmann::json done(const std::string& arguments) const
  {
    const Outcome outcome = collide(arguments + " --clearance 0.05 --report report.json");
    EXPECT_EQ(outcome.exit_code, 0) << arguments << '\n' << outcome.err;
    return nlohmann::json::parse(io::contentOf(folder / "report.json"));
  }

  /// The one line of what was refused.
  std::string refused(const std::string& arguments) const
  {
    const Outcome outcome = collide(arguments + " --clearance 0.05");
    EXPECT_NE(outcome.exit_code, 0) << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    return outcome.err;
  }

  io::TemporaryFolder folder;
  const std::string in_units = " --input-unit m --obstacle-unit mm";
  const std::string place = " --place 412013.5,5653212.25,98.02,0";
};

TEST_F(CollideUnits, AreConvertedOnceAndTold)
{
  const auto metres = done("hall.csv metres.obj out.pcd" + place);
  const auto found = done("hall.csv machine.obj out.pcd" + in_units + place);
  EXPECT_EQ(found["colliding"], metres["colliding"]);
  EXPECT_GT(found["colliding"], 0);
  EXPECT_EQ(found["distance"], metres["distance"]);
  EXPECT_EQ(found["unit"], "m");
  EXPECT_TRUE(metres["unit"].is_null());
  EXPECT_THAT(found["warnings"].dump(), HasSubstr("machine.obj: its lengths are converted from mm to m"));
  EXPECT_THAT(done("hall.csv machine.obj out.pcd")["warnings"].dump(), HasSubstr("--obstacle-unit"));
  EXPECT_EQ(io::contentOf(folder / "out.pcd").empty(), false);
}

TEST_F(CollideUnits, RefuseWhatIsNoUnit)
{
  EXPECT_THAT(refused("hall.csv machine.obj out.pcd --obstacle-unit inch"),
              HasSubstr("--obstacle-unit: 'inch' is no unit: give mm, cm, m, ft or us-ft"));
  EXPECT_THAT(refused("hall.csv machine.obj out.pcd --obstacle-unit mm"),
              HasSubstr("--obstacle-unit: mm: the unit of INPUT is not known: give --input-unit, too"));
  EXPECT_THAT(refused("hall.csv machine.obj out.pcd --input-unit m"),
              HasSubstr("machine.obj: does not say its unit, and is wanted in m: name its unit, too"));
  EXPECT_THAT(refused("hall.csv machine.obj out.pcd --clashes c.json --unit mm" + in_units),
              HasSubstr("--unit: mm: lengths are in INPUT's unit, m: leave it out"));
}

TEST_F(CollideUnits, PosesArePlacesAndPairs)
{
  const auto at_place = done("hall.csv machine.obj out.pcd" + in_units + " --place 412013.5,5653212.25,98.02,90");
  folder.write("pairs.txt", "0 0 0 412013.5 5653212.25 98.02\n1000 0 0 412013.5 5653213.25 98.02\n"
                            "0 500 0 412013 5653212.25 98.02\n");
  const auto fitted = done("hall.csv machine.obj out.pcd --pairs pairs.txt --poses-out pose.txt" + in_units);
  EXPECT_EQ(fitted["colliding"], at_place["colliding"]);
  EXPECT_THAT(fitted["warnings"].dump(), HasSubstr("--pairs: pairs.txt: the pose fits 3 pairs with residuals of "));
  const auto poses = io::readPoses(folder / "pose.txt");
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_NEAR(poses[0](1, 0), 1.0, 1e-12);
  folder.write("line.txt", "0 0 0 1 0 0\n1000 0 0 2 0 0\n2000 0 0 3 0 0\n");
  EXPECT_THAT(refused("hall.csv machine.obj out.pcd --pairs line.txt" + in_units),
              HasSubstr("line.txt: has places of the obstacle on one line, to within "));
  EXPECT_THAT(refused("hall.csv metres.obj out.pcd --pairs pairs.txt"),
              HasSubstr("pairs.txt: has places of the obstacle "
                        "1000 times as far apart"));
  EXPECT_THAT(refused("hall.csv machine.obj out.pcd --place 1,2,3"), HasSubstr("--place: '1,2,3' is not four finite"));
  EXPECT_THAT(refused("hall.csv machine.obj out.pcd --place 1,2,3,4 --pose 1,2,3,0,0,0"),
              HasSubstr("--place: another pose is given, too"));
}

TEST_F(CollideUnits, WaypointsAreAPath)
{
  folder.write("way.txt", "waypoints 0.25 10\n412001 5653212 98.02 0\n412006 5653212 98.02 0\n"
                          "412008 5653214 98.02 90 arc\n412008 5653218 98.02 180 turn\n");
  const auto found = done("hall.csv machine.obj out.pcd --trajectory way.txt --poses-out poses.txt" + in_units);
  const auto again = done("hall.csv machine.obj out.pcd --trajectory poses.txt" + in_units);
  EXPECT_EQ(found["colliding"], again["colliding"]);
  EXPECT_EQ(found["path"]["poses"], io::readPoses(folder / "poses.txt").size());
}

TEST_F(CollideUnits, TheFloorDoesNotCount)
{
  const auto all = done("hall.csv machine.obj out.pcd" + in_units + place);
  const auto found =
      done("hall.csv machine.obj out.pcd --clashes c.json --ignore-points classification=2" + in_units + place);
  EXPECT_LT(found["colliding"], all["colliding"]);
  EXPECT_EQ(found["input"]["ignored"], 10000);
  EXPECT_EQ(found["free"].get<int>() + found["colliding"].get<int>(), 3900);
  EXPECT_THAT(found["warnings"].dump(),
              HasSubstr("hall.csv: 10000 of 13900 points do not count: 10000 of classification=2"));
  EXPECT_EQ(done("hall.csv machine.obj out.pcd --ignore-points plane=0,0,1,98,0.01" + in_units + place)["colliding"],
            found["colliding"]);
  const auto list = nlohmann::json::parse(io::contentOf(folder / "c.json"));
  EXPECT_EQ(list["unit"], "m");
  const pcl::PCLPointCloud2 hall = io::readCloud(folder / "hall.csv");
  std::string marks;
  for (std::size_t i = 0; i < hall.width; ++i) marks += io::valueOf(hall, i, "classification") == 2.0 ? "1\n" : "0\n";
  folder.write("marks.txt", marks);
  const auto marked = done("hall.csv machine.obj out.pcd --ignore-points mask=marks.txt" + in_units + place);
  EXPECT_EQ(marked["colliding"], found["colliding"]);
  EXPECT_EQ(marked["input"]["ignored"], 10000);
  folder.write("marks.txt", marks + "1\n");
  EXPECT_THAT(refused("hall.csv machine.obj out.pcd --ignore-points mask=marks.txt" + in_units + place),
              HasSubstr("hall.csv: has 13900 points, and mask marks.txt has 13901 values: give the mask a value for "));
  EXPECT_THAT(refused("hall.csv machine.obj marks.txt --ignore-points mask=marks.txt" + in_units + place),
              HasSubstr("--ignore-points"));
  EXPECT_THAT(refused("hall.csv machine.obj out.pcd --ignore-points classification=2,7" + in_units + place),
              HasSubstr("hall.csv: has no point to ignore of 'classification=7'"));
  EXPECT_THAT(refused("hall.csv machine.obj out.pcd --ignore-points class=2" + in_units + place),
              HasSubstr("hall.csv: field 'class' of points to ignore is missing"));
  EXPECT_THAT(refused("hall.csv machine.obj out.pcd --ignore-points 2" + in_units + place),
              HasSubstr("--ignore-points: '2' is none: give FIELD=N,N"));
}

} // namespace
} // namespace pcl_bsh
