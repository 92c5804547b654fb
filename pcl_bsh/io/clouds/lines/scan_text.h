// SPDX-License-Identifier: BSD-3-Clause
// Leica's text formats of terrestrial scans: PTS, and PTX with the scanner's pose.
#pragma once

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <pcl/PCLPointCloud2.h>

#include <cstddef>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// .pts: a line with the number of points, then a point per line: x y z, x y z intensity, x y z r g b or x y z
/// intensity r g b. More values are column_8 ... Several such blocks may follow each other. A block may have more
/// points than it says, as some writers' do, but no fewer. x y z are float64, intensity float32, colours are packed as
/// rgb. A file whose first line names columns, is a comment, or has commas or semicolons is one of columns
/// (parseColumns()).
/// @param remarks if not null, gets a remark where blocks have more points than they say
/// @throws FormatError
pcl::PCLPointCloud2 parsePts(std::string_view file, std::vector<std::string>* remarks = nullptr);

/// Only the fields that parsePts() makes, from a file's beginning. @param whole as of parseColumnNames()
/// @throws FormatError
pcl::PCLPointCloud2 parsePtsHeader(std::string_view file, bool whole = true);

/// .ptx: scans, each of ten lines and columns x rows points, column by column. The lines have columns, rows, the
/// scanner's registered position and axes, and a 4 x 4 transform whose rows are applied to a point from the left. All
/// points are transformed into the common frame. "No return", which is 0 0 0 with intensity 0, 0.5 or none, is NaN.
///
/// One scan is an organised cloud of its columns and rows. Several scans are one row of their points, in the file's
/// order, with a field `scan` (uint16, from 0). x y z are float64, intensity float32, colours are packed as rgb.
/// @param scan only that one, from 0
/// @param viewpoint the scanner's pose in the common frame: the transform's position, and its rotation; of several
/// scans, the first one's
/// @param scanners null, or gets the pose of each scan that is read
/// @param allow_scale transforms may scale uniformly
/// @param remarks null, or gets a line where the nearest rotation took the place of a transform's (rigid_pose.h)
/// @throws FormatError; for a transform that is no rigid motion, with the scan's number
pcl::PCLPointCloud2 parsePtx(std::string_view file, Viewpoint& viewpoint, std::optional<std::size_t> scan = {},
                             std::vector<Viewpoint>* scanners = nullptr, bool allow_scale = false,
                             std::vector<std::string>* remarks = nullptr);

/// Only the fields that parsePtx() makes; looks how many scans there are. Throws as it does for transforms.
pcl::PCLPointCloud2 parsePtxHeader(std::string_view file, std::optional<std::size_t> scan = {},
                                   bool allow_scale = false);

/// The fields that scans have a place for: x y z, intensity, rgb, columns that readers number; of PTX also `scan`.
std::vector<pcl::PCLPointField> fieldsForScans(const pcl::PCLPointCloud2& cloud, bool several_scans);

/// A line with the number of points, then a line for each: x y z, intensity, r g b, where the cloud has them; columns
/// that parsePts() could not name, as it numbers them. Points without finite coordinates are left out.
/// @throws FormatError when the cloud has other fields
void writePts(std::ostream& out, const pcl::PCLPointCloud2& cloud);

/// One scan, or one for each run of points with the same value of a field `scan`. Points that are not finite are "no
/// return". An organised cloud keeps its columns and rows; others have a column for each point.
/// @param viewpoint the scanner's pose: points are written as it sees them, which rounds their coordinates a few times
///   in float64. no_viewpoint: as they are
/// @throws FormatError when the cloud has other fields than those of writePts() and `scan`; for a point that PTX takes
///   for no return
void writePtx(std::ostream& out, const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint);

} // namespace pcl_bsh::io
