// SPDX-License-Identifier: BSD-3-Clause
// Attacks on the error bounds: pairs as near to the limit as the bounds claim to know, of all magnitudes, against exact
// arithmetic. PCL_BSH_ATTACKS in the environment: how many pairs per test.
#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/geometry/given_sphere.h>
#include <pcl_bsh/geometry/relative_frame.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/geometry/sphere_radius.h>
#include <pcl_bsh/hierarchy/storage.h>

#include "support/attacks.h"
#include "support/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace pcl_bsh {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using test::Random;
using Floats = std::array<float, 3>;

const Isometry3d identity = Isometry3d::Identity();
const long kAttacks = test::attacks(200'000);

Vector3d vectorOf(const Point3& p)
{
  return {p[0], p[1], p[2]};
}

Point3 pointOf(const Vector3d& v)
{
  return {v[0], v[1], v[2]};
}

/// Points in one voxel: as given, and as stored.
struct Cluster {
  std::vector<Point3> given;
  std::vector<Floats> stored;
  LocalFrame frame;

  Cluster(std::vector<Point3> points, bool floats) : given(std::move(points))
  {
    if (floats)
      for (Point3& p : given)
        for (double& x : p) x = roundToFloat(x);
    Point3 low = given[0], high = given[0];
    for (const Point3& p : given)
      for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
    frame = frameBetween(low, high, floats);
    for (const Point3& p : given) {
      Floats x;
      for (std::size_t k = 0; k < 3; ++k)
        x[k] = frame.unit == 1.0 ? roundToFloat(p[k] - frame.origin[k])
                                 : roundToFloat(p[k] * (1.0 / frame.unit) - frame.origin[k] * (1.0 / frame.unit));
      stored.push_back(x);
    }
  }
};

Isometry3d nearlyRigid(const Isometry3d& pose, Random& random)
{
  Isometry3d spoiled = pose;
  for (int k = 0; k < 9; ++k) spoiled.linear()(k / 3, k % 3) += 1.5e-7 * random.uniform(-1, 1);
  return spoiled;
}

/// Two voxels that face each other: of any size and place, under poses of any kind.
struct VoxelPair {
  Isometry3d pose_a = identity, pose_b = identity;
  Cluster a, b;
  RelativeFrame frame;
  ExactDistance distance;

  explicit VoxelPair(Random& random) : VoxelPair(Setup(random), random) {}

private:
  struct Setup {
    double scale, other_scale, far, apart;
    Isometry3d pose_a = identity, pose_b = identity;
    bool floats;

    explicit Setup(Random& random)
    {
      constexpr int extremes[] = {-140, -120, -60, 50, 70, 100};
      const int exponent = random.chance(0.15) ? random.pick(extremes) : random.integer(-20, 12);
      scale = std::ldexp(random.uniform(1, 2), exponent);
      other_scale = scale * std::ldexp(1.0, random.integer(-12, 3));
      constexpr double reaches[] = {0, 1, 1e3, 1e7};
      far = random.pick(reaches) * (exponent < -30 || exponent > 30 ? scale : 1.0);
      constexpr double distances[] = {0, 1e-3, 1, 30};
      apart = random.pick(distances) * scale;
      floats = random.chance(0.5) && exponent < 90;
      const int kind = random.integer(0, 4);
      if (kind == 1) pose_a.translation() = Vector3d(far, -far / 3, far / 7), pose_b = pose_a;
      if (kind >= 2) pose_a = random.pose(far), pose_b = random.pose(far);
      if (kind == 4) pose_a = nearlyRigid(pose_a, random), pose_b = nearlyRigid(pose_b, random);
    }
  };

  static std::vector<Point3> pointsAround(const Vector3d& center, double scale, Random& random)
  {
    std::vector<Point3> points;
    for (int i = 0; i < 16; ++i) {
      const bool corner = random.chance(0.3); // where local coordinates, and with them the errors, are largest
      points.push_back(
          random.point([&] { return corner ? scale * (random.chance(0.5) ? 1 : -1) : scale * random.uniform(-1, 1); }));
      for (std::size_t k = 0; k < 3; ++k) points.back()[k] += center[static_cast<Eigen::Index>(k)];
    }
    return points;
  }

  VoxelPair(const Setup& setup, Random& random)
  : VoxelPair(setup, random, Vector3d(setup.far, -0.7 * setup.far, 0.1 * setup.far))
  {
  }

  VoxelPair(const Setup& setup, Random& random, const Vector3d& center)
  : pose_a(setup.pose_a),
    pose_b(setup.pose_b),
    a(pointsAround(center, setup.scale, random), setup.floats),
    b(pointsAround(pose_b.matrix().topLeftCorner<3, 3>().transpose() *
                       (pose_a * center + random.rotation() * Vector3d(setup.apart, 0, 0) - pose_b.translation()),
                   setup.other_scale, random),
      setup.floats),
    frame(a.frame, pose_a, b.frame, pose_b),
    distance(pose_a, pose_b)
  {
  }
};

/// Squared distance of y = M x + g to another point, as the kernels compute it; `fused`: with contracted sums instead,
/// which the bounds allow as well.
float squaredDistance(const RelativeFrame& f, const Floats& x, const Floats& to, bool fused)
{
  Floats d;
  for (std::size_t i = 0; i < 3; ++i) {
    const float* m = f.m.data() + 3 * i;
    const float y = fused ? std::fma(m[2], x[2], std::fma(m[1], x[1], std::fma(m[0], x[0], f.g[i])))
                          : ((f.g[i] + m[0] * x[0]) + m[1] * x[1]) + m[2] * x[2];
    d[i] = y - to[i];
  }
  return fused ? std::fma(d[2], d[2], std::fma(d[1], d[1], d[0] * d[0])) : (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2];
}

/// A clearance that the distance meets, or misses by about the error.
double clearanceNear(double distance, double error, Random& random)
{
  const double shift = random.chance(0.1) ? 0.0 : error * random.uniform(-2, 2);
  return std::max(0.0, distance + shift);
}

TEST(ErrorBounds, PairsNearTheClearance)
{
  Random random(24);
  long wrong = 0, hits = 0, misses = 0, undecided = 0;
  for (long n = 0; n < kAttacks;) {
    const VoxelPair m(random);
    for (int k = 0; k < 64; ++k, ++n) {
      const auto i = static_cast<std::size_t>(random.integer(0, 15)),
                 j = static_cast<std::size_t>(random.integer(0, 15));
      const double length = (m.pose_a * vectorOf(m.a.given[i]) - m.pose_b * vectorOf(m.b.given[j])).norm();
      const double clearance = clearanceNear(length, m.frame.error * m.b.frame.unit, random);
      if (!std::isfinite(clearance)) continue;
      const DistanceBand band = m.frame.band(clearance);
      const float squared = squaredDistance(m.frame, m.a.stored[i], m.b.stored[j], random.chance(0.5));
      const bool hit = squared <= band.hit, miss = squared > band.miss;
      hits += hit, misses += miss, undecided += !hit && !miss;
      if (!hit && !miss) continue;
      wrong += hit != (m.distance.compare(m.a.given[i], m.b.given[j], clearance) <= 0);
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(hits, kAttacks / 10);
  EXPECT_GT(misses, kAttacks / 20);
  EXPECT_GT(undecided, kAttacks / 20);
  RecordProperty("decided", std::to_string(hits + misses));
}

/// A point of a sphere in direction `way`, in the frame's cloud: as far out as the radius allows. None, where the
/// sphere is too small for doubles this far from the origin.
std::optional<Point3> outermost(const LocalFrame& frame, const Floats& center, float radius, const Vector3d& way)
{
  const Vector3d origin(frame.origin[0], frame.origin[1], frame.origin[2]);
  const Vector3d local = Vector3d(center[0], center[1], center[2]) * frame.unit;
  const double length = static_cast<double>(radius) * frame.unit;
  Isometry3d pose = identity;
  pose.translation() = origin;
  const ExactDistance distance(identity, pose);
  for (double part = 1.0; part > 0.0; part = part == 1.0 ? 1.0 - 0x1p-53 : part - 4 * (1.0 - part)) {
    const Point3 p = pointOf(origin + local + way * (length * part));
    if (distance.compare(p, pointOf(local), length) <= 0) return p;
  }
  return std::nullopt;
}

TEST(ErrorBounds, SpheresNearTheClearance)
{
  Random random(25);
  constexpr float margin = 0x1p-20f; // as the sphere kernels have it
  long wrong_apart = 0, wrong_inside = 0, apart = 0, inside = 0;
  for (long n = 0; n < kAttacks;) {
    const VoxelPair m(random);
    for (int k = 0; k < 16; ++k, ++n) {
      const auto i = static_cast<std::size_t>(random.integer(0, 15)),
                 j = static_cast<std::size_t>(random.integer(0, 15));
      const auto radiusIn = [&](const LocalFrame& f) {
        return roundToFloat(random.uniform(0, 1) * std::max({f.reach[0], f.reach[1], f.reach[2]}));
      };
      const float ra = radiusIn(m.a.frame), rb = radiusIn(m.b.frame);
      const Vector3d between = m.pose_b * vectorOf(m.b.given[j]) - m.pose_a * vectorOf(m.a.given[i]);
      const Vector3d way = between.norm() > 0 ? Vector3d(between.normalized()) : Vector3d::UnitX();
      const double unit = m.b.frame.unit;
      const float stretched_a = ra * m.frame.stretch_a, stretched_b = rb * m.frame.stretch_b;
      const float squared = squaredDistance(m.frame, m.a.stored[i], m.b.stored[j], false);
      const double length = between.norm(),
                   radii = static_cast<double>(ra) * m.a.frame.unit + static_cast<double>(rb) * unit;
      const double error = m.frame.error * unit + 0x1p-21 * (length + radii);

      const double low = clearanceNear(length - radii, error, random);
      const float reach = stretched_a + (stretched_b + m.frame.pruneReach(low));
      if (squared > reach * reach * (1.0f + margin)) {
        ++apart;
        const auto p = outermost(m.a.frame, m.a.stored[i], ra, m.pose_a.linear().transpose() * way);
        const auto q = outermost(m.b.frame, m.b.stored[j], rb, -(m.pose_b.linear().transpose() * way));
        wrong_apart += p && q && m.distance.compare(*p, *q, low) <= 0;
      }
      const double high = clearanceNear(length + radii, error, random);
      const float room = (m.frame.acceptReach(high) - stretched_b * (1.0f + margin)) - stretched_a * (1.0f + margin);
      if (room > 0.0f && squared <= room * room * (1.0f - margin) - 0x1p-120f) {
        ++inside;
        const auto p = outermost(m.a.frame, m.a.stored[i], ra, -(m.pose_a.linear().transpose() * way));
        const auto q = outermost(m.b.frame, m.b.stored[j], rb, m.pose_b.linear().transpose() * way);
        wrong_inside += p && q && m.distance.compare(*p, *q, high) > 0;
      }
    }
  }
  EXPECT_EQ(wrong_apart, 0);
  EXPECT_EQ(wrong_inside, 0);
  EXPECT_GT(apart, kAttacks / 20);
  EXPECT_GT(inside, kAttacks / 20);
}

TEST(ErrorBounds, FramesThatSeparate)
{
  Random random(26);
  long wrong = 0, separate = 0;
  for (long n = 0; n < kAttacks;) {
    const VoxelPair m(random);
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 16; ++i)
      for (std::size_t j = 0; j < 16; ++j) smallest = std::min(smallest, m.distance.gap({m.a.given[i], m.b.given[j]}));
    n += 256;
    for (int k = 0; k < 8; ++k) {
      const double clearance = smallest * random.uniform(0, 1.1);
      if (!m.frame.separates(clearance)) continue;
      ++separate;
      wrong += clearance >= smallest;
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(separate, 0);
}

TEST(ErrorBounds, StoredSpheresHoldTheGivenPoints)
{
  Random random(27);
  long wrong = 0;
  for (long n = 0; n < kAttacks;) {
    const VoxelPair m(random);
    for (const Cluster* c : {&m.a, &m.b}) {
      const LocalFrame& f = c->frame;
      Isometry3d origin = identity;
      origin.translation() = Vector3d(f.origin[0], f.origin[1], f.origin[2]);
      const ExactDistance distance(identity, origin);
      for (int k = 0; k < 4; ++k) {
        const std::size_t from = static_cast<std::size_t>(random.integer(0, 15)),
                          to = from + 1 + static_cast<std::size_t>(random.integer(0, 15 - static_cast<int>(from)));
        const Floats& near = c->stored[from];
        Floats center = near;
        if (k > 0)
          for (std::size_t axis = 0; axis < 3; ++axis)
            center[axis] = 0.5f * near[axis] + 0.5f * c->stored[to - 1][axis];
        float squared = 0.0f;
        for (std::size_t i = from; i < to; ++i) {
          const Floats& x = c->stored[i];
          const float dx = x[0] - center[0], dy = x[1] - center[1], dz = x[2] - center[2];
          squared = std::max(squared, (dx * dx + dy * dy) + dz * dz);
        }
        const double radius = static_cast<double>(roundUp(radiusOver(squared, storedSlack(f)))) * f.unit;
        for (std::size_t i = from; i < to; ++i, ++n)
          wrong +=
              distance.compare(c->given[i], {center[0] * f.unit, center[1] * f.unit, center[2] * f.unit}, radius) > 0;
      }
    }
  }
  EXPECT_EQ(wrong, 0);
}

/// Where a frame says that it loses nothing, origin and stored point add up to the given one: near zero, where floats
/// are finest, about powers of two, where they change, and far away.
TEST(ErrorBounds, LosslessFramesKeepEveryFloat)
{
  Random random(29);
  long wrong = 0, lossless = 0;
  for (long n = 0; n < kAttacks; n += 16) {
    const double scale = std::ldexp(random.uniform(1, 2), random.integer(-24, 24));
    const double place[] = {0.0, 1.0, -1.0, 0.5, random.uniform(-3, 3), 1024.0, -4097.0, 0x1p25};
    const Point3 middle = random.point([&] { return scale * random.pick(place); });
    const Point3 half = random.point([&] { return scale * random.pick({0.0, 1e-3, 0.25, 1.0}); });
    std::vector<Point3> points(16);
    for (Point3& p : points)
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = middle[k] + half[k] * (random.chance(0.3) ? (random.chance(0.5) ? 1 : -1) : random.uniform(-1, 1));
    const Cluster cluster(std::move(points), true);
    if (!cluster.frame.lossless) continue;
    ++lossless;
    for (std::size_t i = 0; i < 16; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        wrong += cluster.frame.origin[k] + static_cast<double>(cluster.stored[i][k]) != cluster.given[i][k];
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(16 * lossless, kAttacks / 4);
}

TEST(ErrorBounds, GivenSpheresHoldTheirPoints)
{
  Random random(28);
  const ExactDistance distance(identity, identity);
  long wrong = 0;
  for (long n = 0; n < kAttacks;) {
    const double scale = std::ldexp(random.uniform(1, 2), random.integer(-1074, 1000));
    const double far = random.chance(0.5) ? 0.0 : scale * std::ldexp(1.0, random.integer(0, 20));
    std::vector<Point3> points(static_cast<std::size_t>(random.integer(1, 16)));
    for (Point3& p : points) p = random.point([&] { return far + scale * random.uniform(-1, 1); });
    const double ball = random.chance(0.5) ? 0.0 : scale * random.uniform(0, 1);
    const GivenSphere sphere = sphereAround(
        points.size(), [&](std::size_t i) { return points[i]; }, [&](std::size_t) { return ball; });
    for (const Point3& p : points) wrong += distance.compare(p, sphere.center, sphere.radius, -ball) > 0;
    n += static_cast<long>(points.size());
  }
  EXPECT_EQ(wrong, 0);
}

TEST(ErrorBounds, EnclosuresHoldTheDistance)
{
  Random random(29);
  long wrong = 0;
  for (long n = 0; n < kAttacks / 4;) {
    const VoxelPair m(random);
    for (std::size_t i = 0; i < 16; ++i, ++n) {
      const ExactDistance::Enclosure interval = m.distance.enclose(m.a.given[i], m.b.given[i]);
      if (std::isinf(interval.high)) continue;
      if (interval.low > 0.0) wrong += m.distance.compare(m.a.given[i], m.b.given[i], interval.low) < 0;
      wrong += m.distance.compare(m.a.given[i], m.b.given[i], interval.high) > 0;
    }
  }
  EXPECT_EQ(wrong, 0);
}

} // namespace
} // namespace pcl_bsh
