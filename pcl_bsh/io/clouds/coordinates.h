// SPDX-License-Identifier: BSD-3-Clause
// x y z of clouds as files have them, in the types that queries take.
#pragma once

#include <pcl/PCLPointCloud2.h>

namespace pcl_bsh::io {

/// Whether x y z, of which there is one each, are integers of any types.
bool hasIntegerCoordinates(const pcl::PCLPointCloud2& cloud);

/// Where x y z are integers, makes float64 of them. Records may be there or not; what lies between the fields does not
/// stay.
/// @throws FormatError for an integer that float64 does not hold
void makeCoordinatesPlain(pcl::PCLPointCloud2& cloud);

/// Requires that the points have usable x y z. @throws FormatError
void requireCoordinates(const pcl::PCLPointCloud2& cloud);

} // namespace pcl_bsh::io
