// SPDX-License-Identifier: BSD-3-Clause
// Clouds of some of the records of another: every byte of a record stays as it is.
#pragma once

#include <pcl_bsh/export.h>

#include <pcl/PCLPointCloud2.h>
#include <pcl/types.h>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// A cloud with the header and the fields of this one, and no records: one row of width 0.
pcl::PCLPointCloud2 withoutRecords(const pcl::PCLPointCloud2& cloud);

/// The records with these numbers, in their order, as one row. pcl::copyPointCloud() counts bytes with 32 bits; this
/// does not.
/// @param records each less than width * height of the cloud, which has no padding between its rows
pcl::PCLPointCloud2 selectedRecords(const pcl::PCLPointCloud2& cloud, const pcl::Indices& records);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
