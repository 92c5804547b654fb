// SPDX-License-Identifier: BSD-3-Clause
#include "scenes.h"

#include "hall.h"
#include "real_scans.h"
#include "terrain.h"

namespace pcl_bsh::bench {

std::optional<ScanPair> scene(const std::string& name, std::size_t count, const std::string& folder)
{
  if (name == "terrain") return terrainPair(count);
  if (name == "sweep") return sweepPair(count);
  if (name == "hall") return statueInHall(count);
  return realPair(name, folder);
}

} // namespace pcl_bsh::bench
