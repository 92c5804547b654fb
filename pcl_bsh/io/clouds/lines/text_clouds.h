// SPDX-License-Identifier: BSD-3-Clause
// Points as lines of text. Decimal numbers, so coordinates are float64.
#pragma once

#include <pcl_bsh/io/text/column_names.h>

#include <pcl/PCLPointCloud2.h>

#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// .xyz, .asc, .txt, .csv: a point per line. Values are separated by semicolons, commas, tabs or blanks, as the first
/// line that has values says. The line, or a comment before it (// or #) with as many words, may name the columns: x, y
/// and z are among them, or what withAxes() takes for them. Then colours of a byte per channel are packed, and normals
/// get PCL's names (pcl_names.h). Without a row, a file that names x, y and z is an empty cloud. A line of one whole
/// number before the first row counts the points, as CloudCompare writes it: fewer are an error, more a remark.
///
/// Columns without names may be a colour or a normal. Columns 4 to 6 are a colour if in all rows they are whole numbers
/// from 0 to 255, and each exceeds 31 in some row, as no return and no class of LAS does. The last three of nine or
/// more are a normal beside it if all are of length 1 (or 0). Columns are float64. Whole numbers beyond 2^53 are INT64
/// or UINT64. Words that are no number, or have more digits than float64 holds, are INT8 of a count: the bytes of the
/// text and zeros behind them (column_kinds.h).
/// @param given names of all columns, whatever the file says
/// @param remarks if not null, gets a line where columns without names were taken for a colour or a normal, and where
///   the first of four or more columns without a name counts the rows
/// @throws FormatError
pcl::PCLPointCloud2 parseColumns(std::string_view file, const ColumnNames& given = {},
                                 std::vector<std::string>* remarks = nullptr);

/// Only the fields that parseColumns() makes. Rows are looked at where they tell whether columns are a colour.
/// @param whole false: this is the file's beginning
/// @throws FormatError, also where the fields depend on all rows, and `whole` is false
pcl::PCLPointCloud2 parseColumnNames(std::string_view file, bool whole = true, const ColumnNames& given = {});

/// .obj: the `v` lines, with their colours; the `vn` lines where there is one for each vertex, and no face says
/// otherwise. A file without vertices is an empty cloud when it says so in a comment `# Vertices: 0`.
/// @param remarks if not null, gets a remark where such a comment counts fewer vertices than there are
/// @throws FormatError
pcl::PCLPointCloud2 parseObj(std::string_view file, std::vector<std::string>* remarks = nullptr);

/// Only the fields that parseObj() makes; looks for colours and normals in all of the file.
pcl::PCLPointCloud2 parseObjHeader(std::string_view file);

/// .off, with any of the prefixes that keep three coordinates (ST, C, N, in any order): the vertices, with their
/// normals and colours. @throws FormatError
pcl::PCLPointCloud2 parseOff(std::string_view file);

/// Only the fields that parseOff() makes. @throws FormatError
pcl::PCLPointCloud2 parseOffHeader(std::string_view file);

/// A first line that names the columns, then a point per line, every number with as many digits as its type needs. A
/// packed colour is columns r g b [a], normals are nx ny nz, texts are as they were read.
/// @param separator between values: a blank, or what CSV has
/// @throws FormatError when a field cannot be a column
void writeColumns(std::ostream& out, const pcl::PCLPointCloud2& cloud, char separator = ' ');

/// The fields that an .obj has a place for: x y z, a packed colour, normals.
std::vector<pcl::PCLPointField> fieldsForObj(const pcl::PCLPointCloud2& cloud);

/// A `v` line per point, with the three or four channels of its colour as shares of 1, after a `vn` line if it has a
/// normal.
/// @throws FormatError when the cloud has other fields
void writeObj(std::ostream& out, const pcl::PCLPointCloud2& cloud);

} // namespace pcl_bsh::io
