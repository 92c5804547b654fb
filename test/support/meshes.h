// SPDX-License-Identifier: BSD-3-Clause
// Meshes of many kinds, and scenes in which a cloud, or both, are of triangles.
#pragma once

#include <pcl_bsh/query/record_distance.h>

#include "random_clouds.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::test {

struct Mesh {
  std::vector<Point3> vertices;
  std::vector<std::uint32_t> corners; ///< three a triangle

  void add(const Point3& a, const Point3& b, const Point3& c)
  {
    for (const Point3& p : {a, b, c}) {
      corners.push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back(p);
    }
  }
};

/// Soups of sizes that differ by 1000, triangles on a lattice, thin ones, segments and points, sheets with shared
/// vertices, fans about one place. Also triangles turned about one centre, some of them twice.
enum class MeshKind { soup, lattice, needles, degenerate, sheet, fan, centred };
inline constexpr MeshKind kMeshKinds[] = {MeshKind::soup,  MeshKind::lattice, MeshKind::needles, MeshKind::degenerate,
                                          MeshKind::sheet, MeshKind::fan,     MeshKind::centred};

/// About `count` triangles within some 2 * scale. Lattices have a spacing of scale / 8.
inline Mesh makeMesh(MeshKind kind, std::size_t count, double scale, Random& random)
{
  const auto anywhere = [&] { return random.point([&] { return scale * random.uniform(-1, 1); }); };
  const auto on_lattice = [&] { return random.point([&] { return scale / 8 * random.integer(-8, 8); }); };
  const auto beside = [&](const Point3& p, double reach) {
    const Point3 by = random.point([&] { return reach * random.uniform(-1, 1); });
    return Point3{p[0] + by[0], p[1] + by[1], p[2] + by[2]};
  };
  Mesh mesh;
  if (kind == MeshKind::sheet) {
    const auto side = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(count) / 2.0)) + 1;
    const double wave = random.uniform(0, 0.3);
    for (std::uint32_t i = 0; i <= side; ++i)
      for (std::uint32_t j = 0; j <= side; ++j) {
        const double x = 2.0 * i / side - 1.0, y = 2.0 * j / side - 1.0;
        mesh.vertices.push_back({scale * x, scale * y, scale * wave * std::sin(5 * x + 3 * y)});
      }
    for (std::uint32_t i = 0; i < side; ++i)
      for (std::uint32_t j = 0; j < side; ++j) {
        const std::uint32_t a = i * (side + 1) + j, b = a + 1, c = a + side + 1, d = c + 1;
        mesh.corners.insert(mesh.corners.end(), {a, b, c, c, b, d});
      }
    return mesh;
  }
  const auto put = [&mesh](const Triangle3& t) { mesh.add(t[0], t[1], t[2]); };
  const Point3 middle = anywhere(), first = on_lattice();
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = 6.283185307179586 * static_cast<double>(i / (1 + i % 2)) / static_cast<double>(count);
    const Point3 p = anywhere();
    switch (kind) {
    case MeshKind::soup: {
      const double size = scale * std::pow(10.0, random.uniform(-3, 0));
      put({beside(p, size), beside(p, size), beside(p, size)});
      break;
    }
    case MeshKind::lattice:
      put({on_lattice(), on_lattice(), on_lattice()});
      break;
    case MeshKind::needles:
      put({p, beside(p, 1e-6 * scale), anywhere()});
      break;
    case MeshKind::degenerate: {
      const Point3 q = on_lattice(), r = on_lattice();
      const int which = random.integer(0, 3);
      const Point3 between = {(q[0] + r[0]) / 2, (q[1] + r[1]) / 2, (q[2] + r[2]) / 2};
      mesh.add(q, which == 0 ? q : r, which < 2 ? q : which == 2 ? r : between);
      break;
    }
    case MeshKind::sheet:
      break;
    case MeshKind::fan: {
      const double next = turn + 6.3 / static_cast<double>(count);
      mesh.add(first, {first[0] + scale * std::cos(turn), first[1] + scale * std::sin(turn), first[2]},
               {first[0] + scale * std::cos(next), first[1] + scale * std::sin(next), first[2]});
      break;
    }
    case MeshKind::centred: { // segments have their middle as the ball's: all of one length and one middle
      const double x = scale / 4 * std::cos(turn), y = scale / 4 * std::sin(turn);
      const Point3 at = i % 5 == 0 ? middle : first;
      mesh.add({at[0] + x, at[1] + y, at[2]}, {at[0] - x, at[1] - y, at[2]}, {at[0] + x, at[1] + y, at[2]});
      break;
    }
    }
  }
  return mesh;
}

/// Triangles of any kind and layout around `center`; sometimes with corners that are not finite, or a subset.
inline Cloud anyMesh(std::size_t count, double scale, const Point3& center, Random& random)
{
  Mesh mesh = makeMesh(random.pick(kMeshKinds), count, scale, random);
  for (Point3& p : mesh.vertices)
    for (std::size_t k = 0; k < 3; ++k) p[k] += center[k];
  if (random.chance(0.2))
    for (Point3& p : mesh.vertices)
      if (random.chance(0.05)) p[1] = std::numeric_limits<double>::quiet_NaN();
  constexpr Layout layouts[] = {{Scalar::float32, 0, 0}, {Scalar::float32, 3, 2}, {Scalar::float64, 0, 0}};
  const std::size_t triangles = mesh.corners.size() / 3;
  Cloud cloud(mesh.vertices, random.pick(layouts));
  cloud.setTriangles(std::move(mesh.corners));
  if (random.chance(0.15)) {
    std::vector<std::int32_t> indices;
    for (std::size_t i = triangles; i-- > 0;)
      if (random.chance(0.5)) indices.push_back(static_cast<std::int32_t>(i));
    cloud.restrictTo(std::move(indices));
  }
  return cloud;
}

/// As tiedClearance(), of any records.
inline double tiedGap(const PointsView& a, const Eigen::Isometry3d& pose_a, const PointsView& b,
                      const Eigen::Isometry3d& pose_b, Random& random)
{
  const RecordDistance distance(a, pose_a, b, pose_b);
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 30 && a.size() > 0 && b.size() > 0; ++i) {
    const auto any_record = [&](const PointsView& view) {
      return view.record(static_cast<std::size_t>(random.integer(0, static_cast<int>(view.size()) - 1)));
    };
    const PointPair pair{any_record(a), any_record(b)};
    if (!isFinite(a.point(pair.a)) || !isFinite(b.point(pair.b))) continue;
    smallest = std::min(smallest, std::max(0.0, distance.gap(pair)));
  }
  if (!std::isfinite(smallest)) return 0.0;
  const int last_bit = random.integer(-1, 1);
  return last_bit == 0 ? smallest : std::nextafter(smallest, last_bit < 0 ? 0.0 : 2 * smallest);
}

/// Points or triangles against triangles or points, triangles on one side at least, that meet or nearly meet, in any
/// pose; half of the clearances are ties.
inline Scene anyMeshScene(std::uint64_t seed, int most)
{
  Random random(seed);
  constexpr double scales[] = {0x1p-10, 1.0, 0x1p10};
  constexpr double distances[] = {0, 0, 0x1p7, 1e6};
  const double scale = random.pick(scales);
  const double far_a = scale * random.pick(distances), far_b = scale * random.pick(distances);
  const Point3 center_a = {far_a, -0.5 * far_a, 0.25 * far_a}, center_b = {-far_b, 0.125 * far_b, far_b};
  const bool a_is_mesh = seed % 3 != 0, b_is_mesh = seed % 3 != 1;
  const auto any = [&](bool is_mesh, const Point3& center) {
    const auto count = static_cast<std::size_t>(random.chance(0.2) ? random.integer(0, 20) : random.integer(0, most));
    return is_mesh ? anyMesh(count, scale, center, random) : anyCloud(count, scale, center, random);
  };
  Cloud a = any(a_is_mesh, center_a), b = any(b_is_mesh, center_b);
  const double shift = random.chance(0.3) ? 2.5 * scale : 0.0;
  const Eigen::Isometry3d world = random.chance(0.5) ? Eigen::Isometry3d::Identity() : random.pose(100 * scale);
  const auto bring = [&](const Point3& center, double by) {
    Eigen::Isometry3d pose = random.chance(0.5) ? random.pose(scale) : Eigen::Isometry3d::Identity();
    pose = world * Eigen::Translation3d(0, by, 0) * pose;
    pose.translate(-Eigen::Vector3d(center[0], center[1], center[2]));
    return pose;
  };
  const Eigen::Isometry3d pose_a = bring(center_a, 0), pose_b = bring(center_b, shift);
  const int kind = random.integer(0, 9);
  const double clearance = kind < 5    ? tiedGap(a.view(), pose_a, b.view(), pose_b, random)
                           : kind == 5 ? 0.0
                           : kind == 6 ? scale * random.integer(0, 8) / 8
                                       : scale * random.uniform(0, 0.2);
  const std::string name = "meshes " + std::to_string(seed) + " of up to " + std::to_string(most) + ": " +
                           std::to_string(a.view().size()) + (a_is_mesh ? " triangles" : " points") + " x " +
                           std::to_string(b.view().size()) + (b_is_mesh ? " triangles" : " points") + ", clearance " +
                           std::to_string(clearance);
  return {std::move(a), std::move(b), pose_a, pose_b, clearance, name};
}

} // namespace pcl_bsh::test
