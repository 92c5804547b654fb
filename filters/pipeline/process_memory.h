// SPDX-License-Identifier: BSD-3-Clause
// What the whole program holds, in bytes.
#pragma once

#include <cstddef>

namespace pcl_bsh::pipeline {

/// In memory now; 0 where the system does not tell.
std::size_t residentBytes();

/// The most that was in memory so far.
std::size_t peakBytes();

} // namespace pcl_bsh::pipeline
