// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/mesh_edges.h>

#include "meshes.h"
#include "support/random.h"

#include <gtest/gtest.h>

#include <limits>

namespace pcl_bsh {
namespace {

/// Checked against the comparison of all places. @return whether it closes
bool closes(const test::ClosedMesh& mesh)
{
  const TrianglesView view = mesh.view();
  std::vector<OpenEdge> all = {{7, {}, {}}}, expected_all;
  const OpenEdges open = openEdgesOf(view, &all);
  const OpenEdges expected = findOpenEdges(
      view.count, [&](std::size_t i) { return view.triangle(static_cast<std::uint32_t>(i)); }, &expected_all);
  EXPECT_EQ(open.count, expected.count);
  EXPECT_EQ(open.triangle, expected.triangle);
  EXPECT_EQ(open.from, expected.from);
  EXPECT_EQ(open.to, expected.to);
  EXPECT_EQ(all.size(), expected_all.size());
  for (std::size_t i = 0; i < std::min(all.size(), expected_all.size()); ++i) {
    EXPECT_EQ(all[i].triangle, expected_all[i].triangle);
    EXPECT_EQ(all[i].from, expected_all[i].from);
    EXPECT_EQ(all[i].to, expected_all[i].to);
  }
  EXPECT_EQ(openEdgesOf(view).count, expected.count);
  return open.closed();
}

TEST(MeshEdges, CloseByNumberOrByPlace)
{
  test::ClosedMesh box = test::boxMesh();
  EXPECT_TRUE(closes(box));
  test::ClosedMesh apart; // each triangle with vertices of its own
  for (const std::uint32_t corner : box.corners)
    apart.corners.push_back(apart.vertex(box.xyz[3 * corner], box.xyz[3 * corner + 1], box.xyz[3 * corner + 2]));
  EXPECT_TRUE(closes(apart));
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  test::ClosedMesh lost = box; // the triangles of a vertex that is not finite do not count
  lost.xyz[10] = nan;
  EXPECT_FALSE(closes(lost));
  box.vertex(0, nan, 0); // which no triangle names
  EXPECT_TRUE(closes(box));
  for (int i = 0; i < 1000; ++i) box.vertex(i, 0, 0);
  EXPECT_TRUE(closes(box));
  box.corners[0] = box.corners[1]; // an edge is left, and nothing of its triangle
  EXPECT_FALSE(closes(box));
}

TEST(MeshEdges, OfRandomTriangles)
{
  test::Random random(5);
  int closed = 0;
  for (int i = 0; i < 20000; ++i) {
    test::ClosedMesh mesh;
    const int vertices = random.integer(3, 6);
    for (int k = 0; k < vertices; ++k)
      mesh.vertex(random.integer(0, 2), random.integer(0, 2),
                  random.chance(0.02) ? std::numeric_limits<double>::infinity() : 0.0);
    for (int k = random.integer(1, 4); k > 0; --k) {
      const auto any = [&] { return static_cast<std::uint32_t>(random.integer(0, vertices - 1)); };
      const std::uint32_t a = any(), b = any(), c = any();
      mesh.triangle(a, b, c);
      if (random.chance(0.5)) mesh.triangle(b, a, c);
    }
    closed += closes(mesh) ? 1 : 0;
  }
  EXPECT_GT(closed, 5000);
  EXPECT_LT(closed, 17000);
}

} // namespace
} // namespace pcl_bsh
