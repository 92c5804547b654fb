// SPDX-License-Identifier: BSD-3-Clause
// Memory that runs out when a test says so: this executable's operator new counts, and throws where it is told to.
#pragma once

#include <cstddef>

namespace pcl_bsh::test {

/// The fate of allocations after one that fails.
enum class Shortage {
  once,   ///< they get their memory
  lasting ///< they fail as well
};

/// While it lives, the k-th allocation from now on throws std::bad_alloc, whichever thread asks. One at a time.
class FailingAllocation {
public:
  /// @param k counted from 1; 0: none fails
  explicit FailingAllocation(std::size_t k, Shortage shortage = Shortage::once) noexcept;
  ~FailingAllocation();
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;

  bool hasHappened() const noexcept;
  std::size_t allocations() const noexcept; ///< since it began
};

/// Blocks that were allocated and not freed.
std::ptrdiff_t liveAllocations() noexcept;

} // namespace pcl_bsh::test
