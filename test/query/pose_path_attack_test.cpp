// SPDX-License-Identifier: BSD-3-Clause
// Climbs towards the largest stray of a point from the straight line that an interval of poses takes its way for. In
// double arithmetic, whose errors are far below the parts of the bounds that are judged.
#include <pcl_bsh/query/pose_path.h>
#include <pcl_bsh/query/trajectory.h>

#include "../geometry/climb.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace pcl_bsh {
namespace {

using Eigen::Vector3d;
using test::Random;
using Numbers = std::vector<double>;

void report(const std::string& what, double fraction)
{
  testing::Test::RecordProperty(what, std::to_string(fraction));
  std::printf("  %s: %.4f of the bound\n", what.c_str(), fraction);
  EXPECT_LE(fraction, 1.0) << what;
}

Eigen::Isometry3d poseOf(const Numbers& n, std::size_t from)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const Vector3d turn(n[from], n[from + 1], n[from + 2]);
  const double angle = std::min(turn.norm(), 3.0);
  if (angle > 0.0) pose.rotate(Eigen::AngleAxisd(angle, turn.normalized()));
  pose.pretranslate(Vector3d(n[from + 3], n[from + 4], n[from + 5]));
  return pose;
}

bool isSane(const Numbers& n)
{
  for (const double x : n)
    if (!(std::abs(x) < 100.0)) return false;
  return true;
}

Vector3d vectorOf(const Point3& p)
{
  return {p[0], p[1], p[2]};
}

double strayAllowed(const PathInterval& interval, const Point3& place)
{
  return interval.drift + interval.turn * (vectorOf(place) - vectorOf(interval.pivot)).norm();
}

/// Three poses and a place, of 21 numbers. For a difference of rotations the bound takes the Frobenius norm, the root
/// of two times what it does to any place: what reaches the bound is the drift.
double intervalFraction(const Numbers& n)
{
  if (!isSane(n)) return 0.0;
  const PosePath path(Eigen::Isometry3d::Identity(), {poseOf(n, 0), poseOf(n, 6), poseOf(n, 12)}, {0, 0, 0});
  if (path.poses.size() != 3) return 0.0;
  const Point3 place = {n[18], n[19], n[20]};
  const Vector3d from = vectorOf(path.poses[0].see(place)), to = vectorOf(path.poses[2].see(place));
  const double stray = (vectorOf(path.poses[1].see(place)) - 0.5 * (from + to)).norm();
  return stray > 1e-6 ? stray / strayAllowed(path.intervals[0], place) : 0.0;
}

TEST(PosePathAttack, IntervalsOfPoses)
{
  Random random(201);
  const auto start = [&random] {
    Numbers n(21);
    for (double& x : n) x = random.uniform(-1, 1);
    return n;
  };
  const double reached = test::climbFromMany(start, intervalFraction, 40, 400, random);
  report("intervals of poses", reached);
  EXPECT_GE(reached, 0.9);
}

/// Two poses, and a place, of 15 numbers: within a cut of the motion, and over all of it.
double bowFraction(const Numbers& n, bool whole)
{
  if (!isSane(n)) return 0.0;
  const Eigen::Isometry3d from = poseOf(n, 0), to = poseOf(n, 6);
  const Point3 place = {n[12], n[13], n[14]};
  const PosePath path(Eigen::Isometry3d::Identity(), {from, to}, {0, 0, 0}, {{0, 0, 0}, 2.0, 1.0, whole ? 0.5 : 0.05});
  const std::size_t last = path.poses.size() - 1;
  if (last == 0) return 0.0;
  double most = 0.0;
  for (const PathInterval& interval : path.intervals) {
    if (interval.first == interval.last || interval.divided() != whole) continue;
    const PathPose &begin = path.poses[interval.first], &end = path.poses[interval.last];
    const Vector3d first = vectorOf(begin.see(place)), second = vectorOf(end.see(place));
    for (const double t : {0.25, 0.5, 0.75}) {
      const double end_fraction = interval.last == last ? 1.0 : end.fraction;
      const Eigen::Isometry3d pose = poseBetween(from, to, (1 - t) * begin.fraction + t * end_fraction);
      const Vector3d seen = pose.linear().transpose() * (vectorOf(place) - pose.translation());
      const double stray = (seen - ((1 - t) * first + t * second)).norm();
      if (stray > 1e-6) most = std::max(most, stray / strayAllowed(interval, place));
    }
  }
  return most;
}

TEST(PosePathAttack, BowOfAMotion)
{
  Random random(202);
  const auto start = [&random] {
    Numbers n(15);
    for (double& x : n) x = random.uniform(-1, 1);
    return n;
  };
  const double cut = test::climbFromMany(
      start, [](const Numbers& n) { return bowFraction(n, false); }, 20, 200, random);
  report("bow of a cut", cut);
  EXPECT_GE(cut, 0.9);
  const double whole = test::climbFromMany(
      start, [](const Numbers& n) { return bowFraction(n, true); }, 20, 200, random);
  report("bow of a motion", whole);
  EXPECT_GE(whole, 0.9);
}

} // namespace
} // namespace pcl_bsh
