// SPDX-License-Identifier: BSD-3-Clause
// Long numbers about a point and a triangle, against exact arithmetic; and bounds by slabs.
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/geometry/triangle/triangle_distance.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include "kernels.h"
#include "support/attack.h"
#include "support/made_meshes.h"
#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace pcl_bsh {
namespace {

using test::Random;

/// Pairs of many kinds: any shape; tiny and huge; thin; on a lattice, where places lie above edges and corners. Also
/// far from the origin of the world, or so far that long numbers tell little of a triangle that is small beside its
/// distance.
struct Case {
  Point3 p;
  Triangle3 t;
  Eigen::Isometry3d a = Eigen::Isometry3d::Identity(), b = a;
};

Case randomCase(Random& random)
{
  Case c;
  const bool lattice = random.chance(0.3);
  const double far = random.pick({0.0, 0.0, 5e6}), size = std::ldexp(1.0, random.pick({0, 0, 0, -40, 40, -130}));
  const auto coordinate = [&] { return far + size * (lattice ? 0.25 * random.integer(-8, 8) : random.uniform(-1, 1)); };
  for (Point3& corner : c.t) corner = random.point(coordinate);
  if (random.chance(0.2)) // thin
    for (std::size_t k = 0; k < 3; ++k)
      c.t[2][k] =
          c.t[0][k] + 0.5 * (c.t[1][k] - c.t[0][k]) + size * random.pick({1e-3, 1e-9, 0.0}) * random.uniform(-1, 1);
  c.p = random.point(coordinate);
  if (random.chance(0.1)) c.p = c.t[0];
  if (random.chance(0.2)) { // near the face
    const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
    for (std::size_t k = 0; k < 3; ++k) c.p[k] = c.t[0][k] + u * (c.t[1][k] - c.t[0][k]) + v * (c.t[2][k] - c.t[0][k]);
  }
  if (random.chance(0.3)) c.b = random.pose(2.0);
  if (random.chance(0.3)) c.a = random.pose(2.0);
  if (random.chance(0.2)) c.a.linear() = c.b.linear() = Eigen::Matrix3d::Identity();
  if (random.chance(0.05)) {
    const Eigen::Vector3d off(std::ldexp(size, random.integer(40, 110)), 0, 0);
    c.a.pretranslate(off);
    c.b.pretranslate(off);
    for (double& x : c.p) x *= random.pick({1.0, 0x1p12});
  }
  return c;
}

TEST(LongTriangles, SayWhatExactArithmeticSays)
{
  test::onEveryTarget([](const std::string& target) {
    Random random(77);
    int known = 0, kinds[4] = {};
    constexpr int kCases = 20000;
    for (int i = 0; i < kCases; ++i) {
      const Case c = randomCase(random);
      const TriangleDistance exact(c.a, c.b);
      const test::LongTriangleDistance found = test::longTriangleDistance(c.p, c.a, c.t, c.b);
      ++kinds[found.kind];
      if (found.low > -std::numeric_limits<double>::infinity()) {
        EXPECT_GE(exact.compare(c.p, c.t, found.low), 0) << target << ", case " << i;
        EXPECT_LE(exact.compare(c.p, c.t, found.high), 0) << target << ", case " << i;
      }
      if (std::isnan(found.rounded)) continue;
      ++known;
      EXPECT_EQ(found.rounded, exact.distance(c.p, c.t)) << target << ", case " << i << ", part " << found.kind;
    }
    EXPECT_GT(known, kCases / 2) << target;
    EXPECT_LT(kinds[0], kCases / 2) << target;
    for (int kind = 1; kind < 4; ++kind) EXPECT_GT(kinds[kind], kCases / 20) << target << ", part " << kind;
  });
}

/// A triangle at two poses, or two that share an edge. Poses turn alike or nearly so. Shifts go along an axis, a face
/// or an edge, by as much as rounding, or not at all.
TEST(LongTriangles, KnowWhichOfTwoIsNearer)
{
  test::onEveryTarget([](const std::string& target) {
    Random random(80);
    int known = 0, ties = 0, near_ties = 0;
    constexpr int kCases = 12000;
    for (int i = 0; i < kCases; ++i) {
      Case c = randomCase(random);
      if (random.chance(0.5)) // of a box
        for (Point3& corner : c.t) corner = random.point([&] { return random.pick({-1.5, -0.25, 0.75, 2.0}); });
      if (random.chance(0.5)) // below it
        for (std::size_t k = 0; k < 3; ++k)
          c.p[k] = 0.4 * c.t[0][k] + random.uniform(0, 0.6) * c.t[1][k] + random.uniform(0, 0.6) * c.t[2][k];
      test::PosedTriangle x{c.t, c.b}, y = x;
      const int kind = random.integer(0, 5), axis = random.integer(0, 2);
      if (kind == 0) y.pose.translation()[axis] += random.pick({1e-16, 1e-3, 0.25});
      if (kind == 1)
        y.pose.translation() += y.pose.linear() *
                                Eigen::Vector3d(c.t[1][0] - c.t[0][0], c.t[1][1] - c.t[0][1], c.t[1][2] - c.t[0][2]) *
                                random.uniform(-0.1, 0.1);
      if (kind == 2) y.pose.linear()(axis, random.integer(0, 2)) += random.pick({1e-16, -1e-13, 1e-9});
      if (kind == 3) y.corners[2] = random.point([&] { return random.uniform(-3, 3); });
      if (kind == 4) std::swap(y.corners[0], y.corners[1]);
      if (kind == 5) y.corners = {c.t[1], c.t[0], random.point([&] { return random.uniform(-3, 3); })};
      if (random.chance(0.2)) y.pose.translation()[axis] += 0.5;
      const TriangleDistance of_x(c.a, x.pose), of_y(c.a, y.pose);
      const std::optional<int> found = test::longTriangleOrder(c.p, c.a, x, y);
      if (!found) continue;
      ++known;
      const int exact = of_x.compareGaps(TriangleDistance::PointPair{c.p, x.corners}, of_y,
                                         TriangleDistance::PointPair{c.p, y.corners});
      ASSERT_EQ(*found, exact) << target << ", case " << i << " of kind " << kind;
      ties += exact == 0;
      near_ties += exact != 0 && std::abs(of_x.distance(c.p, x.corners) - of_y.distance(c.p, y.corners)) < 1e-13;
    }
    EXPECT_GT(known, kCases / 4) << target;
    EXPECT_GT(ties, kCases / 20) << target;
    EXPECT_GT(near_ties, kCases / 40) << target;
  });
}

/// Needles all of which have a ball about every point.
TEST(LongTriangles, AreMeasuredWhereSlabsLeaveThem)
{
  const test::TestMesh mesh = test::fanMesh(8000, 1.0, 0.3, true);
  test::TestMesh scan;
  Random random(5);
  for (int i = 0; i < 1000; ++i)
    scan.vertices.push_back({random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2), random.uniform(-0.5, 0.5)});
  const SphereHierarchy triangles(viewOf(mesh.trianglesView())), points(scan.view());
  const Work work = pointDistances({points}, {triangles}).work;
  EXPECT_LT(work.leaf_pairs, 12000u);
  EXPECT_LT(work.node_pairs, 300000u);
}

TEST(LongTriangles, KnowMostDistances)
{
  Random random(78);
  int known = 0;
  for (int i = 0; i < 10000; ++i) {
    Case c;
    for (Point3& corner : c.t) corner = random.point([&] { return 100.0 + random.uniform(-1, 1); });
    c.p = random.point([&] { return 100.0 + random.uniform(-1, 1); });
    if (i % 2 == 0) c.b = random.pose(2.0), c.a = random.pose(2.0);
    known += std::isnan(test::longTriangleDistance(c.p, c.a, c.t, c.b).rounded) ? 0 : 1;
  }
  EXPECT_GT(known, 9900);
}

using Floats = std::array<float, 3>;

Floats rounded(const Eigen::Vector3d& v)
{
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}
Eigen::Vector3d direction(const Floats& v)
{
  return Eigen::Vector3d(v[0], v[1], v[2]).normalized();
}

TEST(LengthToSlabs, IsNoMoreThanTheDistanceOfAnyPlaceInOne)
{
  test::onEveryTarget([](const std::string& target) {
    Random random(79);
    for (int i = 0; i < 20000; ++i) {
      const auto place = [&] {
        return rounded({random.uniform(-10, 10), random.uniform(-10, 10), random.uniform(-10, 10)});
      };
      const float radius = static_cast<float>(random.uniform(0, 3));
      const float h = random.chance(0.2) ? 0.0f : radius * static_cast<float>(random.uniform(0, 1));
      const test::Held held{rounded(random.rotation() * Eigen::Vector3d::UnitZ()), {}, h, 0.0f, place(), radius};
      const Floats from = place();
      // The nearest place: towards the plane, and across it.
      const Eigen::Vector3d n = direction(held.normal), c(held.center[0], held.center[1], held.center[2]),
                            p(from[0], from[1], from[2]), d = p - c;
      const double on = std::clamp(n.dot(d), -double{h}, double{h}), across = (d - n.dot(d) * n).norm();
      Eigen::Vector3d q = c + on * n;
      if (across > 0) q += std::min(across, std::sqrt(double{radius} * radius - on * on)) / across * (d - n.dot(d) * n);
      EXPECT_LE(test::lengthToSlabs(held, from), (p - q).norm()) << target << ", case " << i;
    }
  });
}

/// Two slabs, square to each other or at any angle, and a place beyond the edge between them. The nearest place is on
/// the edge where the vector to it lies between both normals.
TEST(LengthToSlabs, IsNoMoreThanTheDistanceOfAnyPlaceInBoth)
{
  test::onEveryTarget([](const std::string& target) {
    Random random(81);
    for (int i = 0; i < 20000; ++i) {
      const Eigen::Matrix3d turn = random.rotation().toRotationMatrix();
      const bool square = random.chance(0.5);
      test::Held held{};
      held.normal = rounded(turn.col(0));
      held.cross = rounded(square ? turn.col(1) : (turn.col(1) + random.uniform(-3, 3) * turn.col(0)).normalized());
      held.h = random.chance(0.3) ? 0.0f : static_cast<float>(random.uniform(0, 1));
      held.cross_h = random.chance(0.3) ? 0.0f : static_cast<float>(random.uniform(0, 1));
      const Eigen::Vector3d n = direction(held.normal) * random.pick({-1.0, 1.0}),
                            c = direction(held.cross) * random.pick({-1.0, 1.0}), along = n.cross(c).normalized();
      // n . q = h and c . q = k, somewhere along the edge; p beyond it.
      const double cosine = n.dot(c), sine = 1.0 - cosine * cosine;
      const Eigen::Vector3d q = (held.h - cosine * held.cross_h) / sine * n +
                                (held.cross_h - cosine * held.h) / sine * c + random.uniform(-2, 2) * along,
                            p = q + random.uniform(0, 3) * n + random.uniform(0, 3) * c;
      held.radius = static_cast<float>(q.norm() * random.uniform(1.001, 1.5));
      const Floats from = rounded(p);
      const double length = (Eigen::Vector3d(from[0], from[1], from[2]) - q).norm();
      const double found = double{test::lengthToSlabs(held, from)};
      ASSERT_LE(found, length * (1 + 1e-12)) << target << ", case " << i << ", cosine " << cosine;
      if (square) {
        ASSERT_GE(found, (1 - 1e-4) * length - 1e-4 * (p.norm() + held.radius)) << target << ", case " << i;
      }
    }
  });
}

TEST(LengthToSlabs, SaysNothingWhereSquaresOverflow)
{
  test::onEveryTarget([](const std::string& target) {
    for (const float far : {0x1p59f, 0x1p62f, 0x1p66f, 0x1p100f}) {
      const test::Held held{{0, 0, 1}, {0, 1, 0}, 0.0f, 0.0f, {}, 2 * far};
      EXPECT_LE(test::lengthToSlabs(held, {far, 0, 0}), 0.0f) << target << ", " << far; // both hold it
    }
  });
}

} // namespace
} // namespace pcl_bsh
