// SPDX-License-Identifier: BSD-3-Clause
#include "peer/search_peer.h"

#include <stdexcept>

namespace pcl_bsh::bench {

std::unique_ptr<SearchRacer> makeSearchRacer(const std::string& name)
{
  if (name == "pcl_bsh") return makeSphereSearch();
  if (name == "pcl_bsh_batch") return makeSphereBatch(1);
  if (name == "pcl_bsh_batch2") return makeSphereBatch(2);
  if (name == "pcl_kdtree") return makePclKdTreeSearch();
  if (name == "pcl_octree") return makePclOctreeSearch();
  if (name == "nanoflann") return makeNanoflannSearch();
  if (name == "grid") return makeGridSearch();
  throw std::invalid_argument("racer '" + name + "' is unknown: see --help");
}

} // namespace pcl_bsh::bench
