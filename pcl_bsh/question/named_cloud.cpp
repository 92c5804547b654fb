// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/named_cloud.h>

#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <utility>

namespace pcl_bsh {

NamedCloud namedCloud(std::string name, const SphereHierarchy& points)
{
  NamedCloud cloud;
  cloud.name = std::move(name);
  cloud.points = points.view().size();
  cloud.finite = points.size();
  cloud.is_surface = points.view().triangles != nullptr;
  if (cloud.is_surface) cloud.loose = looseVertices(*points.view().triangles);
  cloud.coordinate_spacing = points.coordinateSpacing();
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
