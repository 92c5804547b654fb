// SPDX-License-Identifier: BSD-3-Clause
// Verdicts and distances of surfaces, as obstacle and as what is asked about, against CGAL's exact distances.
#include "support/made_meshes.h"

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/squared_distance_3.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#ifdef PCL_BSH_PROGRAM_DIR
#include "support/temporary_folder.h"
#endif

namespace pcl_bsh {
namespace {

using Kernel = CGAL::Simple_cartesian<CGAL::Exact_rational>;
using Number = Kernel::FT;

Kernel::Point_3 exact(const Point3& p)
{
  return {p[0], p[1], p[2]};
}

std::vector<Kernel::Point_3> exact(const std::vector<Point3>& points)
{
  std::vector<Kernel::Point_3> places;
  for (const Point3& p : points) places.push_back(exact(p));
  return places;
}

std::vector<Kernel::Triangle_3> exact(const test::TestMesh& mesh)
{
  std::vector<Kernel::Triangle_3> triangles;
  for (const Triangle& t : mesh.triangles)
    triangles.emplace_back(exact(mesh.vertices[t[0]]), exact(mesh.vertices[t[1]]), exact(mesh.vertices[t[2]]));
  return triangles;
}

/// As CGAL takes triangles: it takes none without area.
void dropFlat(test::TestMesh& mesh)
{
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return CGAL::collinear(exact(mesh.vertices[t[0]]), exact(mesh.vertices[t[1]]), exact(mesh.vertices[t[2]]));
  });
}

/// Triangles with area, some thin; those of uneven seeds in UTM coordinates.
test::TestMesh triangles(std::uint64_t seed, int count)
{
  test::TestMesh mesh = test::soup(seed, count, 1.0, 0.6);
  if (seed % 2 == 1) {
    Eigen::Isometry3d utm = Eigen::Isometry3d::Identity();
    utm.translation() << 513449.75, 5402650.25, 300.125;
    mesh.move(utm);
  }
  dropFlat(mesh);
  return mesh;
}

/// For each thing, the least squared distance to any of the others.
template <typename Things, typename Others>
std::vector<Number> squaredDistances(const Things& things, const Others& others)
{
  std::vector<Number> least;
  for (const auto& thing : things) {
    Number best = CGAL::squared_distance(thing, others.front());
    for (const auto& other : others) best = std::min(best, Number(CGAL::squared_distance(thing, other)));
    least.push_back(best);
  }
  return least;
}

/// Whether a double is what the root of this square is rounded to.
bool isRootOf(double distance, const Number& squared)
{
  const double below = std::nextafter(distance, -1.0), above = std::nextafter(distance, 1e300);
  const Number low = (Number(distance) + Number(below)) / 2, high = (Number(distance) + Number(above)) / 2;
  return (distance == 0.0 || squared >= CGAL::square(low)) && squared <= CGAL::square(high);
}

struct Counts {
  int colliding = 0, free = 0;
};

/// Flags and distances of a's records from b at one pose, against the squares of the true distances.
void expectTrue(const SphereHierarchy& a, const SphereHierarchy& b, double clearance,
                const std::vector<Number>& squared, Counts& counts)
{
  FlagsRequest question;
  question.clearance = clearance;
  const FlagsResult flags = collisionFlags({a}, {b}, question);
  const PointDistances distances = pointDistances({a}, {b});
  ASSERT_EQ(flags.a.size(), squared.size());
  for (std::size_t i = 0; i < squared.size(); ++i) {
    const bool collides = squared[i] <= CGAL::square(Number(clearance));
    EXPECT_EQ(flags.a[i], (collides ? Verdict::colliding : Verdict::free)) << i;
    EXPECT_TRUE(isRootOf(distances.distance[i], squared[i])) << i << ": " << distances.distance[i];
    ++(collides ? counts.colliding : counts.free);
  }
}

/// A point within some reach of a random point of the mesh.
Point3 near(const test::TestMesh& mesh, double reach, test::Random& random)
{
  const Triangle& t =
      mesh.triangles[static_cast<std::size_t>(random.integer(0, static_cast<int>(mesh.triangles.size()) - 1))];
  double u = random.uniform(0, 1), v = random.uniform(0, 1);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  const Point3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  Point3 p;
  for (std::size_t k = 0; k < 3; ++k)
    p[k] = a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]) + random.uniform(-reach, reach);
  return p;
}

void expectTrueOfPoints(test::TestMesh mesh, std::uint64_t seed)
{
  test::Random random(seed);
  Eigen::Isometry3d frame = random.pose(1.0);
  if (seed % 3 == 0) frame.translation() += Eigen::Vector3d(513449.7, 5402650.2, 300.1);
  mesh.move(frame);
  dropFlat(mesh);
  const double clearance = random.pick({0.03, 0.1, 0.2});
  std::vector<Point3> scan;
  for (int i = 0; i < 200; ++i) scan.push_back(near(mesh, 1.2 * clearance, random));
  Counts counts;
  expectTrue(SphereHierarchy(viewOf(scan[0].data(), scan.size())), SphereHierarchy(viewOf(mesh.trianglesView())),
             clearance, squaredDistances(exact(scan), exact(mesh)), counts);
  EXPECT_GT(counts.colliding, 20);
  EXPECT_GT(counts.free, 5);
}

TEST(SurfaceQueries, OfPointsAboutMeshes)
{
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    expectTrueOfPoints(test::soup(seed, 30, 1.0, 0.5), seed);
  }
  expectTrueOfPoints(test::boxMesh(1, 0.5, 0.1), 20);
  expectTrueOfPoints(test::boxMesh(1, 1, 0.001), 21);
  expectTrueOfPoints(test::sphereMesh(0.7, 12), 22);
  expectTrueOfPoints(test::gridMesh(12, 10,
                                    [](double u, double v) -> Point3 {
                                      return {u, v, 0.05 * std::sin(20 * u) * std::cos(15 * v)};
                                    }),
                     24);
}

TEST(SurfaceQueries, OfTrianglesAboutPoints)
{
  Counts counts;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(100 + seed);
    const test::TestMesh part = triangles(seed, 40), around = triangles(seed + 50 * 2, 12);
    expectTrue(SphereHierarchy(viewOf(part.trianglesView())), SphereHierarchy(around.view()), random.pick({0.05, 0.2}),
               squaredDistances(exact(part), exact(around.vertices)), counts);
  }
  EXPECT_GT(counts.colliding, 10);
  EXPECT_GT(counts.free, 10);
}

TEST(SurfaceQueries, OfTrianglesAboutTriangles)
{
  Counts counts;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    const test::TestMesh part = triangles(seed, 24), around = triangles(seed + 50 * 2, 30);
    expectTrue(SphereHierarchy(viewOf(part.trianglesView())), SphereHierarchy(viewOf(around.trianglesView())),
               0.1 * static_cast<double>(seed % 4), squaredDistances(exact(part), exact(around)), counts);
  }
  EXPECT_GT(counts.colliding, 10);
  EXPECT_GT(counts.free, 10);
}

TEST(SurfaceQueries, OfTrianglesAlongAPath)
{
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    const test::TestMesh part = triangles(2 * seed, 30), tool = triangles(2 * seed + 20, 2);
    std::vector<Eigen::Isometry3d> poses;
    std::vector<std::vector<Number>> squared; // of each pose
    for (int k = 0; k < 6; ++k) {
      poses.push_back(Eigen::Isometry3d::Identity());
      poses.back().translation().x() = 0.25 * (k - 3); // exact
      std::vector<Kernel::Point_3> points;
      for (const Point3& p : tool.vertices)
        points.emplace_back(Number(p[0]) + Number(poses.back().translation().x()), Number(p[1]), Number(p[2]));
      squared.push_back(squaredDistances(exact(part), points));
    }
    TrajectoryRequest request;
    request.clearance = 0.125;
    request.distances = request.first_poses = request.closest_poses = true;
    const TrajectoryResult run =
        collideAlong({SphereHierarchy(viewOf(part.trianglesView()))}, SphereHierarchy(tool.view()), poses, request);
    for (std::size_t t = 0; t < part.triangles.size(); ++t) {
      std::int32_t first = -1, closest = -1;
      for (std::size_t k = 0; k < poses.size(); ++k) {
        if (squared[k][t] > CGAL::square(Number(request.clearance))) continue;
        const auto pose = static_cast<std::int32_t>(k);
        if (first < 0) first = pose;
        if (closest < 0 || squared[k][t] < squared[static_cast<std::size_t>(closest)][t]) closest = pose;
      }
      EXPECT_EQ(run.flags[t], (first >= 0 ? Verdict::colliding : Verdict::free)) << t;
      EXPECT_EQ(run.first_pose[t], first) << t;
      EXPECT_EQ(run.closest_pose[t], closest) << t;
    }
  }
}

#ifdef PCL_BSH_PROGRAM_DIR

std::string textOf(const Point3& p)
{
  char text[96];
  std::snprintf(text, sizeof text, "%.17g %.17g %.17g\n", p[0], p[1], p[2]);
  return text;
}

/// The output of pcl_bsh_collide for a mesh and points near it, in files.
void expectTrueOutput(test::TestMesh mesh, double clearance, std::uint64_t seed)
{
  dropFlat(mesh);
  test::Random random(seed);
  std::vector<Point3> scan;
  for (int i = 0; i < 300; ++i) scan.push_back(near(mesh, 1.2 * clearance, random));
  std::string points, file;
  for (const Point3& p : scan) points += textOf(p);
  for (const Point3& p : mesh.vertices) file += "v " + textOf(p);
  for (const Triangle& t : mesh.triangles) {
    for (const char* separator = "f "; const std::uint32_t vertex : t) {
      file += separator + std::to_string(vertex + 1);
      separator = " ";
    }
    file += '\n';
  }
  const files::TemporaryFolder folder;
  folder.write("scan.xyz", points);
  folder.write("mesh.obj", file);
  std::ostringstream command;
  command << "cd " << folder.path().string() << " && " << PCL_BSH_PROGRAM_DIR
          << "/pcl_bsh_collide scan.xyz mesh.obj out.csv --distances --clearance " << clearance << " >said 2>&1";
  ASSERT_EQ(std::system(command.str().c_str()), 0) << files::contentOf(folder / "said");
  std::ifstream out(folder / "out.csv");
  std::string line;
  std::getline(out, line);
  ASSERT_EQ(line, "x,y,z,collision,distance");

  const std::vector<Number> squared = squaredDistances(exact(scan), exact(mesh));
  constexpr double rounding = 2e-7; // of a float, in text
  Counts counts;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    ASSERT_TRUE(std::getline(out, line));
    const std::string results = line.substr(line.rfind(',', line.rfind(',') - 1) + 1);
    const bool collides = results[0] == '1';
    ASSERT_EQ(collides, squared[i] <= CGAL::square(Number(clearance))) << i;
    const double truth = std::sqrt(CGAL::to_double(squared[i]));
    ASSERT_NEAR(std::stod(results.substr(2)), truth, truth * rounding + 1e-300) << i;
    ++(collides ? counts.colliding : counts.free);
  }
  EXPECT_GT(counts.colliding, 10);
  EXPECT_GT(counts.free, 10);
}

TEST(SurfaceQueries, OfFilesThatTheProgramReads)
{
  Eigen::Isometry3d utm = Eigen::Isometry3d::Identity();
  utm.translation() << 513449.7, 5402650.2, 300.1;
  test::TestMesh far = test::boxMesh(2, 2, 2);
  far.move(utm);
  test::TestMesh far_soup = test::soup(5, 25, 1.0, 0.5);
  far_soup.move(utm);
  expectTrueOutput(test::boxMesh(2, 2, 2), 0.1, 1);
  expectTrueOutput(far, 0.02, 2);
  expectTrueOutput(test::boxMesh(3, 1, 0.0001), 0.05, 3);
  expectTrueOutput(test::boxMesh(1e-6, 2e-6, 1e-6), 1e-7, 4);
  expectTrueOutput(test::soup(4, 25, 1.0, 0.5), 0.1, 5);
  expectTrueOutput(far_soup, 0.1, 6);
  expectTrueOutput(test::sphereMesh(0.7, 16), 0.0625, 7);
}

#endif

} // namespace
} // namespace pcl_bsh
