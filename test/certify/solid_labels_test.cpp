// SPDX-License-Identifier: BSD-3-Clause
// The inside of meshes that do not cross themselves, by CGAL's exact predicates: no label may differ.
#include <pcl_bsh/solid/labels.h>

#include "solid/meshes.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

namespace pcl_bsh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;

SurfaceMesh toCgal(const test::ClosedMesh& mesh)
{
  SurfaceMesh made;
  std::vector<SurfaceMesh::Vertex_index> vertices;
  for (std::size_t i = 0; i < mesh.xyz.size(); i += 3)
    vertices.push_back(made.add_vertex({mesh.xyz[i], mesh.xyz[i + 1], mesh.xyz[i + 2]}));
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3)
    made.add_face(vertices[mesh.corners[i]], vertices[mesh.corners[i + 1]], vertices[mesh.corners[i + 2]]);
  return made;
}

/// How many are outside, inside and on the surface.
using Counts = std::array<std::size_t, 3>;

void expectAsCgal(const test::ClosedMesh& mesh, const std::vector<double>& points, Counts& counts)
{
  const SurfaceMesh other = toCgal(mesh);
  ASSERT_EQ(other.number_of_faces(), mesh.corners.size() / 3);
  const CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel> side(other);
  const Solid solid(mesh.view());
  const SphereHierarchy cloud(viewOf(points.data(), points.size() / 3));
  const LabelsResult found = labelPoints({cloud}, {solid});
  std::size_t differing = 0;
  for (std::size_t i = 0; i < found.labels.size(); ++i) {
    const CGAL::Bounded_side on = side({points[3 * i], points[3 * i + 1], points[3 * i + 2]});
    const Label label = on == CGAL::ON_BOUNDARY       ? Label::surface
                        : on == CGAL::ON_BOUNDED_SIDE ? Label::inside
                                                      : Label::outside;
    differing += found.labels[i] != labelOf(label);
    ++counts[labelOf(label)];
  }
  EXPECT_EQ(differing, 0u);
}

std::vector<double> grid(double low, double high, int steps)
{
  std::vector<double> points;
  for (int x = 0; x <= steps; ++x)
    for (int y = 0; y <= steps; ++y)
      for (int z = 0; z <= steps; ++z)
        for (const int k : {x, y, z}) points.push_back(low + (high - low) * k / steps);
  return points;
}

TEST(SolidLabels, AreThoseOfCgal)
{
  Counts counts = {};
  expectAsCgal(test::boxMesh(), grid(-0.5, 1.5, 16), counts);
  expectAsCgal(test::fanMesh(300), test::pointsAbout(test::fanMesh(300), 3000, 1e-3, 1), counts);
  for (const std::uint32_t rows : {4u, 12u, 40u}) {
    const test::ClosedMesh bumpy = test::bumpyMesh(rows, 0.2);
    expectAsCgal(bumpy, test::pointsAbout(bumpy, 3000, 1e-2, rows), counts);
    expectAsCgal(bumpy, test::pointsAbout(bumpy, 1500, 1e-12, rows + 1), counts);
    expectAsCgal(bumpy, grid(0, 1, 12), counts);
  }
  test::ClosedMesh far; // small edges at georeferenced coordinates
  far.add(test::bumpyMesh(12, 0.2), 1e-3, {513449.75, 5402650.25, 300.125});
  expectAsCgal(far, test::pointsAbout(far, 3000, 1e-4, 9), counts);
  test::ClosedMesh nested; // a body in a hollow in a body
  nested.add(test::boxMesh());
  nested.add(test::boxMesh(), 0.5, {0.25, 0.25, 0.25}, true);
  nested.add(test::boxMesh(), 0.25, {0.375, 0.375, 0.375});
  expectAsCgal(nested, grid(-0.25, 1.25, 24), counts);
  for (const std::size_t count : counts) EXPECT_GT(count, 1000u);
}

} // namespace
} // namespace pcl_bsh
