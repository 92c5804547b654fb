// SPDX-License-Identifier: BSD-3-Clause
// Memory that the library keeps for its next use, in the whole process: the buffers of hierarchies that have ended
// (large_buffer.h) and the scratch memory of threads (kept_scratch.h). One limit, and one call that gives it back.
//
//   setRetainedMemoryLimit(0);  // keep nothing from now on
//   releaseRetainedMemory();    // once, after the largest cloud
#pragma once

#include <pcl_bsh/export.h>

#include <cstddef>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Bytes kept: large buffers of hierarchies and searches that have ended, and each thread's scratch memory (of threads
/// that are in a query, as it was before that query). Not what hierarchies, results and scenes hold. May be called from
/// any thread, as all functions here.
std::size_t retainedMemory() noexcept;

/// 256 MB unless it was set.
std::size_t retainedMemoryLimit() noexcept;

/// At most so many bytes are kept from now on; what exceeds them is given back, the oldest buffers first. Scratch of a
/// query in progress follows when that query ends. Answers do not depend on it; times do: pages that were given back
/// are touched for the first time once more.
void setRetainedMemoryLimit(std::size_t bytes) noexcept;

/// Gives back all that is kept; the limit stays. Scratch of a query in progress stays with its thread.
void releaseRetainedMemory() noexcept;

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
