// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace pcl_bsh::test {

/// Calls of operator new by this thread so far.
std::size_t allocations() noexcept;

/// Bytes that the largest of these calls asked for, since the last call of this function by this thread.
std::size_t takeLargestAllocation() noexcept;

} // namespace pcl_bsh::test
