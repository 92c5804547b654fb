// SPDX-License-Identifier: BSD-3-Clause
// A trajectory query's answer to one question does not depend on its other questions.
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
using test::bitsOf;
using test::Cloud;
using test::everything;
using test::identity;
using test::Journey;
using test::Poses;
using test::Random;

constexpr bool TrajectoryRequest::*outputs[] = {&TrajectoryRequest::flags, &TrajectoryRequest::distances,
                                                &TrajectoryRequest::first_poses, &TrajectoryRequest::closest_poses,
                                                &TrajectoryRequest::pose_summaries};

/// @param bits of the outputs asked for
TrajectoryRequest askingFor(unsigned bits, double clearance)
{
  TrajectoryRequest request;
  request.clearance = clearance;
  for (unsigned i = 0; i < std::size(outputs); ++i) request.*outputs[i] = (bits >> i & 1) != 0;
  constexpr unsigned threads[] = {1, 2, 4};
  request.threads = threads[bits % 3];
  return request;
}

template <class Value>
void expectIfAsked(bool asked, const std::vector<Value>& found, const std::vector<Value>& all)
{
  EXPECT_EQ(found, asked ? all : std::vector<Value>());
}

/// @param all what is answered when everything is asked for, or by brute force
void expectPartOf(const TrajectoryRequest& request, const TrajectoryResult& found, const TrajectoryResult& all)
{
  expectIfAsked(request.flags, found.flags, all.flags);
  expectIfAsked(request.distances, bitsOf(found.distance), bitsOf(all.distance));
  expectIfAsked(request.first_poses, found.first_pose, all.first_pose);
  expectIfAsked(request.closest_poses, found.closest_pose, all.closest_pose);
  expectIfAsked(request.distances || request.closest_poses, found.closest_point, all.closest_point);
  EXPECT_EQ(found.colliding, all.colliding);
  EXPECT_EQ(found.undecided, 0u);
  ASSERT_EQ(found.poses.size(), request.pose_summaries ? all.poses.size() : 0u);
  for (std::size_t k = 0; k < found.poses.size(); ++k) {
    EXPECT_EQ(found.poses[k].colliding, all.poses[k].colliding) << k;
    EXPECT_EQ(found.poses[k].colliding_points, all.poses[k].colliding_points) << k;
    EXPECT_EQ(found.poses[k].distance, all.poses[k].distance) << k;
  }
}

void expectAllCombinations(const Journey& run)
{
  const SphereHierarchy scan(run.scene.a.view()), model(run.scene.b.view());
  const Placed placed{scan, run.scene.pose_a};
  const double clearance = run.scene.clearance;
  const TrajectoryResult truth = brute_force::collideAlong(placed, model, run.poses, everything(clearance));
  for (unsigned bits = 1; bits < 32; ++bits) {
    SCOPED_TRACE(run.name + ", outputs " + std::to_string(bits));
    const TrajectoryRequest request = askingFor(bits, clearance);
    const TrajectoryResult found = collideAlong(placed, model, run.poses, request);
    expectPartOf(request, found, truth);
    if (bits == 5 || bits == 27)
      expectPartOf(request, brute_force::collideAlong(placed, model, run.poses, request), truth);
    EXPECT_FALSE(found.first_contact);
    if (::testing::Test::HasFailure()) return;
  }
}

void expectAllSweptCombinations(const Journey& run, double tolerance)
{
  const SphereHierarchy scan(run.scene.a.view()), model(run.scene.b.view());
  const Placed placed{scan, run.scene.pose_a};
  TrajectoryRequest request = askingFor(15, run.scene.clearance);
  request.swept = tolerance;
  const TrajectoryResult all = collideAlong(placed, model, run.poses, request);
  for (unsigned bits = 0; bits < 15; ++bits) {
    SCOPED_TRACE(run.name + ", swept, outputs " + std::to_string(bits));
    request = askingFor(bits, run.scene.clearance);
    request.swept = tolerance;
    const TrajectoryResult found = collideAlong(placed, model, run.poses, request);
    expectPartOf(request, found, all);
    ASSERT_EQ(found.first_contact.has_value(), all.first_contact.has_value());
    EXPECT_EQ(found.first_contact.has_value(), all.colliding > 0);
    if (found.first_contact) {
      EXPECT_EQ(found.first_contact->pose, all.first_contact->pose);
      EXPECT_EQ(found.first_contact->fraction, all.first_contact->fraction);
    }
    if (::testing::Test::HasFailure()) return;
  }
}

/// A few points past clusters of a model, far ones and near ones, at a clearance that reaches to several: each point
/// touches now this cluster, now that.
Journey clusteredJourney(std::uint64_t seed)
{
  Random random(seed);
  const auto spread = [&](double reach) { return random.point([&] { return random.uniform(-reach, reach); }); };
  std::vector<Point3> scan, model;
  for (int i = random.integer(1, 20); i > 0; --i) scan.push_back(spread(random.chance(0.5) ? 0.05 : 0.5));
  for (int cluster = random.integer(2, 5); cluster > 0; --cluster) {
    const Point3 center = spread(1.5);
    for (int i = random.integer(1, 40); i > 0; --i) {
      const Point3 away = spread(0.05);
      model.push_back({center[0] + away[0], center[1] + away[1], center[2] + away[2]});
    }
  }
  const Point3 amplitude = spread(1.5), frequency = spread(3.0), phase = spread(3.0), turn = spread(0.5);
  const int count = random.integer(1, 40);
  Poses poses;
  for (int k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) / std::max(1, count - 1);
    Eigen::Isometry3d pose = identity;
    for (std::size_t axis = 0; axis < 3; ++axis)
      pose.translation()[static_cast<Eigen::Index>(axis)] =
          amplitude[axis] * std::sin(frequency[axis] * t + phase[axis]);
    if (random.chance(0.7))
      pose.linear() =
          Eigen::AngleAxisd(turn[0] * t, Eigen::Vector3d(turn[0], turn[1], turn[2]).normalized()).toRotationMatrix();
    poses.push_back(pose);
    if (random.chance(0.1)) poses.push_back(pose);
  }
  if (random.chance(0.3)) std::reverse(poses.begin(), poses.end());
  Cloud a(scan, {seed % 2 == 0 ? Scalar::float32 : Scalar::float64, 0, 0}), b(model);
  if (random.chance(0.2)) a.setRadii(std::vector<float>(scan.size(), 0.125f));
  if (random.chance(0.2)) {
    std::vector<std::int32_t> some;
    for (std::size_t i = 0; i < model.size(); i += 2) some.push_back(static_cast<std::int32_t>(i));
    b.restrictTo(some);
  }
  const double clearance = random.chance(0.3) ? tiedClearance(a.view(), identity, b.view(), poses.front(), random)
                                              : random.uniform(0.0, 1.5);
  return {{std::move(a), std::move(b), identity, identity, clearance, ""},
          std::move(poses),
          "clusters " + std::to_string(seed)};
}

TEST(TrajectoryCombinations, AnswerAlikeOnAnyJourney)
{
  for (std::uint64_t seed = 8000; seed < 8150 && !::testing::Test::HasFailure(); ++seed)
    expectAllCombinations(anyJourney(seed, 40, 20));
}

TEST(TrajectoryCombinations, AnswerAlikePastClusters)
{
  for (std::uint64_t seed = 0; seed < 400 && !::testing::Test::HasFailure(); ++seed)
    expectAllCombinations(clusteredJourney(seed));
}

TEST(TrajectoryCombinations, AnswerAlikeWhenSwept)
{
  for (std::uint64_t seed = 0; seed < 200 && !::testing::Test::HasFailure(); ++seed)
    expectAllSweptCombinations(clusteredJourney(seed), seed % 2 == 0 ? 0.01 : 0.1);
}

/// A point at 0, a model whose first cluster touches it at once, and whose second comes nearer later.
Journey farFirstNearLater()
{
  std::vector<Point3> model;
  for (int i = 0; i < 40; ++i) model.push_back({0.001 * i, 0.9, 0});
  for (int i = 0; i < 40; ++i) model.push_back({-2 + 0.001 * i, -0.1, 0});
  Poses poses(2, identity);
  poses[1].translation().x() = 2.0;
  return {{Cloud({{0, 0, 0}}), Cloud(model), identity, identity, 1.0, ""}, poses, "far first, near later"};
}

TEST(TrajectoryCombinations, AnEarlierFartherContactIsTheFirst)
{
  const Journey run = farFirstNearLater();
  expectAllCombinations(run);
  expectAllSweptCombinations(run, 1e-3);
  const SphereHierarchy scan(run.scene.a.view()), model(run.scene.b.view());
  TrajectoryRequest request = askingFor(7, 1.0);
  EXPECT_EQ(collideAlong({scan}, model, run.poses, request).first_pose[0], 0);
  request.swept = 1e-3;
  const TrajectoryResult swept = collideAlong({scan}, model, run.poses, request);
  EXPECT_EQ(swept.first_pose[0], 0);
  ASSERT_TRUE(swept.first_contact);
  EXPECT_EQ(swept.first_contact->pose, 0u);
  EXPECT_EQ(swept.first_contact->fraction, 0.0);
}

TEST(TrajectoryCombinations, OfEqualDistancesTheFirstPoseAndTheFirstPoint)
{
  // Eighths throughout: distances are equal to the last bit, and some are the clearance.
  std::vector<Point3> scan, model;
  for (int i = 0; i < 9; ++i) scan.push_back({0.125 * i, 0, 0});
  for (int i = 0; i < 40; ++i) model.push_back({0.125 * (i % 5), 0.5 * (i % 2 == 0 ? 1 : -1), 0.125 * (i % 3)});
  Poses poses;
  for (int k = 0; k < 33; ++k) { // there and back, resting at both ends
    poses.push_back(identity);
    poses.back().translation().x() = 0.125 * (k < 16 ? std::min(k, 12) : std::min(32 - k, 12));
  }
  for (const double clearance : {0.5, std::nextafter(0.5, 0.0), std::nextafter(0.5, 1.0), 0.625, 1.0})
    for (const bool reversed : {false, true}) {
      if (reversed) std::reverse(poses.begin(), poses.end());
      expectAllCombinations({{Cloud(scan), Cloud(model), identity, identity, clearance, ""},
                             poses,
                             "eighths, clearance " + std::to_string(clearance)});
    }
}

TEST(TrajectoryCombinations, AnyPoseAloneOrRepeated)
{
  for (std::uint64_t seed = 100; seed < 130 && !::testing::Test::HasFailure(); ++seed) {
    Journey run = clusteredJourney(seed);
    const Poses poses = run.poses;
    run.poses = {poses.front()};
    expectAllCombinations(run);
    expectAllSweptCombinations(run, 0.01);
    run.poses.assign(5, poses.back());
    expectAllCombinations(run);
    expectAllSweptCombinations(run, 0.01);
    run.poses.clear();
    for (const Eigen::Isometry3d& pose : poses) run.poses.insert(run.poses.end(), 3, pose);
    run.poses.insert(run.poses.end(), poses.begin(), poses.end());
    expectAllCombinations(run);
    expectAllSweptCombinations(run, 0.01);
  }
}

/// With a tolerance, contacts beyond the clearance may count for one question and not for another; what is asked keeps
/// its promise whatever else is.
TEST(TrajectoryCombinations, KeepTheirPromiseWithinATolerance)
{
  for (std::uint64_t seed = 200; seed < 260; ++seed) {
    const Journey run = clusteredJourney(seed);
    const SphereHierarchy scan(run.scene.a.view()), model(run.scene.b.view());
    const Placed placed{scan, run.scene.pose_a};
    const double clearance = run.scene.clearance, tolerance = 0.05;
    const TrajectoryResult least = brute_force::collideAlong(placed, model, run.poses, everything(clearance));
    const TrajectoryResult most =
        brute_force::collideAlong(placed, model, run.poses, everything(clearance + tolerance));
    for (unsigned bits = 1; bits < 32; ++bits) {
      SCOPED_TRACE(run.name + ", outputs " + std::to_string(bits));
      TrajectoryRequest request = askingFor(bits, clearance);
      request.accuracy = Accuracy::tolerance(tolerance);
      const TrajectoryResult found = collideAlong(placed, model, run.poses, request);
      ASSERT_GE(found.colliding, least.colliding);
      ASSERT_LE(found.colliding, most.colliding);
      for (std::size_t i = 0; i < least.flags.size(); ++i) {
        if (request.flags) {
          ASSERT_LE(least.flags[i], found.flags[i]);
          ASSERT_LE(found.flags[i], most.flags[i]);
        }
        if (request.first_poses && least.flags[i] != Verdict::free) {
          ASSERT_LE(most.first_pose[i], found.first_pose[i]);
          ASSERT_LE(found.first_pose[i], least.first_pose[i]);
        }
        if (least.flags[i] == Verdict::free) continue;
        if (request.distances) {
          ASSERT_EQ(found.distance[i], least.distance[i]);
        }
        if (request.closest_poses) {
          ASSERT_EQ(found.closest_pose[i], least.closest_pose[i]);
        }
      }
    }
  }
}

} // namespace
} // namespace pcl_bsh
