// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/mesh_edges.h>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace pcl_bsh {
namespace {

bool haveFiniteVertices(const TrianglesView& triangles)
{
  for (std::size_t i = 0; i < triangles.vertices.count; ++i)
    if (!isFinite(triangles.vertices.point(static_cast<std::uint32_t>(i)))) return false;
  return true;
}

/// Whether each directed edge between two numbers is met by as many in the opposite direction. Then those between
/// places are, too, whichever numbers stand for one place.
bool numbersClose(const TrianglesView& triangles)
{
  const auto for_each_edge = [&](const auto& take) {
    for (std::size_t i = 0; i < triangles.count; ++i) {
      const Triangle corners = triangles.cornersOf(static_cast<std::uint32_t>(i));
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = corners[k], to = corners[(k + 1) % 3];
        if (from < to)
          take(from, 2 * to);
        else if (from > to)
          take(to, 2 * from + 1);
      }
    }
  };
  std::vector<std::uint32_t> ends(triangles.vertices.count); // of each vertex's edges to higher numbers, in the end
  for_each_edge([&](std::uint32_t low, std::uint32_t) { ++ends[low]; });
  std::uint32_t sum = 0;
  for (std::uint32_t& n : ends) sum += std::exchange(n, sum);
  std::vector<std::uint32_t> edges(sum); // twice the higher number, and 1 more where the edge comes from there
  for_each_edge([&](std::uint32_t low, std::uint32_t edge) { edges[ends[low]++] = edge; });
  auto edge = edges.begin();
  for (const std::uint32_t end : ends) {
    const auto last = edges.begin() + end;
    std::sort(edge, last);
    while (edge != last) {
      const std::uint32_t high = *edge / 2;
      std::int64_t net = 0;
      for (; edge != last && *edge / 2 == high; ++edge) net += *edge % 2 == 0 ? 1 : -1;
      if (net != 0) return false;
    }
  }
  return true;
}

} // namespace

OpenEdges openEdgesOf(const TrianglesView& triangles, std::vector<OpenEdge>* all)
{
  constexpr std::size_t most = std::size_t{1} << 30; // vertices and triangles that are numbered so
  const std::size_t vertices = triangles.vertices.count;
  if (triangles.count < most && vertices < most && vertices <= 3 * triangles.count && haveFiniteVertices(triangles) &&
      numbersClose(triangles)) {
    if (all) all->clear();
    return {};
  }
  return findOpenEdges(
      triangles.count, [&](std::size_t i) { return triangles.triangle(static_cast<std::uint32_t>(i)); }, all);
}

} // namespace pcl_bsh
