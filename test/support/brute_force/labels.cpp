// SPDX-License-Identifier: BSD-3-Clause
#include "labels.h"

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/geometry/triangle/winding.h>
#include <pcl_bsh/query/request_check.h>

#include <optional>

namespace pcl_bsh::brute_force {

LabelsResult labelPoints(const Placed& cloud, const PlacedSolid& solid)
{
  checkPoses(cloud.pose, solid.pose);
  const DefaultFloatEnvironment environment;
  const PointsView& points = cloud.hierarchy().view();
  const TrianglesView& triangles = solid.solid->triangles();
  const Winding winding(cloud.pose, solid.pose);
  LabelsResult found;
  found.labels.assign(points.count, labelOf(Label::outside));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t record = points.record(i);
    const Point3 p = points.point(record);
    if (!isFinite(p)) continue;
    const std::optional<int> turns = winding.number(
        p, triangles.count, [&](std::size_t t) { return triangles.triangle(static_cast<std::uint32_t>(t)); });
    found.work.exact_decisions += triangles.count;
    found.labels[record] = labelOf(!turns ? Label::surface : *turns != 0 ? Label::inside : Label::outside);
  }
  for (const std::uint8_t label : found.labels) {
    found.inside += label == labelOf(Label::inside);
    found.on_surface += label == labelOf(Label::surface);
  }
  return found;
}

} // namespace pcl_bsh::brute_force
