// SPDX-License-Identifier: BSD-3-Clause
// x y z of clouds as files have them, in the types that queries take.
#pragma once

#include <pcl_bsh/io/clouds/systems/system_transform.h>
#include <pcl_bsh/io/text/length_unit.h>

#include <pcl/PCLPointCloud2.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// Whether x y z, of which there is one each, are integers of any types.
bool hasIntegerCoordinates(const pcl::PCLPointCloud2& cloud);

/// Where x y z are integers, makes float64 of them. Records may be there or not. Padding between fields is not kept.
/// @throws FormatError for an integer that float64 does not hold
void makeCoordinatesPlain(pcl::PCLPointCloud2& cloud);

/// Converts x y z and fields with these names, which become float64. Records may be there or not. Padding between
/// fields is not kept where a field was of another type. @pre usable x y z. A field that is not there is left out
/// @throws FormatError for a field of several numbers, and for a length that float64 does not hold
void scaleLengths(pcl::PCLPointCloud2& cloud, const LengthScale& scale, const std::vector<std::string>& more = {});

/// Makes float64 of x y z, as scaleLengths() does.
void makeCoordinatesDouble(pcl::PCLPointCloud2& cloud);

/// Transforms x y z, which become float64. @param first the number of the first record, for errors
/// @throws FormatError as the transform does
void transformPlaces(pcl::PCLPointCloud2& cloud, const SystemTransform& transform, std::uint64_t first = 0);

/// Enlarges a box by a cloud's finite points.
void extendBy(const pcl::PCLPointCloud2& cloud, Eigen::AlignedBox3d& box);

/// Requires that the points have usable x y z. @throws FormatError
void requireCoordinates(const pcl::PCLPointCloud2& cloud);

} // namespace pcl_bsh::io
