// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/open_edges.h>

#include "geometry/soups.h"
#include "meshes.h"
#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace pcl_bsh {
namespace {

using test::both;
using test::boxOf;
using test::ClosedMesh;
using test::flipped;
using test::openByHand;
using test::Soup;

/// Each triangle with vertices of its own.
ClosedMesh meshOf(const Soup& soup)
{
  ClosedMesh mesh;
  for (const Triangle3& t : soup)
    for (const Point3& p : t) mesh.corners.push_back(mesh.vertex(p[0], p[1], p[2]));
  return mesh;
}

Soup soupOf(const TrianglesView& view)
{
  Soup soup;
  for (std::uint32_t i = 0; i < view.count; ++i) soup.push_back(view.triangle(i));
  return soup;
}

/// All open edges, and the first one by itself: checked against each other and against all edges compared by hand.
OpenEdges find(const TrianglesView& view)
{
  std::vector<OpenEdge> all = {{7, {}, {}}};
  const OpenEdges open = openEdgesOf(view, &all), alone = openEdgesOf(view);
  EXPECT_EQ(alone.count, open.count);
  EXPECT_EQ(alone.triangle, open.triangle);
  EXPECT_EQ(alone.from, open.from);
  EXPECT_EQ(alone.to, open.to);

  EXPECT_EQ(all.size(), open.count);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end(),
                             [](const OpenEdge& x, const OpenEdge& y) { return x.triangle < y.triangle; }));
  std::vector<std::array<Point3, 2>> edges;
  for (const OpenEdge& edge : all) {
    edges.push_back({edge.from, edge.to});
    const Triangle3 t = view.triangle(static_cast<std::uint32_t>(edge.triangle));
    bool has = false;
    for (std::size_t k = 0; k < 3; ++k) has = has || (t[k] == edge.from && t[(k + 1) % 3] == edge.to);
    EXPECT_TRUE(has);
  }
  std::sort(edges.begin(), edges.end());
  EXPECT_EQ(edges, openByHand(soupOf(view)));
  if (!all.empty()) {
    EXPECT_EQ(all.front().triangle, open.triangle);
    EXPECT_EQ(all.front().from, open.from);
    EXPECT_EQ(all.front().to, open.to);
  }
  return open;
}

/// The same with vertices shared by number and with vertices of each triangle's own.
OpenEdges find(const ClosedMesh& mesh)
{
  const OpenEdges shared = find(mesh.view());
  const ClosedMesh own = meshOf(soupOf(mesh.view()));
  EXPECT_EQ(find(own.view()).count, shared.count);
  return shared;
}

OpenEdges find(const Soup& soup)
{
  const ClosedMesh mesh = meshOf(soup);
  return find(mesh.view());
}

TEST(OpenEdges, OfClosedTriangles)
{
  const Soup box = boxOf({0, 0, 0}, {2, 2, 2});
  EXPECT_TRUE(find(Soup()).closed());
  EXPECT_TRUE(find(box).closed());
  EXPECT_TRUE(find(both(box, boxOf({2, 0, 0}, {4, 2, 2}))).closed()); // four triangles at each edge between them
  EXPECT_TRUE(find(both(box, box)).closed());
  EXPECT_TRUE(find(Soup{box[0], flipped(box)[0]}).closed()); // a face doubled in opposite directions
  Soup signs = box;
  for (Triangle3& t : signs)
    for (Point3& corner : t)
      for (double& x : corner) x = x == 0.0 && &t == &signs[3] ? -0.0 : x;
  EXPECT_TRUE(find(signs).closed());
}

TEST(OpenEdges, NamesTheFirst)
{
  const Soup box = boxOf({0, 0, 0}, {2, 2, 2});
  Soup open = box;
  open.erase(open.begin() + 7);
  const OpenEdges found = find(open);
  EXPECT_EQ(found.count, 3u);
  std::size_t first = open.size();
  for (std::size_t i = open.size(); i-- > 0;)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t j = 0; j < 3; ++j)
        if (open[i][k] == box[7][(j + 1) % 3] && open[i][(k + 1) % 3] == box[7][j]) first = i;
  EXPECT_EQ(found.triangle, first);

  Soup turned = box; // one that looks inward: its three edges are there twice, and so are their neighbours'
  std::swap(turned[5][0], turned[5][1]);
  EXPECT_EQ(find(turned).count, 6u);
  EXPECT_EQ(find(both(box, {box[0]})).count, 3u);
  EXPECT_EQ(find(both(box, {box[0], box[0], box[5]})).count, 9u);
  EXPECT_EQ(find(Soup{box[3]}).count, 3u);
  Soup broken = box;
  broken[2][1][0] = std::nan("");
  EXPECT_EQ(find(broken).count, 3u);
}

TEST(OpenEdges, CloseByNumberOrByPlace)
{
  ClosedMesh box = test::boxMesh();
  EXPECT_TRUE(find(box).closed());
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  ClosedMesh lost = box; // the triangles of a vertex that is not finite do not count
  lost.xyz[10] = nan;
  EXPECT_FALSE(find(lost).closed());
  box.vertex(0, nan, 0); // which no triangle names
  EXPECT_TRUE(find(box).closed());
  for (int i = 0; i < 1000; ++i) box.vertex(i, 0, 0);
  EXPECT_TRUE(find(box).closed());
  box.corners[0] = box.corners[1]; // an edge is left, and nothing of its triangle
  EXPECT_FALSE(find(box).closed());
}

TEST(OpenEdges, OfRandomTriangles)
{
  test::Random random(5);
  int closed = 0;
  for (int i = 0; i < 20000; ++i) {
    ClosedMesh mesh;
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
    closed += find(mesh).closed() ? 1 : 0;
  }
  EXPECT_GT(closed, 5000);
  EXPECT_LT(closed, 17000);
}

/// Half a million triangles around one vertex, none of which has a neighbour: no edge is looked for among all others.
TEST(OpenEdges, AroundOneVertex)
{
  ClosedMesh mesh;
  mesh.vertex(0, 0, 0);
  for (int i = 0; i < 500000; ++i) mesh.triangle(0, mesh.vertex(i, 1, 0), mesh.vertex(i, 1, 1));
  const TrianglesView view = mesh.view();
  std::vector<OpenEdge> all;
  EXPECT_EQ(openEdgesOf(view, &all).count, 1500000u);
  EXPECT_EQ(all.size(), 1500000u);
  EXPECT_EQ(all[4].triangle, 1u);
}

} // namespace
} // namespace pcl_bsh
