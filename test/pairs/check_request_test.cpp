// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/pairs/check_request.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The check's complaint; empty when it accepts.
std::string verdict(double clearance, const Eigen::Isometry3d& pose_a, const Eigen::Isometry3d& pose_b)
{
  const SphereHierarchy empty{PointsView{}};
  try {
    check({empty, pose_a}, {empty, pose_b}, AnyRequest{clearance, {}});
    return {};
  }
  catch (const std::invalid_argument& error) {
    return error.what();
  }
}

Eigen::Isometry3d turned()
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()));
  pose.pretranslate(Eigen::Vector3d(1e6, -2, 3));
  return pose;
}

TEST(CheckRequest, AcceptsRigidPosesAndClearances)
{
  for (const double clearance : {0.0, 1e-320, 0.05, 1e300}) EXPECT_EQ(verdict(clearance, turned(), turned()), "");
  const Eigen::Isometry3d from_float = turned().cast<float>().cast<double>();
  EXPECT_EQ(verdict(0, from_float, from_float), "");
}

TEST(CheckRequest, NamesABadClearance)
{
  for (const double clearance : {-0.5, -1e-320, infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(verdict(clearance, turned(), turned()), HasSubstr("clearance")) << clearance;
  }
  EXPECT_THAT(verdict(-0.5, turned(), turned()), HasSubstr("-0.5"));
}

TEST(CheckRequest, NamesABadGreatestDistance)
{
  const SphereHierarchy empty{PointsView{}};
  const auto verdictOn = [&](double max_distance) -> std::string {
    DistanceRequest request;
    request.max_distance = max_distance;
    try {
      check({empty}, {empty}, request);
      return {};
    }
    catch (const std::invalid_argument& error) {
      return error.what();
    }
  };
  for (const double good : {0.0, 2.5, infinity}) EXPECT_EQ(verdictOn(good), "");
  for (const double bad : {-0.5, -infinity, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THAT(verdictOn(bad), HasSubstr("max_distance")) << bad;
}

TEST(CheckRequest, NamesThePoseThatIsNotRigid)
{
  const auto refused = [](auto spoil) {
    Eigen::Isometry3d pose = turned();
    spoil(pose.matrix());
    const std::string of_a = verdict(1, pose, turned()), of_b = verdict(1, turned(), pose);
    EXPECT_THAT(of_a, HasSubstr("pose of a"));
    EXPECT_THAT(of_b, HasSubstr("pose of b"));
    EXPECT_THAT(of_a, Not(HasSubstr("\n")));
    return of_a;
  };
  using Matrix = Eigen::Matrix4d;
  EXPECT_THAT(refused([](Matrix& m) { m(0, 3) = infinity; }), HasSubstr("not finite"));
  EXPECT_THAT(refused([](Matrix& m) { m(1, 1) = std::numeric_limits<double>::quiet_NaN(); }), HasSubstr("not finite"));
  EXPECT_THAT(refused([](Matrix& m) { m(3, 0) = 1e-9; }), HasSubstr("last row"));
  EXPECT_THAT(refused([](Matrix& m) { m(3, 3) = 2; }), HasSubstr("last row"));
  EXPECT_THAT(refused([](Matrix& m) { m.topLeftCorner<3, 3>() *= 1.000001; }), HasSubstr("not rigid"));
  EXPECT_THAT(refused([](Matrix& m) { m.topLeftCorner<3, 3>().setZero(); }), HasSubstr("not rigid"));
  EXPECT_THAT(refused([](Matrix& m) { m.topLeftCorner<3, 3>() *= 1e200; }), HasSubstr("not rigid"));
  EXPECT_THAT(refused([](Matrix& m) { m(0, 1) += 2e-6; }), HasSubstr("not rigid"));
  EXPECT_THAT(refused([](Matrix& m) { m.col(2) *= -1; }), HasSubstr("mirror"));
}

} // namespace
} // namespace pcl_bsh
