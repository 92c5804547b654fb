// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/named_cloud.h>

#include <pcl_bsh/geometry/triangle/triangle3.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <utility>

namespace pcl_bsh {

namespace {

Eigen::AlignedBox3d boxOf(const TrianglesView& triangles)
{
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < triangles.count; ++i) {
    const Triangle3 corners = triangles.triangle(static_cast<std::uint32_t>(i));
    if (!isFinite(corners)) continue;
    for (const Point3& corner : corners) box.extend(Eigen::Vector3d(corner.data()));
  }
  return box;
}

} // namespace

NamedCloud namedCloud(std::string name, const SphereHierarchy& points)
{
  NamedCloud cloud;
  cloud.name = std::move(name);
  cloud.points = points.view().size();
  cloud.finite = points.size();
  cloud.coordinate_spacing = points.coordinateSpacing();
  if (const TrianglesView* const triangles = points.view().triangles) {
    cloud.is_surface = true;
    cloud.loose = looseVertices(*triangles);
    cloud.box = boxOf(*triangles);
    return cloud;
  }
  if (points.empty()) return cloud;
  const LocalFrame& frame = points.storage().frame;
  const Eigen::Vector3d middle = Eigen::Map<const Eigen::Vector3d>(frame.origin.data());
  const Eigen::Vector3d reach = frame.unit * Eigen::Map<const Eigen::Vector3d>(frame.reach.data());
  cloud.box = Eigen::AlignedBox3d(middle - reach, middle + reach);
  return cloud;
}

NamedCloud measuredCloud(std::string name, const SphereHierarchy& points)
{
  NamedCloud cloud = namedCloud(std::move(name), points);
  if (!cloud.is_surface) cloud.spacing = spacingOf(points);
  return cloud;
}

Eigen::AlignedBox3d boxAlong(const Eigen::AlignedBox3d& box, const std::vector<Eigen::Isometry3d>& poses)
{
  Eigen::AlignedBox3d all;
  if (box.isEmpty()) return all;
  for (const Eigen::Isometry3d& pose : poses) {
    const Eigen::Vector3d middle = pose * box.center(), reach = pose.linear().cwiseAbs() * (0.5 * box.sizes());
    all.extend(Eigen::AlignedBox3d(middle - reach, middle + reach));
  }
  return all;
}

} // namespace pcl_bsh
