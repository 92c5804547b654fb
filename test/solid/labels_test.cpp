// SPDX-License-Identifier: BSD-3-Clause
// Labels against every triangle in exact arithmetic.
#include <pcl_bsh/solid/bodies.h>
#include <pcl_bsh/solid/labels.h>

#include "support/brute_force/labels.h"

#include "meshes.h"

#include <gtest/gtest.h>

#include <limits>

namespace pcl_bsh {
namespace {

using Eigen::Isometry3d;
using Mesh = test::ClosedMesh;
using test::Random;

Isometry3d poseOf(double angle, const Eigen::Vector3d& shift)
{
  Isometry3d pose = Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, -3).normalized()));
  pose.pretranslate(shift);
  return pose;
}

/// Compares all queries with brute force, of voxels that are built and that are not.
void expectExact(const Mesh& mesh, const std::vector<double>& points, const Isometry3d& pose_a = Isometry3d::Identity(),
                 const Isometry3d& pose_b = Isometry3d::Identity(), const std::string& what = {},
                 double voxel_edge = 0.0)
{
  SCOPED_TRACE(what);
  const Solid solid(mesh.view());
  HierarchyOptions options;
  options.voxel_edge = voxel_edge;
  const SphereHierarchy cloud(viewOf(points.data(), points.size() / 3), options);
  const Placed a(cloud, pose_a);
  const PlacedSolid b(solid, pose_b);
  const LabelsResult expected = brute_force::labelPoints(a, b);
  EXPECT_EQ(expected.work.exact_decisions, expected.labels.size() * mesh.view().count);
  std::optional<std::uint32_t> first;
  for (std::uint32_t i = 0; i < expected.labels.size() && !first; ++i)
    if (expected.labels[i] != labelOf(Label::outside)) first = i;
  for (const bool built : {false, true}) {
    if (built) cloud.buildAll();
    const LabelsResult found = labelPoints(a, b, built ? 2 : 1);
    EXPECT_EQ(found.labels, expected.labels) << "built " << built;
    EXPECT_EQ(found.inside, expected.inside);
    EXPECT_EQ(found.on_surface, expected.on_surface);
    EXPECT_EQ(firstInside(a, b), first);
    EXPECT_EQ(anyInside(a, b), first.has_value());
  }
}

std::vector<double> somewhere(std::size_t count, double low, double high, std::uint64_t seed)
{
  Random random(seed);
  std::vector<double> points(3 * count);
  for (double& x : points) x = random.uniform(low, high);
  return points;
}

TEST(Labels, OfABox)
{
  const Mesh box = test::boxMesh();
  expectExact(box, somewhere(2000, -0.3, 1.3, 1));
  expectExact(box, test::pointsAbout(box, 2000, 0.01, 2));
  expectExact(box, somewhere(2000, -0.3, 1.3, 3), poseOf(0.3, {0.2, 0.1, 0}), poseOf(1.1, {0.1, 0, 0.2}));
}

/// A tree of several levels above them.
TEST(Labels, OfManyVoxels)
{
  const Mesh bumpy = test::bumpyMesh(12, 0.3);
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    std::vector<double> points = somewhere(100, 2.0, 4.0, seed); // outside
    const std::vector<double> about = test::pointsAbout(bumpy, seed == 1 ? 1 : 1000, 0.3, seed);
    points.insert(points.end(), about.begin(), about.end());
    expectExact(bumpy, points, poseOf(0.3, {0.2, 0.1, 0}), poseOf(0.4, {0.1, 0, 0.2}), std::to_string(seed), 0.06);
  }
}

/// Where their sum is beyond all doubles, and where it is not.
TEST(Labels, OfPlacesBeyondAllNumbers)
{
  Mesh box;
  box.add(test::boxMesh(), 1e300, {-5e299, -5e299, -5e299});
  for (const double from : {-1.7e308, 1.7e308})
    for (const double to : {-1.7e308, 0.0, 1.7e308}) {
      Isometry3d pose_a = Isometry3d::Identity(), pose_b = pose_a;
      pose_a.translation().x() = from;
      pose_b.translation().x() = to;
      const std::vector<double> points = {0, 0, 0, -1.7e308, 0, 0, 1.7e308, 0, 0, 1.7e308, 5e299, 0};
      expectExact(box, points, pose_a, pose_b, std::to_string(from > 0) + " " + std::to_string(to));
    }
}

TEST(Labels, OfShellsThatCrossAndTouchOnALattice)
{
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const int steps = seed % 2 == 0 ? 4 : 8;
    const Mesh mesh = test::latticeMesh(12, steps, seed);
    std::vector<double> points;
    for (int x = -1; x <= 2 * steps + 1; x += 2)
      for (int y = -1; y <= 2 * steps + 1; ++y)
        for (int z = -1; z <= 2 * steps + 1; ++z)
          points.insert(points.end(), {x / (2.0 * steps), y / (2.0 * steps), z / (2.0 * steps)});
    expectExact(mesh, points, Isometry3d::Identity(), Isometry3d::Identity(), "seed " + std::to_string(seed));
    expectExact(mesh, test::pointsAbout(mesh, 300, 1e-9, seed), poseOf(0.5, {0, 0, 0}), poseOf(0.5, {0, 0, 0}));
  }
}

/// A surface in triangles whose corners lie within edges of others has the labels of the whole one.
TEST(Labels, OfCornersWithinEdges)
{
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Mesh whole = seed % 2 == 0 ? test::boxMesh() : test::latticeMesh(10, 8, seed);
    const Mesh cut = test::cutMesh(whole, 20 + 30 * static_cast<int>(seed), seed);
    std::vector<double> points = test::pointsAbout(cut, 500, 1e-9, seed);
    const std::vector<double> about = test::pointsAbout(whole, 500, 0.3, seed);
    points.insert(points.end(), about.begin(), about.end());
    for (int x = -1; x <= 17; x += 3)
      for (int y = -1; y <= 17; y += 2)
        for (int z = -1; z <= 17; ++z) points.insert(points.end(), {x / 16.0, y / 16.0, z / 16.0});
    expectExact(cut, points, Isometry3d::Identity(), Isometry3d::Identity(), "seed " + std::to_string(seed));
    expectExact(cut, points, poseOf(0.5, {5e5, 5e6, 0}), poseOf(0.5, {5e5, 5e6, 0}));
    const Solid of_whole(whole.view()), of_cut(cut.view());
    const SphereHierarchy cloud(viewOf(points.data(), points.size() / 3));
    EXPECT_EQ(labelPoints(cloud, of_cut).labels, brute_force::labelPoints(cloud, of_whole).labels);

    const SolidBodies bodies(of_cut); // each closes by itself, and what is inside is inside one of them
    const std::vector<std::uint8_t> labels = labelPoints(cloud, of_cut).labels;
    std::vector<bool> in_a_body(labels.size(), false);
    for (const SolidBodies::Body& body : bodies.all()) {
      const std::vector<std::uint8_t> own = labelPoints(cloud, bodies.solidOf(body)).labels;
      for (std::size_t i = 0; i < own.size(); ++i) in_a_body[i] = in_a_body[i] || own[i] == labelOf(Label::inside);
    }
    for (std::size_t i = 0; i < labels.size(); ++i)
      EXPECT_TRUE(labels[i] != labelOf(Label::inside) || in_a_body[i]) << i;
  }
}

TEST(Labels, OfNestedOverlappingAndDoubledShells)
{
  const Mesh box = test::boxMesh();
  Mesh mesh;
  mesh.add(box, 1.0);
  mesh.add(box, 0.5, {0.25, 0.25, 0.25}, true); // a hollow
  mesh.add(box, 0.25, {0.375, 0.375, 0.375});   // a body in it
  mesh.add(box, 1.0, {0.5, 0.5, 0.5});          // overlaps
  mesh.add(box, 1.0, {2, 0, 0});
  mesh.add(box, 1.0, {2, 0, 0}, true); // doubled in opposite directions: encloses nothing
  mesh.add(box, 1.0, {3, 0, 0}, true); // inside out, and touches
  expectExact(mesh, somewhere(3000, -0.2, 4.2, 5));
  expectExact(mesh, test::pointsAbout(mesh, 2000, 0.02, 6));
  const Solid solid(mesh.view());
  EXPECT_EQ(labelPlace(solid, {0.1, 0.1, 0.1}), Label::inside);
  EXPECT_EQ(labelPlace(solid, {0.3, 0.3, 0.3}), Label::outside);
  EXPECT_EQ(labelPlace(solid, {0.45, 0.45, 0.45}), Label::inside);
  EXPECT_EQ(labelPlace(solid, {0.7, 0.7, 0.7}), Label::inside);
  EXPECT_EQ(labelPlace(solid, {2.5, 0.5, 0.5}), Label::outside);
  EXPECT_EQ(labelPlace(solid, {2.5, 0.5, 1.0}), Label::surface);
  EXPECT_EQ(labelPlace(solid, {3.5, 0.5, 0.5}), Label::inside);
  EXPECT_EQ(labelPlace(solid, {std::numeric_limits<double>::quiet_NaN(), 0, 0}), Label::outside);
}

TEST(Labels, OfManyBoxesInsideEachOther)
{
  for (const bool hollows : {false, true})
    for (const double step : {0.0, 0.002, 1e-9, 1e-17}) { // none: all are equal
      Mesh mesh;
      for (int i = 0; i < 250; ++i) {
        const double edge = 1.0 - i * step;
        mesh.add(test::boxMesh(), edge, {-edge / 2, -edge / 2, -edge / 2}, hollows && i % 2 == 1);
      }
      const std::string what = std::to_string(hollows) + " " + std::to_string(step);
      std::vector<double> points = test::pointsAbout(mesh, 100, 1e-3, 6);
      const std::vector<double> others = somewhere(100, -0.6, 0.6, 7);
      points.insert(points.end(), others.begin(), others.end());
      expectExact(mesh, points, Isometry3d::Identity(), Isometry3d::Identity(), what);
      expectExact(mesh, points, poseOf(0.7, {1, 2, 3}), poseOf(0.7 + step, {1, 2, 3}), what);
    }
}

/// Two cones of so many triangles about the last axis, base to base.
Mesh bipyramid(std::uint32_t around)
{
  Mesh mesh;
  const std::uint32_t top = mesh.vertex(0, 0, 1), bottom = mesh.vertex(0, 0, -1);
  for (std::uint32_t i = 0; i < around; ++i)
    mesh.vertex(std::cos(2 * M_PI * i / around), std::sin(2 * M_PI * i / around), 0);
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t a = 2 + i, b = 2 + (i + 1) % around;
    mesh.triangle(top, a, b);
    mesh.triangle(bottom, b, a);
  }
  return mesh;
}

std::vector<double> onTheAxis(std::size_t count, double low, double high)
{
  Random random(3);
  std::vector<double> points;
  for (std::size_t i = 0; i < count; ++i) points.insert(points.end(), {0.0, 0.0, random.uniform(low, high)});
  return points;
}

/// All rays meet all triangles at the tip.
TEST(Labels, OfPointsOnTheAxisOfARoundShape)
{
  Mesh shape = bipyramid(500);
  shape.add(bipyramid(70), 0.25, {0, 0, 0.25}, true); // a hollow
  std::vector<double> points = onTheAxis(150, -1.1, 1.1);
  for (const double z : {-1.0, 0.0, 0.5, 1.0}) points.insert(points.end(), {0.0, 0.0, z});
  const std::vector<double> beside = onTheAxis(150, -1.1, 1.1);
  for (std::size_t i = 0; i < beside.size(); ++i) points.push_back(beside[i] + (i % 3 == 0 ? 1e-15 : 0.0));
  for (const double angle : {0.0, 0.4}) {
    expectExact(shape, points, poseOf(angle, {1, 2, 3}), poseOf(angle, {1, 2, 3}), std::to_string(angle));
    expectExact(shape, points, Isometry3d::Identity(), poseOf(angle, {0, 0, 0}), std::to_string(angle));
  }
}

TEST(Labels, OfPointsOnTheAxisTakeFewDecisions)
{
  const Mesh shape = bipyramid(2000);
  for (const double low : {-1.2, 0.999}) {
    const std::vector<double> points = onTheAxis(5000, low, 1.0);
    const SphereHierarchy cloud(viewOf(points.data(), points.size() / 3));
    for (const bool built : {false, true}) {
      if (built) cloud.buildAll();
      const LabelsResult found = labelPoints(cloud, Solid(shape.view()));
      EXPECT_GT(found.inside, 4000u);
      EXPECT_LT(found.work.exact_decisions, 20u * 4000u) << "of 20 million";
    }
  }
}

TEST(Labels, OfABumpySurfaceAndAFan)
{
  const Mesh bumpy = test::bumpyMesh(24, 0.3), fan = test::fanMesh(3000);
  expectExact(bumpy, test::pointsAbout(bumpy, 1500, 0.02, 8));
  expectExact(bumpy, test::pointsAbout(bumpy, 500, 0.02, 9), poseOf(2.0, {5, 1, 2}), poseOf(2.1, {5, 1, 2}));
  expectExact(fan, test::pointsAbout(fan, 300, 0.01, 10));
}

TEST(Labels, OfLongThinTriangles)
{
  Random random(11);
  Mesh mesh;
  const Mesh box = test::boxMesh();
  for (int i = 0; i < 60; ++i) { // sheared beams in all directions
    Mesh beam = box;
    const Point3 way = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    for (std::size_t v = 0; v < 8; ++v)
      for (std::size_t k = 0; k < 3; ++k)
        beam.xyz[3 * v + k] = box.xyz[3 * v] * way[k] + (k == 0 ? 0.0 : 1e-3 * box.xyz[3 * v + k]);
    mesh.add(beam, 1.0, {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)});
  }
  expectExact(mesh, test::pointsAbout(mesh, 1500, 1e-3, 12));
}

TEST(Labels, OfSmallEdgesFarFromTheOrigin)
{
  Mesh mesh;
  mesh.add(test::bumpyMesh(10, 0.3), 1e-4, {5e5, 5.4e6, 120}); // edges of about 10 um at UTM coordinates
  const std::vector<double> points = test::pointsAbout(mesh, 1500, 2e-6, 13);
  expectExact(mesh, points);
  expectExact(mesh, points, poseOf(0.7, {10, 20, 30}), poseOf(0.7, {10, 20, 30}));
}

TEST(Labels, OfSinglePointsOnTheSurface)
{
  // Each a node of its own, of no size: where it is seen is off by rounding alone.
  const Mesh box = test::boxMesh();
  Random random(18);
  for (int i = 0; i < 60; ++i) {
    std::vector<double> point = {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
    point[static_cast<std::size_t>(i % 3)] = i % 2;
    const Isometry3d pose = poseOf(random.uniform(0, 3), {random.uniform(-9, 9), random.uniform(-9, 9), 1});
    expectExact(box, point, pose, pose, "point " + std::to_string(i));
    const SphereHierarchy cloud(viewOf(point.data(), 1));
    EXPECT_EQ(labelPoints({cloud, pose}, {Solid(box.view()), pose}).on_surface, 1u) << i;
  }
}

TEST(Labels, OfAStrayBodyAndOfExtremeSizes)
{
  Mesh stray = test::bumpyMesh(12, 0.2);
  stray.add(test::boxMesh(), 1.0, {1e7, -1e7, 3e6});
  expectExact(stray, test::pointsAbout(stray, 1000, 0.02, 14));
  for (const double scale : {1e-150, 1e-30, 1e30, 1e150}) {
    Mesh box;
    box.add(test::bumpyMesh(6, 0.3), scale);
    std::vector<double> points = test::pointsAbout(test::bumpyMesh(6, 0.3), 300, 0.1, 15);
    for (double& x : points) x *= scale;
    if (scale < 1e38 && scale > 1e-38) expectExact(box, points);
    const Solid solid(box.view());
    EXPECT_EQ(labelPlace(solid, {0.5 * scale, 0.5 * scale, 0.5 * scale}), Label::inside);
    EXPECT_EQ(labelPlace(solid, {0.5 * scale, 0.5 * scale, 1.5 * scale}), Label::outside);
  }
}

TEST(Labels, OfPlatesThatCastNoShadowAndOfPoints)
{
  Mesh mesh; // a triangle from both sides, and one without area
  const std::uint32_t a = mesh.vertex(0, 0, 0), b = mesh.vertex(1, 0, 0), c = mesh.vertex(0, 1, 0);
  mesh.triangle(a, b, c);
  mesh.triangle(a, c, b);
  mesh.triangle(a, a, a);
  const Solid solid(mesh.view());
  EXPECT_EQ(labelPlace(solid, {0.25, 0.25, 0}), Label::surface);
  EXPECT_EQ(labelPlace(solid, {0.25, 0.25, 1e-300}), Label::outside);
  const Solid nothing(TrianglesView{viewOf(mesh.xyz.data(), 3), nullptr, 0});
  EXPECT_EQ(labelPlace(nothing, {0, 0, 0}), Label::outside);
}

TEST(Labels, OfWholeNodesTakeFewTests)
{
  const Mesh box = test::boxMesh();
  const Solid solid(box.view());
  const std::vector<double> deep = somewhere(20000, 0.35, 0.65, 16), far = somewhere(20000, 3, 4, 17);
  const SphereHierarchy inside(viewOf(deep.data(), 20000)), outside(viewOf(far.data(), 20000));
  const LabelsResult in = labelPoints({inside}, solid), out = labelPoints({outside}, solid);
  EXPECT_EQ(in.inside, 20000u);
  EXPECT_EQ(in.work.leaf_pairs, 0u);
  EXPECT_EQ(out.inside, 0u);
  EXPECT_LE(out.work.node_pairs, 8u);
  EXPECT_EQ(in.work.voxels_built, 0u);
}

/// Crowds of one place, near the surface: a ray from there goes through edges of the other box, and doubles tell
/// nothing.
TEST(Labels, OfCrowdsInOnePlace)
{
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double at : {-1e-3, 0.0, 1e-3, 1.0, 1.0 + 1e-3, 2.0 - 1e-3}) {
      Mesh boxes = test::boxMesh();
      Point3 shift = {0, 0, 0}, place = {0.5, 0.5, 0.5};
      shift[axis] = 2.0;
      place[axis] = at;
      boxes.add(test::boxMesh(), 1.0, shift);
      std::vector<double> points;
      for (int i = 0; i < 40; ++i) points.insert(points.end(), place.begin(), place.end());
      expectExact(boxes, points, Isometry3d::Identity(), Isometry3d::Identity(),
                  std::to_string(axis) + " " + std::to_string(at));
    }
}

TEST(Labels, CountAPointThatIsNamedTwiceOnce)
{
  const Mesh box = test::boxMesh();
  const Solid solid(box.view());
  const std::vector<double> points = {0.5, 0.5, 0.5, 2, 2, 2, 1, 0.5, 0.5};
  const std::vector<std::int32_t> twice = {2, 0, 1, 0, 2};
  PointsView view = viewOf(points.data(), 3);
  view.indices = twice.data();
  view.index_count = twice.size();
  const SphereHierarchy cloud(view);
  for (const bool built : {false, true}) {
    if (built) cloud.buildAll();
    const LabelsResult found = labelPoints({cloud}, {solid});
    EXPECT_EQ(found.inside, 1u);
    EXPECT_EQ(found.on_surface, 1u);
  }
}

TEST(Labels, OfPointsThatAreNotFinite)
{
  const Mesh box = test::boxMesh();
  const Solid solid(box.view());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> points = {0.5, 0.5, 0.5, nan, 0.5, 0.5, 0.25, 0.5, 0.5};
  const SphereHierarchy cloud(viewOf(points.data(), 3));
  EXPECT_EQ(labelPoints({cloud}, solid).labels, (std::vector<std::uint8_t>{1, 0, 1}));
  const LabelsResult by_force = brute_force::labelPoints({cloud}, solid);
  EXPECT_EQ(by_force.labels, (std::vector<std::uint8_t>{1, 0, 1}));
  EXPECT_EQ(by_force.inside, 2u);
  EXPECT_EQ(by_force.work.exact_decisions, 2 * box.view().count);
}

} // namespace
} // namespace pcl_bsh
