// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/enclosing_sphere.h>

#include <Eigen/Dense>

#include <cmath>
#include <numeric>
#include <vector>

namespace pcl_bsh {
namespace {

using Eigen::Vector3d;

Vector3d at(const PointArrays& points, std::size_t i)
{
  return {points.x[i], points.y[i], points.z[i]};
}

std::array<float, 3> toFloat(const Vector3d& c)
{
  return {static_cast<float>(c.x()), static_cast<float>(c.y()), static_cast<float>(c.z())};
}

struct Ball {
  Vector3d center = Vector3d::Zero();
  double squared_radius = -1.0;

  bool contains(const Vector3d& p) const { return (p - center).squaredNorm() <= squared_radius * (1.0 + 1e-12); }
};

std::size_t farthestFrom(const PointArrays& points, const Vector3d& from)
{
  std::size_t farthest = 0;
  double most = -1.0;
  for (std::size_t i = 0; i < points.count; ++i) {
    const double squared = (at(points, i) - from).squaredNorm();
    if (squared > most) most = squared, farthest = i;
  }
  return farthest;
}

/// The smallest ball through 1 to 4 support points, its centre in their affine hull. Returns `without_last` where the
/// points are affinely dependent.
Ball ballThrough(const std::array<Vector3d, 4>& support, std::size_t count, const Ball& without_last)
{
  if (count == 0) return {};
  if (count == 1) return {support[0], 0.0};
  const auto n = static_cast<Eigen::Index>(count - 1);
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> edges(3, n);
  for (Eigen::Index k = 0; k < n; ++k) edges.col(k) = support[static_cast<std::size_t>(k) + 1] - support[0];
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> gram = edges.transpose() * edges;
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> half = 0.5 * gram.diagonal();
  const auto solver = gram.fullPivLu();
  if (solver.rank() < n) return without_last;
  const Vector3d offset = edges * solver.solve(half);
  return {support[0] + offset, offset.squaredNorm()};
}

/// Welzl's recursion over the support only (four levels at most); points are walked by loops.
class SmallestBall {
public:
  explicit SmallestBall(std::vector<Vector3d> points) : points_(std::move(points))
  {
    ball_ = grow(points_.size(), 0, {});
  }

  const Ball& ball() const { return ball_; }

private:
  Ball grow(std::size_t end, std::size_t support_count, const Ball& start)
  {
    Ball ball = support_count == 0 ? Ball{} : ballThrough(support_, support_count, start);
    if (support_count == 4) return ball;
    for (std::size_t i = 0; i < end; ++i) {
      const Vector3d p = points_[i];
      if (ball.contains(p)) continue;
      support_[support_count] = p;
      ball = grow(i, support_count + 1, ball);
      // The point that forced a new ball is asked early the next time.
      for (std::size_t k = i; k > 0; --k) points_[k] = points_[k - 1];
      points_[0] = p;
    }
    return ball;
  }

  std::vector<Vector3d> points_;
  std::array<Vector3d, 4> support_;
  Ball ball_;
};

} // namespace

std::array<float, 3> ritterCenter(const PointArrays& points)
{
  const Vector3d a = at(points, farthestFrom(points, at(points, 0)));
  const Vector3d b = at(points, farthestFrom(points, a));
  Vector3d center = (a + b) / 2;
  double radius = (a - b).norm() / 2;
  for (std::size_t i = 0; i < points.count; ++i) {
    const Vector3d offset = at(points, i) - center;
    const double distance = offset.norm();
    if (distance <= radius) continue;
    const double grown = (radius + distance) / 2;
    center += offset * ((distance - grown) / distance);
    radius = grown;
  }
  return toFloat(center);
}

std::array<float, 3> minimalCenter(const PointArrays& points)
{
  // Only extreme points of a large set can matter. Grow a set of them: take the smallest ball of the set, add the point
  // farthest outside it, until no point is outside.
  std::vector<Vector3d> chosen{at(points, 0)};
  Ball ball{chosen[0], 0.0};
  for (;;) {
    const std::size_t farthest = farthestFrom(points, ball.center);
    const Vector3d p = at(points, farthest);
    const double before = ball.squared_radius;
    if (ball.contains(p)) break;
    chosen.insert(chosen.begin(), p);
    ball = SmallestBall(chosen).ball();
    if (!(ball.squared_radius > before)) break; // rounding allows no further growth
  }
  return toFloat(ball.center);
}

} // namespace pcl_bsh
