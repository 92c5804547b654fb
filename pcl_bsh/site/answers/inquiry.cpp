// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/site/answers/inquiry.h>

namespace pcl_bsh::site {

/// To be called by all ranks, after the visit.
TilesRead Inquiry::readOf(std::size_t needed) const
{
  TilesRead found;
  found.tiles = site_.tiles.size();
  found.needed = needed;
  found.read = sumOfAllRanks(visitor_.read());
  found.costs = costsOfAllRanks();
  return found;
}

std::vector<TileCost> Inquiry::costsOfAllRanks() const
{
  std::vector<double> own;
  for (const TileCost& cost : visitor_.costs())
    own.insert(own.end(), {static_cast<double>(cost.tile), static_cast<double>(cost.place), cost.reading, cost.asking});
  const std::vector<double> all = gatheredFromAllRanks(own);
  std::vector<TileCost> costs;
  for (std::size_t i = 0; i < all.size(); i += 4)
    costs.push_back(
        {static_cast<std::uint32_t>(all[i]), static_cast<std::uint32_t>(all[i + 1]), all[i + 2], all[i + 3]});
  std::sort(costs.begin(), costs.end(), [](const TileCost& c, const TileCost& d) { return c.place < d.place; });
  return costs;
}

} // namespace pcl_bsh::site
