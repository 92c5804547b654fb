// SPDX-License-Identifier: BSD-3-Clause
// The distance of two convex bodies that are given by their support functions, after Gilbert, Johnson and Keerthi.
// Every direction n proves a lower bound, min n.a - max n.b; every place that is found proves an upper bound.
#pragma once

#include <pcl_bsh/query/result.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace pcl_bsh::robots {

/// Up to four corners. Finds the place between them that is nearest to the origin.
class Simplex {
public:
  void add(const Eigen::Vector3d& p) { at_[size_++] = p; }
  bool has(const Eigen::Vector3d& p) const
  {
    return std::find(at_.begin(), at_.begin() + size_, p) != at_.begin() + size_;
  }

  /// The radius of the ball about the origin that is within the tetrahedron; 0: the origin is not in it.
  double depth() const { return depth_; }

  /// The place that is nearest to the origin; keeps only the corners that it lies between.
  Eigen::Vector3d reduce()
  {
    if (size_ == 1) return at_[0];
    if (size_ == 2) return segment(at_[0], at_[1]);
    if (size_ == 3) return triangle(at_[0], at_[1], at_[2]);
    return tetrahedron();
  }

private:
  using Vector = Eigen::Vector3d;

  Vector keep(std::initializer_list<Vector> corners, const Vector& nearest)
  {
    size_ = 0;
    for (const Vector& corner : corners) add(corner);
    return nearest;
  }

  Vector segment(const Vector a, const Vector b)
  {
    const Vector ab = b - a;
    const double along = -a.dot(ab), all = ab.squaredNorm();
    if (!(along > 0.0)) return keep({a}, a);
    if (along >= all) return keep({b}, b);
    return keep({a, b}, a + along / all * ab);
  }

  Vector triangle(const Vector a, const Vector b, const Vector c)
  {
    const Vector ab = b - a, ac = c - a;
    const double d1 = -ab.dot(a), d2 = -ac.dot(a), d3 = -ab.dot(b), d4 = -ac.dot(b), d5 = -ab.dot(c), d6 = -ac.dot(c);
    const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (va > 0.0 && vb > 0.0 && vc > 0.0) {
      const double v = vb / (va + vb + vc), w = vc / (va + vb + vc);
      return keep({a, b, c}, a + v * ab + w * ac);
    }
    Simplex best;
    Vector nearest = best.segment(a, b);
    for (const auto& [p, q] : {std::pair(a, c), std::pair(b, c)}) {
      Simplex other;
      const Vector place = other.segment(p, q);
      if (place.squaredNorm() < nearest.squaredNorm()) nearest = place, best = other;
    }
    *this = best;
    return nearest;
  }

  Vector tetrahedron()
  {
    constexpr std::size_t faces[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
    Simplex best;
    Vector nearest = Vector::Zero();
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [i, j, k, beyond] : faces) {
      const Vector normal = (at_[j] - at_[i]).cross(at_[k] - at_[i]);
      const double side = normal.dot(at_[beyond] - at_[i]), of_origin = -normal.dot(at_[i]);
      if (side * of_origin > 0.0) continue; // a flat one has two sides that are 0: all faces count
      Simplex face;
      const Vector place = face.triangle(at_[i], at_[j], at_[k]);
      if (place.squaredNorm() < least) least = place.squaredNorm(), nearest = place, best = face;
    }
    if (best.size_ > 0) {
      *this = best;
      return nearest;
    }
    depth_ = std::numeric_limits<double>::infinity();
    for (const auto& [i, j, k, beyond] : faces) {
      const Vector normal = (at_[j] - at_[i]).cross(at_[k] - at_[i]);
      depth_ = std::min(depth_, std::abs(normal.dot(at_[i])) / normal.norm());
    }
    return nearest;
  }

  std::array<Vector, 4> at_ = {Vector::Zero(), Vector::Zero(), Vector::Zero(), Vector::Zero()};
  std::size_t size_ = 0;
  double depth_ = 0.0;
};

/// Returns bounds of the distance. Where the bodies are found to overlap, the bounds are minus infinity and -d: they
/// surely still meet after any move of up to d. Doubles move the bounds by a few roundings of the coordinates.
/// @param a, b return the place that is farthest in a direction
/// @param isEnough(bounds) whether bounds need not come nearer to each other. The upper one may be infinite
/// @param from_b about the way from b to a
template <class SupportA, class SupportB, class IsEnough>
Interval convexDistance(const SupportA& a, const SupportB& b, const IsEnough& isEnough, const Eigen::Vector3d& from_b)
{
  constexpr double kEnough = 1e-10;
  constexpr int kMostSteps = 100;
  Simplex simplex;
  Eigen::Vector3d nearest = from_b;
  Interval bounds{0.0, std::numeric_limits<double>::infinity()};
  for (int step = 0; step < kMostSteps && bounds.upper - bounds.lower > kEnough; ++step) {
    const double length = nearest.norm();
    const Eigen::Vector3d direction = length > 0.0 ? Eigen::Vector3d(nearest / length) : Eigen::Vector3d::UnitX();
    const Eigen::Vector3d place = a(-direction) - b(direction);
    bounds.lower = std::max(bounds.lower, direction.dot(place));
    if (isEnough(bounds) || simplex.has(place)) break;
    simplex.add(place);
    nearest = simplex.reduce();
    const double norm = nearest.norm();
    if (simplex.depth() > 0.0) return {-std::numeric_limits<double>::infinity(), -simplex.depth()};
    if (!(norm < bounds.upper)) break;
    bounds.upper = norm;
    if (norm == 0.0 || isEnough(bounds)) break;
  }
  bounds.lower = std::min(bounds.lower, bounds.upper);
  return bounds;
}

} // namespace pcl_bsh::robots
