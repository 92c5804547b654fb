// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/defect.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/io/poses/waypoints.h>
#include <pcl_bsh/io/text/format_error.h>

#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

namespace pcl_bsh::io {
namespace {

using testing::HasSubstr;
using Way = Waypoint::Way;

constexpr double degrees_of_radian = 180.0 / 3.14159265358979323846;

double headingOf(const Eigen::Isometry3d& pose)
{
  return std::atan2(pose(1, 0), pose(0, 0)) * degrees_of_radian;
}

std::string refusalOfWay(const std::string& text, const std::string& step = "1 10")
{
  try {
    posesAlong(parseWaypoints("waypoints " + step + "\n" + text));
  }
  catch (const FormatError& error) {
    return std::string(error.what()) + ": " + error.remedy();
  }
  return {};
}

std::vector<Eigen::Isometry3d> along(const std::string& text, const LargestStep& step)
{
  const std::string first = "waypoints " + std::to_string(step.length) + " " + std::to_string(step.degrees) + "\n";
  return posesAlong(parseWaypoints(first + text));
}

TEST(Waypoints, PlacesTurnFromXTowardsY)
{
  for (int quarter = -9; quarter < 9; ++quarter) {
    const Eigen::Matrix4d pose = placeAt({1, 2, 3}, 90.0 * quarter).matrix();
    EXPECT_EQ(pose, pose.array().round().matrix()) << "exactly: " << quarter;
    EXPECT_TRUE(pose.isApprox(placeAt({1, 2, 3}, 90.0 * quarter + 1e-9).matrix(), 1e-10)) << quarter;
  }
  EXPECT_EQ(placeAt({1, 2, 3}, 90) * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 3, 3));
  for (int i = -1800; i <= 1800; ++i) {
    const double heading = 0.3 * i;
    const Eigen::Isometry3d expected(Eigen::AngleAxisd(heading / degrees_of_radian, Eigen::Vector3d::UnitZ()));
    EXPECT_TRUE(placeAt(Eigen::Vector3d::Zero(), heading).isApprox(expected, 1e-14)) << heading;
  }
}

TEST(Waypoints, AreReadFromLines)
{
  const std::string text = "# a way\nwaypoints, 0.5, 2\n1 2 3 -90\n\n4,5,6,7.5,turn # there\n1;1;1;0;arc\r\n";
  EXPECT_TRUE(areWaypoints(text));
  EXPECT_FALSE(areWaypoints("1 0 0 0 0 1 0 0 0 0 1 0\nwaypoints"));
  EXPECT_FALSE(areWaypoints("# waypoints 1 2\n"));
  const WaypointPath path = parseWaypoints(text);
  EXPECT_EQ(path.step.length, 0.5);
  EXPECT_EQ(path.step.degrees, 2.0);
  const std::vector<Waypoint>& way = path.way;
  ASSERT_EQ(way.size(), 3u);
  EXPECT_EQ(way[0].place, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(way[0].heading, -90.0);
  EXPECT_EQ(way[0].way, Way::straight);
  EXPECT_EQ(way[1].way, Way::turn);
  EXPECT_EQ(way[2].way, Way::arc);
  const std::string remedy = ": give x y z heading, the heading in degrees, and turn or arc where its way is no line";
  EXPECT_EQ(refusalOfWay("0 0 0 0\n1 2 3"), "line 3 has too few numbers" + remedy);
  EXPECT_EQ(refusalOfWay("0 0 0 0 left"), "line 2 has 'left', which is no way" + remedy);
  EXPECT_EQ(refusalOfWay("0 0 nan 0"), "line 2 has a number that is not finite" + remedy);
  EXPECT_EQ(refusalOfWay("# nothing"), "holds no waypoint" + remedy);
  EXPECT_THAT(refusalOfWay("0 0 0 0 arc 3"), HasSubstr("line 2 has more values than it should"));
  EXPECT_THAT(refusalOfWay("0 0 0 east"), HasSubstr("line 2 is damaged"));
}

TEST(Waypoints, StepsAreNoLarger)
{
  const std::string text = "0 0 0 10\n3 4 0 20\n3 4 0 350 turn\n-1 4 2 260 arc\n-1 4 2 260\n-5 0 0 200 turn";
  for (const LargestStep step : {LargestStep{0.5, 5}, {100, 1}, {0.03, 100}, {1000, 1000}}) {
    const std::vector<Eigen::Isometry3d> poses = along(text, step);
    for (std::size_t k = 1; k < poses.size(); ++k) {
      EXPECT_LE((poses[k].translation() - poses[k - 1].translation()).norm(), step.length * (1 + 1e-12)) << k;
      EXPECT_LE(std::abs(std::remainder(headingOf(poses[k]) - headingOf(poses[k - 1]), 360)), step.degrees * (1 + 1e-9))
          << k;
      EXPECT_FALSE(poses[k].isApprox(poses[k - 1], 0.0)) << k;
      EXPECT_TRUE(poses[k].linear().isUnitary(1e-15));
    }
    EXPECT_EQ(poses.front().matrix(), placeAt({0, 0, 0}, 10).matrix());
    EXPECT_EQ(poses.back().matrix(), placeAt({-5, 0, 0}, 200).matrix());
  }
  EXPECT_EQ(along(text, {1000, 1000}).size(), 6u) << "one waypoint stays where it is, one turns first";
  EXPECT_EQ(along("0 0 0 0\n10 0 0 0", {1, 10}).size(), 11u);
  EXPECT_EQ(along("0 0 0 0\n10 0 0 45", {1, 3}).size(), 16u);
  EXPECT_EQ(along("1 2 3 4", {1, 1}).size(), 1u);
}

TEST(Waypoints, TurnInPlaceFirst)
{
  const std::vector<Eigen::Isometry3d> poses = along("0 0 0 350\n10 0 0 20 turn", {2, 10});
  ASSERT_EQ(poses.size(), 1u + 3 + 5);
  for (std::size_t k = 1; k <= 3; ++k) {
    EXPECT_EQ(poses[k].translation(), Eigen::Vector3d::Zero());
    EXPECT_NEAR(headingOf(poses[k]), -10.0 + 10.0 * static_cast<double>(k), 1e-12) << "the short way round";
  }
  for (std::size_t k = 4; k < 9; ++k) EXPECT_NEAR(headingOf(poses[k]), 20.0, 1e-12);
}

/// A quarter of a circle about (0, 4), as a car drives it, and a body that looks sideways on the same way.
TEST(Waypoints, ArcsTurnAboutOneAxis)
{
  for (const double sideways : {0.0, 75.0, -90.0}) {
    const std::string text = "0 0 0 " + std::to_string(sideways) + "\n4 4 1 " + std::to_string(sideways + 90) + " arc";
    const std::vector<Eigen::Isometry3d> poses = along(text, {0.1, 90});
    EXPECT_EQ(poses.size(), 65u) << "of its length, 6.36, not of the chord, 5.74";
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const double angle = static_cast<double>(k) / 64 * 90 / degrees_of_radian;
      const Eigen::Vector3d expected(4 * std::sin(angle), 4 - 4 * std::cos(angle), static_cast<double>(k) / 64);
      EXPECT_TRUE(poses[k].translation().isApprox(expected, 1e-13) || k == 0) << k;
      EXPECT_NEAR(std::remainder(headingOf(poses[k]) - sideways - angle * degrees_of_radian, 360), 0.0, 1e-11);
    }
  }
  const std::vector<Eigen::Isometry3d> straight = along("0 0 0 7\n4 0 0 7 arc", {1, 1});
  ASSERT_EQ(straight.size(), 5u) << "without a turn it is a line";
  EXPECT_EQ(straight[2].translation(), Eigen::Vector3d(2, 0, 0));
}

TEST(Waypoints, RefuseWhatNobodyCanTell)
{
  EXPECT_EQ(refusalOfWay("0 0 0 90\n1 0 0 -90"),
            "has waypoint 1 half a turn from the one before: add one between them, which tells which way round");
  EXPECT_EQ(refusalOfWay("0 0 0 90\n1 0 0 -89"), "");
  EXPECT_EQ(refusalOfWay("0 0 0 0\n1e9 0 0 0"), "has more than ten million poses: give a larger step");
  EXPECT_EQ(refusalOfWay("0 0 0 0\n1e300 0 0 0", "1e-300 1"), "has more than ten million poses: give a larger step");
  const std::string remedy = ": give `waypoints LENGTH DEGREES`, the largest step from a pose to the next, both finite "
                             "and > 0";
  for (const char* none : {"0 1", "1 0", "-1 1"})
    EXPECT_EQ(refusalOfWay("0 0 0 0", none), "line 1 has no largest step" + remedy) << none;
  EXPECT_EQ(refusalOfWay("0 0 0 0", "1"), "line 1 has too few numbers" + remedy);
  EXPECT_EQ(refusalOfWay("0 0 0 0", "1 inf"), "line 1 has a number that is not finite" + remedy);
  EXPECT_THAT(refusalOfWay("0 0 0 0", "1 2 3"), HasSubstr("line 1 has more values than it should"));
}

/// Wherever poses are read.
TEST(Waypoints, AreAFileOfPoses)
{
  const TemporaryFolder folder;
  const auto file = folder.write("way.txt", "waypoints 1 10\n0 0 0 0\n3 0 0 0\n");
  const std::vector<Eigen::Isometry3d> poses = readPoses(file);
  ASSERT_EQ(poses.size(), 4u);
  writePoses(folder / "poses.txt", poses);
  const std::vector<Eigen::Isometry3d> again = readPoses(folder / "poses.txt");
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(again[k].matrix(), poses[k].matrix());
  EXPECT_THAT([&] { readPoses(folder.write("way.txt", "waypoints 1\n0 0 0 0\n")); },
              testing::ThrowsMessage<files::FileError>(
                  HasSubstr("way.txt: line 1 has too few numbers: give `waypoints LENGTH DEGREES`")));
}

} // namespace
} // namespace pcl_bsh::io
