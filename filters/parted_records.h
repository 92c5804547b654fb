// SPDX-License-Identifier: BSD-3-Clause
// What a filter keeps of its input, and what it removes.
#pragma once

#include <pcl_bsh/hierarchy/points_view.h>

#include <pcl/types.h>

#include <cstddef>
#include <cstdint>
#include <utility>

namespace pcl_bsh {

/// Parts the input's records, in their order. `kept` may be the very list that the input is seen through: it is
/// replaced only at the end.
/// @param keeps bool(record)
/// @param removed may be null
template <typename Keeps>
void partRecords(const PointsView& input, const Keeps& keeps, pcl::Indices& kept, pcl::Indices* removed)
{
  pcl::Indices keep;
  pcl::Indices remove;
  for (std::size_t i = 0; i < input.size(); ++i) {
    const std::uint32_t record = input.record(i);
    if (keeps(record))
      keep.push_back(static_cast<pcl::index_t>(record));
    else if (removed)
      remove.push_back(static_cast<pcl::index_t>(record));
  }
  kept = std::move(keep);
  if (removed) *removed = std::move(remove);
}

} // namespace pcl_bsh
