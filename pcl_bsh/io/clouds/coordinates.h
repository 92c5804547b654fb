// SPDX-License-Identifier: BSD-3-Clause
// x y z of clouds as files have them, in the types that queries take.
#pragma once

#include <pcl_bsh/io/text/length_unit.h>

#include <pcl/PCLPointCloud2.h>

#include <string>
#include <vector>

namespace pcl_bsh::io {

/// Whether x y z, of which there is one each, are integers of any types.
bool hasIntegerCoordinates(const pcl::PCLPointCloud2& cloud);

/// Where x y z are integers, makes float64 of them. Records may be there or not; what lies between the fields does not
/// stay.
/// @throws FormatError for an integer that float64 does not hold
void makeCoordinatesPlain(pcl::PCLPointCloud2& cloud);

/// Converts x y z and fields with these names, which become float64. Records may be there or not; what lies between the
/// fields does not stay where one was of another type. @pre usable x y z. A field that is not there is left out
/// @throws FormatError for a field of several numbers, and for a length that float64 does not hold
void scaleLengths(pcl::PCLPointCloud2& cloud, const LengthScale& scale, const std::vector<std::string>& more = {});

/// Requires that the points have usable x y z. @throws FormatError
void requireCoordinates(const pcl::PCLPointCloud2& cloud);

} // namespace pcl_bsh::io
