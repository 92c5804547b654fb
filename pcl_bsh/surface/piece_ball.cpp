// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/surface/piece_ball.h>

#include <pcl_bsh/geometry/enclosing_sphere.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh::surface {

namespace {

Vector3d nearestOnSegment(const Vector3d& p, const Vector3d& a, const Vector3d& b)
{
  const Vector3d edge = b - a;
  const double squared = edge.squaredNorm();
  if (!(squared > 0)) return a;
  return a + std::clamp((p - a).dot(edge) / squared, 0.0, 1.0) * edge;
}

/// The nearest point of a triangle: its foot where that is inside, else the nearest of its edges.
Vector3d nearestOnTriangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c)
{
  const Vector3d ab = b - a, ac = c - a, ap = p - a;
  const Vector3d normal = ab.cross(ac);
  const double squared = normal.squaredNorm();
  if (squared > 0) {
    const double v = ap.cross(ac).dot(normal) / squared, w = ab.cross(ap).dot(normal) / squared;
    if (v >= 0 && w >= 0 && v + w <= 1) return a + v * ab + w * ac;
  }
  Vector3d nearest = nearestOnSegment(p, a, b);
  for (const Vector3d& q : {nearestOnSegment(p, b, c), nearestOnSegment(p, c, a)})
    if ((q - p).squaredNorm() < (nearest - p).squaredNorm()) nearest = q;
  return nearest;
}

/// The nearest point of a convex polygon, a fan of triangles.
Vector3d nearestOnPiece(const Vector3d& p, const Vector3d* corner, std::size_t count)
{
  if (count == 1) return corner[0];
  if (count == 2) return nearestOnSegment(p, corner[0], corner[1]);
  Vector3d nearest = nearestOnTriangle(p, corner[0], corner[1], corner[2]);
  for (std::size_t i = 3; i < count; ++i) {
    const Vector3d q = nearestOnTriangle(p, corner[0], corner[i - 1], corner[i]);
    if ((q - p).squaredNorm() < (nearest - p).squaredNorm()) nearest = q;
  }
  return nearest;
}

/// The centre of the smallest ball that holds all points, to float rounding.
Vector3d middleOf(const std::vector<Vector3d>& points)
{
  const std::size_t count = points.size();
  std::vector<float> values(3 * count);
  float *x = values.data(), *y = x + count, *z = y + count;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f p = (points[i] - points[0]).cast<float>();
    x[i] = p.x(), y[i] = p.y(), z[i] = p.z();
  }
  const std::array<float, 3> c = minimalCenter({x, y, z, count});
  return points[0] + Vector3d(c[0], c[1], c[2]);
}

} // namespace

void fitBall(const std::vector<Vector3d>& corners, Patch& patch)
{
  std::vector<Vector3d> points;
  for (const Piece& piece : patch.pieces) {
    const auto first = corners.begin() + static_cast<std::ptrdiff_t>(piece.first);
    points.insert(points.end(), first, first + piece.count);
  }
  const auto reachFrom = [&points](const Vector3d& place) {
    double most = 0.0;
    for (const Vector3d& p : points) most = std::max(most, (p - place).squaredNorm());
    return std::sqrt(most);
  };
  patch.middle = middleOf(points);
  patch.least = reachFrom(patch.middle);
  double least = std::numeric_limits<double>::infinity();
  for (const Piece& piece : patch.pieces) {
    const Vector3d q = nearestOnPiece(patch.middle, corners.data() + piece.first, piece.count);
    const double squared = (q - patch.middle).squaredNorm();
    if (squared < least) least = squared, patch.center = q, patch.triangle = piece.triangle;
  }
  patch.radius = reachFrom(patch.center);
}

} // namespace pcl_bsh::surface
