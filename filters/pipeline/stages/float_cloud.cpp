// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/clashes/extent.h>
#include <pcl_bsh/filters/pipeline/stages/float_cloud.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/neighbors/spacing.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace pcl_bsh::pipeline {
namespace {

Point3 middleOf(const PointsView& points)
{
  const auto [least, most] = extentOf(points).value_or(Extent());
  return {least[0] / 2 + most[0] / 2, least[1] / 2 + most[1] / 2, least[2] / 2 + most[2] / 2};
}

} // namespace

FloatCloud floatCloud(const PointsView& points)
{
  FloatCloud cloud;
  cloud.points = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  if (points.scalar == Scalar::float64) cloud.origin = middleOf(points);
  cloud.points->reserve(points.count);
  cloud.records.reserve(points.count);
  for (std::uint32_t i = 0; i < points.count; ++i) {
    const Point3 p = points.point(i);
    if (!isFinite(p)) continue;
    float local[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const double exact = p[k] - cloud.origin[k];
      if (std::abs(exact) > std::numeric_limits<float>::max()) {
        throw std::invalid_argument("a coordinate is too large for float32, in which this stage computes: remove it");
      }
      local[k] = roundToFloat(exact);
      cloud.moved = std::max(cloud.moved, std::abs(static_cast<double>(local[k]) - exact));
    }
    cloud.points->emplace_back(local[0], local[1], local[2]);
    cloud.records.push_back(i);
  }
  cloud.points->is_dense = true;
  return cloud;
}

double neighbourSpacing(const PointsView& points, const FloatCloud& cloud)
{
  if (cloud.moved == 0) return std::numeric_limits<double>::infinity();
  return spacingOf(SphereHierarchy(points)).median;
}

std::string roundingWarning(const FloatCloud& cloud, double length)
{
  if (cloud.moved <= length * 1e-4) return {};
  const std::string text =
      plainText("float32, in which neighbours are searched, moves points of this float64 cloud by up to ", cloud.moved);
  if (cloud.moved > length * 1e-2) throw std::invalid_argument(text + ": crop the cloud first");
  return text;
}

} // namespace pcl_bsh::pipeline
