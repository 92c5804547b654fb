// SPDX-License-Identifier: BSD-3-Clause
// Verdicts about covered surfaces against CGAL's exact distances from points to triangles.
#include "../surface/meshes.h"

#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/surface/surface_cover.h>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>

#include <gtest/gtest.h>

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
#include "support/verdicts.h"
#endif

namespace pcl_bsh {
namespace {

using Kernel = CGAL::Simple_cartesian<CGAL::Exact_rational>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Tree =
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>>;

Kernel::Point_3 exact(const Point3& p)
{
  return {p[0], p[1], p[2]};
}

/// A point within some clearances of a random point of the mesh.
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

/// As CGAL's tree takes triangles: it takes none without area, which test/surface has.
void dropFlat(test::TestMesh& mesh)
{
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return CGAL::collinear(exact(mesh.vertices[t[0]]), exact(mesh.vertices[t[1]]), exact(mesh.vertices[t[2]]));
  });
}

Triangles trianglesOf(const test::TestMesh& mesh)
{
  Triangles triangles;
  for (const Triangle& t : mesh.triangles)
    triangles.emplace_back(exact(mesh.vertices[t[0]]), exact(mesh.vertices[t[1]]), exact(mesh.vertices[t[2]]));
  return triangles;
}

/// Free only farther than the clearance, colliding only within clearance + tolerance: of the mesh, in exact arithmetic.
void expectTrueVerdicts(test::TestMesh mesh, std::uint64_t seed)
{
  test::Random random(seed);
  Eigen::Isometry3d frame = random.pose(1.0);
  if (seed % 3 == 0) frame.translation() += Eigen::Vector3d(513449.7, 5402650.2, 300.1);
  mesh.move(frame);
  dropFlat(mesh);
  SurfaceRequest request;
  request.tolerance = std::pow(10.0, random.uniform(-2, -0.5));
  request.triangles_apart = seed % 2 == 0;
  const double clearance = random.pick({0.0, 0.5, 3.0}) * request.tolerance;
  const SurfaceCover cover = coverSurface(mesh.view(), mesh.triangles, request);
  std::vector<Point3> scan;
  for (int i = 0; i < 400; ++i) scan.push_back(near(mesh, 1.2 * (clearance + request.tolerance), random));
  const SphereHierarchy surface(cover.view()), points(viewOf(scan[0].data(), scan.size()));
  FlagsRequest question;
  question.clearance = clearance;
  const FlagsResult flags = collisionFlags({points}, {surface}, question);

  const Triangles triangles = trianglesOf(mesh);
  const Tree tree(triangles.begin(), triangles.end());
  const Kernel::FT least = Kernel::FT(clearance) * clearance;
  const Kernel::FT most = CGAL::square(Kernel::FT(clearance) + request.tolerance);
  int close = 0, between = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Kernel::FT squared = tree.squared_distance(exact(scan[i]));
    if (squared <= least) {
      ASSERT_EQ(flags.a[i], Verdict::colliding) << i;
      ++close;
    }
    else if (squared <= most) {
      ++between;
    }
    else {
      ASSERT_EQ(flags.a[i], Verdict::free) << i;
    }
  }
  EXPECT_GT(between, 0);
  EXPECT_TRUE(close > 0 || clearance == 0);
}

TEST(SurfaceDistance, OfRandomMeshes)
{
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    expectTrueVerdicts(test::soup(seed, 30, 1.0, 0.5), seed);
  }
}

TEST(SurfaceDistance, OfBoxesSpheresAndWaves)
{
  expectTrueVerdicts(test::boxMesh(1, 0.5, 0.1), 20);
  expectTrueVerdicts(test::boxMesh(1, 1, 0.001), 21);
  expectTrueVerdicts(test::sphereMesh(0.7, 24), 22);
  expectTrueVerdicts(test::gridMesh(40, 30,
                                    [](double u, double v) -> Point3 {
                                      return {u, v, 0.05 * std::sin(20 * u) * std::cos(15 * v)};
                                    }),
                     24);
}

#ifdef PCL_BSH_PROGRAM_DIR

std::string textOf(const Point3& p)
{
  char text[96];
  std::snprintf(text, sizeof text, "%.17g %.17g %.17g\n", p[0], p[1], p[2]);
  return text;
}

/// What pcl_bsh_collide writes of a mesh and points near it, in files.
void expectTrueOutput(test::TestMesh mesh, double tolerance, double clearance, std::uint64_t seed)
{
  dropFlat(mesh);
  test::Random random(seed);
  std::vector<Point3> scan;
  for (int i = 0; i < 300; ++i) scan.push_back(near(mesh, 1.2 * (clearance + tolerance), random));
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
          << "/pcl_bsh_collide scan.xyz mesh.obj out.csv --distances --clearance " << clearance
          << " --surface-tolerance " << tolerance << " >said 2>&1";
  ASSERT_EQ(std::system(command.str().c_str()), 0) << files::contentOf(folder / "said");
  std::ifstream out(folder / "out.csv");
  std::string line;
  std::getline(out, line);
  ASSERT_EQ(line, "x,y,z,collision,distance");

  const Triangles triangles = trianglesOf(mesh);
  const Tree tree(triangles.begin(), triangles.end());
  const Kernel::FT least = Kernel::FT(clearance) * clearance;
  const Kernel::FT most = CGAL::square(Kernel::FT(clearance) + tolerance);
  constexpr double rounding = 1e-7; // of a float
  int colliding = 0, free = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    ASSERT_TRUE(std::getline(out, line));
    const std::string results = line.substr(line.rfind(',', line.rfind(',') - 1) + 1);
    const bool collides = results[0] == '1';
    const double distance = std::stod(results.substr(2));
    const Kernel::FT squared = tree.squared_distance(exact(scan[i]));
    ASSERT_FALSE(collides ? squared > most : squared <= least) << i;
    const double truth = std::sqrt(CGAL::to_double(squared));
    ASSERT_GE(distance, 0.0) << i;
    ASSERT_LE(distance, truth * (1 + rounding) + 1e-300) << i;
    ASSERT_GE(distance + tolerance, truth * (1 - rounding)) << i;
    ++(collides ? colliding : free);
  }
  EXPECT_GT(colliding, 10);
  EXPECT_GT(free, 10);
}

TEST(SurfaceDistance, OfFilesThatTheProgramReads)
{
  Eigen::Isometry3d utm = Eigen::Isometry3d::Identity();
  utm.translation() << 513449.7, 5402650.2, 300.1;
  test::TestMesh far = test::boxMesh(2, 2, 2);
  far.move(utm);
  test::TestMesh far_soup = test::soup(5, 25, 1.0, 0.5);
  far_soup.move(utm);
  expectTrueOutput(test::boxMesh(2, 2, 2), 0.01, 0.1, 1);
  expectTrueOutput(far, 0.03, 0.02, 2);
  expectTrueOutput(test::boxMesh(3, 1, 0.0001), 0.02, 0.05, 3);
  expectTrueOutput(test::boxMesh(1e-6, 2e-6, 1e-6), 2e-8, 1e-7, 4);
  expectTrueOutput(test::soup(4, 25, 1.0, 0.5), 0.05, 0.1, 5);
  expectTrueOutput(far_soup, 0.05, 0.1, 6);
  expectTrueOutput(test::sphereMesh(0.7, 16), 0.02, 0.0625, 7);
}

#endif

} // namespace
} // namespace pcl_bsh
