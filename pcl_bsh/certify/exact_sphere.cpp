// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/certify/exact_sphere.h>

#include <pcl_bsh/geometry/enclosing_sphere.h>
#include <pcl_bsh/geometry/rounding.h>

#include <CGAL/Min_sphere_annulus_d_traits_3.h>
#include <CGAL/Min_sphere_d.h>
#include <CGAL/Min_sphere_of_spheres_d.h>
#include <CGAL/Min_sphere_of_spheres_d_traits_3.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>

namespace pcl_bsh {
namespace {

using Kernel = CGAL::Simple_cartesian<Exact>;
using MinSphere = CGAL::Min_sphere_d<CGAL::Min_sphere_annulus_d_traits_3<Kernel>>;
using MinSphereOfBalls = CGAL::Min_sphere_of_spheres_d<CGAL::Min_sphere_of_spheres_d_traits_3<Kernel, Exact>>;

/// Distance from a centre to the far side of a point's ball, in units, and a bound of its rounding error.
struct Reach {
  double value;
  double bound;
};

/// Derivation of the bound, v = 2^-53. Local coordinates err by v |w|, a rational centre turned to doubles by 2v |c|,
/// their difference by v |d| more. The sum of squares and its root err by 3v of the distance. Twice that is allowed,
/// and 2^-500 for underflow. Overflow gives infinity or NaN, and so no verdict.
Reach reach(const Point3& center, const CertifiedPoint& point)
{
  double squared = 0.0, sizes = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double difference = point.local[k] - center[k];
    squared += difference * difference;
    sizes += std::abs(point.local[k]) + std::abs(center[k]) + std::abs(difference);
  }
  const double distance = std::sqrt(squared);
  return {distance + point.radius, 0x1p-51 * sizes + 0x1p-50 * (distance + point.radius) + 0x1p-500};
}

bool surelyWithin(const Point3& center, double radius, const CertifiedPoint& point)
{
  const Reach far_side = reach(center, point);
  return far_side.value + far_side.bound <= radius * (1.0 - 0x1p-50);
}

Exact squareOf(const Exact& x)
{
  return x * x;
}

Exact squaredDistance(const ExactPoint& p, const ExactPoint& q)
{
  Exact sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += squareOf(p[k] - q[k]);
  return sum;
}

ExactPoint exactLocal(const LocalFrame& frame, const Point3& given)
{
  const Exact unit = frame.unit;
  ExactPoint local;
  for (std::size_t k = 0; k < 3; ++k) local[k] = (Exact(given[k]) - Exact(frame.origin[k])) / unit;
  return local;
}

Exact exactRadius(const LocalFrame& frame, const CertifiedPoint& point)
{
  return Exact(point.given_radius) / Exact(frame.unit);
}

/// By how much a point sticks out of a sphere, and the point's number.
using Excess = std::pair<double, std::size_t>;

/// The points that stick out farthest, eight at most: a smallest sphere most likely touches some of them.
std::vector<std::size_t> farthest(std::vector<Excess>& candidates)
{
  constexpr std::size_t most = 8;
  const std::size_t count = std::min(most, candidates.size());
  const auto last = candidates.begin() + static_cast<std::ptrdiff_t>(count);
  std::partial_sort(candidates.begin(), last, candidates.end(), std::greater<>());
  std::vector<std::size_t> points;
  for (auto candidate = candidates.begin(); candidate != last; ++candidate) points.push_back(candidate->second);
  return points;
}

/// Returns the points to begin with: the farthest from where the float fit would put the centre. Any choice ends at the
/// same sphere.
std::vector<std::size_t> firstGuess(const std::vector<CertifiedPoint>& points)
{
  std::array<std::vector<float>, 3> arrays;
  for (std::size_t k = 0; k < 3; ++k) {
    arrays[k].reserve(points.size());
    for (const CertifiedPoint& point : points) arrays[k].push_back(roundToFloat(point.local[k]));
  }
  const auto center = minimalCenter({arrays[0].data(), arrays[1].data(), arrays[2].data(), points.size()});
  std::vector<Excess> candidates;
  candidates.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double value = reach({center[0], center[1], center[2]}, points[i]).value;
    candidates.push_back({value >= 0.0 ? value : 0.0, i}); // NaN would not sort
  }
  return farthest(candidates);
}

/// Returns the squared radius, in units, of the smallest sphere around the points. It is the smallest sphere around a
/// few of them that holds all. Points outside join the few, which makes the sphere grow, until no point is outside.
Exact minimalSquaredRadius(const LocalFrame& frame, const std::vector<CertifiedPoint>& points)
{
  std::vector<Kernel::Point_3> few;
  const auto join = [&](const std::vector<std::size_t>& chosen) {
    for (const std::size_t i : chosen) {
      const ExactPoint p = exactLocal(frame, points[i].given);
      few.emplace_back(p[0], p[1], p[2]);
    }
  };
  join(firstGuess(points));
  for (;;) {
    const MinSphere sphere(few.begin(), few.end());
    const Exact squared_radius = sphere.squared_radius();
    const ExactPoint center = {sphere.center().x(), sphere.center().y(), sphere.center().z()};
    const Point3 near_center = {CGAL::to_double(center[0]), CGAL::to_double(center[1]), CGAL::to_double(center[2])};
    const double near_radius = std::sqrt(CGAL::to_double(squared_radius)) * (1.0 - 0x1p-50);
    std::vector<Excess> outside;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (surelyWithin(near_center, near_radius, points[i])) continue;
      const Exact beyond = squaredDistance(exactLocal(frame, points[i].given), center) - squared_radius;
      if (beyond > 0) outside.push_back({CGAL::to_double(beyond), i});
    }
    if (outside.empty()) return squared_radius;
    few.assign(sphere.support_points_begin(), sphere.support_points_end());
    join(farthest(outside));
  }
}

/// The square root of x > 0: computed in double, then improved by one step of Newton's method.
Exact rootOf(const Exact& x)
{
  const Exact first = std::sqrt(CGAL::to_double(x));
  if (first == 0) return first;
  return (first + x / first) / 2;
}

/// The radius, in units, of the smallest sphere around the points' balls; as above, except that its centre has square
/// roots. So whether a ball is inside is known to double precision only.
Exact minimalRadiusOfBalls(const LocalFrame& frame, const std::vector<CertifiedPoint>& points)
{
  std::vector<std::size_t> few = firstGuess(points);
  for (;;) {
    MinSphereOfBalls sphere;
    for (const std::size_t i : few) {
      const ExactPoint p = exactLocal(frame, points[i].given);
      sphere.insert({Kernel::Point_3(p[0], p[1], p[2]), exactRadius(frame, points[i])});
    }
    const Exact root = rootOf(sphere.discriminant());
    const auto value = [&](const auto& with_root) -> Exact { return with_root.first + with_root.second * root; };
    const Exact radius = value(sphere.radius());
    Point3 center;
    auto coordinate = sphere.center_cartesian_begin();
    for (double& c : center) c = CGAL::to_double(value(*coordinate++));
    const double enough = CGAL::to_double(radius) * (1.0 + 1e-10);
    std::vector<Excess> outside;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double beyond = reach(center, points[i]).value - enough;
      const bool joined = std::find(few.begin(), few.end(), i) != few.end();
      if (beyond > 0.0 && !joined) outside.push_back({beyond, i});
    }
    if (outside.empty()) return radius;
    const std::vector<std::size_t> more = farthest(outside);
    few.insert(few.end(), more.begin(), more.end());
  }
}

} // namespace

CertifiedPoint certifiedPoint(const LocalFrame& frame, const Point3& given, double radius)
{
  CertifiedPoint point{given, radius, {}, radius / frame.unit};
  for (std::size_t k = 0; k < 3; ++k) point.local[k] = (given[k] - frame.origin[k]) / frame.unit;
  return point;
}

bool surelyContains(const StoredSphere& sphere, const CertifiedPoint& point)
{
  return surelyWithin({sphere.x, sphere.y, sphere.z}, sphere.r, point);
}

double excess(const LocalFrame& frame, const StoredSphere& sphere, const CertifiedPoint& point)
{
  constexpr double everything = std::numeric_limits<double>::infinity();
  for (const float number : {sphere.x, sphere.y, sphere.z, sphere.r}) {
    if (std::isnan(number) || std::isinf(number)) // not rational; an infinite sphere proves nothing, so it leaks
      return everything;
  }
  const ExactPoint center = {sphere.x, sphere.y, sphere.z};
  const Exact squared = squaredDistance(exactLocal(frame, point.given), center);
  const Exact room = Exact(sphere.r) - exactRadius(frame, point); // for the point alone
  if (room >= 0 && squared <= room * room) return 0.0;
  // As (s - m^2) / (d + m), d = sqrt(s): nothing cancels in the doubles.
  const double distance = std::sqrt(CGAL::to_double(squared)), near_room = CGAL::to_double(room);
  const Exact beyond = squared - room * room;
  const double units = room >= 0 ? CGAL::to_double(beyond) / (distance + near_room) : distance - near_room;
  return std::max(units * frame.unit, std::numeric_limits<double>::denorm_min());
}

std::optional<double> radiusRatio(const LocalFrame& frame, const StoredSphere& sphere,
                                  const std::vector<CertifiedPoint>& points)
{
  const bool balls = std::any_of(points.begin(), points.end(), [](const auto& p) { return p.given_radius > 0.0; });
  const Exact stored = sphere.r;
  const Exact smallest = balls ? squareOf(minimalRadiusOfBalls(frame, points)) : minimalSquaredRadius(frame, points);
  if (smallest == 0) return std::nullopt;
  const Exact squared_ratio = stored * stored / smallest;
  if (!balls && squared_ratio < 1) throw std::logic_error("certify: a sphere is smaller than the smallest possible");
  return std::max(1.0, std::sqrt(CGAL::to_double(squared_ratio)));
}

} // namespace pcl_bsh
