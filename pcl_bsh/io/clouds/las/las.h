// SPDX-License-Identifier: BSD-3-Clause
// Clouds written as LAS.
#pragma once

#include <pcl_bsh/io/clouds/las/reader.h>

#include <pcl/PCLPointCloud2.h>

#include <ostream>

namespace pcl_bsh::io {

/// Writes a cloud as LAS.
///
/// With the header of the file that the points come from, everything in it is kept: version, point format, scale and
/// offset, records before and behind the points, whether their meaning is known or not. Counts, bounds and places are
/// made right; bounds that are right to within a scale stay as they are. A point that did not change keeps its
/// integers; a coordinate that moved is rounded to the nearest. Where coordinates have no place at that scale and
/// offset, the offset moves, and where that is not enough, both are chosen anew. A format without time, colour or
/// infrared becomes the one that has it when the cloud has it.
///
/// Without one of a LAS file, it writes LAS 1.4, point format 6, 7 with a colour, 8 with nir. The scale is the same on
/// all axes: the least power of ten for which the cloud's extent needs no more than 31 bits and whose multiples are
/// different doubles. The system that the header names for such points is written as a record of WKT.
///
/// A field of lasFields()'s name goes to its place when each of its values has one there. All other fields, our results
/// among them, become extra bytes with a description; fields of several values become several. rgb or rgba are
/// stored as red green blue unless the cloud has these. Points without finite coordinates have no place in LAS: they
/// are left out.
/// @param header may be null
/// @param is_compressed as LAZ, by LazCompressor; all compressed points are in memory at once
/// @throws FormatError when a field cannot be extra bytes: a name longer than 32, more than 65535 bytes per point
void writeLas(std::ostream& out, const pcl::PCLPointCloud2& cloud, const LasHeader* header, bool is_compressed = false);

} // namespace pcl_bsh::io
