// SPDX-License-Identifier: BSD-3-Clause
// The parts of ROS 2's pcl_conversions that the README's example uses.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <utility>

namespace sensor_msgs::msg {
struct PointCloud2 {
  pcl::PCLPointCloud2 cloud;
};
} // namespace sensor_msgs::msg

namespace pcl_conversions {

inline void toPCL(const sensor_msgs::msg::PointCloud2& message, pcl::PCLPointCloud2& cloud)
{
  cloud = message.cloud;
}

inline void moveFromPCL(pcl::PCLPointCloud2& cloud, sensor_msgs::msg::PointCloud2& message)
{
  message.cloud = std::move(cloud);
}

} // namespace pcl_conversions
