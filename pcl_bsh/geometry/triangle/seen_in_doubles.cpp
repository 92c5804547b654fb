// SPDX-License-Identifier: BSD-3-Clause
// The corners that TriangleDistance computes in doubles, with their error, and the enclosures that follow.
#include <pcl_bsh/geometry/triangle/triangle_distance.h>

#include <pcl_bsh/geometry/triangle/double_distance.h>
#include <pcl_bsh/geometry/triangle/nearest_features.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {

TriangleDistance::Seen TriangleDistance::seen(const Point3& a, const Triangle3& b) const
{
  Seen seen{{}, {}, 0.0};
  for (std::size_t j = 0; j < 3; ++j) {
    const ExactDistance::Difference z = points_.approximate(a, b[j]);
    seen.b[j] = {-z.vector[0], -z.vector[1], -z.vector[2]};
    seen.error = std::max(seen.error, z.error);
  }
  return seen;
}

/// The origin is the first corner of b. The other corners of b are computed by way of the first corner of a.
TriangleDistance::Seen TriangleDistance::seen(const Triangle3& a, const Triangle3& b) const
{
  Seen seen{{}, {}, 0.0};
  double error_a = 0.0, error_b = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const ExactDistance::Difference z = points_.approximate(a[i], b[0]);
    seen.a[i] = z.vector;
    error_a = std::max(error_a, z.error);
  }
  for (std::size_t j = 1; j < 3; ++j) {
    const ExactDistance::Difference z = points_.approximate(a[0], b[j]);
    seen.b[j] = seen.a[0] - z.vector;
    double largest = 0.0;
    for (const double x : seen.b[j]) largest = std::max(largest, std::abs(x));
    error_b = std::max(error_b, error_a + z.error + 2 * kDoubleUnit * largest);
  }
  seen.error = (error_a + error_b) * (1.0 + kDoubleMargin);
  return seen;
}

TriangleDistance::Enclosure TriangleDistance::enclose(const Point3& p, const Triangle3& b) const
{
  const Seen at = seen(p, b);
  if (!isFinite(at.b) || !std::isfinite(at.error))
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  return distanceOfOrigin(flatten<double>(at.b, at.error));
}

TriangleDistance::Enclosure TriangleDistance::enclose(const Triangle3& a, const Triangle3& b, double reach) const
{
  const Seen at = seen(a, b);
  return distanceOfTriangles(at.a, at.b, at.error, reach).distance;
}

} // namespace pcl_bsh
