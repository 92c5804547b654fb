// SPDX-License-Identifier: BSD-3-Clause
// Handles removed points where a cloud keeps its rows and columns.
#pragma once

#include <pcl_bsh/export.h>

#include <pcl/PCLPointCloud2.h>
#include <pcl/types.h>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Sets x, y and z of these records to the value, in the type the cloud has; a value that is not finite makes the cloud
/// not dense. Other fields stay. @throws std::invalid_argument as viewOf() does
void overwritePoints(pcl::PCLPointCloud2& cloud, const pcl::Indices& records, float value);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
