// SPDX-License-Identifier: BSD-3-Clause
#ifdef PCL_BSH_SITE_QUERIES
#include "plan.h"

#include <algorithm>

namespace pcl_bsh::cli {

namespace {

double secondsOf(const site::TileCost& tile)
{
  return tile.reading + tile.asking;
}

/// Seconds of work of the busiest of so many ranks, where each takes the next tile when it has done one.
double busiestOf(const std::vector<site::TileCost>& tiles, std::size_t ranks)
{
  std::vector<double> load(std::min(ranks, std::max<std::size_t>(tiles.size(), 1)), 0.0);
  for (const site::TileCost& tile : tiles) *std::min_element(load.begin(), load.end()) += secondsOf(tile);
  return *std::max_element(load.begin(), load.end());
}

} // namespace

RunPlan planRun(const MeasuredRun& run, unsigned ranks)
{
  RunPlan plan;
  plan.ranks = ranks;
  double longest = 0.0, sum = 0.0;
  for (const site::TileCost& tile : run.tiles) {
    longest = std::max(longest, secondsOf(tile));
    sum += secondsOf(tile);
    plan.reading += tile.reading;
  }
  plan.on_all = std::max(run.seconds - busiestOf(run.tiles, static_cast<std::size_t>(run.ranks)), 0.0);
  plan.busiest = busiestOf(run.tiles, ranks);
  plan.even = sum / ranks;
  plan.copying = run.copying * run.ranks / ranks;
  plan.seconds = plan.on_all + plan.busiest + plan.copying;
  constexpr double most = 0.5; // what takes a larger share of the time is the limit
  if (plan.on_all > most * plan.seconds)
    plan.limit = "what all ranks do";
  else if (ranks > 1 && longest >= 0.9 * plan.busiest)
    plan.limit = run.tiles.size() <= ranks ? "too few tiles" : "the longest tile";
  else if (plan.busiest > 1.25 * plan.even)
    plan.limit = "uneven tiles";
  else
    plan.limit = "work";
  return plan;
}

} // namespace pcl_bsh::cli
#endif
