// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/hierarchy/kept_scratch.h>

#include <cstddef>
#include <deque>

namespace pcl_bsh {

/// One visit for each depth of a walk, with its lists `near`: kept from voxel to voxel for their storage only. A deque,
/// for references to shallower visits stay in use. To be had by a ScratchLease.
template <class Visit>
struct KeptVisits {
  std::deque<Visit> visits;

  std::size_t bytes() const noexcept
  {
    std::size_t sum = visits.size() * sizeof(Visit);
    for (const Visit& visit : visits)
      for (const auto& list : visit.near) sum += list.capacity() * sizeof(*list.data());
    return sum;
  }
};

} // namespace pcl_bsh
