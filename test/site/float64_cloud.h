// SPDX-License-Identifier: BSD-3-Clause
// Points as a cloud that can be written to a file.
#pragma once

#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/io/clouds/records.h>

#include <pcl/PCLPointCloud2.h>

#include <cstdint>
#include <cstring>
#include <vector>

namespace pcl_bsh::site {

inline pcl::PCLPointCloud2 float64Cloud(const std::vector<Point3>& points)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* axis : {"x", "y", "z"}) io::addField(cloud, axis, pcl::PCLPointField::FLOAT64);
  io::allocate(cloud, static_cast<std::uint32_t>(points.size()));
  if (!points.empty()) std::memcpy(cloud.data.data(), points.data(), cloud.data.size());
  return cloud;
}

} // namespace pcl_bsh::site
