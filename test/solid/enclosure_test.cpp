// SPDX-License-Identifier: BSD-3-Clause
// Records that solids hold, and the bodies that hold them, against every place, every body and every triangle in exact
// arithmetic.
#include <pcl_bsh/solid/enclosure.h>

#include "meshes.h"
#include "support/brute_force/labels.h"
#include "support/verdicts.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace pcl_bsh {
namespace {

using Eigen::Isometry3d;
using Mesh = test::ClosedMesh;
using testing::ElementsAre;
using testing::IsEmpty;
using Records = std::vector<std::uint32_t>;

const Isometry3d identity = Isometry3d::Identity();

Isometry3d poseOf(double angle, const Eigen::Vector3d& shift)
{
  Isometry3d pose = identity;
  pose.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, -3).normalized()));
  pose.pretranslate(shift);
  return pose;
}

/// Each triangle's body: triangles that share a place join, until nothing changes.
std::vector<std::size_t> bodiesByHand(const TrianglesView& view)
{
  std::vector<std::size_t> body(view.count);
  for (std::size_t i = 0; i < body.size(); ++i) body[i] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::uint32_t i = 0; i < view.count; ++i)
      for (std::uint32_t j = 0; j < i; ++j) {
        const auto s = view.triangle(i), t = view.triangle(j);
        const bool joined = std::any_of(s.begin(), s.end(),
                                        [&](const Point3& p) { return std::find(t.begin(), t.end(), p) != t.end(); });
        if (!joined || body[i] == body[j]) continue;
        body[i] = body[j] = std::min(body[i], body[j]);
        changed = true;
      }
  }
  return body;
}

/// Labels of some places.
std::vector<std::uint8_t> labelsByHand(const TrianglesView& solid, const Isometry3d& pose_of_solid,
                                       const PointsView& places, const Isometry3d& pose_of_places)
{
  const SphereHierarchy cloud(places);
  return brute_force::labelPoints({cloud, pose_of_places}, {Solid(solid), pose_of_solid}).labels;
}

/// Corners of a triangle, or the point.
Records placesOf(const PointsView& queried, std::uint32_t record)
{
  if (!queried.triangles) return {record};
  const Triangle t = queried.triangles->cornersOf(record);
  return {t.begin(), t.end()};
}

void expectExact(const Mesh& solid_mesh, const PointsView& queried, const Isometry3d& pose_of_solid = identity,
                 const Isometry3d& pose_of_queried = identity)
{
  const TrianglesView view = solid_mesh.view();
  const Solid solid(view);
  const SolidBodies bodies(solid);
  const SphereHierarchy hierarchy(queried);
  const QueriedRecords queried_records(hierarchy);
  const PointsView& places = queried.triangles ? queried.triangles->vertices : queried;

  const std::vector<std::uint8_t> labels = labelsByHand(view, pose_of_solid, places, pose_of_queried);
  Records enclosed; // of what the view names
  for (std::size_t k = 0; k < queried.size(); ++k)
    for (const std::uint32_t place : placesOf(queried, queried.record(k)))
      if (labels[place] != labelOf(Label::outside)) enclosed.push_back(queried.record(k));
  std::sort(enclosed.begin(), enclosed.end());
  enclosed.erase(std::unique(enclosed.begin(), enclosed.end()), enclosed.end());

  const std::vector<std::size_t> body_of = bodiesByHand(view);
  Records holders;
  for (std::size_t body = 0; body < view.count; ++body) {
    std::vector<Triangle> own;
    for (std::uint32_t i = 0; i < view.count; ++i)
      if (body_of[i] == body) own.push_back(view.cornersOf(i));
    if (own.empty()) continue;
    const TrianglesView own_view{view.vertices, own.front().data(), own.size()};
    const std::vector<std::uint8_t> of_body = labelsByHand(own_view, pose_of_solid, places, pose_of_queried);
    const bool holds = std::any_of(enclosed.begin(), enclosed.end(), [&](std::uint32_t record) {
      const Records all = placesOf(queried, record);
      return std::any_of(all.begin(), all.end(), [&](std::uint32_t place) {
        return labels[place] != labelOf(Label::outside) && of_body[place] == labelOf(Label::inside);
      });
    });
    for (std::uint32_t i = 0; holds && i < view.count; ++i)
      if (body_of[i] == body) holders.push_back(i);
  }
  std::sort(holders.begin(), holders.end());

  EXPECT_EQ(enclosedBy({solid, pose_of_solid}, queried_records, pose_of_queried), enclosed);
  EXPECT_EQ(holdersOf(bodies, pose_of_solid, queried_records, pose_of_queried, enclosed), holders);
  const std::optional<PointPair> any = findEnclosed(bodies, pose_of_solid, queried_records, pose_of_queried);
  if (!queried.triangles) {
    ASSERT_EQ(any.has_value(), !enclosed.empty());
    if (any) {
      EXPECT_EQ(any->a, enclosed.front());
    }
  }
  else if (any) {
    EXPECT_TRUE(std::binary_search(enclosed.begin(), enclosed.end(), any->a));
  }
}

TEST(Enclosure, OfRandomMeshesPointsAndTriangles)
{
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    SCOPED_TRACE(seed);
    const int steps = seed % 3 == 0 ? 4 : 64; // on a coarse lattice most share corners
    const Mesh mesh = test::latticeMesh(6, steps, seed), other = test::latticeMesh(4, steps, seed + 100);
    const std::vector<double> points = test::pointsAbout(mesh, 200, 0.3, seed);
    expectExact(mesh, viewOf(points.data(), 200));
    expectExact(mesh, viewOf(other.view()));
    expectExact(mesh, viewOf(other.view()), poseOf(0.4, {0.1, 0, 0}), poseOf(-0.3, {0, 0.1, 0}));
    const std::vector<std::int32_t> some = {7, 3, 3, 12, 5};
    for (PointsView part : {viewOf(points.data(), 200), viewOf(other.view())}) {
      part.restrictTo(some.data(), some.size());
      expectExact(mesh, part);
    }
  }
}

TEST(Enclosure, AHollowHoldsNothing)
{
  Mesh tank;
  tank.add(test::boxMesh(), 4.0);
  tank.add(test::boxMesh(), 2.0, {1, 1, 1}, true); // the hollow
  tank.add(test::boxMesh(), 0.5, {1.75, 1.75, 1.75});
  const std::vector<double> points = {1.5, 1.5, 1.5, 2, 2, 2, 0.5, 0.5, 0.5, 4, 4, 4};
  const Solid solid(tank.view());
  const SolidBodies bodies(solid);
  ASSERT_EQ(bodies.all().size(), 3u);
  const auto enclosed = [&](std::size_t i) {
    const SphereHierarchy cloud(viewOf(points.data() + 3 * i, 1));
    return enclosedBy(solid, QueriedRecords(cloud), identity);
  };
  const auto holders = [&](std::size_t i) {
    const SphereHierarchy cloud(viewOf(points.data() + 3 * i, 1));
    return holdersOf(bodies, identity, QueriedRecords(cloud), identity, enclosed(i));
  };
  EXPECT_THAT(enclosed(0), IsEmpty());
  EXPECT_THAT(enclosed(1), ElementsAre(0u));
  EXPECT_EQ(holders(1).size(), 36u); // it is inside all three, and the hollow turns none off
  EXPECT_EQ(holders(2), bodies.all()[0].triangles);
  EXPECT_THAT(enclosed(3), ElementsAre(0u)); // on the surface
  EXPECT_THAT(holders(3), IsEmpty());
  expectExact(tank, viewOf(points.data(), 4));
}

/// Triangles that lie farther apart in memory than their corners take.
TEST(Enclosure, BodiesOfTrianglesWithOtherNumbersBetweenThem)
{
  Mesh two;
  two.add(test::boxMesh(), 1.0);
  two.add(test::boxMesh(), 1.0, {3, 0, 0});
  TrianglesView view = two.view();
  struct Spaced {
    Triangle corners;
    std::uint32_t other = 0xffffffff;
  };
  std::vector<Spaced> spaced;
  for (std::uint32_t i = 0; i < view.count; ++i) spaced.push_back({view.cornersOf(i)});
  view.corners = spaced.front().corners.data();
  view.stride = sizeof(Spaced);
  const Solid solid(view);
  const SolidBodies bodies(solid);
  ASSERT_EQ(bodies.all().size(), 2u);
  const std::vector<double> point = {3.5, 0.5, 0.5};
  const SphereHierarchy cloud(viewOf(point.data(), 1));
  EXPECT_EQ(holdersOf(bodies, identity, QueriedRecords(cloud), identity, Records{0}), bodies.all()[1].triangles);
}

TEST(Enclosure, SoupOfTrianglesIsOfBodiesByItsPlaces)
{
  const Mesh box = test::boxMesh();
  Mesh soup;
  for (const double shift : {0.0, 3.0})
    for (std::uint32_t i = 0; i < box.view().count; ++i) {
      std::uint32_t corners[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const Point3 p = box.view().triangle(i)[k];
        corners[k] = soup.vertex(p[0] + shift, p[1], p[2] == 0.0 ? -0.0 : p[2]);
      }
      soup.triangle(corners[0], corners[1], corners[2]);
    }
  const std::uint32_t nan = soup.vertex(NAN, 0, 0);
  soup.triangle(nan, 0, 1);
  const Solid solid(soup.view());
  const SolidBodies bodies(solid);
  ASSERT_EQ(bodies.all().size(), 2u);
  EXPECT_EQ(bodies.all()[0].triangles.size(), 12u);
  EXPECT_EQ(bodies.all()[1].triangles.front(), 12u);
  const std::vector<double> point = {3.5, 0.5, 0.5};
  const SphereHierarchy cloud(viewOf(point.data(), 1));
  EXPECT_EQ(findEnclosed(bodies, identity, QueriedRecords(cloud), identity)->b, 12u);
}

TEST(Enclosure, NothingEnclosesARecordWithoutAPlace)
{
  const Mesh box = test::boxMesh();
  const Solid solid(box.view());
  const SolidBodies bodies(solid);
  Mesh nothing;
  const std::uint32_t nan = nothing.vertex(NAN, 0, 0), loose = nothing.vertex(0.5, 0.5, 0.5);
  nothing.triangle(nan, nan, loose);
  const SphereHierarchy hierarchy(viewOf(nothing.view()));
  const QueriedRecords queried(hierarchy);
  EXPECT_THAT(enclosedBy(solid, queried, identity), IsEmpty());
  EXPECT_FALSE(findEnclosed(bodies, identity, queried, identity));
}

TEST(Enclosure, VerdictsOfUncertainPlaces)
{
  const Mesh box = test::boxMesh();
  const Solid solid(box.view());
  const SolidBodies bodies(solid);
  const std::vector<double> points = {0.5, 0.5, 0.5, 0.9, 0.5, 0.5, 2, 2, 2};
  const SphereHierarchy cloud(viewOf(points.data(), 3));
  const QueriedRecords queried(cloud);
  const Records enclosed = enclosedBy(solid, queried, identity);
  std::vector<Verdict> of_points = test::verdictsOf({0, 2, 0}), of_box(12, Verdict::free);
  addEnclosed(bodies, identity, queried, identity, enclosed, true, of_points, of_box);
  EXPECT_EQ(of_points, test::verdictsOf({1, 2, 0}));
  EXPECT_EQ(of_box, std::vector<Verdict>(12, Verdict::colliding));
  of_points = test::verdictsOf({2, 2, 0}), of_box.assign(12, Verdict::free);
  addEnclosed(bodies, identity, queried, identity, enclosed, true, of_points, of_box);
  EXPECT_EQ(of_points, test::verdictsOf({2, 2, 0}));
  EXPECT_EQ(of_box, std::vector<Verdict>(12, Verdict::undecided));
  addEnclosed(bodies, identity, queried, identity, enclosed, false, of_points, of_box);
  EXPECT_EQ(of_points, test::verdictsOf({1, 1, 0}));
  EXPECT_EQ(of_box, std::vector<Verdict>(12, Verdict::colliding));
}

} // namespace
} // namespace pcl_bsh
