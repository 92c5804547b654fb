// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/question/scan_origins.h>

namespace pcl_bsh::io {

/// The field that numbers the scans of a merged cloud, from 0, where our readers make one.
inline constexpr auto scan_field_name = "scan";

/// Whether it is one of beam_field_names.
bool isBeamField(const std::string& name);

/// Where the scanners of a cloud stood, as its file has it: of each scan of a .ptx or .e57; else the viewpoint. Not
/// known where the viewpoint is the origin, as in files without a viewpoint, or where it would stand for several scans.
ScanOrigins originsOf(const pcl::PCLPointCloud2& cloud, const CloudFacts& facts);

} // namespace pcl_bsh::io
