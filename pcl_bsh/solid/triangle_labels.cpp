// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/triangle_labels.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/solid/labels.h>
#include <pcl_bsh/solid/point_labels.h>

#include <algorithm>
#include <numeric>

namespace pcl_bsh {

std::vector<std::uint8_t> labelTriangles(const TrianglesView& triangles, const Eigen::Isometry3d& T_world_triangles,
                                         const PlacedSolid& solid, unsigned threads)
{
  checkTriangles(triangles);
  const SphereHierarchy vertices(triangles.vertices);
  const LabelsResult corners = labelPoints({vertices, T_world_triangles}, solid, threads);
  std::vector<std::uint8_t> labels(triangles.count, labelOf(Label::outside));
  for (std::uint32_t i = 0; i < triangles.count; ++i) {
    if (!isFinite(triangles.triangle(i))) continue;
    for (const std::uint32_t corner : triangles.cornersOf(i)) {
      if (corners.labels[corner] == labelOf(Label::inside))
        labels[i] = labelOf(Label::inside);
      else if (labels[i] == labelOf(Label::outside))
        labels[i] = corners.labels[corner];
    }
  }
  return labels;
}

std::vector<std::uint32_t> firstOfShells(const TrianglesView& triangles)
{
  checkTriangles(triangles);
  std::vector<std::uint32_t> parent(triangles.vertices.count);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t vertex) {
    while (parent[vertex] != vertex) vertex = parent[vertex] = parent[parent[vertex]];
    return vertex;
  };
  for (std::uint32_t i = 0; i < triangles.count; ++i) {
    if (!isFinite(triangles.triangle(i))) continue;
    const auto [a, b, c] = triangles.cornersOf(i);
    const std::uint32_t shell = std::min({root(a), root(b), root(c)});
    parent[root(a)] = parent[root(b)] = parent[root(c)] = shell;
  }
  std::vector<bool> known(parent.size(), false);
  std::vector<std::uint32_t> first;
  for (std::uint32_t i = 0; i < triangles.count; ++i) {
    if (!isFinite(triangles.triangle(i))) continue;
    const std::uint32_t shell = root(triangles.cornersOf(i)[0]);
    if (!known[shell]) first.push_back(i);
    known[shell] = true;
  }
  return first;
}

bool holdsAny(const PlacedSolid& solid, const TrianglesView& triangles, const std::vector<std::uint32_t>& shells,
              const Eigen::Isometry3d& T_world_triangles)
{
  checkPoses(T_world_triangles, solid.pose);
  const DefaultFloatEnvironment environment;
  PointLabels labels(T_world_triangles, solid);
  std::uint64_t exact_decisions = 0;
  return std::any_of(shells.begin(), shells.end(), [&](std::uint32_t shell) {
    const Triangle3 t = triangles.triangle(shell);
    return isFinite(t) && std::any_of(t.begin(), t.end(), [&](const Point3& corner) {
             return labels.label(labels.frameAt(corner, 0.0), corner, exact_decisions) != Label::outside;
           });
  });
}

} // namespace pcl_bsh
