// SPDX-License-Identifier: BSD-3-Clause
// Both filters where the obstacle is a mesh of PCL.
#include <pcl_bsh/filters/collision_filter.h>
#include <pcl_bsh/filters/distance_filter.h>
#include <pcl_bsh/filters/mesh_collision_filter.h>

#include "clouds.h"
#include "support/verdicts.h"
#include <pcl_bsh/geometry/triangle/triangle_distance.h>

#include <pcl/PolygonMesh.h>
#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace pcl_bsh {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

using Points = pcl::PointCloud<pcl::PointXYZ>;

/// A crate from the origin to (2, 2, 2), of eight corners and six squares.
pcl::PolygonMesh::Ptr crate()
{
  Points corners;
  for (int k = 0; k < 8; ++k)
    corners.emplace_back(2.f * static_cast<float>(k & 1), 2.f * static_cast<float>(k >> 1 & 1),
                         2.f * static_cast<float>(k >> 2));
  auto mesh = std::make_shared<pcl::PolygonMesh>();
  pcl::toPCLPointCloud2(corners, mesh->cloud);
  for (const auto& square :
       std::vector<pcl::Indices>{{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}) {
    mesh->polygons.emplace_back();
    mesh->polygons.back().vertices = square;
  }
  return mesh;
}

double distanceToCrate(const pcl::PointXYZ& p)
{
  const Eigen::Vector3d outside =
      (p.getVector3fMap().cast<double>().array() - 1).abs().matrix() - Eigen::Vector3d::Ones();
  return outside.maxCoeff() > 0 ? outside.cwiseMax(0).norm() : -outside.maxCoeff();
}

Triangle3 cornersOf(const pcl::PolygonMesh& mesh, const Triangle& triangle)
{
  const PointsView vertices = viewOf(mesh.cloud);
  return {vertices.point(triangle[0]), vertices.point(triangle[1]), vertices.point(triangle[2])};
}

Points::Ptr scanAround(unsigned seed, int count)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-0.5f, 2.5f);
  auto scan = std::make_shared<Points>();
  for (int i = 0; i < count; ++i) scan->emplace_back(place(random), place(random), place(random));
  return scan;
}

TEST(SurfaceFilter, FlagsWhatIsNearTheFaces)
{
  constexpr double clearance = 0.1;
  const Points::Ptr scan = scanAround(1, 4000);
  scan->emplace_back(1.f, 1.f, 2.125f); // ties: the clearance of 1/8 below
  scan->emplace_back(1.f, 1.f, std::nextafter(2.125f, 3.f));
  CollisionFilter<pcl::PointXYZ> filter;
  filter.setInputCloud(scan);
  filter.setObstacleSurface(crate());
  filter.setClearance(clearance);
  std::vector<Verdict> flags;
  filter.computeFlags(flags);
  for (std::size_t i = 0; i < scan->size(); ++i) {
    const double distance = distanceToCrate((*scan)[i]);
    if (std::abs(distance - clearance) > 1e-12) {
      ASSERT_EQ(flags[i], distance < clearance ? Verdict::colliding : Verdict::free) << i;
    }
  }
  filter.setClearance(0.125);
  filter.computeFlags(flags);
  EXPECT_EQ(flags[4000], Verdict::colliding) << "touching counts";
  EXPECT_EQ(flags[4001], Verdict::free);

  // Each copy keeps it; a cloud replaces it.
  CollisionFilter<pcl::PointXYZ> copy(filter);
  std::vector<Verdict> again;
  copy.computeFlags(again);
  EXPECT_EQ(again, flags);
  auto corners = std::make_shared<pcl::PCLPointCloud2>(crate()->cloud);
  filter.setObstacleCloud(corners);
  filter.computeFlags(flags);
  EXPECT_LT(std::count(flags.begin(), flags.end(), Verdict::colliding), 40);
}

TEST(SurfaceFilter, FollowsAPathAndNamesTriangles)
{
  auto scan = std::make_shared<Points>();
  scan->emplace_back(1.f, 0.5f, 5.0625f);
  scan->emplace_back(1.f, 0.5f, 3.f);
  const pcl::PolygonMesh::Ptr mesh = crate();
  CollisionFilter<pcl::PointXYZ> filter;
  filter.setInputCloud(scan);
  filter.setObstacleSurface(mesh);
  filter.setClearance(0.1);
  Eigen::Isometry3d up = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k < 4; ++k) {
    poses.push_back(up);
    up.translation().z() += 1;
  }
  filter.setTrajectory(poses);
  TrajectoryResult result;
  filter.computeTrajectory(result);
  EXPECT_EQ(result.flags, test::verdictsOf({1, 1}));
  EXPECT_THAT(result.first_pose, ElementsAre(3, 1));
  EXPECT_EQ(result.distance[0], 0.0625f);
  EXPECT_EQ(result.distance[1], 0.f);
  EXPECT_EQ(result.poses[1].distance, 0.0);
  EXPECT_EQ(trianglesOf(*mesh).polygons.at(result.closest_point[0]), 1u) << "the square on top of the crate";
}

TEST(SurfaceFilter, TellsDistances)
{
  const Points::Ptr scan = scanAround(2, 3000);
  scan->emplace_back(1.f, 1.f, 2.f);
  scan->emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.f, 0.f);
  DistanceFilter<pcl::PointXYZ> filter;
  filter.setInputCloud(scan);
  filter.setObstacleSurface(crate());
  PointDistances found;
  filter.computeDistances(found);
  for (std::size_t i = 0; i + 1 < scan->size(); ++i)
    ASSERT_NEAR(found.distance[i], distanceToCrate((*scan)[i]), 1e-15) << i;
  EXPECT_EQ(found.distance[3000], 0.0);
  for (const auto& [least, most] : {std::pair{0.0, 0.0}, std::pair{0.0, 0.2}, std::pair{0.1, 0.2}}) {
    filter.setFilterLimits(least, most);
    pcl::Indices kept, expected;
    filter.filter(kept);
    for (std::size_t i = 0; i + 1 < scan->size(); ++i)
      if (found.distance[i] >= least && found.distance[i] <= most) expected.push_back(static_cast<pcl::index_t>(i));
    EXPECT_EQ(kept, expected) << least << ' ' << most;
    EXPECT_FALSE(kept.empty());
  }
  filter.setAccuracy(Accuracy::tolerance(0.05));
  filter.computeDistances(found);
  for (std::size_t i = 0; i + 1 < scan->size(); ++i) {
    const double distance = distanceToCrate((*scan)[i]);
    ASSERT_LE(found.interval[i].lower, distance + 1e-15) << i;
    ASSERT_GE(found.interval[i].upper, distance - 1e-15) << i;
  }
}

/// A mesh in the caller's own arrays is the same obstacle, and watched alike.
TEST(SurfaceFilter, OfTrianglesAnywhere)
{
  std::vector<float> xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  auto scan = std::make_shared<Points>();
  scan->emplace_back(0.25f, 0.25f, 0.5f);
  CollisionFilter<pcl::PointXYZ> filter;
  filter.setInputCloud(scan);
  filter.setObstacleSurface(TrianglesView{viewOf(xyz.data(), 3), triangles[0].data(), 1});
  filter.setClearance(0.5);
  std::vector<Verdict> flags;
  filter.computeFlags(flags);
  EXPECT_EQ(flags, test::verdictsOf({1}));
  xyz[8] = 1;
  EXPECT_THAT([&] { filter.computeFlags(flags); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("the obstacle: has changed since it was set")));
}

/// Polygons that are asked about, against the crate: whether any of their triangles is near any of its.
TEST(MeshFilter, FlagsPolygonsAndKeepsThem)
{
  constexpr double clearance = 0.1;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-1.f, 3.f), side(-0.2f, 0.2f);
  Points corners;
  auto mesh = std::make_shared<pcl::PolygonMesh>();
  for (int p = 0; p < 300; ++p) { // parallelograms, of four corners each
    const Eigen::Vector3f at(place(random), place(random), place(random));
    const Eigen::Vector3f u(side(random), side(random), side(random)), v(side(random), side(random), side(random));
    mesh->polygons.emplace_back();
    for (const Eigen::Vector3f& corner :
         {at, Eigen::Vector3f(at + u), Eigen::Vector3f(at + u + v), Eigen::Vector3f(at + v)}) {
      mesh->polygons.back().vertices.push_back(static_cast<pcl::index_t>(corners.size()));
      corners.emplace_back(corner.x(), corner.y(), corner.z());
    }
  }
  pcl::toPCLPointCloud2(corners, mesh->cloud);
  mesh->header.frame_id = "map";
  MeshCollisionFilter filter;
  filter.setInputMesh(mesh);
  filter.setObstacleSurface(crate());
  filter.setClearance(clearance);
  std::vector<Verdict> flags;
  filter.computeFlags(flags);
  ASSERT_EQ(flags.size(), 300u);
  TrajectoryResult found;
  filter.computeTrajectory(found);
  EXPECT_EQ(found.flags, flags);
  const pcl::PolygonMesh::Ptr box = crate();
  const MeshTriangles of_mesh = trianglesOf(*mesh), of_crate = trianglesOf(*box);
  const TriangleDistance distance(Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity());
  std::size_t colliding = 0;
  for (std::size_t p = 0; p < flags.size(); ++p) {
    const bool near = std::any_of(of_mesh.triangles.begin(), of_mesh.triangles.end(), [&](const Triangle& t) {
      if (of_mesh.polygons[static_cast<std::size_t>(&t - of_mesh.triangles.data())] != p) return false;
      return std::any_of(of_crate.triangles.begin(), of_crate.triangles.end(), [&](const Triangle& u) {
        return distance.compare(cornersOf(*mesh, t), cornersOf(*box, u), clearance) <= 0;
      });
    });
    ASSERT_EQ(flags[p], near ? Verdict::colliding : Verdict::free) << p;
    colliding += flags[p] == Verdict::colliding;
  }
  EXPECT_GT(colliding, 20u);
  EXPECT_LT(colliding, 280u);
  for (const bool negative : {false, true}) {
    filter.setNegative(negative);
    pcl::PolygonMesh kept;
    filter.filter(kept);
    ASSERT_EQ(kept.polygons.size(), negative ? colliding : 300 - colliding);
    EXPECT_EQ(kept.header.frame_id, "map");
    EXPECT_EQ(kept.cloud.width, 4 * kept.polygons.size());
    Points left;
    pcl::fromPCLPointCloud2(kept.cloud, left);
    std::size_t next = 0;
    for (std::size_t p = 0; p < flags.size(); ++p) {
      if ((flags[p] != Verdict::free) != negative) continue;
      const pcl::Vertices& polygon = kept.polygons[next++];
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_EQ(left[static_cast<std::size_t>(polygon.vertices[k])].x, corners[4 * p + k].x);
    }
  }
}

TEST(MeshFilter, AMeshThatHasChangedIsNotAskedAbout)
{
  const pcl::PolygonMesh::Ptr mesh = crate();
  auto one_side = std::make_shared<Points>();
  one_side->emplace_back(1.f, 1.f, 2.f);
  MeshCollisionFilter filter;
  filter.setInputMesh(mesh);
  filter.setObstacleCloud(one_side);
  filter.setClearance(0.05);
  std::vector<Verdict> flags;
  filter.computeFlags(flags);
  EXPECT_EQ(flags, test::verdictsOf({0, 1, 0, 0, 0, 0}));
  filter.filter(*mesh); // writes over its input
  EXPECT_EQ(mesh->polygons.size(), 5u);
  const auto refused = [](const auto& call) {
    EXPECT_THAT(call, ThrowsMessage<std::invalid_argument>(
                          HasSubstr("input mesh has changed since setInputMesh(): call it again")));
  };
  TrajectoryResult found;
  refused([&] { filter.filter(*mesh); });
  refused([&] { filter.computeFlags(flags); });
  refused([&] { filter.computeTrajectory(found); });
  EXPECT_EQ(mesh->polygons.size(), 5u);
  filter.setInputMesh(mesh);
  filter.computeFlags(flags);
  EXPECT_EQ(flags, test::verdictsOf({0, 0, 0, 0, 0}));
  std::swap(mesh->polygons[0].vertices[0], mesh->polygons[0].vertices[1]); // vertices alone stay
  refused([&] { filter.computeFlags(flags); });
  std::swap(mesh->polygons[0].vertices[0], mesh->polygons[0].vertices[1]);
  EXPECT_NO_THROW(filter.computeFlags(flags)) << "as it was";
  pcl::Indices &first = mesh->polygons[0].vertices, &second = mesh->polygons[1].vertices;
  second.insert(second.begin(), first.back()); // the same vertices one after another, divided otherwise
  first.pop_back();
  refused([&] { filter.computeFlags(flags); });
}

TEST(MeshFilter, HoldsWhatItsInputEncloses)
{
  auto mesh = std::make_shared<pcl::PolygonMesh>(); // a tetrahedron, and a point within
  for (const auto& corners : {pcl::Indices{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}) {
    mesh->polygons.emplace_back();
    mesh->polygons.back().vertices = corners;
  }
  Points corners;
  for (const auto& [x, y, z] : {std::tuple(0.f, 0.f, 0.f), {9.f, 0.f, 0.f}, {0.f, 9.f, 0.f}, {0.f, 0.f, 9.f}})
    corners.emplace_back(x, y, z);
  pcl::toPCLPointCloud2(corners, mesh->cloud);
  auto inside = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  inside->emplace_back(1.f, 1.f, 1.f);
  MeshCollisionFilter filter;
  filter.setInputMesh(mesh);
  filter.setObstacleCloud(inside);
  filter.setClearance(0.1);
  std::vector<Verdict> flags;
  for (const bool solid : {false, true}) {
    filter.setInputSolid(solid);
    filter.computeFlags(flags);
    EXPECT_EQ(flags, std::vector<Verdict>(4, solid ? Verdict::colliding : Verdict::free));
  }
}

TEST(MeshFilter, RefusesWhatIsNoInput)
{
  MeshCollisionFilter filter;
  std::vector<Verdict> flags;
  pcl::PolygonMesh kept;
  const auto refused = [](const auto& call, const std::string& text) {
    EXPECT_THAT(call, ThrowsMessage<std::invalid_argument>(HasSubstr(text)));
  };
  filter.setObstacleCloud(scanAround(6, 100));
  refused([&] { filter.computeFlags(flags); }, "input mesh is missing");
  refused([&] { filter.filter(kept); }, "input mesh is missing: call setInputMesh() before filtering");
  refused([&] { filter.setInputMesh(nullptr); }, "input mesh is null");
  const std::vector<float> xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 1, 1}};
  filter.setInputSurface(TrianglesView{viewOf(xyz.data(), 3), triangles[0].data(), 2});
  filter.computeFlags(flags);
  EXPECT_EQ(flags.size(), 2u) << "triangles";
  refused([&] { filter.filter(kept); }, "a list of triangles is no mesh to keep of: call setInputMesh()");
  filter.setInputMesh(crate());
  filter.setDensityGuard(true);
  refused([&] { filter.filter(kept); }, "density: is about points");
  filter.setDensityGuard(false);
  filter.setInputUncertainty(Uncertainty("sigma", 1));
  refused([&] { filter.filter(kept); }, "sigma");
  filter.setInputUncertainty(0.01);
  filter.filter(kept);
  MeshCollisionFilter bare;
  bare.setInputMesh(crate());
  refused([&] { bare.computeFlags(flags); }, "obstacle cloud is missing");
}

TEST(SurfaceFilter, HasNoHolesToGuard)
{
  const Points::Ptr scan = scanAround(3, 500);
  CollisionFilter<pcl::PointXYZ> filter;
  filter.setInputCloud(scan);
  filter.setObstacleSurface(crate());
  filter.setClearance(0.1);
  std::vector<Verdict> plain, guarded;
  filter.computeFlags(plain);
  filter.setDensityGuard(true);
  filter.computeFlags(guarded);
  EXPECT_EQ(plain, guarded);
  EXPECT_EQ(filter.getSparseCount(), 0u);
  filter.setDensityGuard(false);
  filter.setObstacleUncertainty(0.01); // of the surface as a whole
  filter.computeFlags(guarded);
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const double distance = distanceToCrate((*scan)[i]);
    const Verdict expected = distance <= 0.09   ? Verdict::colliding
                             : distance <= 0.11 ? Verdict::undecided
                                                : Verdict::free;
    if (std::abs(distance - 0.09) > 1e-12 && std::abs(distance - 0.11) > 1e-12) {
      ASSERT_EQ(guarded[i], expected) << i;
    }
  }
}

TEST(SurfaceFilter, RefusesWhatIsNoSurface)
{
  CollisionFilter<pcl::PointXYZ> filter;
  const auto refused = [&](const pcl::PolygonMesh::ConstPtr& mesh, const std::string& text) {
    EXPECT_THAT([&] { filter.setObstacleSurface(mesh); }, ThrowsMessage<std::invalid_argument>(HasSubstr(text)));
  };
  refused(nullptr, "surface is null");
  auto mesh = crate();
  mesh->polygons[2].vertices[1] = 8;
  refused(mesh, "a face names vertex 8 (from 0), of 8");
  mesh->polygons[2].vertices[1] = -1;
  refused(mesh, "a face names vertex 4294967295 (from 0), of 8");
  Points corners;
  pcl::fromPCLPointCloud2(mesh->cloud, corners);
  // Nothing is near no surface.
  auto nothing = std::make_shared<pcl::PolygonMesh>();
  pcl::toPCLPointCloud2(corners, nothing->cloud);
  filter.setObstacleSurface(nothing);
  filter.setInputCloud(scanAround(4, 10));
  pcl::Indices free;
  filter.filter(free);
  EXPECT_EQ(free.size(), 10u);
}

} // namespace
} // namespace pcl_bsh
