// SPDX-License-Identifier: BSD-3-Clause
// Along a path, points that may be elsewhere than they were measured: against brute force, and at both edges.
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/many_poses/collide_on_motions.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/journeys.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::anyJourney;
using test::Cloud;
using test::everything;
using test::expectSame;
using test::flagsOnly;
using test::identity;
using test::Journey;
using test::Poses;
using test::Random;

Journey uncertainJourney(std::uint64_t seed, int most_points, int most_poses)
{
  Journey run = anyJourney(seed, most_points, most_poses);
  Random random(seed + 2000000);
  const double scale = run.scene.clearance > 0.0 ? run.scene.clearance : 0.01;
  const bool first = random.chance(0.8);
  if (first) test::makeUncertain(run.scene.a, scale, random);
  if (!first || random.chance(0.7)) test::makeUncertain(run.scene.b, scale, random);
  if (random.chance(0.3)) run.scene.clearance *= 2;
  return run;
}

/// Only what the request asks for is to be compared.
TrajectoryResult partOf(TrajectoryResult all, const TrajectoryRequest& request)
{
  if (!request.distances) all.distance.clear();
  if (!request.first_poses) {
    all.first_pose.clear();
    all.certain_pose.clear();
  }
  if (!request.closest_poses) all.closest_pose.clear();
  if (!request.distances && !request.closest_poses) all.closest_point.clear();
  if (!request.pose_summaries) all.poses.clear();
  return all;
}

TEST(UncertainPaths, SameAsBruteForceWhateverIsAsked)
{
  std::size_t flags[3] = {}, later = 0;
  for (std::uint64_t seed = 0; seed < 250; ++seed) {
    const Journey run = uncertainJourney(seed, seed < 230 ? 60 : 300, 12);
    SCOPED_TRACE(run.name);
    const SphereHierarchy scan(run.scene.a.view()), model(run.scene.b.view());
    const Placed placed(scan, run.scene.pose_a);
    const TrajectoryResult truth = brute_force::collideAlong(placed, model, run.poses, everything(run.scene.clearance));
    for (const unsigned threads : {1u, 2u})
      expectSame(collideAlong(placed, model, run.poses, everything(run.scene.clearance, threads)), truth);
    TrajectoryRequest request = flagsOnly(run.scene.clearance);
    expectSame(collideAlong(placed, model, run.poses, request), partOf(truth, request));
    request.first_poses = true;
    expectSame(collideAlong(placed, model, run.poses, request), partOf(truth, request));
    request.distances = true;
    expectSame(collideAlong(placed, model, run.poses, request), partOf(truth, request));
    request.flags = false;
    EXPECT_TRUE(collideAlong(placed, model, run.poses, request).flags.empty());
    if (::testing::Test::HasFailure()) return;
    for (const Verdict flag : truth.flags) ++flags[test::numberOf(flag)];
    for (std::size_t i = 0; i < truth.certain_pose.size(); ++i) later += truth.certain_pose[i] > truth.first_pose[i];
  }
  for (const std::size_t count : flags) EXPECT_GT(count, 500u);
  EXPECT_GT(later, 50u) << "points which collide for certain later than they may";
}

/// Nodes small beside the clearance, which is the reach of one of the pairs, or nearly. The lengths of their own points
/// settle them; these differ by a million, by one, or by none.
TEST(UncertainPaths, WholeNodesByLengthsOfTheirOwn)
{
  std::size_t flags[3] = {};
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed + 3000000);
    const auto cloud = [&random] {
      Cloud made(test::makePoints(random.chance(0.5) ? test::Shape::uniform : test::Shape::plane,
                                  static_cast<std::size_t>(random.integer(20, 80)), random.uniform(0.02, 0.5), random));
      std::vector<float> own(random.chance(0.2) ? 0 : made.view().count);
      const int octaves = random.integer(0, 2);
      for (float& length : own)
        length = static_cast<float>(octaves == 0   ? random.uniform(0, 0.3)
                                    : octaves == 1 ? std::pow(10.0, random.uniform(-6, 0))
                                                   : (random.chance(0.05) ? 0.0 : 0.25));
      made.setUncertainties(random.chance(0.3) ? 0.0625 : 0.0, std::move(own));
      return made;
    };
    const Cloud cloud_a = cloud(), cloud_b = cloud();
    const SphereHierarchy scan(cloud_a.view()), model(cloud_b.view());
    Poses poses;
    for (int k = 0; k < 8; ++k) {
      poses.push_back(random.pose(0.1));
      poses.back().translation().x() += 1.0 + 0.1 * k;
    }
    const auto any = [&random](const Cloud& of) {
      return static_cast<std::uint32_t>(random.integer(0, static_cast<int>(of.view().count) - 1));
    };
    const std::uint32_t i = any(cloud_a), j = any(cloud_b);
    const Point3 p = cloud_a.view().point(i), q = cloud_b.view().point(j);
    const double off = cloud_a.view().uncertainty + cloud_a.view().ownUncertainty(i) + cloud_b.view().uncertainty +
                       cloud_b.view().ownUncertainty(j);
    const double distance = (Eigen::Vector3d(p[0], p[1], p[2]) -
                             poses[static_cast<std::size_t>(random.integer(0, 7))] * Eigen::Vector3d(q[0], q[1], q[2]))
                                .norm();
    const double edge = std::max(0.0, random.chance(0.5) ? distance + off : distance - off);
    for (const double clearance : {edge, std::nextafter(edge, 0.0), std::nextafter(edge, 9.0)}) {
      const TrajectoryRequest request = flagsOnly(clearance);
      const TrajectoryResult found = collideAlong({scan}, model, poses, request);
      expectSame(found, brute_force::collideAlong({scan}, model, poses, request));
      ASSERT_FALSE(::testing::Test::HasFailure());
      for (const Verdict flag : found.flags) ++flags[test::numberOf(flag)];
    }
  }
  for (const std::size_t count : flags) EXPECT_GT(count, 100u);
}

/// Many small steps, which leaves pass on arcs. Lengths differ so much that the nearest pair is often not one that
/// collides. Within a tolerance, what collides has a distance all the same.
TEST(UncertainPaths, OnArcsAsAtEachPose)
{
  std::size_t colliding = 0, undecided = 0, not_nearest = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed + 4000000);
    const auto cloud = [&random](std::size_t count) {
      Cloud made(test::makePoints(random.chance(0.5) ? test::Shape::uniform : test::Shape::plane, count, 1.0, random));
      std::vector<float> own(count);
      for (float& length : own) length = static_cast<float>(random.chance(0.5) ? 0.0 : random.uniform(0.0, 0.2));
      made.setUncertainties(random.chance(0.3) ? 0.01 : 0.0, std::move(own));
      return made;
    };
    const Cloud of_scan = cloud(200), of_model = cloud(120);
    const SphereHierarchy scan(of_scan.view()), model(of_model.view());
    Poses poses;
    const double turn = random.uniform(-0.3, 0.3);
    for (int k = 0; k < 48; ++k) {
      Eigen::Isometry3d pose(Eigen::AngleAxisd(turn * k / 48.0, Eigen::Vector3d::UnitZ()));
      pose.translation() = Eigen::Vector3d(-0.6 + 0.02 * k, 0.1, 0.2);
      poses.push_back(pose);
    }
    const TrajectoryRequest all = everything(random.chance(0.2) ? 0.02 : 0.1);
    const TrajectoryResult truth = brute_force::collideAlong({scan}, model, poses, all);
    expectSame(collideAlong({scan}, model, poses, all), truth);
    for (int asked = 1; asked < 16; ++asked) {
      TrajectoryRequest some = flagsOnly(all.clearance);
      some.distances = (asked & 1) != 0;
      some.first_poses = (asked & 2) != 0;
      some.closest_poses = (asked & 4) != 0;
      some.pose_summaries = (asked & 8) != 0;
      expectSame(collideAlong({scan}, model, poses, some), partOf(truth, some));
      some.accuracy = Accuracy::tolerance(0.05);
      const TrajectoryResult found = collideAlong({scan}, model, poses, some);
      for (std::size_t i = 0; some.distances && i < found.flags.size(); ++i)
        EXPECT_EQ(found.flags[i] == Verdict::free, found.closest_point[i] >= of_model.view().count) << i;
    }
    if (::testing::Test::HasFailure()) return;
    Cloud measured_scan = of_scan, measured_model = of_model;
    for (Cloud* const measured : {&measured_scan, &measured_model}) measured->setUncertainties(0.0, {});
    const TrajectoryResult nearest = brute_force::collideAlong(
        {SphereHierarchy(measured_scan.view())}, SphereHierarchy(measured_model.view()), poses, everything(10.0));
    for (std::size_t i = 0; i < truth.flags.size(); ++i)
      not_nearest += truth.flags[i] != Verdict::free && nearest.distance[i] < truth.distance[i];
    colliding += truth.colliding;
    undecided += truth.undecided;
  }
  EXPECT_GT(colliding, 60u);
  EXPECT_GT(undecided, 300u);
  EXPECT_GT(not_nearest, 50u);
}

TEST(UncertainPaths, BothEdgesToTheLastBit)
{
  std::size_t verdicts[3] = {};
  for (const double clearance : {0.3, 1.0})
    for (const double of_scan : {0.0, 0.1, 1e-30})
      for (const double of_model : {0.2, 0x1p-4})
        for (const float own : {0.0f, 0.1f})
          for (const double sign : {-1.0, 1.0})
            for (int bits = -2; bits <= 2; ++bits) {
              double distance = clearance + sign * (of_scan + of_model + static_cast<double>(own));
              for (int i = 0; i < std::abs(bits); ++i) distance = std::nextafter(distance, bits < 0 ? 0.0 : 10.0);
              Cloud cloud_a({{0, 0, 0}}, {Scalar::float64}), cloud_b({{distance, 0, 0}}, {Scalar::float64});
              cloud_a.setUncertainties(of_scan, {});
              cloud_b.setUncertainties(of_model, {own});
              const SphereHierarchy scan(cloud_a.view()), model(cloud_b.view());
              Poses poses(5, identity);
              for (const int k : {0, 1, 3, 4}) poses[static_cast<std::size_t>(k)].translation().x() = 0.1 + k;
              const TrajectoryResult found = collideAlong({scan}, model, poses, everything(clearance));
              expectSame(found, brute_force::collideAlong({scan}, model, poses, everything(clearance)));
              ASSERT_FALSE(::testing::Test::HasFailure()) << distance;
              ++verdicts[test::numberOf(found.flags[0])];
            }
  for (const std::size_t count : verdicts) EXPECT_GT(count, 30u);
}

/// Lengths whose sums are exact, so that the answers are those of two plain queries, swept ones too.
TEST(UncertainPaths, AreTwoPlainQueries)
{
  std::size_t undecided = 0;
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    Journey run = anyJourney(seed, 80, 6);
    const double clearance = run.scene.clearance > 0.0 ? std::ldexp(1.0, std::ilogb(run.scene.clearance)) : 0.25;
    const SphereHierarchy scan(run.scene.a.view()), model(run.scene.b.view());
    Cloud of_scan = run.scene.a, of_model = run.scene.b;
    of_scan.setUncertainties(clearance / 4, {});
    of_model.setUncertainties(clearance / 8, {});
    const SphereHierarchy uncertain(of_scan.view()), other(of_model.view());
    for (const bool swept : {false, true}) {
      SCOPED_TRACE(run.name + (swept ? ", swept" : ""));
      TrajectoryRequest request;
      request.distances = request.first_poses = request.closest_poses = true;
      if (swept) request.swept = clearance / 8;
      TrajectoryResult possible, certain, found;
      try {
        request.clearance = clearance * 1.375;
        possible = collideAlong({scan, run.scene.pose_a}, model, run.poses, request);
        request.clearance = clearance * 0.625;
        certain = collideAlong({scan, run.scene.pose_a}, model, run.poses, request);
      }
      catch (const InvalidInput&) {
        continue; // coordinates too large for the tolerance, or half a turn
      }
      request.clearance = clearance;
      found = collideAlong({uncertain, run.scene.pose_a}, other, run.poses, request);
      for (std::size_t i = 0; i < found.flags.size(); ++i)
        ASSERT_EQ(found.flags[i], certain.flags[i] != Verdict::free    ? Verdict::colliding
                                  : possible.flags[i] != Verdict::free ? Verdict::undecided
                                                                       : Verdict::free)
            << i;
      EXPECT_EQ(test::bitsOf(found.distance), test::bitsOf(possible.distance));
      EXPECT_EQ(found.first_pose, possible.first_pose);
      EXPECT_EQ(found.closest_point, possible.closest_point);
      EXPECT_EQ(found.certain_pose, certain.first_pose);
      EXPECT_EQ(found.first_contact.has_value(), possible.first_contact.has_value());
      EXPECT_EQ(found.certain_contact.has_value(), certain.first_contact.has_value());
      undecided += found.undecided;
      if (::testing::Test::HasFailure()) return;
    }
  }
  EXPECT_GT(undecided, 200u);
}

/// The motion's answer covers the answer of brute force at each instant.
TEST(UncertainPaths, SweptMotionHoldsAtEveryInstant)
{
  std::size_t flags[3] = {};
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const auto cloud = [&](double scale) {
      Cloud made(test::makePoints(random.pick(test::all_shapes), 60, scale, random));
      std::vector<float> own;
      for (int i = 0; i < 60; ++i) own.push_back(static_cast<float>(0.1 * random.uniform(0, 1)));
      made.setUncertainties(random.chance(0.5) ? 0.02 : 0.0, own);
      return made;
    };
    const Cloud of_scan = cloud(1.0), of_model = cloud(0.3);
    const SphereHierarchy scan(of_scan.view()), model(of_model.view());
    Poses ends(2, identity);
    for (Eigen::Isometry3d& pose : ends)
      for (Eigen::Index axis = 0; axis < 3; ++axis) pose.translation()[axis] = random.uniform(-1, 1);
    ends[1].linear() =
        Eigen::AngleAxisd(random.uniform(0, 1), Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    TrajectoryRequest request = flagsOnly(0.25);
    request.swept = 0.004;
    const TrajectoryResult found = collideAlong({scan}, model, ends, request);
    Poses instants;
    for (int i = 0; i <= 60; ++i) instants.push_back(poseBetween(ends[0], ends[1], i / 60.0));
    const TrajectoryResult at_instants = brute_force::collideAlong({scan}, model, instants, flagsOnly(0.25));
    for (std::size_t i = 0; i < found.flags.size(); ++i) {
      if (at_instants.flags[i] != Verdict::free) {
        ASSERT_NE(found.flags[i], Verdict::free) << seed << ' ' << i << ": may collide at an instant";
      }
      if (at_instants.flags[i] == Verdict::colliding) {
        ASSERT_EQ(found.flags[i], Verdict::colliding) << seed << ' ' << i << ": surely collides at one";
      }
      ++flags[test::numberOf(found.flags[i])];
    }
    // And it claims no more than the tolerance allows, where the instants are dense against it.
    Poses dense;
    for (int i = 0; i <= 2000; ++i) dense.push_back(poseBetween(ends[0], ends[1], i / 2000.0));
    const TrajectoryResult wider = collideAlong({scan}, model, dense, flagsOnly(0.25 + 0.004 + 0.002));
    for (std::size_t i = 0; i < found.flags.size(); ++i) {
      if (found.flags[i] == Verdict::colliding) {
        ASSERT_EQ(wider.flags[i], Verdict::colliding) << seed << ' ' << i;
      }
      if (found.flags[i] == Verdict::undecided) {
        ASSERT_NE(wider.flags[i], Verdict::free) << seed << ' ' << i;
      }
    }
  }
  for (const std::size_t count : flags) EXPECT_GT(count, 100u);
}

TEST(UncertainPaths, LessThanExactClaimsNothingFalse)
{
  std::size_t decided = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Journey run = uncertainJourney(seed, 200, 8);
    const SphereHierarchy scan(run.scene.a.view()), model(run.scene.b.view());
    const Placed placed(scan, run.scene.pose_a);
    TrajectoryRequest request = flagsOnly(run.scene.clearance);
    const TrajectoryResult truth = brute_force::collideAlong(placed, model, run.poses, request);
    for (const Accuracy& accuracy :
         {Accuracy::level(0), Accuracy::level(2), Accuracy::nodePairs(40), Accuracy::nodePairs(4000)}) {
      SCOPED_TRACE(run.name + " at " + accuracy.text());
      request.accuracy = accuracy;
      const TrajectoryResult found = collideAlong(placed, model, run.poses, request);
      std::size_t undecided = 0;
      for (std::size_t i = 0; i < truth.flags.size(); ++i) {
        undecided += found.flags[i] == Verdict::undecided;
        if (found.flags[i] == Verdict::undecided) continue;
        ASSERT_EQ(found.flags[i], truth.flags[i]) << i;
        ++decided;
      }
      EXPECT_EQ(found.undecided, undecided);
    }
  }
  EXPECT_GT(decided, 1000u);
}

TEST(UncertainPaths, ProgressNeverFalls)
{
  const Journey run = uncertainJourney(3, 300, 12);
  const SphereHierarchy scan(run.scene.a.view()), model(run.scene.b.view());
  TrajectoryRequest request = everything(0.5);
  double last = 0.0;
  std::size_t calls = 0;
  request.progress = [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    last = fraction;
    return ++calls < 1000000;
  };
  const Poses poses(30, run.scene.pose_b);
  collideAlong({scan, run.scene.pose_a}, model, poses, request);
  EXPECT_GT(calls, 0u);
  request.progress = [](double) { return false; };
  EXPECT_THROW(collideAlong({scan, run.scene.pose_a}, model, poses, request), Cancelled);
}

} // namespace
} // namespace pcl_bsh
