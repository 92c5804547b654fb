// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/query/result.h>

#include <cstdint>
#include <map>
#include <string>

namespace pcl_bsh::test {

/// All counts of a query, by name, to be compared and printed as a whole.
inline std::map<std::string, std::uint64_t> countsOf(const Work& work)
{
  return {
      {"node_pairs", work.node_pairs}, {"volumes_carried", work.volumes_carried}, {"volumes_built", work.volumes_built},
      {"leaf_pairs", work.leaf_pairs}, {"exact_decisions", work.exact_decisions}, {"voxels_built", work.voxels_built},
      {"ranked", work.ranked}};
}

} // namespace pcl_bsh::test
