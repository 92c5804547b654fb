// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/hierarchy/points_view.h>

#include <hwy/cache_control.h>

#include <cstdint>

namespace pcl_bsh {

/// Prefetches what will be read soon of a record. Records in the order of a tree are anywhere in the caller's arrays,
/// so that each read would wait for memory.
inline void prefetch(const PointsView& view, std::uint32_t record)
{
  const auto* const base = static_cast<const unsigned char*>(view.data) + view.stride * record;
  hwy::Prefetch(base + view.offset[0]);
  hwy::Prefetch(base + view.offset[2]);
  if (view.radii) hwy::Prefetch(view.radii + record);
}

/// Prefetches entries of an array that has one for each record. @param first, last of the records
template <class Entry>
void prefetchEach(const Entry* entries, const std::uint32_t* first, const std::uint32_t* last)
{
  for (; first != last; ++first) hwy::Prefetch(entries + *first);
}

} // namespace pcl_bsh
