// SPDX-License-Identifier: BSD-3-Clause
// Large buffers that nobody uses, kept within the limit of retained_memory.h.
#pragma once

#include <pcl_bsh/hierarchy/large_buffer.h>

namespace pcl_bsh {

/// The smallest that holds `size` bytes and is not twice as large, the youngest of these; null when there is none.
AllocatedBuffer takeKeptBuffer(std::size_t size) noexcept;

/// Keeps a buffer; gives back the oldest ones for it, or itself where it exceeds the limit alone.
void keepBuffer(const AllocatedBuffer& buffer) noexcept;

} // namespace pcl_bsh
