// SPDX-License-Identifier: BSD-3-Clause
// The motion between poses, watched at many instants: by another implementation of its definition, in long double.
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/journeys.h"
#include "support/verdicts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using test::anyCloud;
using test::Cloud;
using test::flagsOnly;
using test::identity;
using test::Poses;
using test::Random;

using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1>;
using Matrix = Eigen::Matrix<Real, 3, 3>;

Vector vectorOf(const Point3& p)
{
  return {p[0], p[1], p[2]};
}

struct TruePose {
  Matrix linear;
  Vector translation;

  Vector operator*(const Vector& p) const { return linear * p + translation; }
};

TruePose exactly(const Eigen::Isometry3d& pose)
{
  return {pose.linear().cast<Real>(), pose.translation().cast<Real>()};
}

Matrix rotationOf(Matrix m)
{
  for (int i = 0; i < 4; ++i) m = (0.5L * (m + m.inverse().transpose())).eval();
  return m;
}

/// The pivot goes straight, the rotation turns evenly about one axis, what is left of the pose changes linearly.
TruePose between(const TruePose& from, const TruePose& to, Real fraction, const Vector& pivot)
{
  const Matrix first = rotationOf(from.linear), last = rotationOf(to.linear);
  const Eigen::AngleAxis<Real> turn(Matrix(last * first.transpose()));
  const Matrix stretch = (1 - fraction) * (first.transpose() * from.linear) + fraction * (last.transpose() * to.linear);
  TruePose pose;
  pose.linear = Eigen::AngleAxis<Real>(fraction * turn.angle(), turn.axis()).toRotationMatrix() * first * stretch;
  pose.translation = (1 - fraction) * (from * pivot) + fraction * (to * pivot) - pose.linear * pivot;
  return pose;
}

struct Run {
  Cloud a, b;
  Eigen::Isometry3d scan_pose;
  Poses poses;
  Point3 pivot;
  double clearance, tolerance, size; ///< size: of coordinates
  std::string name;
};

struct NamedPoint {
  std::uint32_t record;
  Vector at;
  Real radius;
};

std::vector<NamedPoint> finitePoints(const PointsView& view)
{
  std::vector<NamedPoint> points;
  for (std::size_t i = 0; i < view.size(); ++i) {
    const std::uint32_t record = view.record(i);
    const Point3 p = view.point(record);
    if (std::isfinite(p[0] + p[1] + p[2])) points.push_back({record, vectorOf(p), view.radius(record)});
  }
  return points;
}

/// Distances of the scan's points, at an instant.
class Watched {
public:
  explicit Watched(const Run& run) : run_(run), scan_(finitePoints(run.a.view())), model_(finitePoints(run.b.view()))
  {
    const TruePose pose = exactly(run.scan_pose);
    for (NamedPoint& p : scan_) p.at = pose * p.at;
  }

  TruePose poseAt(double time) const
  {
    const auto k = std::min(static_cast<std::size_t>(time), run_.poses.size() - 1);
    const Real fraction = static_cast<Real>(time) - static_cast<Real>(k);
    if (fraction == 0 || k + 1 == run_.poses.size()) return exactly(run_.poses[k]);
    return between(exactly(run_.poses[k]), exactly(run_.poses[k + 1]), fraction, vectorOf(run_.pivot));
  }

  /// By record; infinity where there is no point. @param moved how far any point of the model moved since the last call
  std::vector<Real> distancesAt(double time, Real* moved = nullptr)
  {
    const TruePose pose = poseAt(time);
    std::vector<Vector> places;
    for (const NamedPoint& q : model_) places.push_back(pose * q.at);
    if (moved) {
      *moved = 0;
      for (std::size_t j = 0; j < before_.size(); ++j) *moved = std::max(*moved, (places[j] - before_[j]).norm());
    }
    std::vector<Real> distances(run_.a.view().count, std::numeric_limits<Real>::infinity());
    for (const NamedPoint& p : scan_)
      for (std::size_t j = 0; j < places.size(); ++j)
        distances[p.record] = std::min(distances[p.record], (p.at - places[j]).norm() - p.radius - model_[j].radius);
    before_ = std::move(places);
    return distances;
  }

private:
  const Run& run_;
  std::vector<NamedPoint> scan_, model_;
  std::vector<Vector> before_;
};

/// @param between_bounds becomes how many points come within the clearance and the tolerance, but not within the
///   clearance: those may be answered either way
/// @return whether it was refused
bool expectTrueAtEachInstant(const Run& run, std::size_t* between_bounds = nullptr)
{
  SCOPED_TRACE(run.name);
  const SphereHierarchy scan(run.a.view()), model(run.b.view());
  const Placed placed{scan, run.scan_pose};
  TrajectoryRequest request = flagsOnly(run.clearance);
  request.distances = request.first_poses = request.closest_poses = true;
  request.swept = run.tolerance;
  request.pivot = run.pivot;
  TrajectoryResult found;
  try {
    found = collideAlong(placed, model, run.poses, request);
  }
  catch (const std::invalid_argument&) {
    return true;
  }
  const std::vector<Verdict> at_poses = collideAlong(placed, model, run.poses, flagsOnly(run.clearance)).flags;
  const Real rounding = 1e-17L * run.size;
  const double end = static_cast<double>(run.poses.size() - 1);
  const double contact = found.first_contact
                             ? static_cast<double>(found.first_contact->pose) + found.first_contact->fraction
                             : std::numeric_limits<double>::infinity();
  std::vector<double> times;
  for (int i = 0; i <= 1000; ++i) times.push_back(end * i / 1000);
  for (std::size_t k = 0; k < run.poses.size(); ++k) times.push_back(static_cast<double>(k));
  std::sort(times.begin(), times.end());
  Watched watched(run);
  std::vector<Real> least(found.flags.size(), std::numeric_limits<Real>::infinity());
  Real step = 0;
  for (const double time : times) {
    Real moved = 0;
    const std::vector<Real> distances = watched.distancesAt(time, &moved);
    step = std::max(step, moved);
    for (std::size_t p = 0; p < distances.size(); ++p) {
      least[p] = std::min(least[p], distances[p]);
      if (distances[p] > run.clearance - rounding) continue;
      EXPECT_EQ(found.flags[p], Verdict::colliding) << "point " << p << " collides at " << time;
      EXPECT_LE(contact, time + 1e-15 * (end + 1.0)) << "point " << p;
      EXPECT_LE(found.first_pose[p], time) << "point " << p;
    }
  }
  if (between_bounds)
    *between_bounds = static_cast<std::size_t>(std::count_if(least.begin(), least.end(), [&](Real distance) {
      return distance > run.clearance && distance <= run.clearance + run.tolerance;
    }));
  for (std::size_t p = 0; p < least.size(); ++p) {
    EXPECT_LE(at_poses[p], found.flags[p]) << "point " << p << " collides at a pose";
    if (found.flags[p] == Verdict::free) continue;
    EXPECT_LE(least[p], run.clearance + run.tolerance + step / 2 + rounding) << "point " << p;
    EXPECT_LE(std::abs(found.distance[p] - least[p]),
              run.tolerance / 2 + step / 2 + 1e-7 * std::abs(least[p]) + rounding);
  }
  EXPECT_EQ(found.first_contact.has_value(), found.colliding > 0);
  if (!found.first_contact) return false;
  const std::vector<Real> there = watched.distancesAt(contact);
  EXPECT_LE(*std::min_element(there.begin(), there.end()), run.clearance + run.tolerance) << "at the first contact";
  return false;
}

Run anyRun(std::uint64_t seed)
{
  Random random(seed);
  const double scale = std::exp2(random.integer(-3, 3));
  const double far = random.chance(0.3) ? 1e5 * scale : 0.0;
  const Point3 center = {far, -far, 0.1 * far};
  Run run{anyCloud(static_cast<std::size_t>(random.integer(1, 12)), scale, {0, 0, 0}, random),
          anyCloud(static_cast<std::size_t>(random.integer(1, 12)), scale, center, random),
          identity,
          {},
          random.chance(0.5) ? center : Point3{0, 0, 0},
          scale * random.uniform(0, 0.5),
          0.0,
          4 * (scale + far),
          "run " + std::to_string(seed)};
  if (random.chance(0.2)) run.clearance = 0.0;
  if (random.chance(0.5)) run.scan_pose = random.pose(scale);
  const bool turning = random.chance(0.8), skewed = random.chance(0.4);
  for (int k = random.integer(1, 4); k >= 0; --k) {
    Eigen::Isometry3d pose = random.pose(2 * scale);
    if (!turning) pose.linear().setIdentity();
    if (skewed) pose.linear() *= 1.0 + 2.8e-7 * random.uniform(-1, 1);
    pose.translate(-Eigen::Vector3d(center[0], center[1], center[2]));
    run.poses.push_back(pose);
    if (random.chance(0.15)) run.poses.push_back(pose);
  }
  run.tolerance = std::max(run.size * 1e-10, scale * std::exp2(random.uniform(-12, 0)));
  return run;
}

TEST(TrajectoryMotion, TrueAtEachInstant)
{
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 250 && !::testing::Test::HasFailure(); ++seed)
    refused += expectTrueAtEachInstant(anyRun(seed)) ? 1 : 0;
  EXPECT_LT(refused, 50);
}

/// A body 8 m long on a bend, with few poses. Points of the wall are picked where its side passes between them, at
/// about the clearance.
Run grazingRun(double bend, double step, double tolerance, std::uint64_t seed)
{
  Random random(seed);
  Poses poses;
  const auto onBend = [bend](double way) {
    Eigen::Isometry3d pose(Eigen::AngleAxisd(way / bend, Eigen::Vector3d::UnitZ()));
    pose.translation() = bend * Eigen::Vector3d(std::sin(way / bend), 1 - std::cos(way / bend), 0);
    return pose;
  };
  constexpr int count = 12;
  for (int k = 0; k < count; ++k) poses.push_back(onBend(step * k));
  constexpr double clearance = 0.05;
  std::vector<Point3> body, wall;
  for (int i = 0; i < 120; ++i) body.push_back({random.uniform(-4, 4), random.uniform(-0.006, 0.006), -0.02 * (i % 9)});
  for (int i = 0; i < 90; ++i) {
    const double gap = clearance + tolerance * random.uniform(-1, 2);
    const Eigen::Vector3d at = onBend(random.uniform(0, step * (count - 1))) *
                               Eigen::Vector3d{random.uniform(-4, 4), gap, random.uniform(-0.2, 0.1)};
    wall.push_back({at.x(), at.y(), at.z()});
  }
  return {Cloud(wall), Cloud(body),        identity,
          poses,       {0, 0, 0},          clearance,
          tolerance,   4 * (2 * bend + 8), "bend " + std::to_string(bend)};
}

/// Which points between clearance and clearance + tolerance are flagged depends on boxes and leaves. None beyond is,
/// and all within the clearance are.
TEST(TrajectoryMotion, TrueWhereSurfacesGraze)
{
  std::uint64_t seed = 0;
  for (const auto& [bend, step] :
       {std::pair(180.0, 0.05), std::pair(180.0, 1.0), std::pair(20.0, 0.3), std::pair(3.0, 0.3)})
    for (const double tolerance : {0.01, 0.05}) {
      std::size_t between_bounds = 0;
      EXPECT_FALSE(expectTrueAtEachInstant(grazingRun(bend, step, tolerance, ++seed), &between_bounds));
      EXPECT_GT(between_bounds, 3u) << "bend " << bend << ", tolerance " << tolerance;
    }
}

/// Floats do not hold the squares of the smallest lengths, nor, in the unit of the clouds, the largest: all pairs are
/// compared there.
TEST(TrajectoryMotion, IsTheSameAtAnyScale)
{
  const auto at = [](double scale) {
    Random random(5);
    const auto uniform = [&](std::size_t count, double reach) {
      std::vector<Point3> points;
      for (std::size_t i = 0; i < count; ++i)
        points.push_back(random.point([&] { return random.uniform(-1, 1) * reach; }));
      return Cloud(points, {Scalar::float64, 0, 0});
    };
    const Cloud wall = uniform(300, scale), body = uniform(60, 0.25 * scale);
    Poses poses;
    for (int k = 0; k < 6; ++k) poses.push_back(Eigen::Isometry3d(Eigen::Translation3d(0.4 * (k - 3) * scale, 0, 0)));
    TrajectoryRequest request;
    request.clearance = 0.05 * scale;
    request.swept = 0.01 * scale;
    request.first_poses = request.closest_poses = request.distances = true;
    const SphereHierarchy scan(wall.view()), model(body.view());
    return collideAlong({scan}, model, poses, request);
  };
  const TrajectoryResult one = at(1.0);
  EXPECT_GT(one.colliding, 5u);
  EXPECT_LT(one.colliding, 200u);
  for (const double scale : {0x1p-70, 0x1p-60, 0x1p-45, 0x1p40, 0x1p60, 0x1p90}) {
    SCOPED_TRACE(scale);
    const TrajectoryResult scaled = at(scale);
    EXPECT_EQ(scaled.flags, one.flags);
    EXPECT_EQ(scaled.first_pose, one.first_pose);
    EXPECT_EQ(scaled.closest_point, one.closest_point);
    EXPECT_NEAR(scaled.first_contact->fraction, one.first_contact->fraction, 1e-9);
  }
}

/// A model point at (1, 0, 0), under a pose that shrinks by 2.8e-7, which is accepted.
TEST(TrajectoryMotion, IncludesGivenPosesExactlyAsGiven)
{
  const Cloud model_cloud({{1, 0, 0}});
  const SphereHierarchy model(model_cloud.view());
  Eigen::Isometry3d shrunk = identity, away = identity, turned = identity;
  shrunk.linear() *= 1.0 - 2.8e-7;
  away.translation().x() = 10;
  turned.linear() = Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Cloud scan_cloud({{1.0 - 2.8e-7, 0, 0}}, {Scalar::float64, 0, 0});
  const SphereHierarchy scan(scan_cloud.view());
  TrajectoryRequest request = flagsOnly(1e-10);
  for (const Poses& poses : {Poses{shrunk}, Poses{shrunk, away}, Poses{away, shrunk}, Poses{away, shrunk, away},
                             Poses{turned, shrunk, turned}, Poses{shrunk, shrunk}}) {
    request.swept.reset();
    EXPECT_EQ(collideAlong({scan}, model, poses, request).colliding, 1u);
    request.swept = 1e-9;
    const TrajectoryResult swept = collideAlong({scan}, model, poses, request);
    EXPECT_EQ(swept.colliding, 1u);
    EXPECT_TRUE(swept.first_contact);
  }
  // Nor is anything there that is not: the same poses, a point where rigid ones would have the model's.
  const Cloud beyond_cloud({{1.0, 0, 0}});
  const SphereHierarchy beyond(beyond_cloud.view());
  EXPECT_EQ(collideAlong({beyond}, model, {shrunk}, request).colliding, 0u);
}

TEST(TrajectoryMotion, BeginsAndEndsAtThePosesGiven)
{
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    Eigen::Isometry3d from = random.pose(10), to = random.pose(10);
    from.linear() *= 1.0 + 2e-7 * random.uniform(-1, 1);
    const Point3 pivot = random.point([&] { return random.uniform(-5, 5); });
    EXPECT_EQ(poseBetween(from, to, 0, pivot).matrix(), from.matrix());
    EXPECT_EQ(poseBetween(from, to, 1, pivot).matrix(), to.matrix());
    const double fraction = random.uniform(0, 1);
    const TruePose truth = between(exactly(from), exactly(to), fraction, vectorOf(pivot));
    const Eigen::Isometry3d found = poseBetween(from, to, fraction, pivot);
    EXPECT_LT((found.linear().cast<Real>() - truth.linear).norm(), 1e-14L);
    EXPECT_LT((found.translation().cast<Real>() - truth.translation).norm(), 1e-13L);
  }
}

std::string refusalOf(const Poses& poses)
{
  const Cloud cloud({{1, 0, 0}});
  const SphereHierarchy scan(cloud.view());
  TrajectoryRequest request = flagsOnly(0.1);
  request.swept = 0.01;
  try {
    collideAlong({scan}, scan, poses, request);
  }
  catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing";
}

/// Up to half a turn the shorter way round; of half a turn both are as short.
TEST(TrajectoryMotion, TurnsTheShorterWayOrRefuses)
{
  const auto turned = [](double angle) {
    Eigen::Isometry3d pose = identity;
    pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return pose;
  };
  const Cloud model_cloud({{1, 0, 0}}), scan_cloud({{0, 1, 0}, {0, -1, 0}});
  const SphereHierarchy scan(scan_cloud.view()), model(model_cloud.view());
  TrajectoryRequest request = flagsOnly(0.1);
  request.swept = 0.01;
  for (const double less : {1e-9, 1e-3, 0.5}) { // than half a turn: by y; more than half a turn: by -y
    EXPECT_EQ(collideAlong({scan}, model, {identity, turned(M_PI - less)}, request).flags, test::verdictsOf({1, 0}));
    EXPECT_EQ(collideAlong({scan}, model, {identity, turned(M_PI + less)}, request).flags, test::verdictsOf({0, 1}));
    EXPECT_THAT(collideAlong({scan}, model, {identity, turned(2 * M_PI - less)}, request).flags.size(), 2u);
  }
  EXPECT_EQ(collideAlong({scan}, model, {identity, turned(2 * M_PI)}, request).flags, test::verdictsOf({0, 0}));
  Eigen::Isometry3d half = identity;
  half.linear().diagonal() = Eigen::Vector3d(-1, -1, 1);
  for (const Poses& poses : {Poses{identity, half}, Poses{half, identity}, Poses{identity, turned(M_PI)}}) {
    EXPECT_THAT(refusalOf(poses),
                testing::AllOf(testing::HasSubstr("from pose 0 to the next the model turns by half a turn"),
                               testing::HasSubstr("give a pose between them")));
    EXPECT_THROW(poseBetween(poses[0], poses[1], 0.5), std::invalid_argument);
    EXPECT_EQ(poseBetween(poses[0], poses[1], 0.0).matrix(), poses[0].matrix());
    EXPECT_EQ(poseBetween(poses[0], poses[1], 1.0).matrix(), poses[1].matrix());
  }
  EXPECT_EQ(refusalOf({identity, turned(M_PI / 2), half}), "nothing");
}

} // namespace
} // namespace pcl_bsh
