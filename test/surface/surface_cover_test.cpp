// SPDX-License-Identifier: BSD-3-Clause
#include "support/made_meshes.h"
#include "support/verdicts.h"

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/surface/surface_cover.h>

#include <boost/container_hash/hash.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <unordered_map>

namespace pcl_bsh {
namespace {

using test::TestMesh;
using Wide = long double; // its roundings are a thousandth of what covers keep for theirs
using Vector = Eigen::Matrix<Wide, 3, 1>;

Vector wide(const Point3& p)
{
  return {p[0], p[1], p[2]};
}

/// Looks for balls near a place.
class BallGrid {
public:
  explicit BallGrid(const SurfaceCover& cover) : cover_(cover), edge_(2 * cover.tolerance)
  {
    for (std::uint32_t i = 0; i < cover.centers.size(); ++i) balls_[cubeOf(wide(cover.centers[i]))].push_back(i);
  }

  /// Whether a ball holds all three, which proves that it holds their triangle. A ball that holds a point has its
  /// centre within the tolerance.
  bool oneHolds(const Vector& a, const Vector& b, const Vector& c) const
  {
    const auto middle = cubeOf(a);
    for (std::int64_t k = 0; k < 27; ++k) {
      const auto found = balls_.find({middle[0] + k % 3 - 1, middle[1] + k / 3 % 3 - 1, middle[2] + k / 9 - 1});
      if (found == balls_.end()) continue;
      for (const std::uint32_t i : found->second) {
        const Vector center = wide(cover_.centers[i]);
        const Wide squared = Wide(cover_.radii[i]) * cover_.radii[i];
        if ((a - center).squaredNorm() <= squared && (b - center).squaredNorm() <= squared &&
            (c - center).squaredNorm() <= squared)
          return true;
      }
    }
    return false;
  }

private:
  std::array<std::int64_t, 3> cubeOf(const Vector& p) const
  {
    std::array<std::int64_t, 3> cube;
    for (Eigen::Index k = 0; k < 3; ++k)
      cube[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(p[k] / edge_));
    return cube;
  }

  const SurfaceCover& cover_;
  Wide edge_;
  using Cube = std::array<std::int64_t, 3>;
  std::unordered_map<Cube, std::vector<std::uint32_t>, boost::hash<Cube>> balls_;
};

/// Proves that balls hold each point of a triangle: one holds it, or they hold its halves.
bool isHeld(const BallGrid& balls, const Vector& a, const Vector& b, const Vector& c, int depth)
{
  if (balls.oneHolds(a, b, c)) return true;
  if (depth == 0) return false;
  const Wide ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
  if (ab >= bc && ab >= ca) {
    const Vector m = (a + b) / 2;
    return isHeld(balls, a, m, c, depth - 1) && isHeld(balls, m, b, c, depth - 1);
  }
  if (bc >= ca) {
    const Vector m = (b + c) / 2;
    return isHeld(balls, a, b, m, depth - 1) && isHeld(balls, a, m, c, depth - 1);
  }
  const Vector m = (c + a) / 2;
  return isHeld(balls, a, b, m, depth - 1) && isHeld(balls, m, b, c, depth - 1);
}

Wide distanceToSegment(const Vector& p, const Vector& a, const Vector& b)
{
  const Vector edge = b - a;
  const Wide squared = edge.squaredNorm();
  const Wide t = squared > 0 ? std::clamp<Wide>((p - a).dot(edge) / squared, 0, 1) : 0;
  return (p - a - t * edge).norm();
}

Wide distanceTo(const Vector& p, const Vector& a, const Vector& b, const Vector& c)
{
  Wide distance = std::min({distanceToSegment(p, a, b), distanceToSegment(p, b, c), distanceToSegment(p, c, a)});
  const Vector normal = (b - a).cross(c - a);
  const Wide squared = normal.squaredNorm();
  if (squared > 0) {
    const Wide v = (p - a).cross(c - a).dot(normal) / squared, w = (b - a).cross(p - a).dot(normal) / squared;
    if (v >= 0 && w >= 0 && v + w <= 1)
      distance = std::min(distance, std::abs((p - a).dot(normal)) / std::sqrt(squared));
  }
  return distance;
}

/// Each point of the mesh is in a ball, and no ball reaches farther than the tolerance beyond the mesh.
void expectCovers(const SurfaceCover& cover, const TestMesh& mesh)
{
  const BallGrid balls(cover);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    ASSERT_TRUE(isHeld(balls, wide(mesh.vertices[a]), wide(mesh.vertices[b]), wide(mesh.vertices[c]), 120)) << t;
  }
  ASSERT_EQ(cover.radii.size(), cover.centers.size());
  ASSERT_EQ(cover.triangles.size(), cover.centers.size());
  for (std::size_t i = 0; i < cover.centers.size(); ++i) {
    const auto [a, b, c] = mesh.triangles[cover.triangles[i]];
    const Wide from_surface =
        distanceTo(wide(cover.centers[i]), wide(mesh.vertices[a]), wide(mesh.vertices[b]), wide(mesh.vertices[c]));
    ASSERT_LE(from_surface + cover.radii[i], Wide(cover.tolerance)) << i;
  }
}

SurfaceRequest within(double tolerance, bool apart = false)
{
  SurfaceRequest request;
  request.tolerance = tolerance;
  request.triangles_apart = apart;
  return request;
}

double ratioOf(const SurfaceCover& cover)
{
  return static_cast<double>(cover.centers.size()) / cover.hexagonalOptimum();
}

TEST(CoverSurface, HoldsABoxAtAnyTolerance)
{
  TestMesh box = test::boxMesh(1.0, 0.7, 0.31);
  test::Random random(1);
  box.move(random.pose(10.0));
  for (const double tolerance : {3.0, 0.5, 0.1, 0.03}) {
    for (const bool apart : {false, true}) {
      SCOPED_TRACE(testing::Message() << tolerance << (apart ? " apart" : ""));
      expectCovers(coverSurface(box.view(), box.triangles, within(tolerance, apart)), box);
    }
  }
}

TEST(CoverSurface, TakesHardlyMoreBallsThanALatticeWould)
{
  const TestMesh box = test::boxMesh(26.0, 3.0, 3.0);
  const SurfaceCover wagon = coverSurface(box.view(), box.triangles, within(0.05));
  EXPECT_LT(ratioOf(wagon), 1.1);
  // However the faces are triangulated.
  const TestMesh fine = test::gridMesh(400, 300, [](double u, double v) -> Point3 { return {4 * u, 3 * v, 0.0}; });
  EXPECT_LT(ratioOf(coverSurface(fine.view(), fine.triangles, within(0.02))), 1.1);
  EXPECT_LT(ratioOf(coverSurface(fine.view(), fine.triangles, within(0.1))), 1.3);
  const TestMesh sphere = test::sphereMesh(1.0, 100);
  for (const double tolerance : {0.07, 0.03}) {
    const SurfaceCover cover = coverSurface(sphere.view(), sphere.triangles, within(tolerance));
    EXPECT_LT(ratioOf(cover), 1.5) << tolerance;
    expectCovers(cover, sphere);
  }
}

TEST(CoverSurface, HoldsThinTinyAndDegenerateTriangles)
{
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    SCOPED_TRACE(seed);
    TestMesh mesh = test::soup(seed, 12, 1.0, 0.5);
    if (seed % 4 == 1) {
      Eigen::Isometry3d utm = Eigen::Isometry3d::Identity();
      utm.translation() << 513449.7, 5402650.2, 300.1;
      mesh.move(utm);
    }
    test::Random random(seed);
    const double tolerance = std::pow(10.0, random.uniform(-1.3, 0.5));
    expectCovers(coverSurface(mesh.view(), mesh.triangles, within(tolerance, seed % 2 == 0)), mesh);
  }
}

TEST(CoverSurface, UnitesSmallTriangles)
{
  const TestMesh mesh = test::soup(3, 20000, 1.0, 0.01);
  const SurfaceCover cover = coverSurface(mesh.view(), mesh.triangles, within(0.2));
  EXPECT_LT(cover.centers.size(), 700u);
  expectCovers(cover, mesh);
}

TEST(CoverSurface, HoldsASurfaceThatLiesOverItself)
{
  // A ramp that winds: its charts fold over themselves in their planes.
  const TestMesh ramp = test::gridMesh(150, 3, [](double u, double v) -> Point3 {
    const double turn = 20 * u;
    return {(1 + v) * std::cos(turn), (1 + v) * std::sin(turn), 0.5 * u};
  });
  for (const double tolerance : {0.2, 0.05}) {
    expectCovers(coverSurface(ramp.view(), ramp.triangles, within(tolerance)), ramp);
  }
}

TEST(CoverSurface, IsEmptyForNoTriangles)
{
  const SurfaceCover cover = coverSurface({}, {}, within(1.0));
  EXPECT_TRUE(cover.centers.empty());
  EXPECT_EQ(cover.view().size(), 0u);
  EXPECT_EQ(cover.hexagonalOptimum(), 0.0);
}

TEST(CoverSurface, RefusesWhatItCannotCover)
{
  TestMesh mesh = test::boxMesh(1, 1, 1);
  const auto expectRefused = [&](double tolerance, const char* words) {
    try {
      coverSurface(mesh.view(), mesh.triangles, within(tolerance));
      ADD_FAILURE() << "accepted: " << words;
    }
    catch (const InvalidInput& error) {
      EXPECT_EQ(error.input(), Input::surface);
      EXPECT_THAT(error.what(), testing::HasSubstr(words));
    }
  };
  for (const double tolerance :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e-300, 1e300})
    expectRefused(tolerance, "is not a length above 0");
  expectRefused(1e-12, "too small for coordinates up to 1");
  expectRefused(1e-6, "would take some");
  mesh.triangles[5][1] = 8;
  expectRefused(0.1, "triangle 5 names vertex 8 of 8");
  mesh.triangles[5][1] = 7;
  mesh.vertices[7][2] = std::numeric_limits<double>::quiet_NaN();
  expectRefused(0.1, "vertex 7 of triangle");
}

TEST(CoverSurface, TellsHowFarItIsAndStops)
{
  const TestMesh box = test::boxMesh(26.0, 3.0, 3.0);
  SurfaceRequest request = within(0.05);
  double last = 0.0;
  request.progress = [&](double done) {
    EXPECT_GE(done, last);
    last = done;
    return true;
  };
  coverSurface(box.view(), box.triangles, request);
  EXPECT_GT(last, 0.5);
  request.progress = [](double) { return false; };
  EXPECT_THROW(coverSurface(box.view(), box.triangles, request), Cancelled);
}

TEST(CoverSurface, MakesQueriesAnswerForTheSurface)
{
  const TestMesh box = test::boxMesh(1, 1, 1);
  constexpr double tolerance = 0.01, clearance = 0.05;
  const SurfaceCover cover = coverSurface(box.view(), box.triangles, within(tolerance));
  const SphereHierarchy surface(cover.view());
  test::Random random(7);
  std::vector<double> scan;
  for (int i = 0; i < 60000; ++i) scan.push_back(random.uniform(-0.2, 1.2));
  const SphereHierarchy points(viewOf(scan.data(), scan.size() / 3));
  FlagsRequest request;
  request.clearance = clearance;
  const FlagsResult flags = collisionFlags({points}, {surface}, request);
  int near = 0, between = 0;
  for (std::size_t i = 0; i < scan.size() / 3; ++i) {
    const Vector p(scan[3 * i], scan[3 * i + 1], scan[3 * i + 2]);
    Wide distance = std::numeric_limits<Wide>::infinity();
    for (const Triangle& t : box.triangles)
      distance = std::min(distance,
                          distanceTo(p, wide(box.vertices[t[0]]), wide(box.vertices[t[1]]), wide(box.vertices[t[2]])));
    if (distance <= clearance) {
      ASSERT_EQ(flags.a[i], Verdict::colliding) << i;
      ++near;
    }
    else if (distance <= clearance + tolerance) {
      ++between;
    }
    else {
      ASSERT_EQ(flags.a[i], Verdict::free) << i;
    }
  }
  EXPECT_GT(near, 1000);
  EXPECT_GT(between, 100);
}

} // namespace
} // namespace pcl_bsh
