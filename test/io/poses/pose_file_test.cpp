// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/defect.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/io/poses/pose_text.h>
#include <pcl_bsh/io/poses/rigid_pose.h>
#include <pcl_bsh/io/text/format_error.h>

#include <gmock/gmock.h>

#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <utility>

namespace pcl_bsh::io {

using Poses = std::vector<Eigen::Isometry3d>;
using testing::HasSubstr;

class PoseFile : public testing::Test {
protected:
  Poses read(const std::string& text) const { return readPoses(folder.write("poses.txt", text)); }

  void expectRefused(const std::string& text, const std::string& message) const
  {
    try {
      read(text);
      ADD_FAILURE() << text;
    }
    catch (const files::FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr("poses.txt: " + message)) << text;
      EXPECT_THAT(error.what(), HasSubstr(": give 12 or 16 numbers")) << text;
    }
  }

  TemporaryFolder folder;
  Poses quarter_turn = [] {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.matrix() << 0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1;
    return Poses{Eigen::Isometry3d::Identity(), pose};
  }();

  void expectQuarterTurn(const Poses& poses) const
  {
    ASSERT_EQ(poses.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(poses[i].isApprox(quarter_turn[i], 1e-15)) << i;
  }
};

TEST_F(PoseFile, ToldApartByTheirColumns)
{
  expectQuarterTurn(read("1 0 0 0 0 1 0 0 0 0 1 0\n0 -1 0 1 1 0 0 2 0 0 1 3\n"));
  expectQuarterTurn(read("# 4 x 4\n\n1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 # start\r\n"
                         "0,-1,0,1;1,0,0,2;0,0,1,3;0,0,0,1"));
  expectQuarterTurn(read("0.0 0 0 0 0 0 0 1\n1e9 1 2 3 0 0 0.70710678118654752 0.70710678118654752\n"));
}

TEST_F(PoseFile, NamesOfColumnsDecide)
{
  const std::string half = "0.70710678118654752";
  // EuRoC: w first, and more columns behind, of which v_RS_R_x and b_w_RS_S_x are no position.
  expectQuarterTurn(read("#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
                         "q_RS_z [], v_RS_R_x [m s^-1], b_w_RS_S_x [rad s^-1]\n"
                         "1403636580838555648,0,0,0,1,0,0,0,9,9\n1403636580843555648,1,2,3," +
                         half + ",0,0," + half + ",9,9\n"));
  expectQuarterTurn(read("timestamp tx ty tz qx qy qz qw\n0 0 0 0 0 0 0 1\n1 1 2 3 0 0 " + half + " " + half + "\n"));
  expectQuarterTurn(
      read("# x y z qx qy qz qw\n0 0 0 0 0 0 1\n# z y x qw qx qy qz\n1 2 3 0 0 " + half + " " + half + "\n"));
  expectQuarterTurn(
      read("# by someone\n# time qw qx qy qz tx ty tz\n0 1 0 0 0 0 0 0\n1 " + half + " 0 0 " + half + " 1 2 3\n"));
  expectQuarterTurn(
      read("%time,field.header.frame_id,field.pose.position.x,field.pose.position.y,field.pose.position.z,"
           "field.pose.orientation.x,field.pose.orientation.y,field.pose.orientation.z,field.pose.orientation.w\n"
           "0,/world,0,0,0,0,0,0,1\n1,/world,1,2,3,0,0," +
           half + "," + half + "\n"));
  expectQuarterTurn(read("X;Y;Z;QW;QX;QY;QZ\n0;0;0;1;0;0;0\n1;2;3;" + half + ";0;0;" + half + "\n"));
  expectQuarterTurn(
      read("#\n# \n# time qw qx qy qz tx ty tz\n#\n0 1 0 0 0 0 0 0\n1 " + half + " 0 0 " + half + " 1 2 3\n"));
  // A line with another number of columns than the poses is a comment.
  expectQuarterTurn(read("# made of tx ty tz qx qy qz qw\n1 0 0 0 0 1 0 0 0 0 1 0\n0 -1 0 1 1 0 0 2 0 0 1 3\n"));
  expectRefused("timestamp x y z\n0 1 2 3\n", "line 1 names columns, and not one each of tx ty tz qx qy qz qw");
  expectRefused("tx ty tz qx qy qz qw tx\n", "line 1 names columns, and not one each");
  expectRefused("tx ty tz qx qy qz qw\n0 0 0 0 0 1\n", "line 2 has 6 values, and 7 columns are named");
  expectRefused("tx ty tz qx qy qz qw\n0 0 zero 0 0 0 1\n", "line 2 is damaged: 'zero' is not a number");
  expectRefused("tx ty tz qx qy qz qw\n0 0 0 0 0 0 2\n", "line 2 has a quaternion of length 2");
  expectRefused("tx ty tz qx qy qz qw\n", "holds no pose");
}

TEST_F(PoseFile, NumbersAreSeparatedAlike)
{
  const std::string row = "line 1 separates numbers by several characters, or has decimal commas";
  expectQuarterTurn(read("\xef\xbb\xbf"
                         "1;0;0;0;0;1;0;0;0;0;1;0\n0\t-1\t0\t1\t1\t0\t0\t2\t0\t0\t1\t3\n"));
  expectQuarterTurn(read("1 0 0 0; 0 1 0 0; 0 0 1 0\n0, -1, 0, 1; 1, 0, 0, 2; 0, 0, 1, 3;\n"));
  for (const std::string text : {"0,5;1,5;2,5;3,5;0,0;0,0;0,0;1,0\n", "1,0,0,0;0,1,0;0,0,0,1\n", "1;0,0,0,0\n"}) {
    try {
      read(text);
      ADD_FAILURE() << text;
    }
    catch (const files::FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr(row)) << text;
    }
  }
  expectRefused("0,5 1,5 2,5 3,5 0,0 0,0 0,0 1,0\n", "line 1 is damaged: '5 1' is not a number");
  expectRefused("1,0,0,0,0,1,0,0,,0,1,0\n", "line 1 has an empty value");
  EXPECT_EQ(numbersOf("1,2,3,0,0,0").size(), 6U);
  EXPECT_THROW(numbersOf("1,5 2,5 3,5"), FormatError) << "x y z, not x y z roll pitch yaw";
  EXPECT_THROW(numbersOf("1,5;2,5;3,5"), FormatError);
}

TEST_F(PoseFile, QuaternionsOfFewDigitsAreNormalised)
{
  const Poses poses = read("0 1 2 3 0 0 0.7071 0.7071\n");
  EXPECT_LT((poses[0].linear().transpose() * poses[0].linear() - Eigen::Matrix3d::Identity()).norm(), 1e-15);
}

/// Rotations all over, as printed with so many digits.
std::string printed(int count, int digits)
{
  std::ostringstream text;
  text << std::setprecision(digits);
  for (int i = 0; i < count; ++i) {
    const Eigen::Matrix3d r =
        Eigen::AngleAxisd(0.37 * i, Eigen::Vector3d(std::sin(i), std::cos(3 * i), std::sin(2 * i + 1)).normalized())
            .toRotationMatrix();
    for (int row = 0; row < 3; ++row) text << r(row, 0) << ' ' << r(row, 1) << ' ' << r(row, 2) << ' ' << row << ' ';
    text << '\n';
  }
  return text.str();
}

TEST_F(PoseFile, PrintedMatricesStandForTheirNearestRotations)
{
  for (const int digits : {6, 5}) {
    std::vector<std::string> warnings;
    const Poses poses = readPoses(folder.write("poses.txt", printed(200, digits)), &warnings);
    ASSERT_EQ(poses.size(), 200U);
    const Poses exact = read(printed(200, 17));
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Eigen::Matrix3d r = poses[i].linear();
      EXPECT_LE((r.transpose() * r - Eigen::Matrix3d::Identity()).norm(), 1e-6) << i;
      EXPECT_LE((r - exact[i].linear()).norm(), 2 * std::pow(10.0, -digits)) << i;
      EXPECT_EQ(poses[i].translation(), Eigen::Vector3d(0, 1, 2));
    }
    ASSERT_EQ(warnings.size(), 1U) << digits;
    EXPECT_THAT(warnings[0], HasSubstr("poses.txt: "));
    EXPECT_THAT(warnings[0], HasSubstr(" of 200 poses: the worst |R'R - I| is "));
  }
  std::vector<std::string> warnings;
  readPoses(folder.write("poses.txt", printed(50, 9)), &warnings);
  EXPECT_THAT(warnings, testing::IsEmpty()) << "rigid as they are";
  EXPECT_EQ(parsePoses(printed(5, 6)).size(), 5U) << "nobody asks for warnings";
  EXPECT_THROW(read(printed(50, 3)), files::FileError);
}

TEST(NearestRigid, LeavesWhatNoRotationCanMendAsItIs)
{
  Eigen::Isometry3d printed = Eigen::Isometry3d::Identity();
  printed.linear()(0, 1) = 1e-5;
  EXPECT_GT(nearestRigid(printed).deviation, 0.0);
  Eigen::Isometry3d endless = printed, scaled = printed;
  endless.translation().x() = std::numeric_limits<double>::infinity();
  scaled.matrix()(3, 3) = 2.0;
  for (const Eigen::Isometry3d& given : {endless, scaled}) {
    const RigidPose left = nearestRigid(given);
    EXPECT_EQ(left.deviation, 0.0);
    EXPECT_EQ(left.pose.matrix(), given.matrix());
  }
}

TEST_F(PoseFile, MayBeginWithTheMarkOfUtf8)
{
  expectQuarterTurn(read("\xef\xbb\xbf"
                         "1 0 0 0 0 1 0 0 0 0 1 0\n0 -1 0 1 1 0 0 2 0 0 1 3\n"));
}

TEST_F(PoseFile, RefusesLinesByNumber)
{
  const std::string good = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  const std::string quaternion = "0 0 0 0 0 0 0 1\n";
  expectRefused("1 2 3\n", "line 1 has 3 numbers, not 8, 12 or 16");
  expectRefused("# all of one line\n" + good + "1 0 0 0 0 1 0 0 0 0 1\n", "line 3 has 11 numbers, not 8, 12 or 16");
  expectRefused(good + quaternion, "line 2 has 8 numbers, the lines before have 12");
  expectRefused(good + "\n1 0 0 0 0 1 0 0 0 0 1 0 0\n", "line 3 has 13 numbers");
  expectRefused(good + "1 0 0 0 0 1 0 0 0 0 1 zero\n", "line 2 is damaged: 'zero' is not a number");
  expectRefused(good + "1 0 0 0 0 1 0 0 0 0 1 0x\n", "line 2 is damaged: '0x' is not a number");
  expectRefused(good + "2 0 0 0 0 2 0 0 0 0 2 0\n", "line 2 holds no pose, not rigid, |R'R - I| is ");
  expectRefused("-1 0 0 0 0 1 0 0 0 0 1 0\n", "line 1 holds no pose, a mirror");
  expectRefused("1 0 0 nan 0 1 0 0 0 0 1 0\n", "line 1 holds no pose, not finite");
  expectRefused("1 0 0 inf 0 1 0 0 0 0 1 0\n", "line 1 holds no pose, not finite");
  expectRefused("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2\n", "line 1 holds no pose, last row is 0 0 0 2");
  expectRefused(quaternion + "1 0 0 0 0 0 0 0\n", "line 2 has a quaternion of length 0");
  expectRefused(quaternion + "1 0 0 0 0 0 0 nan\n", "line 2 has a quaternion of length nan");
  expectRefused(quaternion + "1 0 0 0 0 0 0 1.01\n", "line 2 has a quaternion of length 1.01");
  expectRefused(quaternion + "1 inf 0 0 0 0 0 1\n", "line 2 holds no pose, not finite");
  expectRefused("# nothing\n", "holds no pose");
}

TEST_F(PoseFile, RefusesFiles)
{
  EXPECT_THROW(readPoses(folder / "none.txt"), files::FileError);
  EXPECT_THROW(readPoses(folder / ""), files::FileError);
  EXPECT_THROW(read(""), files::FileError);
}

TEST_F(PoseFile, WhatIsWrittenReadsBackToTheSameBits)
{
  Poses poses;
  for (int i = 0; i < 20; ++i) {
    Eigen::Isometry3d pose(Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d(1, 2, -3).normalized()));
    pose.translation() = Eigen::Vector3d(1e6 / 3 * i, -1e-9 * i, 0.1);
    poses.push_back(pose);
  }
  writePoses(folder / "poses.txt", poses);
  const Poses again = readPoses(folder / "poses.txt");
  ASSERT_EQ(again.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_TRUE(again[i].matrix() == poses[i].matrix()) << i;
  EXPECT_EQ(folder.files(), 1U);
}

TEST_F(PoseFile, TellsTheWorstOfItsMatrices)
{
  const std::string good = "1 0 0 0 0 1 0 0 0 0 1 0\n", bad = "1 1e-5 0 0 0 1 0 0 0 0 1 0\n",
                    worst = "1 4e-5 0 0 0 1 0 0 0 0 1 0\n";
  std::vector<std::string> first, last, one;
  readPoses(folder.write("poses.txt", worst + good + bad), &first);
  readPoses(folder.write("poses.txt", good + bad + worst), &last);
  readPoses(folder.write("poses.txt", good + bad), &one);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first, last);
  EXPECT_THAT(first[0], HasSubstr("2 of 3 poses: the worst |R'R - I| is 5.6"));
  EXPECT_THAT(one.at(0), HasSubstr("1 of 2 poses: the worst |R'R - I| is 1.4"));
}

TEST_F(PoseFile, ColumnsOfOtherMeaningsAreLeftOut)
{
  const std::string half = "0.70710678118654752";
  expectQuarterTurn(read("w tx ty tz qx qy qz qw pw speed_x (m)\n9 0 0 0 0 0 0 1 9 9 9\n9 1 2 3 0 0 " + half + " " +
                         half + " 9 9 9\n"));
}

TEST_F(PoseFile, RowsOfAMatrixAreAlike)
{
  EXPECT_EQ(numbersOf("1;2;3").size(), 3U);
  EXPECT_EQ(numbersOf("1 2 3 4;5 6 7 8").size(), 8U);
  EXPECT_EQ(numbersOf("1,2,3,4\n5,6,7,8").size(), 8U);
  for (const char* text : {"1 2;3 4", "1 2 3;4 5 6", "1 2 3 4;5", "1;2 3 4 5", "1 2 3 4;5 6 7", "1 2 3 4;;1 2 3 4"})
    EXPECT_THROW(numbersOf(text), FormatError) << text;
}

TEST_F(PoseFile, APoseOfAFileIsAMatrix)
{
  EXPECT_TRUE(readPose(folder.write("pose", "0 -1 0 1 1 0 0 2 0 0 1 3")).isApprox(quarter_turn[1], 1e-15));
  EXPECT_TRUE(readPose(folder.write("pose", "0 -1 0 1\n1 0 0 2\n0 0 1 3\n0 0 0 1")).isApprox(quarter_turn[1], 1e-15));
  for (const auto& [text, wrong] : {std::pair("1 2 3 0 0 0", "holds 6 numbers: give the 12 or 16 numbers"),
                                    {"1 2 3", "holds 3 numbers: give"},
                                    {"1", "holds 1 number: give"}}) {
    const auto file = folder.write("pose", text);
    const auto read_it = [&] { readPose(file); };
    EXPECT_THAT(read_it, testing::ThrowsMessage<files::FileError>(HasSubstr(wrong)));
  }
}

/// Names that begin with a separator, that are a unit alone, that are but one letter.
TEST_F(PoseFile, OddNamesOfColumnsAreNoFault)
{
  const std::string half = "0.70710678118654752";
  const std::string rows = "0 0 0 0 0 0 1\n1 2 3 0 0 " + half + " " + half + "\n";
  expectQuarterTurn(read("/t/x /t/y /t/z /q/x /q/y /q/z /q/w\n" + rows));
  expectQuarterTurn(read("_.p..x _p_y p__z -q--x q..y qz_ qw()\n" + rows));
  expectQuarterTurn(read("px py pz qx qy qz qw q_s rotation-k t_s\n0 0 0 0 0 0 1 9 9 9\n1 2 3 0 0 " + half + " " +
                         half + " 9 9 9\n"));
  expectQuarterTurn(
      read("[a] t tx ty tz q qx qy qz qw pos\n9 9 0 0 0 9 0 0 0 1 9\n9 9 1 2 3 9 0 0 " + half + " " + half + " 9\n"));
}

/// Read as the number before its '#', a pose would be a metre off.
TEST_F(PoseFile, RefusesWhatProgramsWriteForNaN)
{
  for (const std::string nan : {"1.#QNAN", "-1.#IND", "1.#SNAN", "1.#INF", "nan(ind)"}) {
    expectRefused("1 0 0 " + nan + " 0 1 0 0 0 0 1 0\n", "line 1 holds no pose");
    expectRefused("1 0 0 0 0 1 0 0 0 0 1 " + nan + "\n", "line 1 holds no pose");
    expectRefused("0 1 2 3 0 0 0 " + nan + "\n", "line 1 has a quaternion of length");
    EXPECT_EQ(read(nan + " 1 2 3 0 0 0 1 # a time is not used\n").size(), 1U) << nan;
  }
}

TEST_F(PoseFile, NobodyHasToAskForWarnings)
{
  EXPECT_EQ(readPoses(folder.write("poses.txt", printed(5, 6))).size(), 5U);
}

/// Rz(yaw) Ry(pitch) Rx(roll), then moved.
TEST(PoseText, SixNumbersArePlaceAndAngles)
{
  const Eigen::Isometry3d pose = poseFrom({1, 2, 3, 0.1, 0.2, 0.3});
  using Eigen::AngleAxisd, Eigen::Vector3d;
  const Eigen::Matrix3d turn =
      (AngleAxisd(0.3, Vector3d::UnitZ()) * AngleAxisd(0.2, Vector3d::UnitY()) * AngleAxisd(0.1, Vector3d::UnitX()))
          .toRotationMatrix();
  EXPECT_TRUE(pose.linear().isApprox(turn, 1e-15));
  EXPECT_EQ(pose.translation(), Vector3d(1, 2, 3));
  EXPECT_THROW(poseFrom({1, 2, 3}), FormatError);
}

namespace {

Eigen::Matrix3d turned(double angle)
{
  return Eigen::AngleAxisd(angle, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
}

} // namespace

TEST(RigidPart, TakesWhatPrintedDigitsLeave)
{
  for (const double angle : {0.0, 0.3, 1.7, 3.1, M_PI}) {
    const Eigen::Matrix3d exact = turned(angle);
    EXPECT_EQ(rigidPart(exact).linear, exact) << "to the bit";
    EXPECT_EQ(rigidPart(exact).deviation, 0.0);
    Eigen::Matrix3d printed = exact;
    printed(1, 2) += 2e-5;
    for (const bool allow_scale : {false, true}) {
      const RigidPart part = rigidPart(printed, allow_scale);
      EXPECT_EQ(part.wrong, "");
      EXPECT_GT(part.deviation, 1e-6);
      EXPECT_TRUE(part.rotation.isApprox(exact, 2e-5));
      EXPECT_LT((part.rotation.transpose() * part.rotation - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    }
  }
}

TEST(RigidPart, SaysWhyAMatrixIsRefused)
{
  const Eigen::Matrix3d r = turned(0.7);
  Eigen::Matrix3d flat = r, zero = Eigen::Matrix3d::Zero(), mirror = r, shear = r, uneven = r, endless = r, counted;
  flat.col(2) = flat.col(0) + flat.col(1);
  counted << 1, 2, 3, 4, 5, 6, 7, 8, 9; // whose determinant rounds to 7e-16
  mirror.col(1) *= -1;
  shear.col(1) += 0.01 * shear.col(0);
  uneven.col(2) *= 1.001;
  endless(0, 0) = std::numeric_limits<double>::quiet_NaN();
  for (const bool allow_scale : {false, true}) {
    for (const Eigen::Matrix3d& singular : {flat, zero, counted, Eigen::Matrix3d(flat * 1e150)})
      EXPECT_EQ(rigidPart(singular, allow_scale).wrong, "flattens space: it is singular");
    for (const double scale : {1.0, 1000.0, 1e-150})
      EXPECT_EQ(rigidPart(scale * mirror, allow_scale).wrong, "mirrors") << scale;
    EXPECT_THAT(rigidPart(shear, allow_scale).wrong, HasSubstr("shears or scales unevenly"));
    EXPECT_THAT(rigidPart(uneven, allow_scale).wrong, HasSubstr("shears or scales unevenly"));
    EXPECT_EQ(rigidPart(endless, allow_scale).wrong, "is not finite");
    EXPECT_FALSE(rigidPart(uneven, allow_scale).scales);
  }
}

TEST(RigidPart, TakesAUniformScaleWhereItIsAllowed)
{
  for (const double scale : {1000.0, 0.0254, 1.0001, 0.9996, 1e-150, 1e150}) {
    const Eigen::Matrix3d scaled = scale * turned(0.7);
    const RigidPart refused = rigidPart(scaled);
    EXPECT_TRUE(refused.scales) << scale;
    EXPECT_THAT(refused.wrong, HasSubstr("scales by ")) << scale;
    const RigidPart part = rigidPart(scaled, true);
    EXPECT_EQ(part.wrong, "");
    EXPECT_EQ(part.linear, scaled) << "to the bit";
    EXPECT_TRUE(part.rotation.isApprox(turned(0.7), 1e-14)) << scale;
    Eigen::Matrix3d printed = scaled;
    printed(0, 1) += 2e-5 * scale;
    EXPECT_GT(rigidPart(printed, true).deviation, 1e-6) << scale;
    EXPECT_TRUE(rigidPart(printed, true).linear.isApprox(scaled, 3e-5)) << scale;
  }
  EXPECT_EQ(rigidPart(1000.0 * turned(0.7)).wrong, "scales by 1000");
}

} // namespace pcl_bsh::io
