// SPDX-License-Identifier: BSD-3-Clause
// A LAZ file seen as the LAS file that was compressed, which is never there as a whole: for code that reads LAS.
#pragma once

#include <pcl_bsh/io/clouds/las/header.h>
#include <pcl_bsh/io/text/byte_source.h>

#include <cstdint>
#include <memory>

namespace pcl_bsh::io {

/// The file itself when its points are not compressed. Otherwise it has all contents of the file, with the places of an
/// uncompressed file in its header. It leaves out the records of the compression and of COPC's parts. Points are
/// unpacked where they are read: some chunks at once, on as many threads, or a piece of a large one. So reading from
/// front to back is fast, and takes memory for a chunk per thread, compressed, and at most 4 MB of its points; where
/// chunks have no table, for all that is compressed.
/// @param threads 0: as many as the caller's oneTBB arena has
/// @param more null, or gets how many points the chunks have at least that the header does not count
/// @throws FormatError as readLasBlock(); for a compression that is not read; for a table of chunks that the file has
///   no room for. read() does so for chunks that are damaged
std::unique_ptr<ByteSource> unpackedLaz(std::unique_ptr<ByteSource> file, unsigned threads,
                                        std::uint64_t* more = nullptr);

} // namespace pcl_bsh::io
