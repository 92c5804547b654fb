// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace pcl_bsh::test {

/// Calls of operator new by this thread so far.
std::size_t allocations() noexcept;

} // namespace pcl_bsh::test
