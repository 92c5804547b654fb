// SPDX-License-Identifier: BSD-3-Clause
// PCL's clouds, seen in place as the points a hierarchy is built on.
//
//   SphereHierarchy hall(viewOf(*cloud));           // cloud: pcl::PointCloud<PointT> or pcl::PCLPointCloud2
//   SphereHierarchy part(viewOf(*cloud, indices));  // only these points; numbers stay those of the whole cloud
//
//   SphereHierarchy kept(viewOf(cloud));            // a shared pointer: the hierarchy keeps the cloud alive
//
// A view of a reference borrows: cloud and indices must outlive it. The points must not change in either case.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/search/pcl_abi.h>

#include <pcl/PCLPointCloud2.h>
#include <pcl/point_cloud.h>
#include <pcl/types.h>

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <type_traits>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

static_assert(std::is_same_v<pcl::index_t, std::int32_t>, "pcl_bsh needs a PCL built with its default 32-bit indices");

/// View of a typed cloud. Members x, y, z of PointT are all float or all double.
template <typename PointT>
PointsView viewOf(const pcl::PointCloud<PointT>& cloud)
{
  using Coordinate = decltype(PointT::x);
  static_assert(std::is_same_v<Coordinate, float> || std::is_same_v<Coordinate, double>, "x must be float or double");
  static_assert(std::is_same_v<decltype(PointT::y), Coordinate> && std::is_same_v<decltype(PointT::z), Coordinate>,
                "x, y and z must be of one type");

  PointsView view;
  view.count = cloud.size();
  view.stride = sizeof(PointT);
  view.scalar = std::is_same_v<Coordinate, float> ? Scalar::float32 : Scalar::float64;
  if (cloud.empty()) return view;

  // Measured on a point: offsetof is not defined for every type that PCL accepts.
  const PointT& first = *cloud.begin();
  const auto* const start = reinterpret_cast<const char*>(&first);
  const auto offset = [start](const Coordinate& member) {
    return static_cast<std::size_t>(reinterpret_cast<const char*>(&member) - start);
  };
  view.data = start;
  view.offset = {offset(first.x), offset(first.y), offset(first.z)};
  return view;
}

/// View of a cloud that names its fields at run time. x, y, z are FLOAT32 or FLOAT64, all three alike, one value each,
/// anywhere in the record.
/// @throws std::invalid_argument naming the field or the number that is wrong: a field missing or of another type, a
///   byte order not this machine's, padding between rows, fewer bytes than width * height records need.
PointsView viewOf(const pcl::PCLPointCloud2& cloud);

/// View of a shared cloud, which the view, and what is built on it, keeps alive.
/// @throws std::invalid_argument when the pointer is null, or as viewOf() of the cloud does.
template <typename Cloud>
PointsView viewOf(const std::shared_ptr<Cloud>& cloud)
{
  if (!cloud) throw std::invalid_argument("cloud is null: give an empty cloud if there are no points");
  PointsView view = viewOf(*cloud);
  view.owner = cloud;
  return view;
}

/// The view of a subset. An empty list names no point.
template <typename Cloud>
PointsView viewOf(const Cloud& cloud, const pcl::Indices& indices)
{
  PointsView view = viewOf(cloud);
  view.restrictTo(indices.data(), indices.size());
  return view;
}

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
