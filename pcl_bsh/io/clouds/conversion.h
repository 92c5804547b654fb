// SPDX-License-Identifier: BSD-3-Clause
// Clouds in the unit or the coordinate system that the settings of their reading want.
#pragma once

#include <pcl_bsh/io/clouds/cloud_file.h>

namespace pcl_bsh::io {

/// Converts a cloud, where its scanners stood, and what is told of it. @pre usable x y z; facts have the file's own
/// @throws FormatError as scaleOf(), systemOf(), scaleLengths() and transformPlaces() do
void convert(pcl::PCLPointCloud2& cloud, CloudFacts& facts, const ReadSettings& settings);

/// Gives a header without points the types that convert() gives. @param told unit and system that the file names
void convertHeader(pcl::PCLPointCloud2& header, const CloudFacts& told, const ReadSettings& settings);

} // namespace pcl_bsh::io
