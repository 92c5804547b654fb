// SPDX-License-Identifier: BSD-3-Clause
// Parts of edges that are left open where edges are summed up along their lines, by rational numbers.
#pragma once

#include "triangle_oracle.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace pcl_bsh::test {

using Edge = std::array<Point3, 2>; ///< from, to

/// How often a stretch of a line is passed, between two ends of edges that follow each other on it, from the lower one
/// to the higher one less the other way. Stretches that cancel are left out.
using Chain = std::map<std::pair<Point3, Point3>, int>;

/// By the direction of a line, and its moment about the origin: both in units of the direction's first number.
inline std::array<Rational, 6> lineThrough(const Edge& edge)
{
  RationalPoint from, way;
  for (std::size_t k = 0; k < 3; ++k) from[k] = Rational(edge[0][k]), way[k] = Rational(edge[1][k]) - from[k];
  const RationalPoint moment = cross(from, way);
  const auto first = std::find_if(way.begin(), way.end(), [](const Rational& x) { return x != 0; });
  const Rational unit = *first;
  std::array<Rational, 6> line;
  for (std::size_t k = 0; k < 3; ++k) line[k] = way[k] / unit, line[k + 3] = moment[k] / unit;
  return line;
}

/// @param ends of stretches, beside those of the edges
inline Chain chainOf(const std::vector<Edge>& edges, const std::vector<Edge>& ends = {})
{
  struct Line {
    std::set<Point3> places;
    std::vector<Edge> edges;
  };
  const auto plain = [](Edge edge) {
    for (Point3& p : edge)
      for (double& x : p) x += 0.0; // -0 is 0
    return edge;
  };
  std::map<std::array<Rational, 6>, Line> lines;
  for (const auto* some : {&edges, &ends})
    for (const Edge& given : *some) {
      const Edge edge = plain(given);
      if (edge[0] == edge[1]) continue;
      Line& line = lines[lineThrough(edge)];
      line.places.insert(edge.begin(), edge.end());
      if (some == &edges) line.edges.push_back(edge);
    }
  Chain chain;
  for (const auto& [key, line] : lines)
    for (const Edge& edge : line.edges) {
      const auto [low, high] = std::minmax(edge[0], edge[1]);
      for (auto place = line.places.find(low); *place != high;) {
        const Point3 begin = *place++;
        chain[{begin, *place}] += edge[0] == low ? 1 : -1;
      }
    }
  for (auto stretch = chain.begin(); stretch != chain.end();)
    stretch = stretch->second == 0 ? chain.erase(stretch) : std::next(stretch);
  return chain;
}

inline std::vector<Edge> edgesOf(const std::vector<Triangle3>& soup)
{
  std::vector<Edge> edges;
  for (const Triangle3& t : soup)
    for (std::size_t k = 0; isFinite(t) && k < 3; ++k) edges.push_back({t[k], t[(k + 1) % 3]});
  return edges;
}

} // namespace pcl_bsh::test
