// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/defect.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/poses/pose_fit.h>
#include <pcl_bsh/io/text/format_error.h>

#include <gmock/gmock.h>

#include <random>
#include <string>
#include <vector>

namespace pcl_bsh::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::vector<PlacePair> pairsAt(const Eigen::Isometry3d& pose, const std::vector<Eigen::Vector3d>& places)
{
  std::vector<PlacePair> pairs;
  for (const Eigen::Vector3d& place : places) pairs.push_back({place, pose * place});
  return pairs;
}

std::string refusalToFit(const std::vector<PlacePair>& pairs)
{
  try {
    fitPose(pairs);
  }
  catch (const FormatError& error) {
    return std::string(error.what()) + ": " + error.remedy();
  }
  return {};
}

Eigen::Isometry3d poseInHall()
{
  Eigen::Isometry3d pose(Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, -2, 0.5).normalized()));
  pose.translation() = Eigen::Vector3d(412004.5, 5653210.25, 98.125);
  return pose;
}

TEST(PoseFits, FindThePose)
{
  const Eigen::Isometry3d pose = poseInHall();
  for (const auto& places : std::vector<std::vector<Eigen::Vector3d>>{
           {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}},
           {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0.5, 0.5, 1.5}},
           {{100, 100, 100}, {101, 100, 100}, {100, 100.01, 100}},
       }) {
    const PoseFit fit = fitPose(pairsAt(pose, places));
    EXPECT_LT((fit.pose.linear() - pose.linear()).norm(), 2e-7) << "coordinates of maps have 9 digits behind the point";
    EXPECT_NEAR(fit.pose.linear().determinant(), 1.0, 1e-15);
    EXPECT_TRUE(fit.pose.linear().isUnitary(1e-14));
    for (std::size_t i = 0; i < places.size(); ++i) {
      EXPECT_LT(fit.residuals[i], 2e-9);
      EXPECT_LT((fit.pose * places[i] - pose * places[i]).norm(), 3e-9);
    }
  }
}

/// No rigid motion near the one that is found has a smaller sum of squares.
TEST(PoseFits, HaveTheLeastSquares)
{
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::vector<PlacePair> pairs = pairsAt(poseInHall(), {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 1}, {2, 2, 0}});
  for (PlacePair& pair : pairs) pair.scan += Eigen::Vector3d(noise(random), noise(random), noise(random));
  const PoseFit fit = fitPose(pairs);
  const auto squares = [&](const Eigen::Isometry3d& pose) {
    double sum = 0.0;
    for (const PlacePair& pair : pairs) sum += (pose * pair.body - pair.scan).squaredNorm();
    return sum;
  };
  double told = 0.0;
  for (const double residual : fit.residuals) told += residual * residual;
  EXPECT_NEAR(told, squares(fit.pose), 1e-9);
  for (int axis = 0; axis < 3; ++axis)
    for (const double step : {-1e-4, 1e-4}) {
      Eigen::Isometry3d moved = fit.pose, turned = fit.pose;
      moved.translation()[axis] += step;
      turned.rotate(Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(axis)));
      EXPECT_GT(squares(moved), squares(fit.pose)) << axis;
      EXPECT_GT(squares(turned), squares(fit.pose)) << axis;
    }
  EXPECT_THAT(fit.text(), HasSubstr("the pose fits 5 pairs with residuals of 0.0"));
  EXPECT_THAT(fit.text(), HasSubstr(": RMS 0.0"));
}

TEST(PoseFits, RefuseWhatTellsNoPose)
{
  const Eigen::Isometry3d pose = poseInHall();
  EXPECT_THAT(refusalToFit(pairsAt(pose, {{0, 0, 0}, {1, 0, 0}})), HasSubstr("has 2 pairs, and a pose takes three"));
  EXPECT_THAT(refusalToFit(pairsAt(Eigen::Isometry3d::Identity(), {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}})),
              AllOf(HasSubstr("has places of the obstacle on one line, to within "),
                    HasSubstr(": add a pair that is beside it")));
  EXPECT_THAT(refusalToFit(pairsAt(pose, {{0, 0, 0}, {1, 0.0005, 0}, {3, 0, 0}})), HasSubstr("on one line, to within"));
  EXPECT_EQ(refusalToFit(pairsAt(pose, {{0, 0, 0}, {1, 0.02, 0}, {3, 0, 0}})), "");
  EXPECT_THAT(refusalToFit(pairsAt(pose, {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}})), HasSubstr("on one line"));
  std::vector<PlacePair> pairs = pairsAt(Eigen::Isometry3d::Identity(), {{0, 0, 0}, {1, 0.02, 0}, {3, 0, 0}});
  pairs[2].scan.x() = 3.1;
  EXPECT_THAT(refusalToFit(pairs), HasSubstr("on one line")) << "which residuals are as wide as";
  pairs = pairsAt(Eigen::Isometry3d::Identity(), {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}});
  for (PlacePair& pair : pairs) pair.body *= 1000.0;
  EXPECT_EQ(refusalToFit(pairs),
            "has places of the obstacle 1000 times as far apart as those of the other: give both in "
            "the units of their files, and name these: --input-unit and --obstacle-unit");
}

TEST(PoseFits, AreReadFromLines)
{
  const TemporaryFolder folder;
  const auto file =
      folder.write("pairs.txt", "# obstacle, input\n0 0 0 10 20 30\n2000 0 0 10 22 30\n\n0,1000,0,9,20,30\n");
  const PoseFit fit = readPoseFit(file, LengthScale(LengthUnit::mm, LengthUnit::m));
  EXPECT_TRUE(
      fit.pose.linear().isApprox(Eigen::Matrix3d(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ())), 1e-14));
  EXPECT_TRUE(fit.pose.translation().isApprox(Eigen::Vector3d(10, 20, 30), 1e-14));
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      readPoseFit(folder.write("pairs.txt", text));
    }
    catch (const files::FileError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(refusal("1 2 3 4 5"),
              HasSubstr("pairs.txt: line 1 has 5 numbers, not 6: give x y z of the obstacle and"));
  EXPECT_THAT(refusal("1 2 3 4 5 nan"), HasSubstr("line 1 has a number that is not finite"));
  EXPECT_THAT(refusal("# none"), HasSubstr("pairs.txt: has 0 pairs"));
}

} // namespace
} // namespace pcl_bsh::io
