// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/triangle/open_edges.h>

#include "soups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace pcl_bsh {
namespace {

using test::both;
using test::boxOf;
using test::flipped;
using test::Soup;

OpenEdges find(const Soup& soup)
{
  return findOpenEdges(soup.size(), [&](std::size_t i) { return soup[i]; });
}

TEST(OpenEdges, OfClosedTriangles)
{
  const Soup box = boxOf({0, 0, 0}, {2, 2, 2});
  EXPECT_TRUE(find({}).closed());
  EXPECT_TRUE(find(box).closed());
  EXPECT_TRUE(find(both(box, boxOf({2, 0, 0}, {4, 2, 2}))).closed()); // four triangles at each edge between them
  EXPECT_TRUE(find(both(box, box)).closed());
  EXPECT_TRUE(find({box[0], flipped(box)[0]}).closed()); // a face doubled in opposite directions
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
  OpenEdges found = find(open);
  EXPECT_EQ(found.count, 3u);
  std::size_t first = open.size();
  for (std::size_t i = open.size(); i-- > 0;)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t j = 0; j < 3; ++j)
        if (open[i][k] == box[7][(j + 1) % 3] && open[i][(k + 1) % 3] == box[7][j]) first = i;
  EXPECT_EQ(found.triangle, first);
  bool is_edge = false;
  for (std::size_t k = 0; k < 3; ++k)
    is_edge = is_edge || (open[first][k] == found.from && open[first][(k + 1) % 3] == found.to);
  EXPECT_TRUE(is_edge);

  Soup turned = box; // one that looks inward: its three edges are there twice, and so are their neighbours'
  std::swap(turned[5][0], turned[5][1]);
  EXPECT_EQ(find(turned).count, 6u);
  EXPECT_EQ(find(both(box, {box[0]})).count, 3u);
  Soup broken = box;
  broken[2][1][0] = std::nan("");
  EXPECT_EQ(find(broken).count, 3u);
}

/// Each directed edge against each other: what is left over.
std::vector<std::array<Point3, 2>> openByHand(const Soup& soup)
{
  std::vector<std::array<Point3, 2>> edges;
  for (const Triangle3& t : soup)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<Point3, 2> edge = {t[k], t[(k + 1) % 3]}, back = {edge[1], edge[0]};
      if (edge[0] == edge[1]) continue;
      const auto met = std::find(edges.begin(), edges.end(), back);
      if (met != edges.end())
        edges.erase(met);
      else
        edges.push_back(edge);
    }
  std::sort(edges.begin(), edges.end());
  return edges;
}

TEST(OpenEdges, AllAreListed)
{
  const Soup box = boxOf({0, 0, 0}, {2, 2, 2});
  std::vector<Soup> soups = {box, both(box, {box[0]}), both(box, {box[0], box[0], box[5]}), {box[3]}, {}};
  for (std::size_t i = 0; i < box.size(); ++i) {
    soups.push_back(box);
    soups.back().erase(soups.back().begin() + static_cast<std::ptrdiff_t>(i));
    soups.push_back(soups.back());
    std::swap(soups.back()[i % 11][0], soups.back()[i % 11][1]);
  }
  for (const Soup& soup : soups) {
    std::vector<OpenEdge> all = {{7, {}, {}}};
    const OpenEdges found = findOpenEdges(
        soup.size(), [&](std::size_t i) { return soup[i]; }, &all);
    EXPECT_EQ(all.size(), found.count);
    std::vector<std::array<Point3, 2>> edges;
    for (const OpenEdge& edge : all) {
      edges.push_back({edge.from, edge.to});
      const Triangle3& t = soup.at(edge.triangle);
      const auto from = std::find(t.begin(), t.end(), edge.from);
      ASSERT_NE(from, t.end());
      EXPECT_EQ(t[static_cast<std::size_t>(from - t.begin() + 1) % 3], edge.to);
    }
    std::sort(edges.begin(), edges.end());
    EXPECT_EQ(edges, openByHand(soup));
    if (!all.empty()) {
      EXPECT_EQ(all.front().triangle, found.triangle);
    }
  }
}

} // namespace
} // namespace pcl_bsh
