// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/robot/kinematics.h>

#include "made_arms.h"
#include "support/attacks.h"
#include "support/refusal.h"
#include <pcl_bsh/base/invalid_input.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <numbers>

namespace pcl_bsh {
namespace {

using namespace robots;
using test::LongVector;

/// A joint about z at the root, and a link that it turns.
Robot turntable()
{
  Robot robot{"table", {{"base", {}, {}}, {"plate", {}, Joint{"turn"}}}};
  robot.links[1].joint->kind = Joint::Kind::revolute;
  robot.links[1].joint->axis = Eigen::Vector3d::UnitZ();
  return robot;
}

TEST(Kinematics, TurnsAndSlidesLinks)
{
  Robot robot = turntable();
  Joint slide{"slide", Joint::Kind::prismatic, 1};
  slide.origin.translation() = Eigen::Vector3d(1, 0, 0);
  slide.lower = 0.0, slide.upper = 1.0;
  robot.links.push_back({"arm", {}, slide});
  Joint seat{"seat", Joint::Kind::fixed, 2};
  seat.origin.translation() = Eigen::Vector3d(0, 0, 3);
  robot.links.push_back({"hand", {}, seat});
  const Kinematics kinematics(robot);
  EXPECT_EQ(kinematics.variables(), 2u);
  EXPECT_EQ(kinematics.bodies().size(), 3u);
  EXPECT_EQ(kinematics.bodyOf(3), kinematics.bodyOf(2));
  const std::vector<Eigen::Isometry3d> poses =
      kinematics.linkPoses(stateOf(robot, {{"turn", std::numbers::pi / 2}, {"slide", 0.5}}));
  EXPECT_LT((poses[3].translation() - Eigen::Vector3d(0, 1.5, 3)).norm(), 1e-15);
}

/// Climbs to the states where doubles are farthest from the exact place. PCL_BSH_ATTACKS in the environment: how many
/// states.
TEST(Kinematics, BoundsTheErrorOfPlaces)
{
  const long steps = test::attacks(18'000) / 6;
  double most = 0.0;
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u}) {
    test::Random random(seed);
    const Robot robot = test::madeArm(random, 12, true);
    const Kinematics kinematics(robot);
    const std::size_t last = kinematics.bodies().size() - 1;
    const Eigen::Vector3d x = test::madeVector(random, 0.2);
    std::vector<Kinematics::Pose> poses;
    const auto share = [&](const RobotState& state) {
      kinematics.poses(state, {}, last + 1, poses);
      const LongVector exact = test::longPoses(kinematics, {state.begin(), state.end()})[last] * x.cast<long double>();
      RobotState largest = state;
      for (double& value : largest) value = std::abs(value);
      const auto off = static_cast<double>(((poses[last] * x).cast<long double>() - exact).norm());
      return off / kinematics.error(largest, x.norm(), 0.0);
    };
    RobotState best = test::madeState(random, robot);
    double worst = share(best);
    for (long step = 0; step < steps; ++step) {
      RobotState next = step % 3 == 0 ? test::madeState(random, robot) : best;
      if (step % 3 != 0)
        for (double& value : next) value += random.uniform(-1e-2, 1e-2);
      if (const double found = share(next); found > worst) worst = found, best = next;
    }
    EXPECT_LT(worst, 1.0) << seed;
    most = std::max(most, worst);
  }
  EXPECT_GT(most, 1e-4); // the bound is of the size of what it bounds
}

TEST(Kinematics, BoundsDistancesFromAxes)
{
  double most = 0.0;
  for (const std::uint64_t seed : {11u, 12u, 13u, 14u}) {
    test::Random random(seed);
    const Robot robot = test::madeArm(random, 8, true);
    const Kinematics kinematics(robot);
    const std::size_t last = kinematics.bodies().size() - 1;
    const Eigen::Vector3d center = test::madeVector(random, 0.2);
    const std::vector<std::size_t> chain = kinematics.chain(last);
    const std::vector<double> bounds = kinematics.axisDistances(last, center, 0.0);
    std::vector<Kinematics::Pose> poses;
    for (int i = 0; i < 2000; ++i) {
      kinematics.poses(test::madeState(random, robot), {}, last + 1, poses);
      const Eigen::Vector3d p = poses[last] * center;
      for (std::size_t k = 0; k < chain.size(); ++k) {
        const Kinematics::Body& body = kinematics.bodies()[chain[k]];
        if (body.kind == Joint::Kind::prismatic) continue;
        const double across = (poses[chain[k]].rotation * body.axis).cross(p - poses[chain[k]].translation).norm();
        ASSERT_LE(across, bounds[k] * (1 + 1e-12)) << seed << " " << k;
        most = std::max(most, across / bounds[k]);
      }
    }
  }
  EXPECT_GT(most, 0.999);
}

TEST(Kinematics, TwistsAreSpeeds)
{
  test::Random random(21);
  const Robot robot = test::madeArm(random, 10, true);
  const Kinematics kinematics(robot);
  const std::size_t count = kinematics.bodies().size();
  const RobotState state = test::madeState(random, robot);
  RobotState slopes, later = state;
  const double time = 1e-6;
  for (double& value : later) {
    slopes.push_back(random.uniform(-1, 1));
    value += time * slopes.back();
  }
  std::vector<Kinematics::Pose> now, then;
  std::vector<Kinematics::Twist> twists;
  kinematics.poses(state, {}, count, now);
  kinematics.poses(later, {}, count, then);
  kinematics.twists(slopes, now, count, twists);
  const Eigen::Vector3d x(0.1, 0.2, -0.3);
  for (std::size_t i = 0; i < count; ++i)
    EXPECT_LT(((then[i] * x - now[i] * x) / time - twists[i].at(now[i] * x)).norm(), 1e-5) << i;
}

TEST(Kinematics, RefusesWhatIsNoRobot)
{
  const auto refused = [](const auto& change) {
    Robot robot = turntable();
    change(robot);
    return test::refusalOf([&] { Kinematics{robot}; });
  };
  using testing::HasSubstr;
  EXPECT_THAT(refused([](Robot& r) { r.links.clear(); }), HasSubstr("has no link"));
  EXPECT_THAT(refused([](Robot& r) { r.links[1].joint->parent = 1; }), HasSubstr("joint 'turn': has a parent"));
  EXPECT_THAT(refused([](Robot& r) { r.links[1].joint->axis = {0, 0, 2}; }), HasSubstr("not of length 1"));
  EXPECT_THAT(refused([](Robot& r) { r.links[1].joint->origin.linear() *= 2; }), HasSubstr("not rigid"));
  EXPECT_THAT(refused([](Robot& r) { r.links[1].joint->lower = 1, r.links[1].joint->upper = 0; }),
              HasSubstr("lower one come first"));
  EXPECT_THAT(refused([](Robot& r) { r.links[1].joint->kind = Joint::Kind::prismatic; }),
              HasSubstr("slides without limits"));
  EXPECT_THAT(refused([](Robot& r) { r.links[1].joint->mimic = Mimic{"turn"}; }), HasSubstr("mimics itself"));
  EXPECT_THAT(refused([](Robot& r) { r.links[1].joint->mimic = Mimic{"none"}; }), HasSubstr("'none'"));
  EXPECT_THAT(refused([](Robot& r) { r.links[0].shapes = {{Sphere{0.0}}}; }), HasSubstr("link 'base': has a shape"));
  EXPECT_THAT(refused([](Robot& r) { r.links[0].padding = -1; }), HasSubstr("padding"));
  EXPECT_THAT(refused([](Robot& r) { r.links[0].joint = Joint{"loose"}; }), HasSubstr("is the first"));
}

} // namespace
} // namespace pcl_bsh
