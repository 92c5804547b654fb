// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/open_edges.h>

#include "geometry/edge_chains.h"
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
using test::Chain;
using test::chainOf;
using test::ClosedMesh;
using test::cutMesh;
using test::Edge;
using test::edgesOf;
using test::flipped;
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

/// Whether a part of the triangle's boundary goes from one place to the other: places are as given, so that 0 is not
/// -0.
bool passes(const Triangle3& t, const Edge& part)
{
  const auto line = test::lineThrough(part);
  for (std::size_t k = 0; k < 3; ++k) {
    const Edge edge = {t[k], t[(k + 1) % 3]};
    if (edge[0] == edge[1] || test::lineThrough(edge) != line || (edge[0] < edge[1]) != (part[0] < part[1])) continue;
    const auto [low, high] = std::minmax(edge[0], edge[1]);
    if (low <= std::min(part[0], part[1]) && std::max(part[0], part[1]) <= high) return true;
  }
  return false;
}

/// All open edges, the first one by itself, and whether there is one: checked against each other and against the sum of
/// all edges in rational numbers.
OpenEdges find(const TrianglesView& view)
{
  std::vector<OpenEdge> all = {{7, {}, {}}};
  const OpenEdges open = openEdgesOf(view, &all), alone = openEdgesOf(view);
  EXPECT_EQ(closes(view), open.closed());
  EXPECT_EQ(alone.count, open.count);
  EXPECT_EQ(alone.triangle, open.triangle);
  EXPECT_EQ(alone.from, open.from);
  EXPECT_EQ(alone.to, open.to);

  EXPECT_EQ(all.size(), open.count);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end(),
                             [](const OpenEdge& x, const OpenEdge& y) { return x.triangle < y.triangle; }));
  std::vector<Edge> parts;
  for (std::size_t i = 0; i < all.size(); ++i) {
    parts.push_back({all[i].from, all[i].to});
    EXPECT_TRUE(passes(view.triangle(static_cast<std::uint32_t>(all[i].triangle)), parts.back()));
    const bool goes_on = i > 0 && all[i].triangle == all[i - 1].triangle && all[i].from == all[i - 1].to;
    const Triangle3 t = view.triangle(static_cast<std::uint32_t>(all[i].triangle));
    if (goes_on && std::count(t.begin(), t.end(), all[i].from) == 0) ADD_FAILURE() << "one part, in two";
  }
  const std::vector<Edge> edges = edgesOf(soupOf(view));
  const Chain left = chainOf(edges);
  EXPECT_EQ(chainOf(parts, edges), left);
  for (Edge& part : parts) // all one way: no part cancels another
    if (part[1] < part[0]) std::swap(part[0], part[1]);
  Chain all_of_them = left;
  for (auto& [stretch, times] : all_of_them) times = std::abs(times);
  EXPECT_EQ(chainOf(parts, edges), all_of_them);
  if (!all.empty()) {
    EXPECT_EQ(all.front().triangle, open.triangle);
    EXPECT_EQ(all.front().from, open.from);
    EXPECT_EQ(all.front().to, open.to);
  }
  return open;
}

/// Finds open edges with vertices shared by number and with vertices of each triangle's own.
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

/// A cube of which the top is cut into so many squares, and the sides are not.
ClosedMesh cubeWithTop(int columns, int rows, double size = 1.0, const Point3& at = {0, 0, 0})
{
  Soup soup = boxOf(at, {at[0] + size, at[1] + size, at[2] + size});
  soup.erase(soup.begin() + 2, soup.begin() + 4);
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      const auto corner = [&](int x, int y) {
        return Point3{at[0] + size * x / columns, at[1] + size * y / rows, at[2] + size};
      };
      soup.push_back({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
      soup.push_back({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
    }
  return meshOf(soup);
}

TEST(OpenEdges, CancelEndToEnd)
{
  for (const double size : {1.0, 1e-100, 1e-3, 1e100})
    for (const auto& [columns, rows] : {std::array{2, 2}, {3, 5}, {1, 7}, {9, 1}}) {
      EXPECT_TRUE(find(cubeWithTop(columns, rows, size)).closed()) << size << ", " << columns << " x " << rows;
      EXPECT_TRUE(find(cubeWithTop(columns, rows, size, {500000.25, 5e6, 300})).closed());
    }
  // The middle of a square lies on its diagonal; four triangles on one side of it, one on the other.
  EXPECT_TRUE(find(Soup{{{{0, 0, 0}, {2, 2, 0}, {0, 2, 0}}},
                        {{{2, 2, 0}, {1, 1, 0}, {2, 0, 0}}},
                        {{{1, 1, 0}, {0, 0, 0}, {2, 0, 0}}},
                        {{{0, 2, 0}, {2, 2, 0}, {2, 0, 0}}},
                        {{{0, 0, 0}, {0, 2, 0}, {2, 0, 0}}}})
                  .closed());
  EXPECT_TRUE(find(Soup{{{{1, 2, 3}, {3, 6, 9}, {2, 4, 6}}}}).closed()) << "corners on one line";
}

TEST(OpenEdges, NameThePartThatIsOpen)
{
  ClosedMesh cube = cubeWithTop(2, 2); // of the first square, what touches the side y = 0
  const std::size_t first = cube.corners.size() / 3 - 8;
  cube.corners.erase(cube.corners.begin() + 3 * static_cast<std::ptrdiff_t>(first),
                     cube.corners.begin() + 3 * static_cast<std::ptrdiff_t>(first + 1));
  const OpenEdges found = find(cube);
  EXPECT_EQ(found.count, 3u);
  EXPECT_EQ(found.triangle, 3u); // of the side
  EXPECT_EQ(found.from, (Point3{0.5, 0, 1}));
  EXPECT_EQ(found.to, (Point3{0, 0, 1}));

  const double beyond = std::nextafter(1.0, 2.0); // one rounding above the edge
  Soup off = soupOf(cubeWithTop(2, 2).view());
  for (Triangle3& t : off)
    for (Point3& p : t)
      if (p == Point3{0.5, 0, 1}) p[2] = beyond;
  EXPECT_EQ(find(off).count, 3u);
  for (Triangle3& t : off)
    for (Point3& p : t)
      if (p == Point3{0.5, 0, beyond}) p = {0.5, 0, 1};
  EXPECT_TRUE(find(off).closed());

  // Edges that overlap and share no end: both are open, except where they overlap.
  const OpenEdges slid = find(Soup{{{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}}}, {{{3, 0, 0}, {1, 0, 0}, {0, 0, 1}}}});
  EXPECT_EQ(slid.count, 6u);
  EXPECT_EQ(slid.to, (Point3{1, 0, 0}));
  // One within another: the outer one is open in two parts.
  EXPECT_EQ(find(Soup{{{{0, 0, 0}, {3, 0, 0}, {0, 1, 0}}}, {{{2, 0, 0}, {1, 0, 0}, {0, 0, 1}}}}).count, 6u);
}

/// Triangles cut again and again, each by itself, at places exactly on its edges; turned by what rounds, some places
/// are beside them.
TEST(OpenEdges, OfCutMeshes)
{
  test::Random random(28);
  int open = 0;
  for (unsigned i = 0; i < 14; ++i) {
    const ClosedMesh whole = i % 3 == 0 ? test::boxMesh(4) : test::latticeMesh(random.integer(1, 5), 8, 7 + i);
    ClosedMesh cut = cutMesh(whole, random.integer(1, 40), i);
    EXPECT_TRUE(find(cut).closed());
    const double angle = random.uniform(0, 7), cos = i % 2 == 0 ? 0.6 : std::cos(angle),
                 sin = i % 2 == 0 ? 0.8 : std::sin(angle);
    ClosedMesh turned = cut;
    for (std::size_t k = 0; k < cut.xyz.size(); k += 3) {
      turned.xyz[k] = cos * cut.xyz[k] - sin * cut.xyz[k + 1];
      turned.xyz[k + 1] = sin * cut.xyz[k] + cos * cut.xyz[k + 1];
      cut.xyz[k] = 3 * turned.xyz[k]; // and turned exactly, five times as large
    }
    open += find(turned).closed() ? 0 : 1;
    cut.corners.resize(cut.corners.size() - 3);
    find(cut);
  }
  EXPECT_GT(open, 7);
}

/// Edges on few lines, which overlap in every way.
TEST(OpenEdges, OfRandomEdgesOnALine)
{
  test::Random random(29);
  int closed = 0;
  for (int i = 0; i < 800; ++i) {
    Soup soup;
    for (int k = random.integer(1, 7); k > 0; --k) {
      const double from = random.integer(0, 5), to = random.integer(0, 5);
      const auto on = [](double t) { return Point3{1 + 3 * t, 2 - t, 7 * t}; };
      soup.push_back({on(from), on(to), on(random.integer(0, 5))});
      if (random.chance(0.7)) soup.back()[2] = {0, 0, random.integer(0, 1) * 4.0};
    }
    closed += find(soup).closed() ? 1 : 0;
  }
  EXPECT_GT(closed, 20);
  EXPECT_LT(closed, 780);
}

TEST(OpenEdges, OfRandomTriangles)
{
  test::Random random(5);
  int closed = 0;
  for (int i = 0; i < 3000; ++i) {
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
  EXPECT_GT(closed, 750);
  EXPECT_LT(closed, 2600);
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

/// Hundreds of thousands of edges that no edge between the same places cancels: on one line, or around one place.
TEST(OpenEdges, OfManyOnOneLine)
{
  constexpr int count = 100000;
  ClosedMesh comb; // one long edge against many short ones
  const std::uint32_t tip = comb.vertex(0, 1, 0);
  for (int i = 0; i <= count; ++i) comb.vertex(i, 0, 0);
  for (std::uint32_t i = 1; i <= count; ++i) comb.triangle(tip, i, i + 1);
  comb.triangle(tip, count + 1, 1);
  EXPECT_TRUE(openEdgesOf(comb.view()).closed());
  comb.xyz[3 * 50001 + 1] = 0x1p-1000; // one place beside it
  EXPECT_EQ(openEdgesOf(comb.view()).count, 3u);

  ClosedMesh nested; // each within the one before
  for (int i = 0; i < count; ++i) {
    const std::uint32_t from = nested.vertex(i, 0, 0), to = nested.vertex(4.0 * count - i, 0, 0);
    nested.triangle(from, to, nested.vertex(i, 1, i % 7));
  }
  EXPECT_EQ(openEdgesOf(nested.view()).count, 3u * count);
  for (int i = 0; i < count / 2; ++i) { // and half of them the other way, from end to end
    const std::uint32_t from = nested.vertex(i, 0, 0), to = nested.vertex(4.0 * count - i, 0, 0);
    nested.triangle(to, from, nested.vertex(i, -1, i % 7));
  }
  EXPECT_EQ(openEdgesOf(nested.view()).count, 3u * count - count / 2 + 2u * (count / 2));

  ClosedMesh spokes; // cut on one side, and not on the other
  const auto at = [&](int i, double r) { return spokes.vertex(r * (i % count), r * (i % 1024), r * (i % 77 + 1)); };
  const std::uint32_t hub = spokes.vertex(0, 0, 0);
  for (int i = 0; i < count; ++i) {
    const std::uint32_t end = at(i, 2), next = at((i + 1) % count, 1), far = at((i + 1) % count, 2);
    spokes.triangle(hub, end, next);
    spokes.triangle(end, far, next);
  }
  EXPECT_EQ(openEdgesOf(spokes.view()).count, std::uint64_t{count}) << "the rim";
}

} // namespace
} // namespace pcl_bsh
