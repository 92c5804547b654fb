// SPDX-License-Identifier: BSD-3-Clause
// Attacks on how far the search lets a place go at most (kinematics.h), against kinematics in long double.
// PCL_BSH_ATTACKS in the environment: how many motions. One in a hundred is climbed from, towards the bound.
#include <pcl_bsh/robot/motion_search.h>

#include "made_arms.h"
#include "support/attacks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl_bsh {
namespace {

using namespace robots;
using test::LongVector;

/// Motions of an arm of balls, and how much of what the search allows their centres take.
class WayAttack {
public:
  explicit WayAttack(std::uint64_t seed) : random_(seed), robot_(test::madeArm(random_, 9, true)), world_(robot_, {})
  {
    for (const Link& link : robot_.links)
      for (const Shape& shape : link.shapes) radii_.push_back(std::get<Sphere>(shape.form).radius);
  }

  struct Motion {
    RobotState from, to;
    long double share = 0.0;
  };

  /// Mostly short: there the bound is nearest.
  Motion made()
  {
    Motion motion{test::madeState(random_, robot_), {}};
    const double length = std::pow(10.0, random_.uniform(-5.0, 0.5));
    for (const double value : motion.from) motion.to.push_back(value + random_.uniform(-length, length));
    return measured(std::move(motion), 100);
  }

  Motion nearby(Motion motion)
  {
    const double off = std::pow(10.0, random_.uniform(-4.0, -1.0));
    for (std::size_t i = 0; i < motion.from.size(); ++i) {
      motion.to[i] += off * random_.uniform(-1, 1) * (motion.to[i] - motion.from[i]);
      const double moved = off * random_.uniform(-1, 1);
      motion.from[i] += moved, motion.to[i] += moved;
    }
    return measured(std::move(motion), 100);
  }

  Motion measured(Motion motion, int instants)
  {
    keepLimits(motion.from);
    keepLimits(motion.to);
    const std::vector<SweptBall> balls = world_.sweptBalls(motion.from, motion.to, 1);
    const std::vector<LongVector> middles = centersAt(motion, 0.5L);
    std::vector<std::size_t> order; // of the arm's balls among those
    for (const LongVector& middle : middles) {
      const auto away = [&](const SweptBall& ball) { return (ball.center.cast<long double>() - middle).norm(); };
      const auto nearest =
          std::min_element(balls.begin(), balls.end(), [&](const auto& a, const auto& b) { return away(a) < away(b); });
      order.push_back(static_cast<std::size_t>(nearest - balls.begin()));
    }
    motion.share = 0.0L;
    for (int i = 0; i <= instants; ++i) {
      const std::vector<LongVector> centers = centersAt(motion, i / static_cast<long double>(instants));
      for (std::size_t k = 0; k < centers.size(); ++k) {
        const SweptBall& ball = balls[order[k]];
        const long double allowed = static_cast<long double>(ball.radius) - radii_[k];
        motion.share = std::max(motion.share, (centers[k] - ball.center.cast<long double>()).norm() / allowed);
      }
    }
    return motion;
  }

private:
  /// Centres of the arm's balls at the fraction t of a motion.
  std::vector<LongVector> centersAt(const Motion& motion, long double t) const
  {
    const Kinematics& kinematics = world_.kinematics();
    const std::vector<test::LongPose> poses =
        test::longPoses(kinematics, test::longValues(robot_, motion.from, motion.to, t));
    std::vector<LongVector> centers;
    for (std::size_t link = 0; link < robot_.links.size(); ++link)
      for (const Shape& shape : robot_.links[link].shapes)
        centers.push_back(test::longCenter(poses, kinematics, link, shape));
    return centers;
  }

  void keepLimits(RobotState& state) const
  {
    const std::vector<std::size_t> links = variablesOf(robot_);
    for (std::size_t i = 0; i < links.size(); ++i)
      if (const Joint& joint = *robot_.links[links[i]].joint; joint.kind != Joint::Kind::continuous)
        state[i] = std::clamp(state[i], joint.lower, joint.upper);
  }

  test::Random random_;
  Robot robot_;
  RobotWorld world_;
  std::vector<double> radii_; ///< of the arm's balls
};

TEST(MotionSearch, LetsNoPlaceGoFarther)
{
  const long each = std::max(100L, test::attacks(1000) / 5);
  long double most = 0.0;
  for (const std::uint64_t seed : {131u, 132u, 133u, 134u, 135u}) {
    WayAttack attack(seed);
    std::vector<WayAttack::Motion> motions;
    for (long i = 0; i < each; ++i) {
      motions.push_back(attack.made());
      ASSERT_LE(motions.back().share, 1.0L) << seed << " " << i;
      if (motions.size() < static_cast<std::size_t>(each / 50)) continue;
      std::sort(motions.begin(), motions.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
      motions.resize(static_cast<std::size_t>(each / 100));
    }
    for (WayAttack::Motion motion : motions) {
      for (int step = 0; step < 30; ++step)
        if (const WayAttack::Motion next = attack.nearby(motion); next.share > motion.share) motion = next;
      most = std::max(most, attack.measured(motion, 10'000).share);
      ASSERT_LE(most, 1.0L) << seed;
    }
  }
  EXPECT_GT(most, 0.9999L); // the bound is of the size of what it bounds
}

} // namespace
} // namespace pcl_bsh
